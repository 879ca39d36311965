// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/exr.h"

#include <tinyexr.h>

#include <array>
#include <cstring>
#include <map>
#include <memory>

#include "core/base/file.h"
#include "core/render/exr_head.h"
#include "core/render/picture_limits.h"

namespace hairloom::render {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30u;

/// The library's own memory.
struct Loaded {
    EXRVersion version{};
    EXRHeader header{};
    EXRImage image{};
    const char* error = nullptr;

    Loaded() {
        InitEXRHeader(&header);
        InitEXRImage(&image);
    }
    ~Loaded() {
        FreeEXRImage(&image);
        FreeEXRHeader(&header);
        if (error != nullptr) FreeEXRErrorMessage(error);
    }
    Loaded(const Loaded&) = delete;
    Loaded& operator=(const Loaded&) = delete;

    std::string why() const { return error != nullptr ? error : "damaged"; }
    /// After a failure the library has freed what it made, but still points to it.
    void forgetHeader() { InitEXRHeader(&header); }
    void forgetImage() { InitEXRImage(&image); }
};

/// Place of a channel, or -1.
int channelNamed(const EXRHeader& header, const char* name) {
    for (int c = 0; c < header.num_channels; ++c) {
        if (std::strcmp(header.channels[c].name, name) == 0) return c;
    }
    return -1;
}

/// `value` must outlive it.
EXRAttribute attribute(const char* name, const char* type, std::span<std::byte> value) {
    EXRAttribute made{};
    std::strncpy(made.name, name, sizeof(made.name) - 1);
    std::strncpy(made.type, type, sizeof(made.type) - 1);
    made.value = reinterpret_cast<unsigned char*>(value.data());
    made.size = static_cast<int>(value.size());
    return made;
}

}  // namespace

Result<LinearImage> decodeExr(const std::string& file, std::span<const std::byte> content) {
    const auto failed = [&](const std::string& why) {
        return failIn(file, {}, why, "expected an OpenEXR of one part in lines of pixels");
    };
    const auto head = readExrHead(file, content);
    if (!head) return tl::unexpected(head.error());
    if (head->width < 1 || head->height < 1) return failed("is an image without pixels");
    if (auto status = checkPictureSize(file, head->width, head->height,
                                       (std::uint64_t{head->channels} + 4) * sizeof(float));
        !status)
        return tl::unexpected(status.error());
    if (auto status = checkExrBlocks(file, content, *head); !status) return tl::unexpected(status.error());
    const auto* const bytes = reinterpret_cast<const unsigned char*>(content.data());
    Loaded loaded;
    if (ParseEXRVersionFromMemory(&loaded.version, bytes, content.size()) != TINYEXR_SUCCESS)
        return failed("is not an OpenEXR file");
    if (ParseEXRHeaderFromMemory(&loaded.header, &loaded.version, bytes, content.size(), &loaded.error) !=
        TINYEXR_SUCCESS) {
        loaded.forgetHeader();
        return failed("cannot be read: " + loaded.why());
    }
    std::array<int, 4> places{channelNamed(loaded.header, "R"), channelNamed(loaded.header, "G"),
                              channelNamed(loaded.header, "B"), channelNamed(loaded.header, "A")};
    if (const int grey = channelNamed(loaded.header, "Y"); places[0] < 0 && grey >= 0)
        places[0] = places[1] = places[2] = grey;
    if (places[0] < 0 || places[1] < 0 || places[2] < 0) return failed("has no channels R, G and B, or Y");
    for (const int place : places) {
        if (place >= 0 && loaded.header.pixel_types[place] == TINYEXR_PIXELTYPE_UINT)
            return failed("has whole numbers for colours");
    }
    for (int c = 0; c < loaded.header.num_channels; ++c) {
        if (loaded.header.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
            loaded.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
    }
    // Lines say which they are. The library turns pictures over whose lines come from the bottom up.
    loaded.header.line_order = 0;
    if (LoadEXRImageFromMemory(&loaded.image, &loaded.header, bytes, content.size(), &loaded.error) !=
        TINYEXR_SUCCESS) {
        loaded.forgetImage();
        return failed("cannot be read: " + loaded.why());
    }
    if (loaded.image.images == nullptr) return failed("has no pixels");
    LinearImage image{static_cast<std::uint32_t>(head->width), static_cast<std::uint32_t>(head->height),
                      std::vector<float>(static_cast<std::size_t>(4 * head->width * head->height), 1.0f)};
    for (std::size_t c = 0; c < 4; ++c) {
        if (places[c] < 0) continue;
        const auto* const plane = reinterpret_cast<const float*>(loaded.image.images[places[c]]);
        for (std::size_t i = 0; i < image.rgba.size() / 4; ++i) image.rgba[4 * i + c] = plane[i];
    }
    return image;
}

Result<LinearImage> readExr(const std::filesystem::path& path) {
    const auto bytes = readFile(path, kMaxFileBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    return decodeExr(path.string(), *bytes);
}

Status writeExr(const std::filesystem::path& path, const LinearImage& image, std::span<const ExrLayer> layers,
                const LinearSpace& space) {
    const std::size_t pixels = std::size_t{image.width} * image.height;
    if (pixels == 0 || image.rgba.size() != 4 * pixels)
        return failIn(path.string(), {}, "an image without pixels");
    // The library wants alphabetical order.
    std::map<std::string, std::vector<float>> planes;
    const auto split = [&](const std::string& prefix, std::string_view names, std::span<const float> values) {
        for (std::size_t c = 0; c < names.size(); ++c) {
            std::vector<float>& plane = planes[prefix + names[c]];
            for (std::size_t i = c; i < values.size(); i += names.size()) plane.push_back(values[i]);
        }
    };
    split("", "RGBA", image.rgba);
    for (const ExrLayer& layer : layers) {
        if (layer.values.size() != layer.channels.size() * pixels)
            return failIn(path.string(), {}, "a layer '" + layer.name + "' of another size than the image");
        split(layer.name + ".", layer.channels, layer.values);
    }
    std::vector<unsigned char*> pointers;
    std::vector<EXRChannelInfo> channels(planes.size());
    std::vector<int> types(planes.size(), TINYEXR_PIXELTYPE_FLOAT);
    for (auto& [name, plane] : planes) {
        std::strncpy(channels[pointers.size()].name, name.c_str(), sizeof(EXRChannelInfo::name) - 1);
        pointers.push_back(reinterpret_cast<unsigned char*>(plane.data()));
    }
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = static_cast<int>(planes.size());
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    std::array<float, 8> chromaticities = space.chromaticities;
    std::string interopId = space.interopId;
    std::array<EXRAttribute, 2> attributes{
        attribute("chromaticities", "chromaticities", std::as_writable_bytes(std::span(chromaticities))),
        attribute("colorInteropID", "string", std::as_writable_bytes(std::span(interopId)))};
    header.custom_attributes = attributes.data();
    header.num_custom_attributes = interopId.empty() ? 1 : 2;
    EXRImage content;
    InitEXRImage(&content);
    content.num_channels = header.num_channels;
    content.images = pointers.data();
    content.width = static_cast<int>(image.width);
    content.height = static_cast<int>(image.height);
    unsigned char* memory = nullptr;
    const char* error = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&content, &header, &memory, &error);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owned(memory, &std::free);
    if (size == 0) {
        const std::string why = error != nullptr ? error : "unknown reason";
        if (error != nullptr) FreeEXRErrorMessage(error);
        return failIn(path.string(), {}, "cannot be encoded: " + why);
    }
    return writeFileAtomically(path, std::as_bytes(std::span(memory, size)));
}

}  // namespace hairloom::render
