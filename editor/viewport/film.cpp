// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/base/content_kind.h"
#include "core/base/output_batch.h"
#include "core/groom/time_line.h"
#include "core/live/film.h"
#include "core/live/played_frames.h"
#include "core/render/png.h"
#include "core/render/text.h"

namespace hairloom::editor {
namespace {

constexpr std::uint32_t kFramesPerSecond = 60;

render::Image imageOf(const QImage& picture) {
    const QImage rgba = picture.convertToFormat(QImage::Format_RGBA8888);
    render::Image image{
        static_cast<std::uint32_t>(rgba.width()), static_cast<std::uint32_t>(rgba.height()), {}};
    const std::size_t row = std::size_t{4} * image.width;
    image.rgba.resize(row * image.height);
    for (int y = 0; y < rgba.height(); ++y)
        std::memcpy(image.rgba.data() + row * static_cast<std::size_t>(y), rgba.constScanLine(y), row);
    return image;
}

AnimationFile::Kind kindOf(FilmFiles files) {
    if (files == FilmFiles::Mp4) return AnimationFile::Kind::Mp4;
    return files == FilmFiles::AnimatedWebp ? AnimationFile::Kind::Webp : AnimationFile::Kind::Png;
}

class FilmMaker {
  public:
    FilmMaker(const Film& film, const std::function<Result<QImage>(PictureRequest)>& draw,
              const std::function<bool(float)>& progress)
        : film_(film), draw_(draw), progress_(progress) {}

    Status run() {
        if (auto possible = check(); !possible) return possible;
        OutputBatch batch;
        if (film_.isAnimation()) {
            auto opened =
                AnimationFile::open(film_.path, film_.view.width, film_.view.height, film_.imagesPerSecond);
            if (!opened) return tl::unexpected(opened.error());
            animation_ = std::move(*opened);
        }
        Status made = film_.of == FilmOf::Simulation ? simulate() : turn();
        if (made && animation_) made = animation_->finish();
        if (made && film_.manifest) {
            ManifestSource source = *film_.manifest;
            source.groom = film_.view.groom.get();
            made = addManifest(manifestName(film_.path), source);
        }
        return made ? batch.commit() : made;
    }

  private:
    std::filesystem::path nameOf(std::uint32_t number) const {
        return film_.of == FilmOf::View ? film_.path : numbered(film_.path, number);
    }

    /// What can be known before anything is drawn.
    Status check() const {
        if (film_.bytesHeld() > kMostBytesOfFilm)
            return fail("an animation of this size needs more than 2 GiB of memory",
                        "numbered PNG images, fewer images or a smaller size");
        if (film_.isAnimation() && AnimationFile::kindOf(film_.path) != kindOf(film_.files))
            return failIn(film_.path.string(), {}, "has the suffix of another format",
                          fmt::format("expected .{}", suffixOf(film_.files)));
        if (film_.manifest) {
            if (auto may = OutputFile::check(manifestName(film_.path), content::kJson); !may) return may;
        }
        if (film_.isAnimation()) return tryPlace(film_.path, {});
        for (std::uint32_t i = 1; i < film_.images; ++i) {
            if (auto may = OutputFile::check(nameOf(i), content::kPng); !may) return may;
        }
        return tryPlace(nameOf(0), content::kPng);
    }
    static Status tryPlace(const std::filesystem::path& path, std::string_view kind) {
        auto file = OutputFile::open(path, kind);
        if (!file) return tl::unexpected(file.error());
        return file->tryOut();
    }

    Status turn() {
        for (std::uint32_t i = 0; i < film_.images; ++i) {
            PictureRequest request = film_.view;
            request.camera =
                turned(request.camera, 360 * static_cast<float>(i) / static_cast<float>(film_.images));
            if (auto taken = take(i, std::move(request)); !taken) return taken;
        }
        return {};
    }

    Status simulate() {
        const std::uint32_t step = kFramesPerSecond / film_.imagesPerSecond;
        std::vector<Vec3f> before_ws;
        return visitFrames(
            *film_.view.groom, *film_.motion, (film_.images - 1) * step + 1, kFramesPerSecond,
            [&](std::uint32_t number, RecordedFrame frame) -> Status {
                const float share = static_cast<float>(number) / static_cast<float>(film_.images * step);
                if (!progress_(share)) return fail("it was cancelled");
                const std::vector<Vec3f> last_ws = std::exchange(before_ws, frame.positions_ws);
                if (number % step != 0) return {};
                auto pose = std::make_shared<HairPose>();
                for (std::size_t p = 0; p < last_ws.size(); ++p)
                    pose->velocities_ws.push_back((frame.positions_ws[p] - last_ws[p]) * kFramesPerSecond);
                pose->positions_ws = std::move(frame.positions_ws);
                pose->head = std::move(frame.pose);
                if (film_.isOfTimeLine)
                    pose->lineTime =
                        timeLineOf(*film_.view.groom).timeAt(static_cast<float>(number) / kFramesPerSecond);
                PictureRequest request = film_.view;
                request.pose = std::move(pose);
                return take(number / step, std::move(request));
            });
    }

    Status take(std::uint32_t number, PictureRequest request) {
        const auto picture = draw_(std::move(request));
        if (!picture) return tl::unexpected(picture.error());
        render::Image image = imageOf(*picture);
        std::vector<std::string> lines;
        if (film_.burnsInFrame) lines.push_back(fmt::format("frame {}", number));
        lines.insert(lines.end(), film_.burntIn.begin(), film_.burntIn.end());
        if (!lines.empty()) render::burnIn(image, lines);
        if (animation_) {
            if (auto added = animation_->add(image); !added) return added;
        } else if (auto written = render::writePng(nameOf(number), image); !written) {
            return written;
        }
        const float share = static_cast<float>(number + 1) / static_cast<float>(film_.images);
        return progress_(share) ? Status() : fail("it was cancelled");
    }

    const Film& film_;
    const std::function<Result<QImage>(PictureRequest)>& draw_;
    const std::function<bool(float)>& progress_;
    std::optional<AnimationFile> animation_;
};

}  // namespace

const char* suffixOf(FilmFiles files) {
    if (files == FilmFiles::Mp4) return "mp4";
    return files == FilmFiles::AnimatedWebp ? "webp" : "png";
}

std::uint64_t Film::bytesHeld() const {
    const bool holds = isAnimation() && files != FilmFiles::Mp4;
    return holds ? std::uint64_t{4} * images * view.width * view.height : 0;
}

Status makeFilm(const Film& film, const std::function<Result<QImage>(PictureRequest)>& draw,
                const std::function<bool(float)>& progress) {
    return FilmMaker(film, draw, progress).run();
}

}  // namespace hairloom::editor
