// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/alembic_archive.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/file.h"

namespace hairloom {
namespace {

constexpr std::size_t kKeyBytes = 16;    ///< digest before the content of a sample
constexpr std::size_t kHashBytes = 32;   ///< behind the headers of objects
constexpr std::uint32_t kInline = 0xff;  ///< metadata that stands where its number would

constexpr std::array<std::size_t, 14> kPodBytes{1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8, 1, 4};

AlembicMetadata parseMetadata(std::string_view text) {
    AlembicMetadata metadata;
    while (!text.empty()) {
        const std::string_view entry = text.substr(0, text.find(';'));
        text.remove_prefix(std::min(text.size(), entry.size() + 1));
        const std::size_t equals = entry.find('=');
        if (equals != std::string_view::npos)
            metadata.insert_or_assign(std::string(entry.substr(0, equals)),
                                      std::string(entry.substr(equals + 1)));
    }
    return metadata;
}

std::string_view asText(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<std::string> readText(ByteReader& reader, std::uint64_t length, std::string_view what) {
    const auto characters = reader.readArray<char>(length, what);
    if (!characters) return tl::unexpected(characters.error());
    return std::string(characters->begin(), characters->end());
}

/// Numbers of headers, of one, two or four bytes each as the header says.
Result<std::uint32_t> readHinted(ByteReader& reader, std::uint32_t hint, std::string_view what) {
    if (hint == 0) return reader.read<std::uint8_t>(what).map([](auto v) { return std::uint32_t{v}; });
    if (hint == 1) return reader.read<std::uint16_t>(what).map([](auto v) { return std::uint32_t{v}; });
    return reader.read<std::uint32_t>(what);
}

/// Metadata by number, or as text behind it.
Result<AlembicMetadata> readMetadata(ByteReader& reader, std::uint32_t index, std::uint32_t hint,
                                     const std::vector<AlembicMetadata>& shared) {
    if (index != kInline) {
        if (index >= shared.size())
            return tl::unexpected(reader.error(fmt::format("has metadata number {}", index),
                                               fmt::format("the file has {}", shared.size())));
        return shared[index];
    }
    const auto size = readHinted(reader, hint, "metadata");
    if (!size) return tl::unexpected(size.error());
    return readText(reader, *size, "metadata").map([](const std::string& text) {
        return parseMetadata(text);
    });
}

struct HeaderFields {
    std::uint32_t bits;
    std::uint32_t kind() const { return bits & 3u; }
    std::uint32_t hint() const { return (bits >> 2u) & 3u; }
    std::uint32_t pod() const { return (bits >> 4u) & 15u; }
    bool hasTimeSampling() const { return (bits & 0x100u) != 0; }
    bool hasChanges() const { return (bits & 0x200u) != 0; }
    bool isConstant() const { return (bits & 0x800u) != 0; }
    std::uint32_t extent() const { return (bits >> 12u) & 0xffu; }
    std::uint32_t metadata() const { return (bits >> 20u) & 0xffu; }
};

Status readSampling(ByteReader& reader, const HeaderFields& fields, AlembicProperty& property) {
    if (fields.pod() >= kPodBytes.size())
        return tl::unexpected(
            reader.error(fmt::format("holds values of type {}", fields.pod()), "expected 0 to 13"));
    property.kind = fields.kind() == 1 ? AlembicProperty::Kind::Scalar : AlembicProperty::Kind::Array;
    property.pod = static_cast<AlembicPod>(fields.pod());
    property.extent = std::max(1u, fields.extent());
    const auto take = [&](std::uint32_t& value) -> Status {
        const auto read = readHinted(reader, fields.hint(), "a property's header");
        if (!read) return tl::unexpected(read.error());
        value = *read;
        return {};
    };
    if (auto status = take(property.samples); !status) return status;
    if (fields.hasChanges()) {
        if (auto status = take(property.firstChanged); !status) return status;
        if (auto status = take(property.lastChanged); !status) return status;
    } else if (!fields.isConstant() && property.samples > 0) {
        property.firstChanged = 1;
        property.lastChanged = property.samples - 1;
    }
    return fields.hasTimeSampling() ? take(property.timeSampling) : Status{};
}

/// Which stored sample a sample in time is: runs of equal ones before the first and after the last change are
/// stored once.
std::uint32_t storedIndex(const AlembicProperty& property, std::uint32_t index) {
    index = std::min(index, property.samples - 1);
    if (index < property.firstChanged || (property.firstChanged == 0 && property.lastChanged == 0)) return 0;
    if (index >= property.lastChanged) return property.lastChanged - property.firstChanged + 1;
    return index - property.firstChanged + 1;
}

template <class From, class To>
void convert(std::span<const std::byte> bytes, std::vector<To>& values) {
    values.resize(bytes.size() / sizeof(From));
    for (std::size_t i = 0; i < values.size(); ++i) {
        From value;
        std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
        if constexpr (std::is_integral_v<To> && std::is_floating_point_v<From>) {
            values[i] = std::abs(value) < From{9e18f} ? static_cast<To>(value) : To{0};
        } else {
            values[i] = static_cast<To>(value);
        }
    }
}

template <class To>
void convertHalves(std::span<const std::byte> bytes, std::vector<To>& values) {
    std::vector<std::uint16_t> halves;
    convert<std::uint16_t>(bytes, halves);
    values.resize(halves.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] =
            static_cast<To>(Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(halves[i])));
}

}  // namespace

const AlembicProperty* findProperty(const std::vector<AlembicProperty>& properties, std::string_view name) {
    const auto found = std::ranges::find(properties, name, &AlembicProperty::name);
    return found == properties.end() ? nullptr : &*found;
}

Result<AlembicArchive> AlembicArchive::open(const std::string& file, std::span<const std::byte> bytes) {
    auto container = OgawaFile::open(file, bytes);
    if (!container) return tl::unexpected(container.error());
    AlembicArchive archive(std::move(*container));
    const auto children = archive.file_.group(archive.file_.root());
    if (!children) return tl::unexpected(children.error());
    if (children->size() < 6)
        return archive.file_.error(archive.file_.root(), fmt::format("has {} parts", children->size()),
                                   "expected the six of an Alembic archive");
    if (auto status = archive.readTables(*children); !status) return tl::unexpected(status.error());
    archive.top_ = (*children)[2];
    return archive;
}

Status AlembicArchive::readTables(const std::vector<OgawaNode>& children) {
    const auto about = file_.data(children[3]);
    const auto times = file_.data(children[4]);
    const auto shared = file_.data(children[5]);
    for (const auto* part : {&about, &times, &shared}) {
        if (!*part) return tl::unexpected(part->error());
    }
    metadata_ = parseMetadata(asText(*about));
    shared_.emplace_back();
    ByteReader texts(file_.name(), *shared);
    while (texts.remaining() > 0) {
        const auto size = texts.read<std::uint8_t>("metadata");
        const auto text = readText(texts, *size, "metadata");
        if (!text) return tl::unexpected(text.error());
        shared_.push_back(parseMetadata(*text));
    }
    ByteReader samplings(file_.name(), *times);
    while (samplings.remaining() > 0) {
        SampleTimes sampling;
        const auto most = samplings.read<std::uint32_t>("time samplings");
        const auto cycle = most ? samplings.read<double>("time samplings") : tl::unexpected(most.error());
        const auto count =
            cycle ? samplings.read<std::uint32_t>("time samplings") : tl::unexpected(cycle.error());
        auto values = count ? samplings.readArray<double>(*count, "times") : tl::unexpected(count.error());
        if (!values) return tl::unexpected(values.error());
        sampling.cycle = *cycle;
        if (!values->empty()) sampling.times = std::move(*values);
        times_.push_back(std::move(sampling));
    }
    return {};
}

Result<std::vector<AlembicObject>> AlembicArchive::children(const AlembicObject& object) const {
    std::vector<AlembicObject> objects;
    const auto parts = file_.group(object.node);
    if (!parts) return tl::unexpected(parts.error());
    if (parts->empty()) return objects;
    const auto headers = file_.data(parts->back());
    if (!headers) return tl::unexpected(headers.error());
    if (headers->size() < kHashBytes) return objects;
    ByteReader reader(file_.name(), headers->first(headers->size() - kHashBytes));
    while (reader.remaining() > 0) {
        const auto size = reader.read<std::uint32_t>("an object's name");
        auto name = size ? readText(reader, *size, "an object's name") : tl::unexpected(size.error());
        const auto index =
            name ? reader.read<std::uint8_t>("an object's metadata") : tl::unexpected(name.error());
        auto metadata = index ? readMetadata(reader, *index, 2, shared_) : tl::unexpected(index.error());
        if (!metadata) return tl::unexpected(metadata.error());
        // Properties stand first, headers last, the objects between.
        const std::size_t part = objects.size() + 1;
        if (part + 1 >= parts->size())
            return file_.error(object.node, "has more objects than parts",
                               fmt::format("it has {}", parts->size()));
        objects.push_back({object.path + "/" + *name, std::move(*metadata), (*parts)[part]});
    }
    return objects;
}

Result<std::vector<AlembicProperty>> AlembicArchive::properties(const AlembicObject& object) const {
    const auto parts = file_.group(object.node);
    if (!parts) return tl::unexpected(parts.error());
    if (parts->empty()) return std::vector<AlembicProperty>();
    return propertiesIn(parts->front());
}

Result<std::vector<AlembicProperty>> AlembicArchive::properties(const AlembicProperty& compound) const {
    if (compound.kind != AlembicProperty::Kind::Compound)
        return file_.error(compound.node, compound.name + " is not a compound", "expected properties in it");
    return propertiesIn(compound.node);
}

Result<std::vector<AlembicProperty>> AlembicArchive::propertiesIn(OgawaNode node) const {
    std::vector<AlembicProperty> properties;
    const auto parts = file_.group(node);
    if (!parts) return tl::unexpected(parts.error());
    if (parts->empty()) return properties;
    const auto headers = file_.data(parts->back());
    if (!headers) return tl::unexpected(headers.error());
    ByteReader reader(file_.name(), *headers);
    while (reader.remaining() > 0) {
        AlembicProperty property;
        const auto bits = reader.read<std::uint32_t>("a property's header");
        if (!bits) return tl::unexpected(bits.error());
        const HeaderFields fields{*bits};
        if (fields.kind() != 0) {
            if (auto status = readSampling(reader, fields, property); !status)
                return tl::unexpected(status.error());
        }
        const auto size = readHinted(reader, fields.hint(), "a property's name");
        auto name = size ? readText(reader, *size, "a property's name") : tl::unexpected(size.error());
        auto metadata = name ? readMetadata(reader, fields.metadata(), fields.hint(), shared_)
                             : tl::unexpected(name.error());
        if (!metadata) return tl::unexpected(metadata.error());
        if (properties.size() + 1 >= parts->size())
            return file_.error(node, "has more properties than parts",
                               fmt::format("it has {}", parts->size()));
        property.name = std::move(*name);
        property.metadata = std::move(*metadata);
        property.node = (*parts)[properties.size()];
        properties.push_back(std::move(property));
    }
    return properties;
}

const SampleTimes& AlembicArchive::times(std::uint32_t timeSampling) const {
    static const SampleTimes still;
    return timeSampling < times_.size() ? times_[timeSampling] : still;
}

SampleMoment AlembicArchive::momentOf(const AlembicProperty& property, double seconds) const {
    const SampleTimes& times = this->times(property.timeSampling);
    if (!property.moves() || !times.ascend(property.samples)) return {};
    return hairloom::momentAt(times, property.samples, seconds);
}

Result<AlembicObject> AlembicArchive::objectAt(std::string_view path) const {
    AlembicObject object = top();
    std::string_view rest = path;
    while (!rest.empty()) {
        rest.remove_prefix(rest.front() == '/' ? 1 : 0);
        const std::string_view name = rest.substr(0, rest.find('/'));
        rest.remove_prefix(name.size());
        if (name.empty()) continue;
        auto inside = children(object);
        if (!inside) return tl::unexpected(inside.error());
        const auto found = std::ranges::find_if(*inside, [&](const AlembicObject& child) {
            return child.path == fmt::format("{}/{}", object.path, name);
        });
        if (found == inside->end())
            return file_.error(object.node, fmt::format("names an object {}", path),
                               "there is none of that path");
        object = std::move(*found);
    }
    return object;
}

Result<std::span<const std::byte>> AlembicArchive::sample(const AlembicProperty& property,
                                                          std::uint32_t index) const {
    if (property.kind == AlembicProperty::Kind::Compound)
        return file_.error(property.node, property.name + " is a compound", "expected values");
    if (property.samples == 0) return std::span<const std::byte>();
    // Of an array, data and its dimensions by turns.
    const std::uint64_t stride = property.kind == AlembicProperty::Kind::Array ? 2 : 1;
    const auto stored = file_.childCount(property.node);
    if (!stored) return tl::unexpected(stored.error());
    const std::uint64_t part = storedIndex(property, index) * stride;
    if (part >= *stored)
        return file_.error(property.node, fmt::format("{} has no sample {}", property.name, index),
                           fmt::format("it stores {}", *stored / stride));
    const auto bytes = file_.data(file_.child(property.node, part));
    if (!bytes) return bytes;
    return bytes->size() < kKeyBytes ? std::span<const std::byte>() : bytes->subspan(kKeyBytes);
}

template <class T>
Result<std::vector<T>> AlembicArchive::numbers(const AlembicProperty& property, std::uint32_t index) const {
    const auto bytes = sample(property, index);
    if (!bytes) return tl::unexpected(bytes.error());
    const std::size_t element = kPodBytes[static_cast<std::size_t>(property.pod)] * property.extent;
    if (bytes->size() % element != 0)
        return file_.error(property.node, fmt::format("{} has {} bytes", property.name, bytes->size()),
                           fmt::format("expected a multiple of {}", element));
    std::vector<T> values;
    switch (property.pod) {
        case AlembicPod::Bool:
        case AlembicPod::Uint8:
            convert<std::uint8_t>(*bytes, values);
            break;
        case AlembicPod::Int8:
            convert<std::int8_t>(*bytes, values);
            break;
        case AlembicPod::Uint16:
            convert<std::uint16_t>(*bytes, values);
            break;
        case AlembicPod::Int16:
            convert<std::int16_t>(*bytes, values);
            break;
        case AlembicPod::Uint32:
            convert<std::uint32_t>(*bytes, values);
            break;
        case AlembicPod::Int32:
            convert<std::int32_t>(*bytes, values);
            break;
        case AlembicPod::Uint64:
            convert<std::uint64_t>(*bytes, values);
            break;
        case AlembicPod::Int64:
            convert<std::int64_t>(*bytes, values);
            break;
        case AlembicPod::Half:
            convertHalves(*bytes, values);
            break;
        case AlembicPod::Float:
            convert<float>(*bytes, values);
            break;
        case AlembicPod::Double:
            convert<double>(*bytes, values);
            break;
        default:
            return file_.error(property.node, property.name + " is a string", "expected numbers");
    }
    return values;
}

Result<std::vector<float>> AlembicArchive::floats(const AlembicProperty& property,
                                                  std::uint32_t index) const {
    return numbers<float>(property, index);
}

Result<std::vector<double>> AlembicArchive::doubles(const AlembicProperty& property,
                                                    std::uint32_t index) const {
    return numbers<double>(property, index);
}

Result<std::vector<std::int64_t>> AlembicArchive::integers(const AlembicProperty& property,
                                                           std::uint32_t index) const {
    return numbers<std::int64_t>(property, index);
}

Result<std::string> AlembicArchive::text(const AlembicProperty& property, std::uint32_t index) const {
    if (property.pod != AlembicPod::String)
        return file_.error(property.node, property.name + " is not a string", "expected a string");
    const auto bytes = sample(property, index);
    if (!bytes) return tl::unexpected(bytes.error());
    const std::string_view text = asText(*bytes);
    return std::string(text.substr(0, text.find('\0')));
}

Result<std::vector<std::string>> AlembicArchive::texts(const AlembicProperty& property,
                                                       std::uint32_t index) const {
    if (property.pod != AlembicPod::String)
        return file_.error(property.node, property.name + " is no string", "expected strings");
    const auto bytes = sample(property, index);
    if (!bytes) return tl::unexpected(bytes.error());
    std::vector<std::string> found;
    // Each ends with a NUL; the last one may not.
    for (std::string_view rest = asText(*bytes); !rest.empty();) {
        const std::size_t end = std::min(rest.find('\0'), rest.size());
        found.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return found;
}

}  // namespace hairloom
