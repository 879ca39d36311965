// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The container of Hairloom's own files: one JSON head, then named binary arrays, aligned and checksummed. It
// knows no groom; a room that saves something new adds members to the head and arrays beside the others. Byte
// by byte in docs/formats/hairloom.md.

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/groom/attributes.h"

namespace hairloom {

inline constexpr std::uint32_t kArchiveVersion = 1;
inline constexpr std::size_t kArchiveAlignment = 64;

/// Whether these bytes, eight at least, start as the container does.
bool startsAsArchive(std::span<const std::byte> bytes);

/// Gathers arrays and lays them out. The arrays are not copied before finish() and must live until then.
class ArchiveWriter {
  public:
    struct Array {
        std::string name;
        std::string_view type;
        std::size_t count;
        std::span<const std::byte> bytes;
    };

    /// `kind` tells apart the files that use the container ("project"); `version` is that of the kind's
    /// content.
    ArchiveWriter(std::string kind, std::uint32_t version) : kind_(std::move(kind)), version_(version) {}

    /// Names are unique; "/" separates a section from a name within it.
    template <class T>
    void add(std::string name, std::span<const T> values) {
        arrays_.push_back(
            {std::move(name), typeName(AttributeData(CowArray<T>())), values.size(), std::as_bytes(values)});
    }
    void add(std::string name, const AttributeData& data);

    /// As they were added.
    const std::vector<Array>& arrays() const { return arrays_; }

    /// The whole file. `head` is an object without the members "kind", "version" and "arrays", which are
    /// added. Text that is not UTF-8 is stored with replacement characters. Error: a head beyond
    /// kMaxJsonBytes.
    Result<std::vector<std::byte>> finish(const nlohmann::ordered_json& head) const;

  private:
    std::string kind_;
    std::uint32_t version_;
    std::vector<Array> arrays_;
};

/// A file that has been checked: head parsed, every array within the file and equal to its checksum.
class ArchiveReader {
  public:
    /// Errors, each with its place: no archive, another kind, a newer version of container or content (named
    /// with the newest that can be read), a short or long file, a head or an array that does not match its
    /// checksum, arrays that overlap or leave gaps. `file` is named in errors.
    static Result<ArchiveReader> open(std::string file, std::vector<std::byte> bytes, std::string_view kind,
                                      std::uint32_t newestVersion);

    /// With the members "kind", "version" and "arrays".
    const nlohmann::json& head() const { return head_; }
    std::uint32_t version() const { return version_; }
    const std::string& file() const { return file_; }

    bool has(std::string_view name) const { return arrays_.find(name) != arrays_.end(); }
    /// In order of name.
    std::vector<std::string> names() const;

    /// A copy of the values. Errors: no such array, another type.
    template <class T>
    Result<std::vector<T>> read(std::string_view name) const {
        const auto array = find(name, typeName(AttributeData(CowArray<T>())));
        if (!array) return tl::unexpected(array.error());
        return copy<T>(**array);
    }
    /// The array as the attribute type that the file states.
    Result<AttributeData> readAny(std::string_view name) const;
    /// An error that points at an array's first byte.
    Error errorAt(std::string_view name, std::string problem, std::string expected = {}) const;

  private:
    struct Array {
        std::string type;
        std::size_t count;
        std::uint64_t offset;  ///< from the start of the file
        std::uint64_t bytes;
        std::uint64_t checksum;
    };
    Status readPreamble();
    Status readHead(std::string_view kind, std::uint32_t newestVersion);
    Status readTable();
    Status checkLayout() const;
    Status checkContent() const;
    Result<const Array*> find(std::string_view name, std::string_view type) const;

    template <class T>
    std::vector<T> copy(const Array& array) const {
        std::vector<T> values(array.count);
        if (array.bytes > 0) {
            std::memcpy(static_cast<void*>(values.data()), bytes_.data() + array.offset, array.bytes);
        }
        return values;
    }

    std::string file_;
    std::vector<std::byte> bytes_;
    std::uint64_t headBytes_ = 0;
    nlohmann::json head_;
    std::uint32_t version_ = 0;
    std::map<std::string, Array, std::less<>> arrays_;
};

}  // namespace hairloom
