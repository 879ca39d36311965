// SPDX-License-Identifier: MIT
#pragma once
// The runtime asset (.hairrt) byte by byte, for who writes one; docs/formats/runtime.md has the same as
// tables and says what each value means. All numbers are little-endian. hairloom/asset.h reads it.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hairloom::runtime::asset {

static_assert(std::endian::native == std::endian::little, "assets are used in place, without swapping");

/// As PNG's: a copy that changed line ends or lost the eighth bit is found out.
inline constexpr std::array<char, 8> kMagic{'\x89', 'H', 'R', 'T', '\r', '\n', '\x1a', '\n'};
/// A reader refuses another major version, and takes any minor one.
inline constexpr std::uint16_t kMajor = 1, kMinor = 2;
/// From this minor version on, follow hairs cross neither partings near their roots nor borders of layers.
inline constexpr std::uint16_t kMinorOfPartedRoots = 2;
/// Written where there is a clip; other files stay at kMinor.
inline constexpr std::uint16_t kMinorOfClips = 3;
/// Written where there are materials for the shaders of games.
inline constexpr std::uint16_t kMinorOfMaterials = 4;
/// Written where there are poses.
inline constexpr std::uint16_t kMinorOfPoses = 5;
/// Written where strands have a stiffness of their own: an attribute of that name, of one float32 from 0 to
/// kMostStiffness, StrandsView::stiffness. In files of before, the name means nothing.
inline constexpr std::uint16_t kMinorOfStiffness = 6;
inline constexpr std::string_view kStiffnessName = "stiffness";
/// Sections begin at multiples of it, and so does the memory that the file lies in.
inline constexpr std::size_t kAlignment = 16;
inline constexpr std::uint32_t kMaxSections = 4096;

struct Header {
    std::array<char, 8> magic;
    std::uint16_t major, minor;
    std::uint32_t headerBytes;  ///< 64
    std::uint64_t fileBytes;
    std::uint32_t sections;
    std::uint32_t tableChecksum;                ///< of the table of sections, which follows the header
    std::array<float, 3> boundsMin, boundsMax;  ///< of all points at rest, metres
    std::uint32_t points;                       ///< of all strands
    std::uint32_t checksum;                     ///< of the header before this value
};
static_assert(sizeof(Header) == 64);

/// A reader that does not know the section's kind must refuse the file.
inline constexpr std::uint16_t kRequired = 1;

struct Section {
    std::array<char, 4> kind;
    std::uint16_t recordBytes;  ///< of one of `count` records
    std::uint16_t flags;
    std::uint64_t offset, bytes;
    std::uint32_t count;
    std::uint32_t checksum;
};
static_assert(sizeof(Section) == 32);

inline constexpr std::string_view kStrands = "STRD", kResiduals = "PNTS", kRoots = "ROOT",
                                  kScalpVertices = "SVTX", kScalpTriangles = "STRI", kBones = "BONE",
                                  kSpheres = "SPHR", kRecipe = "FLLW", kGuides = "GUID", kGuideHairs = "GHRS",
                                  kGuideTriangles = "GTRI", kRootShifts = "SHFT", kFarRootShifts = "SHFX",
                                  kRadii = "RADI", kLayers = "LAYR", kStrandLayers = "SLYR",
                                  kSettings = "SETT", kValues = "VALS", kText = "TEXT", kAttributes = "ATTR",
                                  kAttributeValues = "ATTV", kLevelErrors = "LVLE", kSeenErrors = "LVLS",
                                  kBody = "BODY", kClip = "CLIP", kClipPlaces = "CLPI", kClipFrames = "CLPD",
                                  kMaterials = "MATL", kFibreTables = "FIBT", kHairLooks = "HLOK",
                                  kPoses = "POSE", kPoseDirections = "POSD", kPoseWeights = "POSW";

/// Finest and coarsest grid of a strand: 2^-24 and 2^-15 m.
inline constexpr std::uint32_t kMaxGridBits = 24, kMinGridBits = 15;

/// Point 0 lies at root / 2^gridBits metres, point 1 at (root + first) / 2^gridBits; point i > 1 lies where
/// the segment before it would lead once more, and its residual farther. Residuals stand in the order of
/// strands and points.
struct Strand {
    std::array<std::int32_t, 3> root, first;
    std::uint16_t points;  ///< 2 … 512
    std::uint8_t gridBits;
    std::uint8_t residualBytes;  ///< 4: three of 10 bits in a u32, x lowest; 6: three i16; 12: three i32
};
static_assert(sizeof(Strand) == 28);

