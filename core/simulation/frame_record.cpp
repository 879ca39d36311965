// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/frame_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>

#include "core/base/checksum.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/regular_file.h"
#include "core/base/write_rules.h"
#include "core/simulation/scene_input.h"
#include "hairloom/body_field.h"

namespace hairloom {
namespace {

constexpr std::array<char, 8> kMagic{'H', 'L', 'F', 'R', 'A', 'M', 'E', 'S'};
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kFirstWithBody = 2;  ///< records of grooms without a body are of version 1

struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kVersion;
    float framesPerSecond = 0;
    std::uint64_t frames = 0;
    std::uint64_t points = 0;    ///< per frame
    std::uint64_t vertices = 0;  ///< of the scalp, per frame; 0 where there is none
    std::uint64_t spheres = 0;   ///< per frame
    std::uint64_t bones = 0;     ///< poses of the body, per frame; from kFirstWithBody on
};
static_assert(sizeof(Header) == 56);

std::size_t headerBytes(const Header& header) {
    return header.version < kFirstWithBody ? offsetof(Header, bones) : sizeof(Header);
}
std::span<const std::byte> bytesOf(const Header& header) {
    return std::as_bytes(std::span(&header, 1)).first(headerBytes(header));
}

constexpr std::uint64_t kVectorsPerBone = 4;

/// A frame is the hash of what follows it, then points, vertices, sphere centres and poses of bones as three
/// floats each.
std::uint64_t vectorsPerFrame(const Header& header) {
    return header.points + header.vertices + header.spheres + kVectorsPerBone * header.bones;
}
std::uint64_t bytesPerFrame(const Header& header) {
    return sizeof(std::uint64_t) + vectorsPerFrame(header) * sizeof(Vec3f);
}

Header headerFor(const Groom& groom) {
    Header header;
    header.points = groom.pointCount();
    header.vertices = groom.scalp ? groom.scalp->vertexCount() : 0;
    header.spheres = groom.spheres.size();
    header.bones = groom.body ? std::max<std::size_t>(groom.body->bones.size(), 1) : 0;
    header.version = groom.body ? kVersion : kFirstWithBody - 1;
    return header;
}

/// All 0 where the pose does not say where the body is.
void appendBody(std::vector<Vec3f>& values, const Groom& groom, const HeadPose& pose, std::uint64_t bones) {
    const auto toVec3 = [](runtime::Float3 v) { return Vec3f(v.x, v.y, v.z); };
    const auto poses = bodyAt(groom, pose);
    for (std::uint64_t b = 0; b < bones; ++b) {
        if (poses.empty()) {
            values.insert(values.end(), kVectorsPerBone, Vec3f::Zero());
            continue;
        }
        const runtime::BonePose& one = poses[poses.size() == 1 ? 0 : b];
        for (const runtime::Float3& column : {one.x, one.y, one.z, one.origin})
            values.push_back(toVec3(column));
    }
}

/// What appendBody() wrote.
std::vector<Eigen::Affine3f> bodyOf(std::span<const Vec3f> values) {
    std::vector<Eigen::Affine3f> bones;
    if (std::ranges::all_of(values, [](const Vec3f& v) { return v == Vec3f::Zero(); })) return bones;
    for (std::size_t i = 0; i < values.size(); i += kVectorsPerBone) {
        Eigen::Affine3f bone = Eigen::Affine3f::Identity();
        for (std::size_t column = 0; column < kVectorsPerBone; ++column)
            bone.matrix().col(static_cast<Eigen::Index>(column)).head<3>() = values[i + column];
        bones.push_back(bone);
    }
    return bones;
}

/// What the pose leaves to the rigid motion of the head, written out.
void appendMoved(std::vector<Vec3f>& values, std::span<const Vec3f> posed_ws, std::span<const Vec3f> rest,
                 const Eigen::Isometry3f& head_ws) {
    if (!posed_ws.empty()) {
        values.insert(values.end(), posed_ws.begin(), posed_ws.end());
        return;
    }
    for (const Vec3f& position : rest) values.push_back(head_ws * position);
}

}  // namespace

struct FrameRecorder::Impl {
    OutputFile file;
    Header header;
    std::vector<Vec3f> scalpRest;
    std::vector<Vec3f> sphereRest;
    Groom bodyOnly;  ///< without hair
};

FrameRecorder::FrameRecorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameRecorder::FrameRecorder(FrameRecorder&&) noexcept = default;
FrameRecorder& FrameRecorder::operator=(FrameRecorder&&) noexcept = default;
FrameRecorder::~FrameRecorder() = default;

Result<FrameRecorder> FrameRecorder::open(const std::filesystem::path& path, const Groom& groom,
                                          float framesPerSecond) {
    auto file = OutputFile::open(path, content::kFrames);
    if (!file) return tl::unexpected(file.error());
    auto impl = std::make_unique<Impl>(Impl{std::move(*file), {}, {}, {}, {}});
    impl->header = headerFor(groom);
    impl->header.framesPerSecond = framesPerSecond;
    if (groom.scalp) impl->scalpRest.assign(groom.scalp->positions().begin(), groom.scalp->positions().end());
    for (const CollisionSphere& sphere : groom.spheres) impl->sphereRest.push_back(sphere.centre);
    impl->bodyOnly.body = groom.body;
    Header unfinished;
    unfinished.version = impl->header.version;
    if (auto status = impl->file.write(bytesOf(unfinished)); !status) return tl::unexpected(status.error());
    return FrameRecorder(std::move(impl));
}

