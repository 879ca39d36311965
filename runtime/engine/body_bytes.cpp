// SPDX-License-Identifier: MIT
// A body as bytes and back (docs/formats/body.md).

#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "engine/body_packing.h"
#include "hairloom/body_bytes.h"

namespace hairloom::runtime {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian, and copied as they are");

constexpr std::uint32_t kBodyVersion = 1, kPackedBodyVersion = 2;

/// What comes first, in this order and without gaps.
struct BodyHead {
    char magic[4];
    std::uint32_t version;
    float low[3], cell, unit;
    std::uint32_t size[3];
    std::uint32_t palette, blocks, bones;
};
static_assert(sizeof(BodyHead) == 52);
constexpr char kBodyMagic[4] = {'H', 'L', 'B', 'F'};

class BodyWriter {
  public:
    template <class T>
    void put(const T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* const first = reinterpret_cast<const std::uint8_t*>(values);
        bytes.insert(bytes.end(), first, first + count * sizeof(T));
    }
    std::vector<std::uint8_t> bytes;
};

class BodyReader {
  public:
    explicit BodyReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    /// False, and nothing is taken or allocated, where there are not as many.
    template <class T>
    bool take(Vector<T>& values, std::uint64_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count > (bytes_.size() - at_) / sizeof(T)) return false;
        values.resize(static_cast<std::size_t>(count));
        return copy(values.data(), values.size() * sizeof(T));
    }
    bool copy(void* to, std::size_t count) {
        if (count > bytes_.size() - at_) return false;
        if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
        at_ += count;
        return true;
    }
    std::span<const std::uint8_t> rest() {
        const auto left = bytes_.subspan(at_);
        at_ = bytes_.size();
        return left;
    }
    std::size_t at() const { return at_; }
    bool finished() const { return at_ == bytes_.size(); }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

static_assert(sizeof(BodyField::Skin) == 8 && sizeof(BodyField::Box) == 24);

bool takeArrays(BodyReader& reader, const BodyHead& head, BodyField& field) {
    constexpr std::uint64_t kMost = 1u << 28;
    std::uint64_t cells = 1, corners = 1;
    for (const std::uint32_t along : head.size) {
        if (along > kMost) return false;
        cells *= along;
        corners *= std::uint64_t{along} + 1;
        if (corners > kMost) return false;
    }
    return reader.take(field.distances, corners) && reader.take(field.skins, corners) &&
           reader.take(field.palette, head.palette) && reader.take(field.blocks, cells) &&
           reader.take(field.values, std::uint64_t{head.blocks} * BodyField::kBlockValues) &&
           reader.take(field.boxes, head.bones);
}

bool takeNames(BodyReader& reader, std::uint32_t count, Vector<String>& names) {
    for (std::uint32_t b = 0; b < count; ++b) {
        std::uint16_t length = 0;
        Vector<char> name;
        if (!reader.copy(&length, sizeof(length)) || !reader.take(name, length)) return false;
        names.emplace_back(name.begin(), name.end());
    }
    return true;
}

bool takePacked(BodyReader& reader, const BodyHead& head, BodyField& field) {
    return reader.take(field.palette, head.palette) && reader.take(field.boxes, head.bones) &&
           takeNames(reader, head.bones, field.bones) && unpackBodyNumbers(reader.rest(), head.blocks, field);
}

BodyHead headOf(const BodyField& field, std::uint32_t version) {
    BodyHead head{};
    std::memcpy(head.magic, kBodyMagic, sizeof(head.magic));
    head.version = version;
    const float numbers[] = {field.low_ss.x, field.low_ss.y, field.low_ss.z};
    std::memcpy(head.low, numbers, sizeof(head.low));
    head.cell = field.cell;
    head.unit = field.unit;
    std::memcpy(head.size, field.size.data(), sizeof(head.size));
    head.palette = static_cast<std::uint32_t>(field.palette.size());
    head.blocks = static_cast<std::uint32_t>(field.values.size() / BodyField::kBlockValues);
    head.bones = static_cast<std::uint32_t>(field.bones.size());
    return head;
}

void putNames(BodyWriter& writer, const Vector<String>& bones) {
    for (const String& bone : bones) {
        constexpr std::size_t kLongest = 0xffff;
        const auto length = static_cast<std::uint16_t>(bone.size() < kLongest ? bone.size() : kLongest);
        writer.put(&length, 1);
        writer.put(bone.data(), length);
    }
}

}  // namespace

std::vector<std::uint8_t> BodyField::toBytes() const {
    const BodyHead head = headOf(*this, kBodyVersion);
    BodyWriter writer;
    writer.put(&head, 1);
    writer.put(distances.data(), distances.size());
    writer.put(skins.data(), skins.size());
    writer.put(palette.data(), palette.size());
    writer.put(blocks.data(), blocks.size());
    writer.put(values.data(), values.size());
    writer.put(boxes.data(), boxes.size());
    putNames(writer, bones);
    return std::move(writer.bytes);
}

std::vector<std::uint8_t> packBody(const BodyField& field) {
    const BodyHead head = headOf(field, kPackedBodyVersion);
    const std::vector<std::uint8_t> numbers = packBodyNumbers(field);
    BodyWriter writer;
    writer.put(&head, 1);
    writer.put(field.palette.data(), field.palette.size());
    writer.put(field.boxes.data(), field.boxes.size());
    putNames(writer, field.bones);
    writer.put(numbers.data(), numbers.size());
    return std::move(writer.bytes);
}

BodyFieldRead bodyFieldFromBytes(std::span<const std::uint8_t> bytes) {
    const auto refuse = [](std::size_t at, const char* why) {
        return BodyFieldRead{std::nullopt, "byte " + std::to_string(at) + ": " + why};
    };
    BodyReader reader(bytes);
    BodyHead head;
    if (!reader.copy(&head, sizeof(head))) return refuse(0, "too short for a body");
    if (std::memcmp(head.magic, kBodyMagic, sizeof(head.magic)) != 0) return refuse(0, "is no body");
    const bool isPacked = head.version == kPackedBodyVersion;
    if (head.version != kBodyVersion && !isPacked)
        return refuse(4, "a body of a version that this program does not read");
    BodyField field;
    field.low_ss = {head.low[0], head.low[1], head.low[2]};
    field.cell = head.cell;
    field.unit = head.unit;
    std::memcpy(field.size.data(), head.size, sizeof(head.size));
    if (head.bones > 255) return refuse(48, "a body with more than 255 bones");
    const bool isWhole = isPacked
                             ? takePacked(reader, head, field)
                             : takeArrays(reader, head, field) && takeNames(reader, head.bones, field.bones);
    if (!isWhole) return refuse(reader.at(), "the body is cut short");
    if (!reader.finished()) return refuse(reader.at(), "more follows than the body needs");
    if (std::string problem = field.problem(); !problem.empty()) return {std::nullopt, std::move(problem)};
    return {std::move(field), {}};
}

}  // namespace hairloom::runtime
