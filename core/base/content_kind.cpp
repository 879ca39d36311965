// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/content_kind.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace hairloom {
namespace {

using std::string_view_literals::operator""sv;

struct Signature {
    std::string_view start;
    std::string_view kind;
    std::string_view suffix = {};  ///< of files that are written as that kind
};

constexpr std::array kSignatures{
    Signature{"HAIRLOOM"sv, content::kProject},
    Signature{"HLFRAMES"sv, content::kFrames},
    Signature{"HLTAKE\r\n"sv, content::kTake},
    Signature{"HAIR"sv, "a .hair file", "hair"},
    Signature{"\x89HRT\r\n\x1a\n"sv, "a runtime asset", "hairrt"},
    Signature{"\0\0\x80\x40"sv, "a TressFX 4 file", "tfx"},
    Signature{"\0\0\x40\x40"sv, "a TressFX 3 file"},
    Signature{"# TressFX collision mesh"sv, "a TressFX collision mesh"},
    Signature{"Ogawa\xff"sv, "an Alembic file", "abc"},
    Signature{"Ogawa\0"sv, "an Alembic file"},
    Signature{"PXR-USDC"sv, "a binary USD file", "usdc"},
    Signature{"#usda"sv, "a USD file of text", "usda"},
    Signature{"ply\n"sv, "a PLY file", "ply"},
    Signature{"ply\r"sv, "a PLY file"},
    Signature{"\x89PNG\r\n\x1a\n"sv, content::kPng},
    Signature{"\x76\x2f\x31\x01"sv, "an OpenEXR image"},
    Signature{"glTF"sv, "a binary glTF file", "glb"},
    Signature{"glTF"sv, "a binary glTF file", "vrm"},
    Signature{"\x03\x02\x23\x07"sv, "a compiled shader"},
    Signature{"DXBC"sv, "a compiled shader"},
    Signature{"<!doctype html"sv, "an HTML page"},
    Signature{"<!DOCTYPE html"sv, "an HTML page"},
    Signature{"<html"sv, "an HTML page"},
    Signature{"<svg"sv, "an SVG drawing"},
    Signature{"<?xml"sv, "an SVG drawing"},
};

constexpr std::string_view kObj = "an OBJ file";
constexpr std::array kObjWords{"v "sv, "vn "sv, "vt "sv, "o "sv,      "g "sv,      "s "sv,
                               "f "sv, "l "sv,  "p "sv,  "mtllib "sv, "usemtl "sv, "cstype "sv};

/// Text without control characters; a last character may be cut.
bool isText(std::string_view text) {
    return std::ranges::all_of(text, [](char c) {
        return static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\r' || c == '\t' || c == '\f';
    });
}

/// The first line that is neither blank nor a comment begins as lines of an OBJ do.
bool isObj(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const std::size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string_view::npos || line[start] == '#') continue;
        return std::ranges::any_of(
            kObjWords, [&](std::string_view word) { return line.substr(start).starts_with(word); });
    }
    return false;
}

}  // namespace

std::string_view contentKind(std::span<const std::byte> beginning) {
    const std::string_view text(reinterpret_cast<const char*>(beginning.data()),
                                std::min(beginning.size(), kContentKindBytes));
    if (text.empty()) return content::kEmpty;
    for (const Signature& signature : kSignatures) {
        if (text.starts_with(signature.start)) return signature.kind;
    }
    if (text.starts_with("RIFF") && text.substr(std::min<std::size_t>(8, text.size())).starts_with("WEBP"))
        return "a WebP image";
    constexpr std::size_t kBrandAt = 4;
    if (text.size() > kBrandAt && text.substr(kBrandAt).starts_with("ftyp")) return content::kMp4;
    if (!isText(text)) return "of no known kind";
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (start != std::string_view::npos && (text[start] == '{' || text[start] == '[')) return content::kJson;
    return isObj(text) ? kObj : "text";
}

std::string_view contentKindOfSuffix(std::string_view suffix) {
    if (suffix == "obj") return kObj;
    const auto* const found = std::ranges::find_if(kSignatures, [&](const Signature& signature) {
        return !suffix.empty() && signature.suffix == suffix;
    });
    return found == kSignatures.end() ? std::string_view() : found->kind;
}

}  // namespace hairloom
