// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the kinds of shown.h are made of.

#include "core/live/shown.h"

namespace hairloom {

/// M and N, of the models in whose names they are.
Result<Shown> kajiyaM(const ShownHair& hair);
Result<Shown> marschnerM(const ShownHair& hair);
Result<Shown> marschnerN(const ShownHair& hair);
Result<Shown> sadeghiM(const ShownHair& hair);
Result<Shown> sadeghiN(const ShownHair& hair);

/// What their shaders look up.
Result<Shown> marschnerTables(const ShownHair& hair);
Result<Shown> sadeghiTables(const ShownHair& hair);

/// Of the hair itself.
Result<Shown> deepOpacityMap(const ShownHair& hair);
Result<Shown> opacityMaps(const ShownHair& hair);

/// The fibre as the model of its kind sees it.
render::FibreMaterial fibreOf(const ShownHair& hair, render::ShadingModel model);

/// What curves and tables follow from, angles in degrees.
std::vector<ShownNumber> parametersOf(const shading::MarschnerParameters& model);
std::vector<ShownNumber> parametersOf(const shading::SadeghiParameters& model);

}  // namespace hairloom
