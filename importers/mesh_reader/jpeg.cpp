// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/jpeg.h"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <vector>

#include <jerror.h>
#include <jpeglib.h>

#include "core/render/picture_limits.h"
#include "core/render/tone_map.h"

namespace hairloom {
namespace {

/// The library ends what it does by calling error_exit, which may not return; jumping out of it passes over
/// no object of C++, since the two functions below that call the library make none.
struct Decoder {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    std::jmp_buf escape{};
    std::array<char, JMSG_LENGTH_MAX> why{};
    int code = 0;  ///< of the error, one of jerror.h

    Decoder() {
        jpeg.err = jpeg_std_error(&errors);
        jpeg.client_data = this;
        errors.error_exit = [](j_common_ptr common) {
            auto& self = *static_cast<Decoder*>(common->client_data);
            (*common->err->format_message)(common, self.why.data());
            self.code = common->err->msg_code;
            std::longjmp(self.escape, 1);
        };
        errors.emit_message = [](j_common_ptr common, int level) {
            // Pixels that it made up for what is missing.
            auto& self = *static_cast<Decoder*>(common->client_data);
            if (level < 0 && self.why[0] == 0) (*common->err->format_message)(common, self.why.data());
        };
    }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    ~Decoder() { jpeg_destroy_decompress(&jpeg); }

    bool begin(const unsigned char* bytes, unsigned long size) {
        if (setjmp(escape) != 0) return false;
        jpeg_create_decompress(&jpeg);
        jpeg_mem_src(&jpeg, bytes, size);
        jpeg_read_header(&jpeg, TRUE);
        jpeg.out_color_space = JCS_RGB;
        jpeg_calc_output_dimensions(&jpeg);
        return true;
    }
    /// Three bytes a pixel, rows from the top.
    bool read(unsigned char* rgb) {
        if (setjmp(escape) != 0) return false;
        jpeg_start_decompress(&jpeg);
        while (jpeg.output_scanline < jpeg.output_height) {
            JSAMPROW row = rgb + std::size_t{3} * jpeg.output_width * jpeg.output_scanline;
            jpeg_read_scanlines(&jpeg, &row, 1);
        }
        jpeg_finish_decompress(&jpeg);
        return why[0] == 0;
    }
};

/// What a file that ends with this error should have been.
const char* expectedInsteadOf(int code) {
    switch (code) {
        case JERR_CONVERSION_NOTIMPL:
        case JERR_BAD_J_COLORSPACE:
        case JERR_COMPONENT_COUNT:
            return "expected grey or RGB: convert CMYK, which is for print, to RGB";
        case JERR_BAD_PRECISION:
            return "expected 8 bits a channel: use OpenEXR or a PNG of 16 bits for more";
        case JERR_SOF_UNSUPPORTED:
        case JERR_ARITH_NOTIMPL:
        case JERR_NOT_COMPILED:
            return "expected a baseline or progressive JPEG: save it as one, or as a PNG";
        case JERR_IMAGE_TOO_BIG:
        case JERR_WIDTH_OVERFLOW:
            return "expected at most 32768 pixels along a side";
        default:
            return "expected a whole JPEG: it was cut, or changed";
    }
}
static_assert(render::kMaxPictureSide == 32768);

}  // namespace

Result<render::LinearImage> decodeJpeg(const std::string& file, std::span<const std::byte> bytes) {
    Decoder decoder;
    const auto failed = [&] {
        return failIn(file, {}, std::string("cannot be read: ") + decoder.why.data(),
                      expectedInsteadOf(decoder.code));
    };
    if (!decoder.begin(reinterpret_cast<const unsigned char*>(bytes.data()),
                       static_cast<unsigned long>(bytes.size())))
        return failed();
    const std::uint32_t width = decoder.jpeg.output_width, height = decoder.jpeg.output_height;
    // The library's rows and, of progressive ones, all coefficients; the bytes, and the linear values.
    constexpr std::uint64_t kBytesPerPixel = 3 * sizeof(short) + 3 + 4 * sizeof(float);
    if (auto status = render::checkPictureSize(file, width, height, kBytesPerPixel); !status)
        return tl::unexpected(status.error());
    std::vector<unsigned char> rgb(std::size_t{3} * width * height);
    if (!decoder.read(rgb.data())) return failed();
    std::array<float, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i)
        linear[i] = render::decodeSrgb(static_cast<float>(i) / 255);
    render::LinearImage image{width, height, std::vector<float>(std::size_t{4} * width * height, 1.0f)};
    for (std::size_t i = 0; i < rgb.size(); ++i) image.rgba[i / 3 * 4 + i % 3] = linear[rgb[i]];
    return image;
}

}  // namespace hairloom
