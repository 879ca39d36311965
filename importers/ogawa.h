// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The container of Alembic files: a tree of groups and blocks of data, each named by its place in the file.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// A place in the file; the top bit says that data stands there and not a group.
struct OgawaNode {
    std::uint64_t reference = 0;
    bool isData() const { return (reference >> 63u) != 0; }
    std::uint64_t offset() const { return reference & ~(std::uint64_t{1} << 63u); }
};

class OgawaFile {
  public:
    /// `bytes` must outlive the file. Errors: no Ogawa file, one that its writer did not finish.
    static Result<OgawaFile> open(std::string file, std::span<const std::byte> bytes);

    OgawaNode root() const { return root_; }
    /// The children; none of an empty group. Errors: data, a group beyond the end of the file, far more
    /// groups than the file has room for (they refer to each other in a circle; instances are read again).
    Result<std::vector<OgawaNode>> group(OgawaNode node) const;
    /// How many children there are. Errors: as group().
    Result<std::uint64_t> childCount(OgawaNode node) const;
    /// One of so many.
    OgawaNode child(OgawaNode node, std::uint64_t index) const;
    /// Errors: a group, data beyond the end of the file.
    Result<std::span<const std::byte>> data(OgawaNode node) const;

    const std::string& name() const { return file_; }
    /// An error about the node.
    tl::unexpected<Error> error(OgawaNode node, std::string problem, std::string expected = {}) const;

  private:
    OgawaFile(std::string file, std::span<const std::byte> bytes) : file_(std::move(file)), bytes_(bytes) {}
    /// The number that begins a group or block, held against what follows it.
    Result<std::uint64_t> countAt(std::uint64_t offset, std::uint64_t elementBytes) const;

    std::string file_;
    std::span<const std::byte> bytes_;
    OgawaNode root_;
    mutable std::uint64_t visited_ = 0;
};

}  // namespace hairloom
