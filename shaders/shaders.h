// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The compiled shaders, part of the program.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hairloom::shaders {

struct Shader {
    std::string_view name;  ///< "NAME.STAGE", as the source file is called
    std::span<const std::uint32_t> spirv;
    std::span<const std::byte> dxbc{};  ///< empty where the program has no Direct3D
};

/// Ascending by name.
std::span<const Shader> all();

/// A file of the strand kernels, of which programs compile what they need when they run.
struct Source {
    std::string_view path;  ///< name of its file
    std::string_view text;
};
std::span<const Source> sources();

/// Nothing for a name that does not exist.
const Shader* find(std::string_view name);

}  // namespace hairloom::shaders
