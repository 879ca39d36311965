// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures and films in files, of what the viewport shows.

#include <QImage>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/file/manifest.h"
#include "core/simulation/motion.h"
#include "editor/viewport/picture_request.h"

namespace hairloom::editor {

enum class FilmOf { View, Turntable, Simulation };
enum class FilmFiles { Pictures, AnimatedPng, AnimatedWebp, Mp4 };
/// What their names end in: "png", "webp", "mp4".
const char* suffixOf(FilmFiles files);

struct Film {
    FilmOf of = FilmOf::View;
    FilmFiles files = FilmFiles::Pictures;
    std::filesystem::path path;  ///< names of several pictures are numbered()
    PictureRequest view;         ///< camera, size, look; of the first picture
    std::uint32_t images = 1;    ///< at least 1; of the view: 1
    /// A divisor of 60, the frames that are simulated in a second.
    std::uint32_t imagesPerSecond = 30;
    std::shared_ptr<const HeadMotion> motion;  ///< of the simulation, which begins at rest
    bool isOfTimeLine = false;                 ///< `motion` is the groom's time line

    bool burnsInFrame = false;         ///< the frame's number, in the lower left corner
    std::vector<std::string> burntIn;  ///< lines below it, the same in all pictures
    /// Writes manifestName(path) beside the pictures; `groom` is the view's.
    std::optional<ManifestSource> manifest;

    bool isAnimation() const { return of != FilmOf::View && files != FilmFiles::Pictures; }
    /// What an animation holds until it is written; 0 for pictures and MP4, which are written as they come.
    std::uint64_t bytesHeld() const;
};

/// Most that bytesHeld() may be.
constexpr std::uint64_t kMostBytesOfFilm = std::uint64_t{2} << 30u;

/// Draws and writes it: all files, or none. `draw` makes a picture; `progress` is told the share that is done
/// and ends the work where it returns false. Errors: those of both, no space, more than kMostBytesOfFilm, an
/// animation whose name has another suffix than suffixOf().
Status makeFilm(const Film& film, const std::function<Result<QImage>(PictureRequest)>& draw,
                const std::function<bool(float)>& progress);

}  // namespace hairloom::editor
