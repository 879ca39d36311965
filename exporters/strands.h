// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Grooms into files of strands and of cards. What each format carries and loses stands in
// docs/formats/strands.md.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/base/work_watch.h"
#include "core/groom/groom.h"
#include "exporters/hair_looks.h"
#include "exporters/report.h"
#include "exporters/safe_limits.h"
#include "importers/strands.h"

namespace hairloom::cards {
struct Chain;
struct Collider;
}  // namespace hairloom::cards

namespace hairloom {

/// What a program takes at most; 0 where it sets no limit.
struct TargetLimits {
    std::string program;  ///< "Unity", for messages; empty without limits
    std::size_t strands = 0;
    std::uint32_t points = 0;        ///< of a strand
    std::uint32_t fewestPoints = 0;  ///< of a strand
    bool refusesCoincident = false;  ///< one segment of no length and it takes none of the strands
};

/// Where strands are in time.
struct StrandFrames {
    double framesPerSecond = 60;  ///< > 0
    double first = 0;             ///< number of the first frame, in the file's time
    /// Sample by sample, those of the whole groom; metres. Each frame has as many as there are exposures.
    std::vector<std::vector<Vec3f>> points;
    /// When the samples of a frame are, in frames from its number; ascending, less than 1 from first to last.
    std::vector<double> exposures{0.0};
    bool closes = false;  ///< one sample more: the first exposure of the frame behind the last

    std::size_t frameCount() const { return (points.size() - (closes ? 1 : 0)) / exposures.size(); }
    /// In frames.
    double numberOf(std::size_t sample) const {
        return first + static_cast<double>(sample / exposures.size()) + exposures[sample % exposures.size()];
    }
};

/// Recorded motion for a game, relative to the head.
struct ClipToWrite {
    struct Frame {
        std::vector<Vec3f> positions_ws;  ///< of all strands of the groom, metres
        Eigen::Isometry3f head_ws = Eigen::Isometry3f::Identity();
        std::vector<Vec3f> scalpPositions_ws;  ///< per vertex of the scalp; empty: it moves with head_ws
    };
    std::string name;
    double framesPerSecond = 60;  ///< 1 to 1000
    std::uint64_t frames = 0;
    bool loops = false;  ///< behind the last frame comes the first
    /// Asked for in order, and then once more. Errors end the export.
    std::function<Result<Frame>(std::uint64_t)> frame;
};

struct StrandExportOptions {
    float metresPerUnit = 1.0f;  ///< > 0; metres in one unit of the file
    UpAxis up = UpAxis::Y;       ///< axis of the file that points up; Z up becomes (x, −z, y)
    std::uint32_t pointsPerStrand =
        0;                ///< resamples every strand evenly to so many; 0 keeps what the format allows
    TargetLimits limits;  ///< what goes beyond them is a finding with its fix
    /// Of strands that move: for writers that animate. The groom is at the first frame. Null: at rest.
    std::shared_ptr<const StrandFrames> frames = nullptr;
    std::shared_ptr<const ClipToWrite> clip = nullptr;  ///< of writers that hold clips; null: none
    std::optional<SafeLimits> safeLimits{};             ///< for formats that carry them
    std::shared_ptr<const HairLooks> looks = nullptr;   ///< of writers that hold them; null: none
    bool physics = false;                               ///< of writers that hold them; of strands at rest
    WorkWatch watch{};                                  ///< of preparing, writing, reading back and comparing
};

/// A program that reads a format, and what it wants of a file.
struct ExportTarget {
    std::string program;  ///< as `--target` has it: "blender"
    std::string name;
    std::string note;
    StrandExportOptions options;
};

/// Cards of a hairstyle on their way into a file.
struct CardsToWrite {
    const cards::Chain& chain;
    std::span<const cards::Collider> colliders;  ///< spheres of the groom, for springs
    const Groom& groom;                          ///< that they are of
    const std::atomic<bool>* cancelled = nullptr;
};
struct WrittenCards {
    std::vector<std::string> companions = {};  ///< names of files that were written beside it
    std::vector<LeftBehind> leftBehind = {};
    bool holdsSprings = false;
    std::vector<Finding> findings = {};
};

/// Replaces `path` atomically, reads the file back and compares. Strands that no consumer could use (fewer
/// than two points, not finite, of no length) are left out and reported. Errors: nothing left to write, a
/// limit of the format that options cannot mend, a file that cannot be written or does not read back, work
/// that was stopped.
using WriteStrands = Result<ExportReport> (*)(const Groom& groom, const std::filesystem::path& path,
                                              const StrandExportOptions& options);
/// Replaces `path`, and files beside it, all or none. Errors: no level that the format can hold, files that
/// cannot be written.
using WriteCards = Result<WrittenCards> (*)(const CardsToWrite& cards, const std::filesystem::path& path);

/// A format that hair is written in, as strands or as cards. One file NAME_writer.cpp of this folder:
/// nameWriter() says what it is.
struct HairWriter {
    std::string name;     ///< as `--format` has it: the suffix of its files and, behind a hyphen, for whom
    std::string label;    ///< "TressFX .tfx"
    std::string carries;  ///< in words: what else than positions
    std::string limits;   ///< in words
    std::vector<ExportTarget> targets;  ///< at least one
    std::variant<WriteStrands, WriteCards> writer;
    std::string ownSuffix{};            ///< of its files, where that is not the name
    bool generatesFollowHairs = false;  ///< the file tells how follow hairs come from guides
    bool marksGuides = false;           ///< hairs go with the guides that they follow, and how much they do
    bool keepsGuides = false;           ///< likewise, where that is asked for
    bool animates = false;              ///< the file can hold StrandExportOptions::frames
    bool holdsClips = false;            ///< the file can hold StrandExportOptions::clip
    bool holdsPhysics = false;          ///< what simulates curves may stand beside them
    bool holdsLooks = false;            ///< the file can hold StrandExportOptions::looks

    std::string suffix() const { return ownSuffix.empty() ? name.substr(0, name.find('-')) : ownSuffix; }
    bool holdsCards() const { return std::holds_alternative<WriteCards>(writer); }
    /// As WriteStrands; of a format that holds strands.
    Result<ExportReport> write(const Groom& groom, const std::filesystem::path& path,
                               const StrandExportOptions& options) const {
        return std::get<WriteStrands>(writer)(groom, path, options);
    }
};
/// All formats, in order of name.
const std::vector<HairWriter>& hairWriters();
/// Those that hold strands.
const std::vector<HairWriter>& strandWriters();
using HairWriters = std::span<const HairWriter>;
/// Programs of all writers as `--target` has them, each once, in order of name.
std::vector<std::string> exportPrograms(HairWriters writers = strandWriters());
/// What the program wants of a format; null where it does not read that.
const ExportTarget* findTarget(const HairWriter& writer, std::string_view program);
/// The writer of the format that the program reads best; there must be one.
const HairWriter& preferredWriter(std::string_view program, HairWriters writers = strandWriters());
/// The writer of that name; there must be one.
const HairWriter& strandWriter(std::string_view name, HairWriters writers = strandWriters());

}  // namespace hairloom
