// SPDX-License-Identifier: GPL-3.0-or-later
// usage: hairloom-video-writer < FRAMES > VIDEO
// libavcodec in a process of its own, so that neither it nor the hundred libraries behind it are loaded by
// the programs that people work in. Both ends are as core/live/video_stream.h has them. It opens no file.

#include <cstdio>
#include <exception>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/live/video_stream.h"
#include "core/live/video_writer/h264_encoder.h"

namespace hairloom {
namespace {

std::vector<std::uint8_t> encodeInput() {
    VideoHead head;
    if (std::fread(&head, sizeof head, 1, stdin) != 1 || head.stream != kVideoStream)
        throw std::runtime_error("the video writer is of another version");
    if (!isVideoSize(head.width, head.height) ||
        !(head.framesPerSecond >= kLeastVideoRate && head.framesPerSecond <= kMostVideoRate))
        throw std::runtime_error("the input has no head");
    H264Encoder encoder(head);
    std::vector<std::uint8_t> frame(std::size_t{4} * head.width * head.height);
    while (const std::size_t got = std::fread(frame.data(), 1, frame.size(), stdin)) {
        if (got != frame.size()) throw std::runtime_error("the last frame is cut off");
        encoder.add(frame);
    }
    return encoder.finish();
}

bool answer(bool isFile, const void* bytes, std::size_t count) {
    const VideoAnswer head{kVideoStream, isFile, count};
    return std::fwrite(&head, sizeof head, 1, stdout) == 1 && std::fwrite(bytes, 1, count, stdout) == count &&
           std::fflush(stdout) == 0;
}

int run() {
    try {
        const std::vector<std::uint8_t> file = encodeInput();
        return answer(true, file.data(), file.size()) ? 0 : 1;
    } catch (const std::exception& exception) {
        const std::string_view words = exception.what();
        answer(false, words.data(), words.size());
        return 1;
    }
}

}  // namespace
}  // namespace hairloom

int main() {
    return hairloom::run();
}
