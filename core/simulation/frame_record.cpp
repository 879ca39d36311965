// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/frame_record.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>

#include "core/base/checksum.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/regular_file.h"
#include "core/base/write_rules.h"

namespace hairloom {
namespace {

constexpr std::array<char, 8> kMagic{'H', 'L', 'F', 'R', 'A', 'M', 'E', 'S'};
constexpr std::uint32_t kVersion = 1;

struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kVersion;
    float framesPerSecond = 0;
    std::uint64_t frames = 0;
    std::uint64_t points = 0;    ///< per frame
    std::uint64_t vertices = 0;  ///< of the scalp, per frame; 0 where there is none
    std::uint64_t spheres = 0;   ///< per frame
};
static_assert(sizeof(Header) == 48);

/// A frame is the hash of what follows it, then points, vertices and sphere centres as three floats each.
std::uint64_t vectorsPerFrame(const Header& header) {
    return header.points + header.vertices + header.spheres;
}
std::uint64_t bytesPerFrame(const Header& header) {
    return sizeof(std::uint64_t) + vectorsPerFrame(header) * sizeof(Vec3f);
}

Header headerFor(const Groom& groom) {
    Header header;
    header.points = groom.pointCount();
    header.vertices = groom.scalp ? groom.scalp->vertexCount() : 0;
    header.spheres = groom.spheres.size();
    return header;
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
};

FrameRecorder::FrameRecorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameRecorder::FrameRecorder(FrameRecorder&&) noexcept = default;
FrameRecorder& FrameRecorder::operator=(FrameRecorder&&) noexcept = default;
FrameRecorder::~FrameRecorder() = default;

Result<FrameRecorder> FrameRecorder::open(const std::filesystem::path& path, const Groom& groom,
                                          float framesPerSecond) {
    auto file = OutputFile::open(path, content::kFrames);
    if (!file) return tl::unexpected(file.error());
    auto impl = std::make_unique<Impl>(Impl{std::move(*file), {}, {}, {}});
    impl->header = headerFor(groom);
    impl->header.framesPerSecond = framesPerSecond;
    if (groom.scalp) impl->scalpRest.assign(groom.scalp->positions().begin(), groom.scalp->positions().end());
    for (const CollisionSphere& sphere : groom.spheres) impl->sphereRest.push_back(sphere.centre);
    const Header unfinished;
    if (auto status = impl->file.write(std::as_bytes(std::span(&unfinished, 1))); !status)
        return tl::unexpected(status.error());
    return FrameRecorder(std::move(impl));
}

Status FrameRecorder::add(std::span<const Vec3f> positions_ws, const HeadPose& pose) {
    std::vector<Vec3f> values(positions_ws.begin(), positions_ws.end());
    values.reserve(vectorsPerFrame(impl_->header));
    appendMoved(values, pose.scalpPositions_ws, impl_->scalpRest, pose.head_ws);
    appendMoved(values, pose.sphereCentres_ws, impl_->sphereRest, pose.head_ws);
    const auto bytes = std::as_bytes(std::span(values));
    const std::uint64_t hash = hashBytes(bytes);
    if (auto status = impl_->file.write(std::as_bytes(std::span(&hash, 1))); !status) return status;
    if (auto status = impl_->file.write(bytes); !status) return status;
    ++impl_->header.frames;
    return {};
}

Status FrameRecorder::finish() {
    const auto header = std::as_bytes(std::span(&impl_->header, 1));
    if (auto status = impl_->file.writeAt(0, header); !status) return status;
    return impl_->file.finish();
}

Result<RecordedFrame> readFrame(const std::filesystem::path& path, const Groom& groom, std::uint64_t index) {
    const std::string name = path.string();
    if (auto status = checkIsFile(path); !status) return tl::unexpected(status.error());
    std::ifstream file(path, std::ios::binary);
    Header header;
    if (!file) return failIn(name, {}, "cannot be read", "expected a record of frames");
    noteInput(path);
    if (!file.read(reinterpret_cast<char*>(&header), sizeof(header)) || header.magic != kMagic) {
        return failIn(name, Byte{0}, "is not a record of frames",
                      "expected a file written by simulate --record");
    }
    if (header.version > kVersion) {
        return failIn(name, Byte{8}, fmt::format("is version {}", header.version),
                      fmt::format("this program reads versions up to {}", kVersion));
    }
    const Header wanted = headerFor(groom);
    if (header.points != wanted.points || header.vertices != wanted.vertices ||
        header.spheres != wanted.spheres) {
        return failIn(
            name, Byte{24},
            fmt::format("has {} points, {} vertices and {} spheres a frame", header.points, header.vertices,
                        header.spheres),
            fmt::format("this groom has {}, {} and {}", wanted.points, wanted.vertices, wanted.spheres));
    }
    if (index >= header.frames) {
        return failIn(name, {}, fmt::format("has no frame {}", index),
                      fmt::format("it has {} frames, counted from 0", header.frames));
    }
    const std::uint64_t start = sizeof(Header) + index * bytesPerFrame(header);
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
    const auto pointsEnd = values.begin() + static_cast<std::ptrdiff_t>(header.points);
    const auto verticesEnd = pointsEnd + static_cast<std::ptrdiff_t>(header.vertices);
    frame.positions_ws.assign(values.begin(), pointsEnd);
    frame.pose.scalpPositions_ws.assign(pointsEnd, verticesEnd);
    frame.pose.sphereCentres_ws.assign(verticesEnd, values.end());
    return frame;
}

}  // namespace hairloom
