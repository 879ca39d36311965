// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strand files into grooms: Yuksel .hair, TressFX .tfx (versions 3 and 4), Wavefront OBJ polylines and the
// flat hair ribbons of Cinema 4D. What each format carries and loses stands in docs/formats/strands.md.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"
#include "core/groom/validate.h"
#include "importers/file_format.h"

namespace hairloom {

enum class UpAxis : std::uint8_t { Y, Z };

/// How the 2n vertices of a Cinema 4D ribbon with n particles follow each other.
enum class RibbonOrder : std::uint8_t {
    Detect,         ///< from the faces, and from the geometry where faces do not decide
    Interleaved,    ///< L0 R0 L1 R1 … (thesis §4.1, Figure 7)
    EdgeAfterEdge,  ///< L0 L1 … R0 R1 …
    Around,         ///< L0 L1 … then the other edge back from its tip: … R1 R0
};

/// Where the particles of a ribbon are.
enum class RibbonParticle : std::uint8_t {
    FirstEdge,  ///< every second vertex, as the thesis has it (§4.1); exact copies of vertices of the file
    Centre,     ///< midway between the two edges
};

struct StrandImportOptions {
    float metresPerUnit = 1.0f;  ///< > 0; metres in one unit of the file
    bool isUnitAsked =
        false;              ///< somebody chose it: it goes before what a format takes where a file says none
    UpAxis up = UpAxis::Y;  ///< axis of the file that points up; Z up becomes (x, z, −y)
    RibbonOrder ribbonOrder = RibbonOrder::Detect;
    RibbonParticle ribbonParticle = RibbonParticle::FirstEdge;
    bool frames = false;                ///< ImportedStrands::frames, too, for the formats that have them
    float framesPerSecond = 0;          ///< of these, resampled in time; 0: as the file has them, if evenly
    bool everySample = false;           ///< frames are the file's samples, whatever their times
    std::uint32_t ribbonSegments = 0;   ///< segments of each ribbon, n − 1; 0 finds it from the file
    std::uint32_t pointsPerStrand = 0;  ///< of files that hold nothing but points; 0 finds it from these
    /// Where given, the end of a strand nearer to this mesh is its root, for the formats that do not say
    /// which end is (OBJ). It must be in metres and Y up. The groom is not bound to it; that is
    /// bindToScalp's.
    const ScalpMesh* scalp = nullptr;
    /// Where files that this one refers to may lie, for the formats that do (USD); empty: none are read.
    std::filesystem::path folder = {};
};

/// Metres. A point that is not farther from the one before it is taken for the same and removed.
inline constexpr float kCoincidentPoints = 1e-8f;

enum class DropReason : std::uint8_t {
    TooFewPoints,  ///< fewer than two points in the file
    NotFinite,     ///< a coordinate is infinite or not a number
    ZeroLength,    ///< all points coincide
    Branches,      ///< two-point lines that meet three or more at a vertex
    ClosedLoop,    ///< two-point lines that return to their start
};
std::string_view dropReasonName(DropReason reason);

struct DroppedStrand {
    std::uint32_t strand;  ///< counted from 0 in the order of the file
    DropReason reason;
};

/// How hair that was written as polygons was read.
struct RibbonsFound {
    RibbonOrder order = RibbonOrder::Detect;   ///< Detect where pieces have different ones
    std::uint32_t fewestSides = 2, sides = 2;  ///< vertices of a cross-section; 2 of ribbons, more of tubes
    std::uint32_t fewestSegments = 0, mostSegments = 0;
};

struct ImportedStrands {
    Groom groom;
    std::string format;  ///< "Yuksel hair", "TressFX 4", "TressFX 3", "OBJ lines", "Cinema 4D hair OBJ"
    std::vector<DroppedStrand> dropped;
    /// Positions of all points at each time of a file whose strands move, where the options ask for them.
    std::vector<std::vector<Vec3f>> frames;
    float framesPerSecond = 0;  ///< of frames
    bool isResampled = false;   ///< frames lie between the file's samples
    std::optional<RibbonsFound> ribbons;
    bool hasSettings = false;  ///< settings, material, interpolation and spheres are the file's
    /// What was mended, ignored or looks wrong; Error where the file contradicts itself though it can be
    /// read.
    std::vector<Finding> warnings;
};

/// The format is found from the content, whatever the name. Errors: unreadable, no known format, damage (with
/// its byte or line), no usable strand. Nothing is allocated from a count that the file's size does not bear
/// out.
Result<ImportedStrands> importStrands(const std::filesystem::path& path,
                                      const StrandImportOptions& options = {});

/// The same from memory; `file` is named in errors.
Result<ImportedStrands> importStrandsFromMemory(const std::string& file, std::span<const std::byte> bytes,
                                                const StrandImportOptions& options = {});

/// What importStrands() reads.
std::vector<FileFormat> strandFormats();

/// Whether the content starts like one of the formats that hold nothing but strands (.hair, .tfx).
bool looksLikeStrandFile(std::span<const std::byte> bytes);

}  // namespace hairloom
