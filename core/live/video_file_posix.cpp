// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/content_kind.h"
#include "core/base/descriptor_posix.h"
#include "core/base/output_file.h"
#include "core/live/video_file.h"
#include "core/live/video_stream.h"
#include "importers/child_process.h"

extern char** environ;

namespace hairloom {
namespace {

constexpr const char* kVideoProgram = "hairloom-video-writer";
/// An encoder that takes or gives nothing for so long hangs: a frame of the largest size takes seconds, and
/// at the end some twenty frames are still to be encoded.
constexpr timeval kVideoPatience{600, 0};

/// The running encoder, at the other end of a socket. It is ended when this goes.
class Encoder {
  public:
    static Result<Encoder> start(const std::filesystem::path& program) {
        std::array<int, 2> ends{};
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
            return fail("no socket to the video writer: " + std::generic_category().message(errno));
        Encoder encoder;
        encoder.socket_ = Descriptor(ends[0]);
        const Descriptor other(ends[1]);
        for (const int option : {SO_RCVTIMEO, SO_SNDTIMEO})
            setsockopt(ends[0], SOL_SOCKET, option, &kVideoPatience, sizeof kVideoPatience);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, other.number(), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, other.number(), STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        std::string name = program.string();
        std::array<char*, 2> words{name.data(), nullptr};
        const int code =
            posix_spawn(&encoder.process_, name.c_str(), &actions, nullptr, words.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (code != 0) {
            encoder.process_ = -1;
            return fail("the video writer cannot be started: " + std::generic_category().message(code),
                        "expected the program hairloom-video-writer beside this one");
        }
        return encoder;
    }

    Encoder(Encoder&& other) noexcept
        : socket_(std::move(other.socket_)), process_(std::exchange(other.process_, -1)) {}
    Encoder& operator=(Encoder&& other) noexcept {
        std::swap(socket_, other.socket_);
        std::swap(process_, other.process_);
        return *this;
    }
    ~Encoder() {
        if (process_ <= 0) return;
        kill(process_, SIGKILL);
        while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }

    /// False where the encoder takes no more.
    bool send(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent <= 0) return false;
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        }
        return true;
    }
    void endInput() { shutdown(socket_.number(), SHUT_WR); }
    /// All that it gives back; less where it ends or hangs.
    std::vector<std::byte> receive() {
        std::vector<std::byte> all, piece(std::size_t{1} << 18u);
        for (;;) {
            const ssize_t got = recv(socket_.number(), piece.data(), piece.size(), 0);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return all;
            all.insert(all.end(), piece.begin(), piece.begin() + got);
        }
    }

  private:
    Encoder() = default;
    Descriptor socket_;
    pid_t process_ = -1;
};

bool isOpaque(const render::Image& frame) {
    for (std::size_t at = 3; at < frame.rgba.size(); at += 4) {
        if (frame.rgba[at] != 255) return false;
    }
    return true;
}

}  // namespace

struct VideoFile::Impl {
    std::filesystem::path path;
    std::string name;
    std::uint32_t width, height;
    Encoder encoder;
    std::uint64_t frames = 0;

    /// What the encoder gives back: the file, or what is wrong.
    Result<std::vector<std::byte>> answer() {
        encoder.endInput();
        std::vector<std::byte> bytes = encoder.receive();
        VideoAnswer head;
        const bool begun = bytes.size() >= sizeof head;
        if (begun) std::memcpy(&head, bytes.data(), sizeof head);
        if (!begun || head.stream != kVideoStream || bytes.size() - sizeof head != head.bytes)
            return failIn(name, {}, "the video writer was ended before the video was whole",
                          "expected more free memory");
        bytes.erase(bytes.begin(), bytes.begin() + sizeof head);
        if (head.isFile != 0) return bytes;
        return failIn(
            name, {},
            "cannot be encoded: " + std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
            "expected --format webp, or a name that ends in .webp");
    }
};

VideoFile::VideoFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoFile::VideoFile(VideoFile&&) noexcept = default;
VideoFile& VideoFile::operator=(VideoFile&&) noexcept = default;
VideoFile::~VideoFile() = default;

bool canWriteVideo() {
    std::error_code code;
    return std::filesystem::exists(programFolder() / kVideoProgram, code);
}

Result<VideoFile> VideoFile::open(const std::filesystem::path& path, std::uint32_t width,
                                  std::uint32_t height, double framesPerSecond) {
    const std::string name = path.string();
    if (!isVideoSize(width, height))
        return failIn(name, {}, fmt::format("a video of {} × {} pixels", width, height),
                      fmt::format("expected 1 to {} along a side, and 8192 × 4352 in all", kMostVideoSide));
    if (!(framesPerSecond >= kLeastVideoRate && framesPerSecond <= kMostVideoRate))
        return failIn(name, {}, fmt::format("a video of {} frames per second", framesPerSecond),
                      "expected 1/66 to 1000");
    if (!canWriteVideo())
        return failIn(name, {}, fmt::format("MP4 cannot be written without the program {}", kVideoProgram),
                      "expected it beside this one, which a build with libavcodec makes, or WebP");
    if (auto may = OutputFile::check(path, content::kMp4); !may) return tl::unexpected(may.error());
    auto encoder = Encoder::start(programFolder() / kVideoProgram);
    if (!encoder) return tl::unexpected(inFile(encoder.error(), name));
    const VideoHead head{kVideoStream, width, height, framesPerSecond};
    encoder->send(std::as_bytes(std::span(&head, 1)));  // one that has ended is seen at the first frame
    return VideoFile(std::unique_ptr<Impl>(new Impl{path, name, width, height, std::move(*encoder)}));
}

Status VideoFile::add(const render::Image& frame) {
    if (frame.width != impl_->width || frame.height != impl_->height ||
        frame.rgba.size() != std::size_t{4} * frame.width * frame.height)
        return failIn(impl_->name, {}, "a video of frames of different sizes", "expected frames of one size");
    if (!isOpaque(frame))
        return failIn(impl_->name, {}, "a video has no transparency",
                      "expected an opaque background, or images as PNG or WebP");
    ++impl_->frames;
    if (impl_->encoder.send(std::as_bytes(std::span(frame.rgba)))) return {};
    const auto why = impl_->answer();
    return why ? Status(failIn(impl_->name, {}, "the video writer ended early",
                               "expected a disk that is not full, or --animation F.webp"))
               : tl::unexpected(why.error());
}

Status VideoFile::finish() {
    if (impl_->frames == 0) return failIn(impl_->name, {}, "a video without frames", "expected at least one");
    const auto bytes = impl_->answer();
    if (!bytes) return tl::unexpected(bytes.error());
    return writeFileAtomically(impl_->path, *bytes);
}

}  // namespace hairloom
