// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/raw_scene_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

namespace hairloom {
namespace {

constexpr std::uint64_t kScene = 0x31454e4543534c48ull;  // "HLSCENE1"
constexpr std::uint64_t kError = 0x31524f5252454c48ull;  // "HLERROR1"
constexpr std::uint64_t kEnd = 0x31444e45454c4c48ull;    // "HLLEEND1"

using AffineData = std::array<float, 12>;
using Vec2Data = std::array<float, 2>;
using Vec3Data = std::array<float, 3>;
using QuatData = std::array<float, 4>;

Vec2Data pack(const Vec2f& v) {
    return {v.x(), v.y()};
}
Vec3Data pack(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}
QuatData pack(const Quatf& q) {
    return {q.x(), q.y(), q.z(), q.w()};
}
Vec2f unpack(const Vec2Data& v) {
    return {v[0], v[1]};
}
Vec3f unpack(const Vec3Data& v) {
    return {v[0], v[1], v[2]};
}
Quatf unpack(const QuatData& q) {
    return {q[3], q[0], q[1], q[2]};
}

AffineData pack(const Eigen::Affine3f& matrix) {
    AffineData data;
    Eigen::Map<Eigen::Matrix<float, 3, 4>>(data.data()) = matrix.matrix().topRows<3>();
    return data;
}
Eigen::Affine3f unpack(const AffineData& data) {
    Eigen::Affine3f matrix = Eigen::Affine3f::Identity();
    matrix.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<float, 3, 4>>(data.data());
    return matrix;
}

// The two visitors below share one list of members, so that writing and reading cannot come apart.
class Writer {
  public:
    explicit Writer(ByteWriter& out) : out_(out) {}

    template <class T>
    requires std::is_arithmetic_v<T>
    void operator()(const T& value) { out_.write(value); }
    template <class T>
    requires(std::is_arithmetic_v<T> || std::is_same_v<T, std::array<std::uint32_t, 4>> ||
             std::is_same_v<T, std::array<float, 4>>) void
    operator()(const std::vector<T>& values) {
        out_.write(std::uint64_t{values.size()});
        out_.writeArray(std::span<const T>(values));
    }
    void operator()(const std::string& text) {
        out_.write(std::uint64_t{text.size()});
        out_.writeArray(std::span<const char>(text));
    }
    void operator()(const Eigen::Affine3f& matrix) { out_.write(pack(matrix)); }
    template <class T>
    requires requires(const T& value) { pack(value); }
    void operator()(const std::vector<T>& values) {
        std::vector<decltype(pack(values.front()))> packed(values.size());
        std::ranges::transform(values, packed.begin(), [](const T& value) { return pack(value); });
        out_.write(std::uint64_t{packed.size()});
        out_.writeArray(std::span<const typename decltype(packed)::value_type>(packed));
    }
    template <class T, class Members>
    void each(const std::vector<T>& values, Members&& members) {
        out_.write(std::uint64_t{values.size()});
        for (const T& value : values) members(value);
    }

  private:
    ByteWriter& out_;
};

class Reader {
  public:
    explicit Reader(ByteReader& in) : in_(in) {}
    const Status& status() const { return status_; }

    template <class T>
    requires std::is_arithmetic_v<T>
    void operator()(T& value) { take(in_.read<T>("a value"), value); }
    template <class T>
    requires(std::is_arithmetic_v<T> || std::is_same_v<T, std::array<std::uint32_t, 4>> ||
             std::is_same_v<T, std::array<float, 4>>) void
    operator()(std::vector<T>& values) {
        take(in_.readArray<T>(count(), "an array"), values);
    }
    void operator()(std::string& text) {
        std::vector<char> characters;
        take(in_.readArray<char>(count(), "a text"), characters);
        text.assign(characters.begin(), characters.end());
    }
    void operator()(Eigen::Affine3f& matrix) {
        AffineData data{};
        take(in_.read<AffineData>("a matrix"), data);
        matrix = unpack(data);
    }
    template <class T>
    requires requires(const T& value) { pack(value); }
    void operator()(std::vector<T>& values) {
        std::vector<decltype(pack(std::declval<T>()))> packed;
        take(in_.readArray<typename decltype(packed)::value_type>(count(), "an array"), packed);
        values.reserve(packed.size());
        for (const auto& value : packed) values.push_back(unpack(value));
    }
    template <class T, class Members>
    void each(std::vector<T>& values, Members&& members) {
        const std::uint64_t size = count();
        for (std::uint64_t index = 0; index < size && status_; ++index) members(values.emplace_back());
    }

  private:
    template <class T>
    void take(Result<T> got, T& value) {
        if (!got && status_) status_ = tl::unexpected(got.error());
        if (got && status_) value = std::move(*got);
    }
    std::uint64_t count() {
        std::uint64_t size = 0;
        (*this)(size);
        return status_ ? size : 0;
    }

    ByteReader& in_;
    Status status_;
};

template <class Archive, class Scene>
void members(Archive& archive, Scene& scene) {
    const auto track = [&](auto& keys) {
        archive(keys.times);
        archive(keys.values);
    };
    archive(scene.soup.positions);
    archive(scene.soup.offsets);
    archive(scene.soup.corners);
    archive(scene.soup.uvs);
    archive(scene.soup.normals);
    archive(scene.soup.faceGroups);
    archive(scene.soup.faceMaterials);
    archive.each(scene.soup.groupNames, archive);
    archive.each(scene.soup.materialNames, archive);
    archive.each(scene.bones, [&](auto& bone) {
        archive(bone.name);
        archive(bone.parent);
        archive(bone.rest);
        archive(bone.inverseBind);
    });
    archive.each(scene.clips, [&](auto& clip) {
        archive(clip.name);
        archive(clip.duration);
        archive.each(clip.channels, [&](auto& channel) {
            archive(channel.bone);
            track(channel.translation);
            track(channel.rotation);
            track(channel.scale);
        });
    });
    archive(scene.skin.bones);
    archive(scene.skin.weights);
    archive.each(scene.warnings, archive);
    archive(scene.metresPerUnit);
}

}  // namespace

ByteWriter writeRawScene(const Result<RawScene>& scene) {
    ByteWriter out;
    out.reserve(std::size_t{1} << 20u);
    Writer writer(out);
    if (scene) {
        out.write(kScene);
        members(writer, *scene);
    } else {
        out.write(kError);
        const Line* line = std::get_if<Line>(&scene.error().place);
        out.write(line ? line->number : std::uint64_t{0});
        writer(scene.error().problem);
        writer(scene.error().expected);
    }
    out.write(kEnd);
    return out;
}

Result<RawScene> readRawScene(const std::string& file, std::span<const std::byte> bytes) {
    ByteReader in("the mesh reader's answer", bytes);
    Reader reader(in);
    RawScene scene;
    scene.soup.offsets.clear();
    Error error{file, {}, {}, {}};
    std::uint64_t kind = 0, end = 0, line = 0;
    reader(kind);
    if (kind == kScene) {
        members(reader, scene);
    } else if (kind == kError) {
        reader(line);
        reader(error.problem);
        reader(error.expected);
    }
    reader(end);
    if (!reader.status() || end != kEnd || (kind != kScene && kind != kError) || in.remaining() != 0) {
        return failIn(file, {}, fmt::format("the mesh reader's answer of {} bytes is invalid", bytes.size()),
                      "the file is damaged in a way that breaks the reader");
    }
    if (kind == kScene) return scene;
    if (line != 0) error.place = Line{line};
    return tl::unexpected(error);
}

}  // namespace hairloom
