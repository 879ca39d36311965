// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Recorded motion on disk: for each frame the strands' points and the scalp's vertices, exact (layout in
// docs/formats/frames.md), or, under a name that ends in .hltake, as a take (take_file.h).

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/simulation/motion.h"

namespace hairloom {

struct RecordedFrame {
    std::vector<Vec3f> positions_ws;
    HeadPose pose;
    float framesPerSecond = 60;        ///< of the record
    std::uint64_t framesInRecord = 0;  ///< 0 where it is of none
};

/// What FrameRecorder writes under this name: one of hairloom::content.
std::string_view recordKind(const std::filesystem::path& path);

/// Writes frames as they come into a temporary file; `finish` puts it under the name asked for. A recorder
/// that is destroyed unfinished leaves nothing, or the blocks of a take.
class FrameRecorder {
  public:
    /// `notes`: TakeInfo::notes, of a take.
    static Result<FrameRecorder> open(const std::filesystem::path& path, const Groom& groom,
                                      float framesPerSecond, std::string notes = {});
    FrameRecorder(FrameRecorder&&) noexcept;
    FrameRecorder& operator=(FrameRecorder&&) noexcept;
    ~FrameRecorder();

    Status add(std::span<const Vec3f> positions_ws, const HeadPose& pose);
    Status finish();

  private:
    struct Impl;
    explicit FrameRecorder(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Frame `index` of a record or take made from this groom. Errors: damage with its place, a record of another
/// groom (other point or vertex count), an index past the end (naming the number of frames).
Result<RecordedFrame> readFrame(const std::filesystem::path& path, const Groom& groom, std::uint64_t index);

}  // namespace hairloom
