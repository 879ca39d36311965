// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Objects, properties and samples of an Alembic file (AbcCoreOgawa of Alembic 1.5 to 1.8).

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "importers/ogawa.h"
#include "importers/sample_times.h"

namespace hairloom {

/// "key=value;key=value"
using AlembicMetadata = std::map<std::string, std::string, std::less<>>;

enum class AlembicPod : std::uint8_t {
    Bool,
    Uint8,
    Int8,
    Uint16,
    Int16,
    Uint32,
    Int32,
    Uint64,
    Int64,
    Half,
    Float,
    Double,
    String,
    WideString
};

struct AlembicProperty {
    enum class Kind : std::uint8_t { Compound, Scalar, Array };
    std::string name;
    AlembicMetadata metadata;
    Kind kind = Kind::Compound;
    AlembicPod pod = AlembicPod::Bool;
    std::uint32_t extent = 1;   ///< components of an element
    std::uint32_t samples = 0;  ///< in time
    std::uint32_t firstChanged = 0, lastChanged = 0;
    std::uint32_t timeSampling = 0;
    OgawaNode node;

    bool moves() const { return lastChanged > 0 && samples > 1; }
};

struct AlembicObject {
    std::string path;
    AlembicMetadata metadata;
    OgawaNode node;
};

class AlembicArchive {
  public:
    /// `bytes` must outlive the archive.
    static Result<AlembicArchive> open(const std::string& file, std::span<const std::byte> bytes);

    const AlembicMetadata& metadata() const { return metadata_; }
    AlembicObject top() const { return {"", {}, top_}; }
    Result<std::vector<AlembicObject>> children(const AlembicObject& object) const;
    /// Of the object itself.
    Result<std::vector<AlembicProperty>> properties(const AlembicObject& object) const;
    /// Of a compound.
    Result<std::vector<AlembicProperty>> properties(const AlembicProperty& compound) const;
    /// 0 seconds for a number that the file does not have.
    const SampleTimes& times(std::uint32_t timeSampling) const;
    /// Where a time lies among the property's samples, of which there is one at least; the first sample where
    /// nothing changes or its times do not ascend.
    SampleMoment momentOf(const AlembicProperty& property, double seconds) const;
    /// The object of that path, "/a/b".
    Result<AlembicObject> objectAt(std::string_view path) const;

    /// Sample `index`, the last one where there are fewer, as numbers; empty where there is no sample.
    /// Errors: text, bytes that are no whole number of elements.
    Result<std::vector<float>> floats(const AlembicProperty& property, std::uint32_t index) const;
    Result<std::vector<double>> doubles(const AlembicProperty& property, std::uint32_t index) const;
    Result<std::vector<std::int64_t>> integers(const AlembicProperty& property, std::uint32_t index) const;
    Result<std::string> text(const AlembicProperty& property, std::uint32_t index) const;
    /// All texts of an array.
    Result<std::vector<std::string>> texts(const AlembicProperty& property, std::uint32_t index) const;

  private:
    explicit AlembicArchive(OgawaFile file) : file_(std::move(file)) {}
    Status readTables(const std::vector<OgawaNode>& children);
    Result<std::vector<AlembicProperty>> propertiesIn(OgawaNode node) const;
    Result<std::span<const std::byte>> sample(const AlembicProperty& property, std::uint32_t index) const;
    template <class T>
    Result<std::vector<T>> numbers(const AlembicProperty& property, std::uint32_t index) const;

    OgawaFile file_;
    OgawaNode top_;
    AlembicMetadata metadata_;
    std::vector<AlembicMetadata> shared_;
    std::vector<SampleTimes> times_;
};

/// The property of that name, or none.
const AlembicProperty* findProperty(const std::vector<AlembicProperty>& properties, std::string_view name);

}  // namespace hairloom
