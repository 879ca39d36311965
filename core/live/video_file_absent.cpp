// SPDX-License-Identifier: GPL-3.0-or-later
// For systems on which no libavcodec is built.
#include "core/live/video_file.h"

namespace hairloom {

struct VideoFile::Impl {};
VideoFile::VideoFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoFile::VideoFile(VideoFile&&) noexcept = default;
VideoFile& VideoFile::operator=(VideoFile&&) noexcept = default;
VideoFile::~VideoFile() = default;

bool canWriteVideo() {
    return false;
}

Result<VideoFile> VideoFile::open(const std::filesystem::path& path, std::uint32_t, std::uint32_t, double) {
    return failIn(path.string(), {}, "this program was built without libavcodec and cannot write MP4",
                  "expected a name that ends in .webp or .png");
}
Status VideoFile::add(const render::Image&) {
    return fail("there is no video");
}
Status VideoFile::finish() {
    return fail("there is no video");
}

}  // namespace hairloom
