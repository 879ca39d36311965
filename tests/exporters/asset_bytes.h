// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Files of the runtime asset that tests change.

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "hairloom/asset.h"
#include "hairloom/engine.h"

namespace hairloom::test {

/// A copy that may be changed, at an aligned place.
class AssetBytes {
  public:
    explicit AssetBytes(std::span<const std::byte> bytes)
        : pieces_(bytes.size() / sizeof(Piece) + 1), size_(bytes.size()) {
        std::memcpy(pieces_.data(), bytes.data(), bytes.size());
    }
    std::span<std::byte> span() { return {reinterpret_cast<std::byte*>(pieces_.data()), size_}; }
    runtime::asset::Header& header() { return *reinterpret_cast<runtime::asset::Header*>(pieces_.data()); }
    std::span<runtime::asset::Section> table() {
        return {reinterpret_cast<runtime::asset::Section*>(pieces_.data() +
                                                           sizeof(runtime::asset::Header) / sizeof(Piece)),
                header().sections};
    }
    /// Checksums as if all were meant so.
    void seal() {
        for (runtime::asset::Section& section : table())
            section.checksum = runtime::asset::checksum(span().subspan(section.offset, section.bytes));
        header().tableChecksum = runtime::asset::checksum(std::as_bytes(table()));
        header().checksum = runtime::asset::checksum(span().first(sizeof(runtime::asset::Header) - 4));
    }

  private:
    struct alignas(16) Piece {
        std::byte bytes[16];
    };
    std::vector<Piece> pieces_;
    std::size_t size_;
};

/// What can be had of an asset whose content is sound; says nothing but must not leave the bytes.
inline std::size_t useAll(const runtime::Asset& asset) {
    const auto strands = asset.strandsAtRest();
    std::size_t sum = strands.positions_ss.size();
    for (const runtime::asset::Setting& setting : asset.settings)
        sum += asset.nameOf(setting).size() + asset.valuesOf(setting).size();
    for (const runtime::asset::Bone& bone : asset.bones) sum += asset.text(bone.name).size();
    for (const runtime::asset::Sphere& sphere : asset.spheres) sum += asset.text(sphere.name).size();
    for (std::size_t pose = 0; pose < asset.poses().size(); ++pose)
        sum +=
            asset.text(asset.poses()[pose].name).size() + asset.poseArrays(pose, strands).positions_ss.size();
    if (const auto made = asset.followHairs(strands); made.hairs) sum += made.hairs->hairCount();
    const auto engine = runtime::Engine::make({strands.offsets, strands.positions_ss}, asset.simulation());
    return sum + (engine.engine ? engine.engine->pointCount() : engine.error.size());
}

}  // namespace hairloom::test