/// The second and third barycentric coordinate as shares of 65,535.
struct Root {
    std::uint32_t triangle;
    std::uint16_t b, c;
};
static_assert(sizeof(Root) == 8);

inline constexpr std::uint16_t kNoBone = 0xffff;
struct ScalpVertex {
    std::array<float, 3> position;                ///< metres, at rest
    std::uint32_t source;                         ///< vertex of the file that the head came from
    std::array<std::uint16_t, 4> bones, weights;  ///< shares of 65,535; all 0 for what nothing moves
};
static_assert(sizeof(ScalpVertex) == 32);

struct ScalpTriangle {
    std::array<std::uint32_t, 3> vertices;
    std::uint32_t source;  ///< triangle of the head
};
static_assert(sizeof(ScalpTriangle) == 16);

/// A place in the section of text.
struct Text {
    std::uint32_t at, bytes;
};

struct Bone {
    Text name;
    std::uint32_t index;  ///< in the skeleton of the head's file
    std::uint32_t unused;
    std::array<float, 12> inverseBind;  ///< row by row: from the head at rest to the bone
};
static_assert(sizeof(Bone) == 64);

struct Sphere {
    std::array<float, 3> centre;
    float radius;
    std::int32_t bone;  ///< −1: goes with the head as a whole
    Text name;
    std::uint32_t joined;  ///< 1 + the number of the sphere with which it makes a capsule; 0: with none
};
static_assert(sizeof(Sphere) == 32);

struct Recipe {
    std::uint64_t seed;
    std::uint32_t hairsPerGuide, pointsPerHair;
    float radiusRoot, radiusTip, blend;
    float shiftStep;  ///< metres that 1 in the section of root shifts stands for, along shiftDirection()
    float beginAngle, endAngle, beginSpread, endSpread;
};
static_assert(sizeof(Recipe) == 48);

struct Guide {
    std::uint32_t strand, id;
    std::array<float, 3> normal, axis;  ///< of the scalp at the root, of unit length and perpendicular
};
static_assert(sizeof(Guide) == 32);

/// Strands that belong together.
struct Layer {
    Text name;
    float density;              ///< by which the hairs of its guides were multiplied
    std::uint32_t ownMaterial;  ///< 1: its material is the settings "layerN.…", N counting from 1
};
static_assert(sizeof(Layer) == 16);

struct GuideTriangle {
    std::array<std::uint32_t, 3> guides;
    float area;  ///< in any unit
};
static_assert(sizeof(GuideTriangle) == 16);

/// Instead of what the section of root shifts says of the hair: metres in units of kFarShiftStep, in the root
/// plane of its own guide.
struct FarRootShift {
    std::uint32_t hair;
    std::array<std::int16_t, 3> shift;
    std::uint16_t unused;
};
static_assert(sizeof(FarRootShift) == 12);
inline constexpr float kFarShiftStep = 0x1p-17f;

enum class ValueKind : std::uint8_t { numbers = 0, choice = 1, seed = 2, ramp = 3 };
/// "simulation.windSpeed" and its values: numbers; for a choice the place of its name in the text and its
/// bytes; for a seed its lower and upper 32 bits; for a ramp position and value of each key.
struct Setting {
    std::uint32_t name;
    std::uint16_t nameBytes;
    ValueKind kind;
    std::uint8_t count;
    std::uint32_t firstValue;
    std::uint32_t unused;
};
static_assert(sizeof(Setting) == 16);

enum class AttributeType : std::uint8_t { uint8 = 0, uint32 = 1, int32 = 2, float32 = 3 };
/// Values of each strand, one strand after the other, from a byte of the section of attributes' values.
struct Attribute {
    Text name;
    AttributeType type;
    std::uint8_t components;  ///< 1 to 4
    std::uint16_t unused;
    std::uint32_t firstByte;  ///< a multiple of 4
};
static_assert(sizeof(Attribute) == 16);
inline std::uint64_t bytesOf(const Attribute& attribute) {
    return (attribute.type == AttributeType::uint8 ? 1u : 4u) * std::uint64_t{attribute.components};
}

/// Of a level of detail, the finest first; hairloom.h says what the numbers mean.
struct MeasuredLevel {
    float still, head, wind;
    std::uint32_t unused;
};
static_assert(sizeof(MeasuredLevel) == 16);
inline constexpr std::uint32_t kLevels = 5;

