// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A chain of levels as the Levels panel keeps it: numbers, meshes, small pictures, and the file that it
// leaves as.

#include <QImage>
#include <QString>
#include <vector>

#include "core/levels/level_chain.h"
#include "editor/document/tasks.h"

namespace hairloom::editor {

struct MadeLevel {
    double lightStep = 0;  ///< of cards::lightSteps()
    cards::Level level;    ///< without its hair and shots; its atlas has a size and no texels
    // By directions, of one size.
    std::vector<QImage> strands, shots;
    struct Texture {
        QString name;  ///< "colour"
        QImage image;  ///< kShownSide texels wide at most
    };
    std::vector<Texture> textures;
};

struct MadeLevels {
    std::vector<MadeLevel> levels;
    std::size_t strands = 0;
    std::vector<Vec3f> roots_ws;  ///< of each strand
    double seconds = 0;
    LevelFile file;
};

/// Errors: those of makeLevels() and levelFile().
Result<MadeLevels> makeShownLevels(const Groom& groom, const LevelBudget& budget, TaskControl& control);

}  // namespace hairloom::editor
