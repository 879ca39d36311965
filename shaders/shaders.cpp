// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaders/shaders.h"

namespace hairloom::shaders {

// Generated at build time.
std::span<const Shader> table_hairloom_shaders();  // NOLINT(readability-identifier-naming)

std::span<const Shader> all() {
    return table_hairloom_shaders();
}

const Shader* find(std::string_view name) {
    for (const Shader& shader : all()) {
        if (shader.name == name) return &shader;
    }
    return nullptr;
}

}  // namespace hairloom::shaders
