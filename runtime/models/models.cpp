// SPDX-License-Identifier: MIT
// The models of strands: one more is a line here, and a value of StrandModel.
#include <array>

#include "engine/strand_model.h"
#include "models/rods/rods.h"
#include "models/springs/springs.h"

namespace hairloom::runtime {

std::span<const Model* const> allModels() {
    static const std::array<const Model*, 2> kModels{&rodModel(), &springModel()};
    return kModels;
}

const Model& modelOf(StrandModel model) {
    return *allModels()[static_cast<std::size_t>(model)];
}

}  // namespace hairloom::runtime
