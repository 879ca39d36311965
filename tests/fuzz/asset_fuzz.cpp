// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for runtime assets: an input is a list of bytes to change in a small asset (place, value;
// four bytes each). Checksums are made to match, so that what looks at the content is what refuses it; what
// is not refused is played.

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

#include "hairloom/asset_format.h"
#include "hairloom/hairloom.hpp"

namespace {

namespace asset = hairloom::runtime::asset;

struct alignas(asset::kAlignment) Piece {
    std::byte bytes[asset::kAlignment];
};

struct File {
    std::vector<Piece> pieces;
    std::size_t size = 0;

    std::span<std::byte> bytes() { return {reinterpret_cast<std::byte*>(pieces.data()), size}; }
};

const File& sample() {
    static const File file = [] {
        File read;
        std::ifstream stream(FUZZED_FILE, std::ios::binary | std::ios::ate);
        if (!stream) std::abort();
        read.size = static_cast<std::size_t>(stream.tellg());
        read.pieces.resize(read.size / sizeof(Piece) + 1);
        stream.seekg(0);
        stream.read(reinterpret_cast<char*>(read.pieces.data()), static_cast<std::streamsize>(read.size));
        return read;
    }();
    return file;
}

void seal(std::span<std::byte> bytes) {
    auto& header = *reinterpret_cast<asset::Header*>(bytes.data());
    if (header.sections > (bytes.size() - sizeof header) / sizeof(asset::Section)) return;
    const std::span table(reinterpret_cast<asset::Section*>(bytes.data() + sizeof header), header.sections);
    for (asset::Section& section : table) {
        if (section.offset <= bytes.size() && section.bytes <= bytes.size() - section.offset)
            section.checksum = asset::checksum(bytes.subspan(section.offset, section.bytes));
    }
    header.tableChecksum = asset::checksum(std::as_bytes(table));
    header.checksum = asset::checksum(bytes.first(sizeof header - sizeof header.checksum));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom::game;
    File file = sample();
    for (; size >= 4; data += 4, size -= 4) {
        const std::size_t at =
            (std::size_t{data[0]} | std::size_t{data[1]} << 8u | std::size_t{data[2]} << 16u) % file.size;
        file.bytes()[at] = static_cast<std::byte>(data[3]);
    }
    seal(file.bytes());
    Error error;
    Asset opened;
    Instance hair;
    if (!opened.open(file.bytes().data(), file.size, &error) || !opened.check(&error)) {
        if (error.what().empty()) std::abort();
        return 0;
    }
    const hl_asset_info info = opened.describe();
    for (std::uint32_t bone = 0; bone < info.bones; ++bone) {
        hl_bone found{};
        if (hl_asset_bone(opened.get(), bone, &found, &error) != HL_OK) std::abort();
    }
    opened.number("material.rootColour", 0);
    if (std::size_t{info.hairs} * info.points_per_hair > 100'000) return 0;
    if (!hair.make(opened, HL_HAIRS, nullptr, &error)) return error.what().empty() ? std::abort(), 0 : 0;
    std::vector<float> points;
    for (int f = 0; f < 3; ++f) hair.step(Frame(), &error);
    hair.readGuides(points);
    if (info.hairs > 0) hair.readHairs(points);
    return 0;
}
