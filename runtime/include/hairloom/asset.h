// SPDX-License-Identifier: MIT
#pragma once
// Reads runtime assets (.hairrt) where they lie in memory: a mapped file, say. hairloom/asset_format.h has
// the layout. Any damage is refused or harmless: no call reads outside of the bytes, whatever they hold.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hairloom/asset_format.h"
#include "hairloom/body_field.h"
#include "hairloom/follow.h"
#include "hairloom/follow_recipe.h"
#include "hairloom/memory.h"
#include "hairloom/settings.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

struct AssetError {
    enum class Kind { damaged, newer, misaligned };
    Kind kind = Kind::damaged;
    std::uint64_t byte = 0;  ///< of the file, near which it is wrong
    std::string words;       ///< "section STRD ends at byte 900; the file has 800"
};

/// A section as the table has it.
struct AssetSection {
    std::string_view kind;
    std::uint64_t offset, bytes;
    std::uint32_t count;
};

/// A view: the bytes must outlive it. Copies are cheap, and const calls are safe on any number of threads.
class Asset {
  public:
    struct Result;
    /// Looks at header and table alone. `bytes` is the whole file, at a multiple of asset::kAlignment.
    static Result open(std::span<const std::byte> bytes);
    /// Compares all checksums, then as checkContent(). Nothing where all is well.
    std::optional<AssetError> check() const;
    /// Whether counts and indices fit each other and numbers are within their ranges, so that the calls below
    /// may be made. Time: one look at each record and point.
    std::optional<AssetError> checkContent() const;

