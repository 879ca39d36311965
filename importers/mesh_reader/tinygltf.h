// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// tinygltf without pictures and without files of its own.

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS

#include <fstream>  // for its writers, which nobody calls
#include <sstream>

#include <tiny_gltf.h>

namespace hairloom {

/// The member of an object, or a value of no type; also where `from` is no object, with which its own Get()
/// may end the program.
inline const tinygltf::Value& memberOf(const tinygltf::Value& from, const std::string& name) {
    static const tinygltf::Value kNothing;
    return from.IsObject() ? from.Get(name) : kNothing;
}

}  // namespace hairloom
