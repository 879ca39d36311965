// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The container of binary USD files ("crate", versions 0.4 to 0.16): tokens, paths, fields and specs. The
// layout is that of OpenUSD's pxr/usd/sdf/crateFile.cpp.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// What a value is and where.
struct UsdcValue {
    std::uint64_t bits = 0;
    bool isArray() const { return (bits >> 63u & 1u) != 0; }
    bool isInlined() const { return (bits >> 62u & 1u) != 0; }
    bool isArrayEdit() const { return (bits >> 60u & 1u) != 0; }
    bool isCompressed() const { return (bits >> 61u & 1u) != 0; }
    std::uint8_t type() const { return static_cast<std::uint8_t>(bits >> 48u); }
    std::uint64_t payload() const { return bits & 0xffff'ffff'ffffu; }
};

struct UsdcField {
    std::uint32_t token = 0;
    UsdcValue value;
};

/// A path by its last element: its parent is another entry.
struct UsdcPath {
    std::uint32_t parent = 0xffffffffu;  ///< none of the root
    std::uint32_t token = 0;
    bool isProperty = false;
};

struct UsdcSpec {
    std::uint32_t path = 0, fieldSet = 0, type = 0;
};
inline constexpr std::uint32_t kUsdcAttribute = 1, kUsdcPrim = 6, kUsdcRoot = 7, kUsdcRelationship = 8,
                               kUsdcVariant = 10, kUsdcVariantSet = 11;

class UsdcFile {
  public:
    /// `bytes` must outlive the file. Errors: no crate file, a version that is not read, sections that are
    /// missing, go beyond the end or contradict each other.
    static Result<UsdcFile> open(std::string file, std::span<const std::byte> bytes);

    const std::vector<std::string>& tokens() const { return tokens_; }
    const std::vector<UsdcPath>& paths() const { return paths_; }
    const std::vector<UsdcSpec>& specs() const { return specs_; }
    /// Of a spec's field set.
    std::vector<UsdcField> fieldsOf(const UsdcSpec& spec) const;

    /// Empty for an index that the file does not have.
    const std::string& token(std::uint64_t index) const;
    const std::string& string(std::uint64_t index) const;
    /// "/groom/hair", "/groom{lod=high}hair"; empty for an index that the file does not have.
    std::string pathText(std::uint64_t index) const;

    const std::string& name() const { return file_; }
    std::span<const std::byte> bytes() const { return bytes_; }
    /// At least that version, as 0.`minor`.
    bool isSince(int minor) const { return minor_ >= minor; }

  private:
    UsdcFile(std::string file, std::span<const std::byte> bytes) : file_(std::move(file)), bytes_(bytes) {}
    Status read();
    Status readTokens();
    Status readStrings();
    Status readFields();
    Status readFieldSets();
    Status readPaths();
    Status readSpecs();
    tl::unexpected<Error> error(std::uint64_t offset, std::string problem, std::string expected = {}) const;

    struct Section {
        std::uint64_t begin = 0, size = 0;
        bool isThere = false;
    };
    enum SectionName { Tokens, Strings, Fields, FieldSets, Paths, Specs, SectionCount };

    std::string file_;
    std::span<const std::byte> bytes_;
    int minor_ = 0;
    std::array<Section, SectionCount> sections_;
    std::vector<std::string> tokens_;
    std::vector<std::uint32_t> strings_;
    std::vector<UsdcField> fields_;
    std::vector<std::uint32_t> fieldSets_;
    std::vector<UsdcPath> paths_;
    std::vector<UsdcSpec> specs_;
};

}  // namespace hairloom
