// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/video_writer/h264_encoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace hairloom {
namespace {

[[noreturn]] void failAv(const char* what, int code) {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> words{};
    av_strerror(code, words.data(), words.size());
    throw std::runtime_error(fmt::format("{}: {}", what, words.data()));
}

int checkAv(const char* what, int code) {
    if (code < 0) failAv(what, code);
    return code;
}

template <class T>
T* checkAv(const char* what, T* made) {
    if (made == nullptr) failAv(what, AVERROR(ENOMEM));
    return made;
}

/// A file in memory that libavformat writes and seeks in.
struct MemoryFile {
    std::vector<std::uint8_t> bytes;
    std::size_t at = 0;

#if LIBAVFORMAT_VERSION_MAJOR >= 61
    using Data = const std::uint8_t*;
#else
    using Data = std::uint8_t*;
#endif
    static int write(void* file, Data data, int size) {
        auto& self = *static_cast<MemoryFile*>(file);
        const auto count = static_cast<std::size_t>(size);
        try {
            self.bytes.resize(std::max(self.bytes.size(), self.at + count));
        } catch (const std::exception&) {
            return AVERROR(ENOMEM);  // no exception may pass through C
        }
        std::memcpy(self.bytes.data() + self.at, data, count);
        self.at += count;
        return size;
    }
    static std::int64_t seek(void* file, std::int64_t offset, int from) {
        auto& self = *static_cast<MemoryFile*>(file);
        if (from == AVSEEK_SIZE) return static_cast<std::int64_t>(self.bytes.size());
        std::int64_t to = offset;
        if (from == SEEK_CUR) to += static_cast<std::int64_t>(self.at);
        if (from == SEEK_END) to += static_cast<std::int64_t>(self.bytes.size());
        if (to < 0) return AVERROR(EINVAL);
        self.at = static_cast<std::size_t>(to);
        return to;
    }
};

const AVCodec& chooseEncoder() {
    for (const char* name : {"libx264", "libopenh264"}) {
        if (const AVCodec* codec = avcodec_find_encoder_by_name(name)) return *codec;
    }
    throw std::runtime_error("this libavcodec has no encoder of H.264 (libx264, libopenh264)");
}

constexpr int evenSize(std::uint32_t pixels) {
    return static_cast<int>(pixels + pixels % 2);
}

}  // namespace

struct H264Encoder::Impl {
    VideoHead head;
    MemoryFile file;
    AVFormatContext* format = nullptr;
    AVCodecContext* codec = nullptr;
    SwsContext* colours = nullptr;
    AVFrame* frame = nullptr;
    AVPacket* packet = nullptr;
    std::vector<std::uint8_t> even;  ///< rgba with a width and height that are even
    std::int64_t count = 0;

