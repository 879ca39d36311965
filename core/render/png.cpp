// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/png.h"

#include <png.h>
#include <zlib.h>

#include <array>
#include <cstring>

#include "core/base/file.h"
#include "core/render/picture_limits.h"
#include "core/render/tone_map.h"

namespace hairloom::render {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{256} << 20u;

Result<std::vector<std::byte>> encode(const std::filesystem::path& path, const Image& image) {
    auto file = encodePng(image);
    if (!file) return tl::unexpected(inFile(file.error(), path.string()));
    return file;
}

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) out.push_back(byte);
}

void putNumber(std::vector<std::byte>& out, std::uint32_t value, int bytes) {
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
        out.push_back(static_cast<std::byte>(value >> static_cast<unsigned>(shift) & 0xffu));
    }
}

std::uint32_t number(std::span<const std::byte> at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8u | std::to_integer<std::uint32_t>(at[i]);
    return value;
}

void putChunk(std::vector<std::byte>& out, const char* type, std::span<const std::byte> content) {
    putNumber(out, static_cast<std::uint32_t>(content.size()), 4);
    const std::size_t start = out.size();
    for (std::size_t i = 0; i < 4; ++i) out.push_back(static_cast<std::byte>(type[i]));
    append(out, content);
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(out.data() + start), static_cast<uInt>(out.size() - start));
    putNumber(out, static_cast<std::uint32_t>(crc), 4);
}

/// The content of all chunks of a type in a PNG that this file's encode() made.
std::vector<std::byte> chunks(std::span<const std::byte> file, const char* type) {
    constexpr std::size_t kSignature = 8;
    std::vector<std::byte> content;
    for (std::size_t at = kSignature; at + 12 <= file.size();) {
        const std::size_t size = number(file.subspan(at, 4));
        if (std::memcmp(file.data() + at + 4, type, 4) == 0) {
            const auto part = file.subspan(at + 8, size);
            append(content, part);
        }
        at += 12 + size;
    }
    return content;
}

}  // namespace

Result<std::vector<std::byte>> encodePng(const Image& image) {
    const std::size_t bytes = std::size_t{image.width} * image.height * 4;
    if (bytes == 0 || image.rgba.size() != bytes) return fail("an image without pixels");
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = image.width;
    png.height = image.height;
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::byte> file(PNG_IMAGE_PNG_SIZE_MAX(png));
    png_alloc_size_t size = file.size();
    if (png_image_write_to_memory(&png, file.data(), &size, 0, image.rgba.data(), 0, nullptr) == 0) {
        return fail(std::string("cannot be encoded: ") + png.message);
    }
    file.resize(size);
    return file;
}

Status writePng(const std::filesystem::path& path, const Image& image) {
    const auto file = encode(path, image);
    if (!file) return tl::unexpected(file.error());
    return writeFileAtomically(path, *file);
}

// The chunks acTL, fcTL and fdAT: Portable Network Graphics (PNG) Specification, third edition.
Status writeAnimatedPng(const std::filesystem::path& path, std::span<const Image> frames,
                        std::uint32_t milliseconds) {
    if (frames.empty() || milliseconds == 0 || milliseconds > 65535) {
        return failIn(path.string(), {}, "an animation without frames or time");
    }
    std::vector<std::byte> out;
    std::uint32_t sequence = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Image& frame = frames[i];
        if (frame.width != frames[0].width || frame.height != frames[0].height) {
            return failIn(path.string(), {}, "an animation of frames of different sizes");
        }
        const auto file = encode(path, frame);
        if (!file) return tl::unexpected(file.error());
        if (i == 0) {
            append(out, std::span(*file).first(8));
            putChunk(out, "IHDR", chunks(*file, "IHDR"));
            std::vector<std::byte> control;
            putNumber(control, static_cast<std::uint32_t>(frames.size()), 4);
            putNumber(control, 0, 4);
            putChunk(out, "acTL", control);
        }
        std::vector<std::byte> control;
        for (const std::uint32_t value : {sequence++, frame.width, frame.height, 0u, 0u})
            putNumber(control, value, 4);
        putNumber(control, milliseconds, 2);
        putNumber(control, 1000, 2);
        putNumber(control, 0, 2);  // nothing is disposed of, nothing blended
        putChunk(out, "fcTL", control);
        std::vector<std::byte> content;
        if (i > 0) putNumber(content, sequence++, 4);
        const auto pixels = chunks(*file, "IDAT");
        append(content, pixels);
        putChunk(out, i == 0 ? "IDAT" : "fdAT", content);
    }
    putChunk(out, "IEND", {});
    return writeFileAtomically(path, out);
}

Result<LinearImage> decodePng(const std::string& file, std::span<const std::byte> bytes) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    const auto failed = [&](const std::string& why) {
        png_image_free(&png);
        return failIn(file, {}, "cannot be read: " + why, "expected a whole PNG");
    };
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return failed(png.message);
    // Bytes of the file's own pixels, and of the linear ones.
    constexpr std::uint64_t kBytesPerPixel = 4 + 4 * sizeof(float);
    if (auto status = checkPictureSize(file, png.width, png.height, kBytesPerPixel); !status) {
        png_image_free(&png);
        return tl::unexpected(status.error());
    }
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
    if (png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr) == 0) return failed(png.message);
    LinearImage image{png.width, png.height, std::vector<float>(pixels.size())};
    std::array<float, 256> linear{}, share{};
    for (std::size_t i = 0; i < linear.size(); ++i) {
        share[i] = static_cast<float>(i) / 255;
        linear[i] = decodeSrgb(share[i]);
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) image.rgba[i] = (i % 4 == 3 ? share : linear)[pixels[i]];
    return image;
}

Result<LinearImage> readPng(const std::filesystem::path& path) {
    const auto bytes = readFile(path, kMaxFileBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    return decodePng(path.string(), *bytes);
}

}  // namespace hairloom::render
