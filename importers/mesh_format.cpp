// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_format.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

namespace hairloom {
namespace {

struct Row {
    MeshFormat format;
    std::string_view name;  ///< the suffix of its files, too, unless there are several
    std::string_view label;
};
constexpr std::array<Row, 8> kFormats{{{MeshFormat::Obj, "obj", "OBJ"},
                                       {MeshFormat::Ply, "ply", "PLY"},
                                       {MeshFormat::Stl, "stl", "STL"},
                                       {MeshFormat::Fbx, "fbx", "FBX"},
                                       {MeshFormat::Gltf, "gltf", "glTF"},
                                       {MeshFormat::Glb, "glb", "GLB"},
                                       {MeshFormat::Usd, "usd", "USD"},
                                       {MeshFormat::Alembic, "abc", "Alembic"}}};

constexpr std::string_view kBlank = " \t\r\n\f\v";

std::string_view withoutLeadingBlanks(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t start = text.find_first_not_of(kBlank);
    return start == std::string_view::npos ? std::string_view() : text.substr(start);
}

bool startsWord(std::string_view text, std::string_view word) {
    return text.starts_with(word) &&
           (text.size() == word.size() || kBlank.find(text[word.size()]) != kBlank.npos);
}

/// A line that only an OBJ file would have: an element with a number after it, or the name of a material.
bool isObjLine(std::string_view line) {
    static constexpr std::array<std::string_view, 7> kElements{"v", "vn", "vt", "vp", "f", "l", "p"};
    if (startsWord(line, "mtllib") || startsWord(line, "usemtl")) return true;
    if (std::ranges::none_of(kElements,
                             [&](std::string_view element) { return startsWord(line, element); })) {
        return false;
    }
    const std::size_t number = line.find_first_not_of(kBlank, line.find_first_of(kBlank));
    return number != line.npos && std::string_view("+-.0123456789").find(line[number]) != line.npos;
}

bool looksLikeObj(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = withoutLeadingBlanks(text.substr(0, end));
        if (isObjLine(line)) return true;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return false;
}

bool looksLikeAsciiStl(std::string_view text) {
    return startsWord(text, "solid") &&
           (text.find("facet") != text.npos || text.find("endsolid") != text.npos || text.size() < 80);
}

/// 80 bytes of anything, a count, and 50 bytes for each triangle of that count.
bool isBinaryStl(std::span<const std::byte> head, std::uint64_t fileSize) {
    if (head.size() < 84) return false;
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, head.data() + 80, sizeof triangles);
    return fileSize == 84 + std::uint64_t{50} * triangles;
}

bool looksLikeAsciiFbx(std::string_view text) {
    return text.starts_with("; FBX") || text.find("FBXHeaderExtension") != text.npos;
}

}  // namespace

std::string_view name(MeshFormat format) {
    return std::ranges::find(kFormats, format, &Row::format)->name;
}

std::optional<MeshFormat> meshFormatNamed(std::string_view name) {
    const auto found = std::ranges::find(kFormats, name, &Row::name);
    if (found == kFormats.end()) return std::nullopt;
    return found->format;
}

std::vector<FileFormat> meshFormats() {
    std::vector<FileFormat> formats;
    for (const Row& row : kFormats) {
        FileFormat& format =
            formats.emplace_back(FileFormat{std::string(row.label), {std::string(row.name)}});
        if (row.format == MeshFormat::Usd) format.suffixes = {"usda", "usdc", "usd", "usdz"};
    }
    return formats;
}

bool mayBeHair(MeshFormat format) {
    return format == MeshFormat::Obj || format == MeshFormat::Ply || format == MeshFormat::Usd ||
           format == MeshFormat::Alembic;
}

std::optional<MeshFormat> meshFormatOf(std::span<const std::byte> head, std::uint64_t fileSize) {
    std::string text(head.size(), '\0');
    if (!head.empty()) std::memcpy(text.data(), head.data(), head.size());
    if (text.starts_with("glTF")) return MeshFormat::Glb;
    if (startsLikeUsd(head)) return MeshFormat::Usd;
    if (startsLikeAlembic(head)) return MeshFormat::Alembic;
    if (text.starts_with("Kaydara FBX Binary")) return MeshFormat::Fbx;
    if (isBinaryStl(head, fileSize)) return MeshFormat::Stl;
    const std::string_view start = withoutLeadingBlanks(text);
    if (startsWord(start, "ply") || startsWord(start, "PLY")) return MeshFormat::Ply;
    if (looksLikeAsciiStl(start)) return MeshFormat::Stl;
    if (start.starts_with("{")) return MeshFormat::Gltf;
    if (start.starts_with("<")) return std::nullopt;
    if (looksLikeAsciiFbx(text)) return MeshFormat::Fbx;
    if (looksLikeObj(text)) return MeshFormat::Obj;
    return std::nullopt;
}

}  // namespace hairloom