    explicit Impl(const VideoHead& of) : head(of) {}
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        av_packet_free(&packet);
        av_frame_free(&frame);
        sws_freeContext(colours);
        avcodec_free_context(&codec);
        if (format != nullptr && format->pb != nullptr) {
            av_freep(&format->pb->buffer);
            avio_context_free(&format->pb);
        }
        avformat_free_context(format);
    }

    void openCodec() {
        const AVCodec& encoder = chooseEncoder();
        codec = checkAv("the encoder", avcodec_alloc_context3(&encoder));
        codec->width = evenSize(head.width);
        codec->height = evenSize(head.height);
        codec->pix_fmt = AV_PIX_FMT_YUV420P;
        // Whole milliseconds of an image and 24000/1001 are exact in it.
        constexpr int kMostDivisor = 1'001'000;
        codec->framerate = av_d2q(head.framesPerSecond, kMostDivisor);
        codec->time_base = av_inv_q(codec->framerate);
        codec->sample_aspect_ratio = {1, 1};
        // ITU-T H.273. The images hold sRGB, whose curve BT.709's is not.
        codec->color_primaries = AVCOL_PRI_BT709;
        codec->color_trc = AVCOL_TRC_IEC61966_2_1;
        codec->colorspace = AVCOL_SPC_BT709;
        codec->color_range = AVCOL_RANGE_MPEG;
        codec->chroma_sample_location = AVCHROMA_LOC_LEFT;
        // Threads take part in what is chosen: one gives the same bytes on each machine.
        codec->thread_count = 1;
        codec->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
        // A second at most to the frame that a player begins at, so that scrubbing is quick.
        codec->gop_size = std::clamp(static_cast<int>(head.framesPerSecond), 1, 250);
        if (std::strcmp(encoder.name, "libx264") == 0) {
            checkAv("libx264", av_opt_set(codec->priv_data, "preset", "medium", 0));
            checkAv("libx264", av_opt_set(codec->priv_data, "crf", "16", 0));
            // Sums whose order depends on the processor are left out. Frames that wait cost memory.
            checkAv("libx264",
                    av_opt_set(codec->priv_data, "x264-params", "cpu-independent=1:rc-lookahead=20", 0));
        } else {
            constexpr double kBitsOfPixel = 0.3;
            codec->bit_rate = static_cast<std::int64_t>(kBitsOfPixel * codec->width * codec->height *
                                                        av_q2d(codec->framerate));
        }
        checkAv("the encoder", avcodec_open2(codec, &encoder, nullptr));
    }

    void openFile() {
        checkAv("MP4", avformat_alloc_output_context2(&format, nullptr, "mp4", nullptr));
        constexpr int kBuffer = 1 << 16;
        auto* buffer = static_cast<unsigned char*>(checkAv("memory", av_malloc(kBuffer)));
        format->pb =
            avio_alloc_context(buffer, kBuffer, 1, &file, nullptr, MemoryFile::write, MemoryFile::seek);
        if (format->pb == nullptr) {
            av_free(buffer);
            failAv("MP4", AVERROR(ENOMEM));
        }
        format->flags |= AVFMT_FLAG_BITEXACT;  // no date, no version of the library
        AVStream* const stream = checkAv("MP4", avformat_new_stream(format, nullptr));
        checkAv("MP4", avcodec_parameters_from_context(stream->codecpar, codec));
        stream->time_base = codec->time_base;
        stream->avg_frame_rate = codec->framerate;
        checkAv("MP4", avformat_write_header(format, nullptr));
    }

    void openColours() {
        frame = checkAv("memory", av_frame_alloc());
        frame->format = codec->pix_fmt;
        frame->width = codec->width;
        frame->height = codec->height;
        checkAv("memory", av_frame_get_buffer(frame, 0));
        packet = checkAv("memory", av_packet_alloc());
        colours = checkAv("libswscale", sws_alloc_context());
        const auto set = [&](const char* option, int value) {
            checkAv("libswscale", av_opt_set_int(colours, option, value, 0));
        };
        set("srcw", codec->width), set("srch", codec->height), set("src_format", AV_PIX_FMT_RGB0);
        set("dstw", codec->width), set("dsth", codec->height), set("dst_format", codec->pix_fmt);
        set("sws_flags", SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP | SWS_BITEXACT);
        // Where AVCHROMA_LOC_LEFT has chroma, in 256ths of a pixel of the image.
        set("dst_h_chr_pos", 0), set("dst_v_chr_pos", 128);
        checkAv("libswscale", sws_init_context(colours, nullptr, nullptr));
        const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
        constexpr int kFull = 1, kLimited = 0, kOne = 1 << 16;
        checkAv("libswscale",
                sws_setColorspaceDetails(colours, bt709, kFull, bt709, kLimited, 0, kOne, kOne));
    }

    /// The image with the last column and row again where their number is odd.
    const std::uint8_t* evenImage(std::span<const std::uint8_t> rgba) {
        const std::size_t row = std::size_t{4} * head.width, wide = std::size_t{4} * evenSize(head.width);
        if (row == wide && head.height % 2 == 0) return rgba.data();
        even.resize(wide * static_cast<std::size_t>(codec->height));
        for (std::size_t y = 0; y < static_cast<std::size_t>(codec->height); ++y) {
            const std::uint8_t* const from = rgba.data() + row * std::min<std::size_t>(y, head.height - 1);
            std::memcpy(even.data() + wide * y, from, row);
            if (wide > row) std::memcpy(even.data() + wide * y + row, from + row - 4, 4);
        }
        return even.data();
    }

    /// Puts what the encoder has ready into the file.
    void takePackets() {
        for (;;) {
            const int code = avcodec_receive_packet(codec, packet);
            if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
            checkAv("encoding", code);
            packet->duration = 1;
            av_packet_rescale_ts(packet, codec->time_base, format->streams[0]->time_base);
            checkAv("MP4", av_interleaved_write_frame(format, packet));
        }
    }
};

H264Encoder::H264Encoder(const VideoHead& head) : impl_(std::make_unique<Impl>(head)) {
    av_log_set_level(AV_LOG_QUIET);
    impl_->openCodec();
    impl_->openFile();
    impl_->openColours();
}

H264Encoder::~H264Encoder() = default;

void H264Encoder::add(std::span<const std::uint8_t> rgba) {
    AVFrame* const frame = impl_->frame;
    checkAv("memory", av_frame_make_writable(frame));
    const std::uint8_t* const from = impl_->evenImage(rgba);
    const int row = 4 * impl_->codec->width;
    checkAv("libswscale",
            sws_scale(impl_->colours, &from, &row, 0, impl_->codec->height, frame->data, frame->linesize));
    frame->pts = impl_->count++;
    checkAv("encoding", avcodec_send_frame(impl_->codec, frame));
    impl_->takePackets();
}

std::vector<std::uint8_t> H264Encoder::finish() {
    checkAv("encoding", avcodec_send_frame(impl_->codec, nullptr));
    impl_->takePackets();
    checkAv("MP4", av_write_trailer(impl_->format));
    avio_flush(impl_->format->pb);
    return std::move(impl_->file.bytes);
}

}  // namespace hairloom
