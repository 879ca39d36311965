// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/ogawa_builder.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "core/base/hash.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kDataBit = std::uint64_t{1} << 63u;
constexpr std::int32_t kLibraryVersion = 10803;  ///< Alembic 1.8.3, whose layout this is
constexpr std::size_t kHeaderBytes = 16;

std::array<std::uint64_t, 2> digest(std::span<const std::byte> bytes) {
    return {hashBytes(bytes, 1), hashBytes(bytes, 2)};
}

}  // namespace

OgawaBuilder::OgawaBuilder() {
    constexpr std::array<std::uint8_t, 8> kStart{'O', 'g', 'a', 'w', 'a', 0xff, 0, 1};
    out_.writeArray(std::span<const std::uint8_t>(kStart));
    out_.write(std::uint64_t{0});
}

std::uint64_t OgawaBuilder::data(std::span<const std::byte> bytes) {
    if (bytes.empty()) return kDataBit;
    const std::uint64_t at = out_.size();
    out_.write(static_cast<std::uint64_t>(bytes.size()));
    out_.writeArray(bytes);
    return at | kDataBit;
}

std::uint64_t OgawaBuilder::sample(std::span<const std::byte> bytes) {
    const std::uint64_t at = out_.size();
    const auto key = digest(bytes);
    out_.write(static_cast<std::uint64_t>(bytes.size() + sizeof key));
    out_.writeArray(std::span<const std::uint64_t>(key));
    out_.writeArray(bytes);
    return at | kDataBit;
}

std::uint64_t OgawaBuilder::group(std::span<const std::uint64_t> children) {
    if (children.empty()) return 0;
    const std::uint64_t at = out_.size();
    out_.write(static_cast<std::uint64_t>(children.size()));
    out_.writeArray(children);
    return at;
}

std::vector<std::byte> OgawaBuilder::finish(std::uint64_t root) {
    out_.overwrite(kHeaderBytes / 2, root);
    return std::move(out_).take();
}

std::uint32_t alembicMetadata(std::vector<std::string>& table, const std::string& text) {
    assert(text.size() < 255);
    if (text.empty()) return 0;
    const auto found = std::ranges::find(table, text);
    const auto index = static_cast<std::uint32_t>(found - table.begin());
    if (found == table.end()) table.push_back(text);
    assert(table.size() < 255);
    return index + 1;
}

void AlembicCompound::header(const std::string& name, std::uint32_t bits, std::size_t samples,
                             const std::string& metadata) {
    constexpr std::uint32_t kFourByteNumbers = 2u << 2u, kTwoByteNumbers = 1u << 2u;
    constexpr std::uint32_t kHasTimes = 0x100, kConstant = 0x800;
    constexpr std::size_t kTwoBytes = 0xffff;
    if (samples == 1) bits |= kConstant;
    if (samples > 1) bits |= kHasTimes;
    const bool isLong = samples > kTwoBytes;
    headers_.write(bits | (isLong ? kFourByteNumbers : kTwoByteNumbers) |
                   alembicMetadata(metadata_, metadata) << 20u);
    const auto number = [&](std::size_t value) {
        isLong ? headers_.write(static_cast<std::uint32_t>(value))
               : headers_.write(static_cast<std::uint16_t>(value));
    };
    if (samples > 0) number(samples);
    if (samples > 1) number(1);  // the sampling of the times
    number(name.size());
    headers_.writeArray(std::span<const char>(name));
}

void AlembicCompound::scalar(const std::string& name, AlembicType type, std::uint32_t extent,
                             std::span<const std::byte> bytes, const std::string& metadata) {
    scalars(name, type, extent, std::span(&bytes, 1), metadata);
}

void AlembicCompound::scalars(const std::string& name, AlembicType type, std::uint32_t extent,
                              std::span<const std::span<const std::byte>> samples,
                              const std::string& metadata) {
    constexpr std::uint32_t kScalar = 1, kHomogeneous = 0x400;
    header(name, kScalar | static_cast<std::uint32_t>(type) << 4u | kHomogeneous | extent << 12u,
           samples.size(), metadata);
    std::vector<std::uint64_t> parts;
    for (const auto& bytes : samples) parts.push_back(file_.sample(bytes));
    parts_.push_back(file_.group(parts));
}

