// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shaders.h"

namespace hairloom::shaders {

const Shader* find(std::string_view name) {
    for (const Shader& shader : all()) {
        if (shader.name == name) return &shader;
    }
    return nullptr;
}

}  // namespace hairloom::shaders
