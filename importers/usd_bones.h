// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What moves the meshes of a USD stage, as bones: joints of its skeletons, and prims whose transforms change.

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "importers/raw_scene.h"
#include "importers/usd_skeleton.h"

namespace hairloom {

/// The part of a stage's time that its clips play, in time codes.
struct UsdRange {
    double start = 0, end = 0;
    double codesPerSecond = 24;
    bool isAuthored = false;  ///< the stage says it, and not only its samples

    float seconds(double code) const { return static_cast<float>((code - start) / codesPerSecond); }
};
/// Of transforms and skeletons.
UsdRange rangeOf(const UsdStage& stage);

/// A prim that moves by its own transforms.
struct UsdMovingPrim {
    std::uint32_t bone = kNoBone;
    std::vector<UsdLevel> levels;  ///< from its parent bone's space to its own
    bool isTop = false;            ///< no bone is above it
};

/// A blend shape of a mesh whose points are those of the soup from `first` on.
struct UsdBlendShape {
    std::string name;  ///< by which animations know it
    const UsdPrim* prim = nullptr;
    std::string mesh;  ///< for messages
    std::uint32_t first = 0, points = 0;
    Eigen::Affine3d toWorld = Eigen::Affine3d::Identity();  ///< from the mesh's points
};

/// A skeleton as its meshes see it.
struct UsdSkeletonBones {
    const UsdPrim* prim = nullptr;
    std::vector<UsdLevel> levels;
    std::vector<UsdJoint> joints;
    std::vector<std::uint32_t> bones;  ///< of the joints
    /// What topmost joints have before their own transforms: from the skeleton's space to that of its bone,
    /// or to the world.
    Eigen::Affine3d base = Eigen::Affine3d::Identity();
    std::uint32_t above = kNoBone;  ///< the bone that topmost joints hang on
    /// From the space that meshes were bound in to the world at rest.
    Eigen::Affine3d carried = Eigen::Affine3d::Identity();
    std::uint32_t space = kNoBone;      ///< a bone for what no joint moves, once it is needed
    std::vector<UsdBlendShape> shapes;  ///< of its meshes
};

/// Where a mesh rests, and what moves it.
struct UsdBinding {
    Eigen::Affine3d toWorld = Eigen::Affine3d::Identity();  ///< from the mesh's points
    SkinWeights skin;                                       ///< per point
};

class UsdBones {
  public:
    /// Bones are put into `scene`, `turn` goes from the stage's axes to ours. All must outlive it.
    UsdBones(const UsdStage& stage, const UsdRange& range, const Eigen::Affine3d& turn, RawScene& scene)
        : stage_(stage), range_(range), turn_(turn), scene_(scene) {}

    /// How a mesh of so many points is bound. Errors: transforms that are none, more bones than are read.
    Result<UsdBinding> bind(const UsdShownPrim& mesh, std::size_t points);
    /// Takes the blend shapes of a mesh that was bound, whose points are those of the soup from `first` on.
    /// Errors: as bind().
    Status addShapes(const UsdShownPrim& mesh, std::uint32_t first, std::size_t points,
                     const Eigen::Affine3d& toWorld);
    /// Fills scene.clips from what was bound; `clip` is what else the stage's own plays. Errors: as bind(),
    /// more keys than are read.
    Status addClips(Clip clip);

  private:
    using Place = std::vector<std::pair<const UsdPrim*, std::size_t>>;
    /// What of levels is a bone, and the transform from behind that bone to the last level.
    struct Carried {
        std::uint32_t bone = kNoBone;
        Eigen::Affine3d rest = Eigen::Affine3d::Identity();  ///< with the turn where there is no bone
    };
    Result<Carried> carriedBy(std::span<const UsdLevel> levels);
    Result<std::size_t> skeletonAt(const std::string& path, const UsdShownPrim& mesh);
    Result<std::size_t> addSkeleton(std::vector<UsdLevel> levels, Place place);
    Status addJoints(UsdSkeletonBones& skeleton);
    std::uint32_t spaceOf(UsdSkeletonBones& skeleton);
    /// Fills the binding where the mesh is skinned, which is what it gives.
    Result<bool> skin(const UsdShownPrim& mesh, std::size_t points, UsdBinding& binding);
    void readWeights(const UsdShownPrim& mesh, const UsdNumbers& indices, const UsdNumbers& weights,
                     std::size_t owners, UsdSkeletonBones& skeleton, SkinWeights& skin);
    Result<std::uint32_t> addBone(std::string name, std::uint32_t parent, const Eigen::Affine3d& rest);
    void setBind(std::uint32_t bone, const Eigen::Affine3d& inverseBind);
    void say(std::string words);

    const UsdStage& stage_;
    const UsdRange& range_;
    const Eigen::Affine3d turn_;
    RawScene& scene_;
    std::vector<Eigen::Affine3d> world_;  ///< of each bone at rest
    std::map<Place, std::uint32_t> movingPlaces_;
    std::vector<UsdMovingPrim> moving_;
    std::map<Place, std::size_t> skeletonPlaces_;  ///< SIZE_MAX where it is unusable
    std::vector<UsdSkeletonBones> skeletons_;
};

/// Fills clips from what bones there are, the stage's own beside what `clip` has. Errors: transforms that are
/// none, more keys than are read.
Status addUsdClips(const UsdStage& stage, const UsdRange& range, const Eigen::Affine3d& turn,
                   std::span<const UsdMovingPrim> moving, std::span<const UsdSkeletonBones> skeletons,
                   Clip clip, RawScene& scene);

}  // namespace hairloom
