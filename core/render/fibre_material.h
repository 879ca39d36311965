// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/shading/sadeghi.h"

namespace hairloom::render {

enum class ShadingModel { kajiya, marschner, sadeghi };

/// What becomes of light that a fibre has scattered towards others.
enum class Scattering {
    single,  ///< nothing: it is lost
    dual,    ///< it reaches them, as in an even layer (Zinke et al. 2008)
    volume,  ///< it is followed from fibre to fibre, around the head and out at the sides
};

/// How the models of light in fibres see the hair; Kajiya-Kay has no use for it.
struct FibreMaterial {
    ShadingModel model = ShadingModel::kajiya;
    Scattering scattering = Scattering::dual;
    /// Where it is the model; the fibre that colours Sadeghi's lobes where absorption changes from place to
    /// place.
    shading::MarschnerParameters marschner;
    shading::SadeghiParameters sadeghi;  ///< where it is

    bool operator==(const FibreMaterial&) const = default;
};

}  // namespace hairloom::render
