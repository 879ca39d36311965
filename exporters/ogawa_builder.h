// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes Ogawa, the container of Alembic files, and the objects and properties in it as AbcCoreOgawa of
// Alembic 1.8 does.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/file.h"

namespace hairloom {

/// A file from its leaves to its root: what refers to something comes after it.
class OgawaBuilder {
  public:
    OgawaBuilder();
    /// A block; its reference, with the bit of data. Empty blocks take no room.
    std::uint64_t data(std::span<const std::byte> bytes);
    /// A block of a sample: a digest, which readers use to tell samples apart, and the bytes.
    std::uint64_t sample(std::span<const std::byte> bytes);
    std::uint64_t group(std::span<const std::uint64_t> children);
    /// Room for so many bytes in all.
    void reserve(std::size_t bytes) { out_.reserve(bytes); }
    /// The whole file, and the end of the builder.
    std::vector<std::byte> finish(std::uint64_t root);

  private:
    ByteWriter out_;
};

/// Names as docs of AbcCoreOgawa number them.
enum class AlembicType : std::uint8_t {
    Bool = 0,
    Uint8 = 1,
    Int16 = 4,
    Int32 = 6,
    Float = 10,
    Double = 11,
    Text = 12
};

/// Properties that are written one after another, and the block of headers that names them.
class AlembicCompound {
  public:
    explicit AlembicCompound(OgawaBuilder& file, std::vector<std::string>& metadata)
        : file_(file), metadata_(metadata) {}

    /// A value, or a few that belong together: `extent` of them.
    void scalar(const std::string& name, AlembicType type, std::uint32_t extent,
                std::span<const std::byte> bytes, const std::string& metadata = {});
    /// An array of elements of `extent` numbers.
    void array(const std::string& name, AlembicType type, std::uint32_t extent,
               std::span<const std::byte> bytes, const std::string& metadata = {});
    /// The same with a value at each time of the file's second sampling.
    void scalars(const std::string& name, AlembicType type, std::uint32_t extent,
                 std::span<const std::span<const std::byte>> samples, const std::string& metadata = {});
    void arrays(const std::string& name, AlembicType type, std::uint32_t extent,
                std::span<const std::span<const std::byte>> samples, const std::string& metadata = {});
    /// An array of texts without a NUL.
    void texts(const std::string& name, std::span<const std::string> values,
               const std::string& metadata = {});
    void compound(const std::string& name, const AlembicCompound& inside, const std::string& metadata = {});
    bool isEmpty() const { return parts_.empty(); }
    /// Its group.
    std::uint64_t write() const;

  private:
    /// `samples` 0 of a compound. More than one are at the times of the second sampling and all differ.
    void header(const std::string& name, std::uint32_t bits, std::size_t samples,
                const std::string& metadata);

    OgawaBuilder& file_;
    std::vector<std::string>& metadata_;
    ByteWriter headers_;
    std::vector<std::uint64_t> parts_;
};

/// The number of a text of metadata in the table of a file, added where it is new. Texts have at most 254
/// bytes, and a file at most 254 of them.
std::uint32_t alembicMetadata(std::vector<std::string>& table, const std::string& text);

/// An object below another.
struct AlembicChild {
    std::string name;
    std::string metadata;
    std::uint64_t group = 0;
};
std::uint64_t alembicObject(OgawaBuilder& file, std::vector<std::string>& metadata, std::uint64_t properties,
                            std::span<const AlembicChild> children);

/// When the samples of properties that change are.
struct AlembicTimes {
    std::uint32_t count = 1;
    double step = 0;            ///< seconds from a cycle to the next
    std::vector<double> cycle;  ///< seconds of the samples of the first cycle, ascending; one where even
};

/// The archive around the top object. The first sampling is of one time, 0; `times` are the second, where
/// there is more than one.
std::vector<std::byte> finishAlembic(OgawaBuilder& file, const std::vector<std::string>& metadata,
                                     std::uint64_t top, const std::string& about, const AlembicTimes& times);

}  // namespace hairloom
