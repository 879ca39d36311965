// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which mesh format a file is in, by its content.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "importers/file_format.h"

namespace hairloom {

enum class MeshFormat { Obj, Ply, Stl, Fbx, Gltf, Glb, Usd, Alembic };

/// "obj", "ply", "stl", "fbx", "gltf", "glb", "usd", "abc".
std::string_view name(MeshFormat format);
std::optional<MeshFormat> meshFormatNamed(std::string_view name);
/// Whether files of the format have hair or a head, as their content says.
bool mayBeHair(MeshFormat format);

/// How many bytes of a file's start meshFormatOf() wants to see.
inline constexpr std::size_t kMeshFormatHead = 64 * 1024;

/// From the first kMeshFormatHead bytes (fewer when the file is shorter) and the file's size. The file's name
/// plays no part. Empty for what is none of the formats.
std::optional<MeshFormat> meshFormatOf(std::span<const std::byte> head, std::uint64_t fileSize);

/// What importScene() reads.
std::vector<FileFormat> meshFormats();

}  // namespace hairloom
