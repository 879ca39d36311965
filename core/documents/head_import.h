// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A head as it is taken out of a file: its unit, which axis is up, and which groups stay.

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "core/editing/sphere_fit.h"
#include "importers/scene.h"

namespace hairloom {

struct HeadImportOptions {
    float metresPerUnit = 0;  ///< of a file that states none; 0: metres
    bool zUp = false;         ///< the file's Z axis becomes Y
    float turnDegrees = 0;    ///< about the vertical then, from +Z towards +X
    /// Of a file that states neither: what is not said above is found by size and shape, and told.
    bool guessUnit = false, guessUp = false;
    bool guessTurn = false;  ///< by the head that hair comes from, in transferToFile()
    /// Groups, NAME or BEGINNING*, that are not shown and carry no hair.
    std::vector<std::string> leaveOut;
    /// Groups likewise, named among those above or not, that spheres are fitted to.
    std::vector<std::string> collideWith;
    std::uint32_t colliderSpheres = 12;  ///< for all of them, 1 … editing::kMaxPartSpheres

    bool isTurned() const { return zUp || turnDegrees != 0; }
    /// The mesh stays as the file has it.
    bool keepsMesh() const { return !isTurned() && leaveOut.empty() && collideWith.empty(); }
};

/// What the size, shape and names in a file tell about it.
struct HeadGuess {
    std::string unit;                  ///< name of that in which it would be a head or a human; may be empty
    bool zUp = false;                  ///< it lies on its back, but for that
    std::vector<std::string> helpers;  ///< groups that are no skin: helpers, joints

    bool isClear() const { return unit.empty() && !zUp && helpers.empty(); }
};
/// `scene` as read without options.
HeadGuess guessHead(const ImportedScene& scene);

/// The mesh turned and without groups, as the options say but for the unit. Errors: a group that is not
/// there, nothing left.
Result<ScalpMesh> partOfHead(const ScalpMesh& mesh, const HeadImportOptions& options);

/// Spheres for the groups to collide with, each on the bone of `skeleton` nearest to it, in the space of
/// partOfHead(). `mesh` is in metres. Errors: a group that is not there or has no faces; those of
/// editing::fitSpheresToParts().
Result<editing::SphereFit> fitColliders(const ScalpMesh& mesh, const Skeleton& skeleton,
                                        const HeadImportOptions& options,
                                        const std::atomic<bool>* cancelled = nullptr);

/// Of some vertices, in their order; none where `all` is empty.
SkinWeights weightsOf(const SkinWeights& all, std::span<const std::uint32_t> vertices);

struct ImportedHead {
    ImportedScene scene;
    editing::SphereFit colliders;    ///< none where nothing is named to collide with
    HeadImportOptions taken;         ///< with what was guessed
    std::vector<std::string> words;  ///< what was guessed, and how to have it otherwise
};
/// Reads a file; its warnings and what was guessed go to the log. Skeleton and clips stay unless the head is
/// turned. Errors: those of importScene(), partOfHead() and fitColliders().
Result<ImportedHead> importHead(const std::string& path, const HeadImportOptions& options);

}  // namespace hairloom
