// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A take: recorded motion in few bytes, which is whole up to its last block whatever ends its writer. Layout
// in docs/formats/take.md.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/simulation/motion.h"

namespace hairloom {

struct RecordedFrame;

inline constexpr const char* kTakeSuffix = ".hltake";

/// Frames in a block: so many are read for the last of them.
inline constexpr std::uint32_t kFramesPerBlock = 8;

struct TakeInfo {
    float framesPerSecond = 60;
    std::uint64_t frames = 0;  ///< in whole blocks
    std::uint64_t points = 0;  ///< per frame
    std::uint64_t bytes = 0;   ///< of the file
    /// Metres: the largest distance of a point or vertex from where it was. Measured while it was written; of
    /// a take that was cut off, what it can be.
    float largestError = 0;
    std::uint64_t shapeHash = 0;  ///< takeShapeHash() of its groom
    bool isFinished = false;      ///< false: its writer was ended
    /// A JSON object of whoever wrote it: the motion's name, settings.
    std::string notes;
};

/// Of what a take moves: strands, their authored points and the scalp. A groom with another one has changed
/// since.
std::uint64_t takeShapeHash(const Groom& groom);

/// Writes frames as they come, in blocks, beside the name that is asked for; finish() puts it there. One that
/// is destroyed or killed before leaves its blocks as a left-over (output_file.h), which readTake() reads.
class TakeWriter {
  public:
    /// Errors: as OutputFile::open(); more than kMostVectors in a frame.
    static Result<TakeWriter> open(const std::filesystem::path& path, const Groom& groom,
                                   float framesPerSecond, std::string notes);
    TakeWriter(TakeWriter&&) noexcept;
    TakeWriter& operator=(TakeWriter&&) noexcept;
    ~TakeWriter();

    /// Errors: a disk that takes no more, and what is not finite or too far away; frames before stay.
    Status add(std::span<const Vec3f> positions_ws, const HeadPose& pose);
    Status finish();

    std::uint64_t frames() const;
    std::uint64_t bytes() const;  ///< that are written

  private:
    struct Impl;
    explicit TakeWriter(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Reads frames in any order. Keeps the block that it read last.
class TakeReader {
  public:
    /// Looks through the blocks, not into them. Errors: no take, another version, a damaged head.
    static Result<TakeReader> open(const std::filesystem::path& path);
    TakeReader(TakeReader&&) noexcept;
    TakeReader& operator=(TakeReader&&) noexcept;
    ~TakeReader();

    const TakeInfo& info() const;
    /// The groom that frame() is asked for. Errors: one of other points, vertices or spheres.
    Status use(const Groom& groom);
    /// Errors: no such frame, damage with its place, no use() before.
    Result<RecordedFrame> frame(std::uint64_t index);

  private:
    struct Impl;
    explicit TakeReader(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Whether a file begins as a take.
bool isTake(const std::filesystem::path& path);

}  // namespace hairloom
