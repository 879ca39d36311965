// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A small runtime asset with changes that its checksums know of: what looks at the content is what refuses
// it.

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <span>
#include <vector>

#include "hairloom/asset_format.h"
#include "tests/fuzz/changes.h"

namespace hairloom {

struct alignas(runtime::asset::kAlignment) AssetPiece {
    std::byte bytes[runtime::asset::kAlignment];
};

struct AssetBytes {
    std::vector<AssetPiece> pieces;
    std::size_t size = 0;

    std::span<std::byte> bytes() { return {reinterpret_cast<std::byte*>(pieces.data()), size}; }
};

inline const AssetBytes& sampleAsset() {
    static const AssetBytes file = [] {
        AssetBytes read;
        std::ifstream stream(FUZZED_FILE, std::ios::binary | std::ios::ate);
        if (!stream) std::abort();
        read.size = static_cast<std::size_t>(stream.tellg());
        read.pieces.resize(read.size / sizeof(AssetPiece) + 1);
        stream.seekg(0);
        stream.read(reinterpret_cast<char*>(read.pieces.data()), static_cast<std::streamsize>(read.size));
        return read;
    }();
    return file;
}

inline void sealAsset(std::span<std::byte> bytes) {
    namespace asset = runtime::asset;
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

inline AssetBytes changedAsset(const std::uint8_t* data, std::size_t size) {
    AssetBytes file = sampleAsset();
    change(file.bytes(), {data, size});
    sealAsset(file.bytes());
    return file;
}

}  // namespace hairloom
