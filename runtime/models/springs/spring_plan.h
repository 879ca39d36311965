// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "engine/strand_model.h"

namespace hairloom::runtime {

std::span<const EffectRow> springEffects();
void listSpringStages(PlanBuilder& plan);

}  // namespace hairloom::runtime
