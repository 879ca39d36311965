// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/frame_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <optional>

#include "core/base/checksum.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/regular_file.h"
#include "core/base/write_rules.h"
#include "core/simulation/frame_vectors.h"
#include "core/simulation/take_file.h"

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

/// A frame is the hash of what follows it, then points, vertices, sphere centres and poses of bones as three
/// floats each.
std::uint64_t vectorsPerFrame(const Header& header) {
    return header.points + header.vertices + header.spheres + kVectorsPerBone * header.bones;
}
std::uint64_t bytesPerFrame(const Header& header) {
    return sizeof(std::uint64_t) + vectorsPerFrame(header) * sizeof(Vec3f);
}

Header headerFor(const Groom& groom) {
    const FrameCounts counts = frameCounts(groom);
    Header header;
    header.points = counts.points;
    header.vertices = counts.vertices;
    header.spheres = counts.spheres;
    header.bones = counts.bones;
    header.version = groom.body ? kVersion : kFirstWithBody - 1;
    return header;
}

}  // namespace

struct FrameRecorder::Impl {
    /// One of the two.
    std::optional<TakeWriter> take;
    std::optional<OutputFile> file;
    Header header;
    std::optional<FrameVectors> vectors;
};

FrameRecorder::FrameRecorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameRecorder::FrameRecorder(FrameRecorder&&) noexcept = default;
FrameRecorder& FrameRecorder::operator=(FrameRecorder&&) noexcept = default;
FrameRecorder::~FrameRecorder() = default;

std::string_view recordKind(const std::filesystem::path& path) {
    return path.extension() == kTakeSuffix ? content::kTake : content::kFrames;
}

Result<FrameRecorder> FrameRecorder::open(const std::filesystem::path& path, const Groom& groom,
                                          float framesPerSecond, std::string notes) {
    auto impl = std::make_unique<Impl>();
    if (recordKind(path) == content::kTake) {
        auto take = TakeWriter::open(path, groom, framesPerSecond, std::move(notes));
        if (!take) return tl::unexpected(take.error());
        impl->take = std::move(*take);
        return FrameRecorder(std::move(impl));
    }
    auto file = OutputFile::open(path, content::kFrames);
    if (!file) return tl::unexpected(file.error());
    impl->file = std::move(*file);
    impl->header = headerFor(groom);
    impl->header.framesPerSecond = framesPerSecond;
    impl->vectors.emplace(groom);
    Header unfinished;
    unfinished.version = impl->header.version;
    if (auto status = impl->file->write(bytesOf(unfinished)); !status) return tl::unexpected(status.error());
    return FrameRecorder(std::move(impl));
}

Status FrameRecorder::add(std::span<const Vec3f> positions_ws, const HeadPose& pose) {
    if (impl_->take) return impl_->take->add(positions_ws, pose);
    std::vector<Vec3f> values(positions_ws.begin(), positions_ws.end());
    values.reserve(vectorsPerFrame(impl_->header));
    impl_->vectors->appendHead(values, pose);
    impl_->vectors->appendBody(values, pose);
    const auto bytes = std::as_bytes(std::span(values));
    const std::uint64_t hash = hashBytes(bytes);
    if (auto status = impl_->file->write(std::as_bytes(std::span(&hash, 1))); !status) return status;
    if (auto status = impl_->file->write(bytes); !status) return status;
    ++impl_->header.frames;
    return {};
}

Status FrameRecorder::finish() {
    if (impl_->take) return impl_->take->finish();
    if (auto status = impl_->file->writeAt(0, bytesOf(impl_->header)); !status) return status;
    return impl_->file->finish();
}

Result<RecordedFrame> readFrame(const std::filesystem::path& path, const Groom& groom, std::uint64_t index) {
    const std::string name = path.string();
    if (auto status = checkIsFile(path); !status) return tl::unexpected(status.error());
    if (isTake(path)) {
        auto reader = TakeReader::open(path);
        if (!reader) return tl::unexpected(reader.error());
        if (auto status = reader->use(groom); !status) return tl::unexpected(status.error());
        return reader->frame(index);
    }
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
    const FrameCounts counts{header.points, header.vertices, header.spheres, header.bones};
    if (auto status = checkCounts(counts, groom, name, Byte{24}); !status)
        return tl::unexpected(status.error());
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

    RecordedFrame frame = frameFrom(values, counts, groom);
    frame.framesPerSecond = header.framesPerSecond;
    frame.framesInRecord = header.frames;
    return frame;
}

}  // namespace hairloom
