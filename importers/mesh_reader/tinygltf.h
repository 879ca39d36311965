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
