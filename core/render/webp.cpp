// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/webp.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "core/base/file.h"

namespace hairloom::render {
namespace {

constexpr float kQuality = 90;

struct WebpPicture {
    WebPPicture value{};

    WebpPicture() { WebPPictureInit(&value); }
    ~WebpPicture() { WebPPictureFree(&value); }
    WebpPicture(const WebpPicture&) = delete;
    WebpPicture& operator=(const WebpPicture&) = delete;
};

struct Assembled {
    WebPData value{};

    Assembled() { WebPDataInit(&value); }
    ~Assembled() { WebPDataClear(&value); }
    Assembled(const Assembled&) = delete;
    Assembled& operator=(const Assembled&) = delete;
};

Status checkFrames(const std::filesystem::path& path, std::span<const Image> frames,
                   std::uint32_t milliseconds) {
    const auto failed = [&](const char* why) { return failIn(path.string(), {}, why); };
    constexpr std::uint32_t kLongest = 65535;
    if (frames.empty() || milliseconds == 0 || milliseconds > kLongest)
        return failed("an animation without frames or time");
    if (frames.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) / milliseconds)
        return failed("an animation that plays for more than 24 days");
    const Image& first = frames.front();
    if (std::max(first.width, first.height) > WEBP_MAX_DIMENSION)
        return failed("an animation of more than 16383 pixels along a side");
    for (const Image& frame : frames) {
        if (frame.width != first.width || frame.height != first.height)
            return failed("an animation of frames of different sizes");
        if (frame.rgba.empty() || frame.rgba.size() != std::size_t{4} * frame.width * frame.height)
            return failed("an image without pixels");
    }
    return {};
}

}  // namespace

Status writeAnimatedWebp(const std::filesystem::path& path, std::span<const Image> frames,
                         std::uint32_t milliseconds) {
    if (auto status = checkFrames(path, frames, milliseconds); !status) return status;
    const auto width = static_cast<int>(frames[0].width), height = static_cast<int>(frames[0].height);
    WebPConfig config;
    WebPAnimEncoderOptions options;
    if (WebPConfigPreset(&config, WEBP_PRESET_PICTURE, kQuality) == 0 ||
        WebPAnimEncoderOptionsInit(&options) == 0) {
        return failIn(path.string(), {}, "cannot be encoded: the library is another version");
    }
    const std::unique_ptr<WebPAnimEncoder, decltype(&WebPAnimEncoderDelete)> encoder(
        WebPAnimEncoderNew(width, height, &options), &WebPAnimEncoderDelete);
    const auto failed = [&] {
        return failIn(path.string(), {},
                      std::string("cannot be encoded: ") +
                          (encoder ? WebPAnimEncoderGetError(encoder.get()) : "out of memory"));
    };
    if (!encoder) return failed();
    int time = 0;
    for (const Image& frame : frames) {
        WebpPicture picture;
        picture.value.use_argb = 1;
        picture.value.width = width;
        picture.value.height = height;
        if (WebPPictureImportRGBA(&picture.value, frame.rgba.data(), 4 * width) == 0 ||
            WebPAnimEncoderAdd(encoder.get(), &picture.value, time, &config) == 0) {
            return failed();
        }
        time += static_cast<int>(milliseconds);
    }
    Assembled file;
    if (WebPAnimEncoderAdd(encoder.get(), nullptr, time, nullptr) == 0 ||
        WebPAnimEncoderAssemble(encoder.get(), &file.value) == 0) {
        return failed();
    }
    return writeFileAtomically(path, std::as_bytes(std::span(file.value.bytes, file.value.size)));
}

}  // namespace hairloom::render
