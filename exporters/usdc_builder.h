// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes binary USD (crate version 0.8): prims and attributes become tokens, paths, fields and specs. The
// layout is that of OpenUSD's pxr/usd/sdf/crateFile.cpp. Nothing is packed: where the format asks for LZ4,
// blocks hold literals alone.

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/file.h"

namespace hairloom {

/// A value as a field has it.
struct UsdcRep {
    std::uint64_t bits = 0;
};

class UsdcBuilder {
  public:
    using Fields = std::vector<std::pair<std::string, UsdcRep>>;

    UsdcBuilder();

    UsdcRep token(const std::string& text);
    /// A text that is no name.
    UsdcRep string(const std::string& text);
    UsdcRep tokens(std::span<const std::string> texts);
    /// Values by names.
    UsdcRep dictionary(const Fields& entries);
    UsdcRep number(double value);
    UsdcRep single(float value);
    /// One element of 2 to 4 numbers.
    UsdcRep vector(std::span<const float> value);
    UsdcRep boolean(bool value) const;
    /// Tokens that are put before what weaker layers say.
    UsdcRep prepended(std::span<const std::string> texts);
    /// The path of a prim or an attribute ("/a/b.c") that is in the file when it is finished.
    UsdcRep path(const std::string& path);
    /// What a prim is (def) and whether an attribute may change in time.
    UsdcRep definition() const;
    UsdcRep uniform() const;
    UsdcRep ints(std::span<const std::int32_t> values);
    UsdcRep bytes(std::span<const std::uint8_t> values, bool areBools);
    /// Elements of 1 to 4 numbers.
    UsdcRep floats(std::span<const float> values, std::uint32_t components);

    /// An attribute's values at times, ascending.
    UsdcRep samples(std::span<const double> times, std::span<const UsdcRep> values);

    /// Paths in the order of a walk from the root: the root itself first, children behind their parent, the
    /// properties of a prim last of its children. `depth` is 0 of the root; "points" of a property.
    void root(const Fields& fields);
    void prim(std::uint32_t depth, const std::string& name, const Fields& fields);
    void attribute(std::uint32_t depth, const std::string& name, const Fields& fields);
    void relationship(std::uint32_t depth, const std::string& name, const Fields& fields);

    /// Room for so many bytes in all.
    void reserve(std::size_t bytes) { out_.reserve(bytes); }
    /// The whole file, and the end of the builder.
    std::vector<std::byte> finish();

  private:
    struct Path {
        std::uint32_t depth, token, type, fieldSet;
    };
    std::uint32_t tokenIndex(const std::string& text);
    template <class T>
    UsdcRep array(std::uint8_t type, std::span<const T> values);
    void add(std::uint32_t depth, const std::string& name, std::uint32_t type, const Fields& fields);
    /// Of the written paths: where the next sibling stands, as the format says it.
    std::vector<std::int32_t> jumps() const;
    /// "/a/b.c" of each path.
    std::vector<std::string> pathTexts() const;

    ByteWriter out_;
    std::vector<std::string> tokens_;
    std::unordered_map<std::string, std::uint32_t> tokenIndices_;
    std::vector<std::uint32_t> strings_;  ///< tokens
    std::vector<std::uint32_t> fieldTokens_, fieldSets_;
    std::vector<std::uint64_t> fieldValues_;
    std::vector<Path> paths_;
    std::vector<std::pair<std::size_t, std::string>> named_;  ///< where the number of a path is to stand
};

}  // namespace hairloom
