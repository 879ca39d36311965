// SPDX-License-Identifier: GPL-3.0-or-later
// tinygltf is its header; what it does with files and pictures is the including file's business.

#define TINYGLTF_IMPLEMENTATION
#include "importers/mesh_reader/tinygltf.h"