    std::uint16_t major() const { return header().major; }
    std::uint16_t minor() const { return header().minor; }
    std::uint64_t bytes() const { return bytes_.size(); }
    /// Also those whose kinds are not known here.
    std::vector<AssetSection> sections() const;
    Float3 boundsMin_ss() const;
    Float3 boundsMax_ss() const;
    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(strands.size()); }
    std::uint32_t pointCount() const { return header().points; }
    std::uint32_t hairCount() const;
    std::uint32_t hairsOf(std::size_t guide) const;
    /// One where none is named.
    std::uint32_t layerCount() const {
        return layers.empty() ? 1 : static_cast<std::uint32_t>(layers.size());
    }
    /// That of the hairstyle, and each layer's that has one of its own.
    std::size_t materialCount() const;

    // All that follows is to be called only where checkContent() finds nothing wrong.

    /// In `layers`; 0 where none is named.
    std::uint32_t layerOf(std::size_t strand) const {
        return strandLayers.empty() ? 0 : strandLayers[strand];
    }

    struct Strands {
        Vector<std::uint32_t> offsets;
        Vector<Float3> positions_ss;
    };
    Strands strandsAtRest() const;
    /// Of the coarsest grid: no point lies farther from where it was authored; metres.
    double greatestError() const;
    /// A field that the asset does not name keeps its default; one that is not known here, or whose value is
    /// out of range, is left out.
    SimulationSettings simulation() const;
    /// The setting of that name, "material.rootColour"; null where there is none.
    const asset::Setting* findSetting(std::string_view name) const;
    std::span<const double> valuesOf(const asset::Setting& setting) const;
    std::string_view nameOf(const asset::Setting& setting) const;
    /// Of a setting of kind choice: its name.
    std::string_view choiceOf(const asset::Setting& setting) const;
    std::string_view text(asset::Text place) const;
    /// A number of a setting, or `missing`.
    double numberOf(std::string_view name, double missing) const;

    std::string_view nameOf(const asset::Attribute& attribute) const { return text(attribute.name); }
    /// bytesOf() of each strand.
    std::span<const std::byte> valuesOf(const asset::Attribute& attribute) const;
    /// Null where there is none of that name.
    const asset::Attribute* findAttribute(std::string_view name) const;
    /// StrandsView::stiffness, of each strand; none.
    std::span<const float> strandStiffness() const;

    /// Which guides follow hairs take part of, by their numbers among the strands. Of an asset that has
    /// hairs.
    DrawnHairs drawnHairs(const Strands& strands, const Host& host = {}) const;
    /// What follow hairs are made of, of an asset that has hairs. The view is of these arrays and `rest`.
    struct FollowArrays {
        Vector<RootPlane> planes;
        DrawnHairs drawn;
        Vector<Float3> shifts;
        Vector<float> radii;
    };
    FollowArrays followArrays(const Strands& rest, const Host& host = {}) const;
    FollowView followView(const Strands& rest, const FollowArrays& arrays) const;
    /// Follow hairs, ready to be evaluated from all strands of strandsAtRest(). The error says why there are
    /// none.
    FollowHairs::Result followHairs(const Strands& strands, const Host& host = {}) const;
    /// What it says of wisps; the default where it says nothing, or no number within the range.
    WispMotion wispMotion() const;

    std::span<const asset::Strand> strands;
    std::span<const std::byte> residuals;
    std::span<const asset::Root> roots;  ///< one of each strand, or none
    std::span<const asset::ScalpVertex> scalpVertices;
    std::span<const asset::ScalpTriangle> scalpTriangles;
    std::span<const asset::Bone> bones;
    std::span<const asset::Sphere> spheres;
    std::span<const asset::Recipe> recipe;  ///< one or none
    std::span<const asset::Guide> guides;
    std::span<const std::uint16_t> guideHairs;  ///< of each guide, or none: all have those of the recipe
    std::span<const asset::GuideTriangle> guideTriangles;
    std::span<const std::int8_t> rootShifts;  ///< one of each follow hair, or none
    std::span<const asset::FarRootShift> farRootShifts;
    std::span<const std::uint16_t> radii;  ///< one of each point, or none: as the material says
    std::span<const asset::Layer> layers;
    std::span<const std::uint16_t> strandLayers;  ///< one of each strand, or none: the first
    std::span<const asset::Setting> settings;
    std::span<const double> values;
    std::span<const char> texts;
    // What is looked for in the table each time: an asset has room for no more.
    std::span<const asset::Attribute> attributes() const {
        return recordsOf<asset::Attribute>(asset::kAttributes);
    }
    std::span<const std::byte> attributeValues() const {
        return recordsOf<std::byte>(asset::kAttributeValues);
    }
    /// Of the skin that hair collides with, as packBody() gives them, or none.
    std::span<const std::byte> body() const { return recordsOf<std::byte>(asset::kBody); }
    /// Of all bones of body(), in its order: their numbers among `bones`.
    Vector<std::size_t> bonesOf(const BodyField& field) const;
    BodyFieldRead readBody() const;
    /// Of asset::kLevels levels, or none: nobody has measured them.
    std::span<const asset::MeasuredLevel> levelErrors() const {
        return recordsOf<asset::MeasuredLevel>(asset::kLevelErrors);
    }
    /// The same of what is seen far off.
    std::span<const asset::MeasuredLevel> seenErrors() const {
        return recordsOf<asset::MeasuredLevel>(asset::kSeenErrors);
    }

    /// What hair looks like to the shaders of games, or none: files of before version 1.4 do not say.
    std::span<const asset::Material> materials() const {
        return recordsOf<asset::Material>(asset::kMaterials);
    }
    /// asset::kTableHalves 16-bit floats for each material that has tables.
    std::span<const std::uint16_t> fibreTables() const {
        return recordsOf<std::uint16_t>(asset::kFibreTables);
    }
    /// One of each follow hair, or none: no streaks, no dye, the material's pigment.
    std::span<const asset::HairLook> hairLooks() const {
        return recordsOf<asset::HairLook>(asset::kHairLooks);
    }

    /// Poses, by their names in text(); none.
    std::span<const asset::Pose> poses() const { return recordsOf<asset::Pose>(asset::kPoses); }
    std::span<const asset::PoseDirection> poseDirections() const {
        return recordsOf<asset::PoseDirection>(asset::kPoseDirections);
    }
    /// Of each point, shares of 255, of poses one after the other.
    std::span<const std::uint8_t> poseWeights() const { return recordsOf<std::uint8_t>(asset::kPoseWeights); }
    /// A pose as an engine takes it: strands of the lengths that `rest` has, each from its root at 0.
    struct PoseArrays {
        Vector<Float3> positions_ss;
        Vector<float> weights;  ///< of each point, or none
    };
    PoseArrays poseArrays(std::size_t pose, const Strands& rest) const;

    /// Recorded motion that games play, or none: null.
    const asset::Clip* clip() const {
        const auto clips = recordsOf<asset::Clip>(asset::kClip);
        return clips.empty() ? nullptr : clips.data();
    }
    std::span<const std::uint32_t> clipPlaces() const { return recordsOf<std::uint32_t>(asset::kClipPlaces); }
    std::span<const std::byte> clipFrames() const { return recordsOf<std::byte>(asset::kClipFrames); }
    /// Decodes all frames of the clip, as check() does. `host` lends threads.
    std::optional<AssetError> checkClipFrames(const Host& host = {}) const;
    /// Where in the file a record lies.
    std::uint64_t placeOf(const void* record) const;
    /// Of the bytes: where they lie, how many they are, and checksums of what they hold.
    std::array<std::uint64_t, 3> identity() const;

  private:
    const asset::Header& header() const { return *reinterpret_cast<const asset::Header*>(bytes_.data()); }
    std::span<const asset::Section> table() const;
    template <class Record>
    bool take(const asset::Section& section, std::string_view kind, std::span<const Record>& records,
              std::string& problem);
    std::optional<AssetError> takeSection(const asset::Section& section);
    const asset::Section* findSection(std::string_view kind) const;
    template <class Record>
    std::span<const Record> recordsOf(std::string_view kind) const {
        const asset::Section* const section = findSection(kind);
        if (!section) return {};
        return {reinterpret_cast<const Record*>(bytes_.data() + section->offset), section->count};
    }
    template <class Record>
    bool isSound(const asset::Section& section, std::string_view kind, std::string& problem) const;
    std::optional<AssetError> checkStrands() const;
    std::optional<AssetError> checkPoints() const;  ///< after checkStrands()
    std::optional<AssetError> checkScalp() const;
    std::optional<AssetError> checkLayers() const;
    std::optional<AssetError> checkFollowHairs() const;
    std::optional<AssetError> checkSettings() const;
    std::optional<AssetError> checkAttributes() const;
    std::optional<AssetError> checkLevels() const;
    std::optional<AssetError> checkBody() const;
    std::optional<AssetError> checkClip() const;
    std::optional<AssetError> checkPoses() const;
    std::optional<AssetError> checkMaterials() const;  ///< after checkFollowHairs() and checkLayers()

    std::span<const std::byte> bytes_;
};

struct Asset::Result {
    std::optional<Asset> asset;
    AssetError error;  ///< where there is no asset
};

}  // namespace hairloom::runtime