/// Recorded motion of the strands. Its frames are in blocks, each strand's bits of a block by themselves:
/// those of strand s in block b begin at the byte of kClipFrames that kClipPlaces has at b · strands + s, and
/// end at the next.
struct Clip {
    Text name;
    float framesPerSecond;  ///< 1 to kMostClipRate
    std::uint32_t frames;
    std::uint16_t framesPerBlock;  ///< the last block may have fewer
    std::uint8_t gridBits;         ///< points lie at multiples of 2^-gridBits metres from their roots
    std::uint8_t loops;            ///< 1: behind the last frame comes the first
    float largestError;            ///< metres, of a point behind its root
};
static_assert(sizeof(Clip) == 24);
inline constexpr float kMostClipRate = 1000;
inline constexpr std::uint32_t kMostClipFrames = 1u << 24u, kMostFramesPerBlock = 64;
inline constexpr std::uint8_t kMinClipGridBits = 8, kMaxClipGridBits = 20;
/// Of a coordinate, in cells.
inline constexpr std::int32_t kFarthestClipCell = 1 << 23;
/// A number from which on the unary part of a residual gives way to its 32 bits.
inline constexpr std::uint32_t kMostClipOnes = 20;
/// Low bits of a residual, of a frame that has residuals at all.
inline constexpr std::uint32_t kMostClipLowBits = 14, kNoClipResiduals = 15;
/// Orders of prediction, in time and along a strand.
inline constexpr std::uint32_t kClipOrders = 3;

/// What hair looks like to the shaders of games, as `HairMaterial` of shaders/hair_types.h has it: that of
/// the hairstyle, then those of layers that have one of their own. Colours are linear RGB, or absorption per
/// fibre radius.
struct Material {
    std::array<float, 4> rootLook, tipLook, streakRoot, streakTip, dye, emissionRoot, emissionTip;
    float gradientStart, gradientScale, dyeStart, dyeScale;
    std::uint32_t absorbs;  ///< 1: what is above is absorption
    float ownScale, spread, streakPigment, regrowthStart, regrowthScale, unused0, unused1;
    std::array<float, 4> primary, secondary;  ///< of Kajiya and Kay, and the exponents
    float primaryTilt, secondaryTilt, primaryNormalisation, secondaryNormalisation;
    float diffuse, diffuseNormalisation, scattering, fibreOpacity;
    std::array<float, 4> tilts, widths, scales;  ///< of Marschner; in w limit, variation, clumping
    std::uint32_t model;                         ///< 0: Kajiya and Kay's, 1: Marschner's, with tables
    std::uint32_t table;                         ///< which of the section of tables
    std::uint32_t bounded;
    float axisRatio;
};
static_assert(sizeof(Material) == 288);
inline constexpr std::uint32_t kMarschner = 1;
/// 16-bit floats of a material of kMarschner: HAIR_TABLE_FLOATS of shaders/hair_types.h.
inline constexpr std::uint32_t kTableHalves = 6 * 64 + 9 * 16 * 64 * 2 + 16 * 64 + 9 * 2 * 16 * 4 + 24 * 32;

/// What a follow hair has of its material's streaks, dye and pigment.
struct HairLook {
    std::uint16_t streak, dye;  ///< shares of 65,535
    std::uint16_t pigment;      ///< that of the material is kPlainPigment
    std::uint16_t length;       ///< steps of kLengthStep
};
static_assert(sizeof(HairLook) == 8);
inline constexpr std::uint16_t kPlainPigment = 8191;
inline constexpr float kLengthStep = 0x1p-14f;

/// Another shape of the strands, which they follow by an amount. Pose k has the segments of all strands from
/// k · (points − strands) of the section of directions on, strand after strand, root to tip.
struct Pose {
    Text name;
    float amount;           ///< 0 to 1, until a game sets another
    std::uint32_t weights;  ///< 1 + which points of the section of weights it has; 0: none, all are 1
};
static_assert(sizeof(Pose) == 16);
/// x and y of a direction that is laid out as an octahedron (Meyer et al. 2010), shares of 32,767.
using PoseDirection = std::array<std::int16_t, 2>;
static_assert(sizeof(PoseDirection) == 4);
/// Radians, of any direction from the nearest that there is.
inline constexpr float kPoseDirectionError = 5e-5f;

/// Metres that 1 in the section of radii stands for.
inline constexpr float kRadiusStep = 0x1p-24f;

/// CRC-32 as in zlib, PNG and gzip.
std::uint32_t checksum(std::span<const std::byte> bytes);

}  // namespace hairloom::runtime::asset