Status FrameRecorder::add(std::span<const Vec3f> positions_ws, const HeadPose& pose) {
    std::vector<Vec3f> values(positions_ws.begin(), positions_ws.end());
    values.reserve(vectorsPerFrame(impl_->header));
    appendMoved(values, pose.scalpPositions_ws, impl_->scalpRest, pose.head_ws);
    appendMoved(values, pose.sphereCentres_ws, impl_->sphereRest, pose.head_ws);
    appendBody(values, impl_->bodyOnly, pose, impl_->header.bones);
    const auto bytes = std::as_bytes(std::span(values));
    const std::uint64_t hash = hashBytes(bytes);
    if (auto status = impl_->file.write(std::as_bytes(std::span(&hash, 1))); !status) return status;
    if (auto status = impl_->file.write(bytes); !status) return status;
    ++impl_->header.frames;
    return {};
}

Status FrameRecorder::finish() {
    if (auto status = impl_->file.writeAt(0, bytesOf(impl_->header)); !status) return status;
    return impl_->file.finish();
}

Result<RecordedFrame> readFrame(const std::filesystem::path& path, const Groom& groom, std::uint64_t index) {
    const std::string name = path.string();
    if (auto status = checkIsFile(path); !status) return tl::unexpected(status.error());
    std::ifstream file(path, std::ios::binary);
    Header header;
    if (!file) return failIn(name, {}, "cannot be read", "expected a record of frames");
    noteInput(path);
    if (!file.read(reinterpret_cast<char*>(&header), offsetof(Header, bones)) || header.magic != kMagic) {
        return failIn(name, Byte{0}, "is not a record of frames",
                      "expected a file written by simulate --record");
    }
    if (header.version > kVersion) {
        return failIn(name, Byte{8}, fmt::format("is version {}", header.version),
                      fmt::format("this program reads versions up to {}", kVersion));
    }
    if (header.version >= kFirstWithBody &&
        !file.read(reinterpret_cast<char*>(&header.bones), sizeof(header.bones)))
        return failIn(name, Byte{offsetof(Header, bones)}, "is cut short", "expected the number of bones");
    const Header wanted = headerFor(groom);
    if (header.points != wanted.points || header.vertices != wanted.vertices ||
        header.spheres != wanted.spheres) {
        return failIn(
            name, Byte{24},
            fmt::format("has {} points, {} vertices and {} spheres a frame", header.points, header.vertices,
                        header.spheres),
            fmt::format("this groom has {}, {} and {}", wanted.points, wanted.vertices, wanted.spheres));
    }
    // A record from before the groom had a body, or had it fitted to other bones, is of the same hair: the
    // body then has no pose.
    constexpr std::uint64_t kMostBones = 255;
    if (header.bones > kMostBones)
        return failIn(name, Byte{offsetof(Header, bones)}, fmt::format("has {} bones", header.bones),
                      fmt::format("expected {} at most", kMostBones));
    if (!(header.framesPerSecond > 0) || !std::isfinite(header.framesPerSecond))
        return failIn(name, Byte{offsetof(Header, framesPerSecond)},
                      fmt::format("has {} frames a second", header.framesPerSecond),
                      "expected a positive number");
    if (index >= header.frames) {
        return failIn(name, {}, fmt::format("has no frame {}", index),
                      fmt::format("it has {} frames, counted from 0", header.frames));
    }
    const std::uint64_t start = headerBytes(header) + index * bytesPerFrame(header);
    std::uint64_t hash = 0;
    std::vector<Vec3f> values(vectorsPerFrame(header));
    file.seekg(static_cast<std::streamoff>(start));
    file.read(reinterpret_cast<char*>(&hash), sizeof(hash));
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(Vec3f)));
    if (!file) return failIn(name, Byte{start}, "is cut short", fmt::format("expected frame {} here", index));
    if (!isChecksum(hashOf(std::span<const Vec3f>(values)), hash)) {
        return failIn(name, Byte{start}, fmt::format("frame {} is damaged", index),
                      "its checksum does not match");
    }

    RecordedFrame frame;
    frame.framesPerSecond = header.framesPerSecond;
    frame.framesInRecord = header.frames;
    const auto pointsEnd = values.begin() + static_cast<std::ptrdiff_t>(header.points);
    const auto verticesEnd = pointsEnd + static_cast<std::ptrdiff_t>(header.vertices);
    frame.positions_ws.assign(values.begin(), pointsEnd);
    frame.pose.scalpPositions_ws.assign(pointsEnd, verticesEnd);
    const auto spheresEnd = verticesEnd + static_cast<std::ptrdiff_t>(header.spheres);
    frame.pose.sphereCentres_ws.assign(verticesEnd, spheresEnd);
    if (header.bones == wanted.bones) frame.pose.body_ws = bodyOf({spheresEnd, values.end()});
    return frame;
}

}  // namespace hairloom
