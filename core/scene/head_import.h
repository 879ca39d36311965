// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A head as it is taken out of a file: its unit, which axis is up, and which groups stay.

#include <string>
#include <vector>

#include "importers/scene.h"

namespace hairloom {

struct HeadImportOptions {
    float metresPerUnit = 0;  ///< of a file that states none; 0: metres
    bool zUp = false;         ///< the file's Z axis becomes Y
    std::vector<std::string>
        leaveOut;  ///< groups, NAME or BEGINNING*; nothing collides with them or shows them

    /// The mesh stays as the file has it, so that its skeleton and clips fit.
    bool keepsMesh() const { return !zUp && leaveOut.empty(); }
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

/// Reads a file. Where the mesh does not stay as it is, skeleton and clips are dropped. Errors: those of
/// importScene() and partOfHead().
Result<ImportedScene> importHead(const std::string& path, const HeadImportOptions& options);

}  // namespace hairloom