void AlembicCompound::array(const std::string& name, AlembicType type, std::uint32_t extent,
                            std::span<const std::byte> bytes, const std::string& metadata) {
    arrays(name, type, extent, std::span(&bytes, 1), metadata);
}

void AlembicCompound::arrays(const std::string& name, AlembicType type, std::uint32_t extent,
                             std::span<const std::span<const std::byte>> samples,
                             const std::string& metadata) {
    constexpr std::uint32_t kArray = 2, kHomogeneous = 0x400;
    header(name,
           kArray | static_cast<std::uint32_t>(type) << 4u | (extent == 1 ? kHomogeneous : 0) | extent << 12u,
           samples.size(), metadata);
    std::vector<std::uint64_t> parts;
    for (const auto& bytes : samples) {
        parts.push_back(file_.sample(bytes));
        parts.push_back(file_.data({}));  // no dimensions: the size of the data tells the number of elements
    }
    parts_.push_back(file_.group(parts));
}

void AlembicCompound::texts(const std::string& name, std::span<const std::string> values,
                            const std::string& metadata) {
    constexpr std::uint32_t kArray = 2, kHomogeneous = 0x400, kOne = 1u << 12u;
    header(name, kArray | static_cast<std::uint32_t>(AlembicType::Text) << 4u | kHomogeneous | kOne, 1,
           metadata);
    std::string all;
    for (const std::string& value : values) all.append(value.c_str()).push_back('\0');
    // The size of the data does not tell how many they are.
    const std::uint64_t count = values.size();
    const std::array<std::uint64_t, 2> parts{file_.sample(std::as_bytes(std::span(all))),
                                             file_.data(std::as_bytes(std::span(&count, 1)))};
    parts_.push_back(file_.group(parts));
}

void AlembicCompound::compound(const std::string& name, const AlembicCompound& inside,
                               const std::string& metadata) {
    header(name, 0, 0, metadata);
    parts_.push_back(inside.write());
}

std::uint64_t AlembicCompound::write() const {
    if (parts_.empty()) return 0;
    std::vector<std::uint64_t> children = parts_;
    children.push_back(file_.data(headers_.bytes()));
    return file_.group(children);
}

std::uint64_t alembicObject(OgawaBuilder& file, std::vector<std::string>& metadata, std::uint64_t properties,
                            std::span<const AlembicChild> children) {
    std::vector<std::uint64_t> parts{properties};
    ByteWriter headers;
    for (const AlembicChild& child : children) {
        parts.push_back(child.group);
        headers.write(static_cast<std::uint32_t>(child.name.size()));
        headers.writeArray(std::span<const char>(child.name));
        headers.write(static_cast<std::uint8_t>(alembicMetadata(metadata, child.metadata)));
    }
    // Digests of properties and of children, which tell two objects apart.
    const auto own = digest(std::as_bytes(std::span(&properties, 1)));
    const auto below = digest(headers.bytes());
    headers.writeArray(std::span<const std::uint64_t>(own));
    headers.writeArray(std::span<const std::uint64_t>(below));
    parts.push_back(file.data(headers.bytes()));
    return file.group(parts);
}

std::vector<std::byte> finishAlembic(OgawaBuilder& file, const std::vector<std::string>& metadata,
                                     std::uint64_t top, const std::string& about,
                                     const AlembicTimes& sampled) {
    ByteWriter texts;
    for (const std::string& text : metadata) {
        texts.write(static_cast<std::uint8_t>(text.size()));
        texts.writeArray(std::span<const char>(text));
    }
    ByteWriter times;
    const auto sampling = [&](std::uint32_t samples, double step, std::span<const double> cycle) {
        times.write(samples);
        times.write(step);
        times.write(static_cast<std::uint32_t>(cycle.size()));
        times.writeArray(cycle);
    };
    constexpr std::array<double, 1> kStart{0.0};
    sampling(1, 1, kStart);
    if (sampled.count > 1) sampling(sampled.count, sampled.step, sampled.cycle);
    const std::int32_t version = 0;
    const auto bytesOf = [](const auto& value) { return std::as_bytes(std::span(&value, 1)); };
    const std::array<std::uint64_t, 6> root{file.data(bytesOf(version)),
                                            file.data(bytesOf(kLibraryVersion)),
                                            top,
                                            file.data(std::as_bytes(std::span(about))),
                                            file.data(times.bytes()),
                                            file.data(texts.bytes())};
    return file.finish(file.group(root));
}

}  // namespace hairloom
