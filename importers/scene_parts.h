// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What all readers of scenes do alike.

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "importers/raw_scene.h"

namespace hairloom {

/// Vertices that all morph targets of a file together move, at most: 64 MiB. Targets beyond are left out.
inline constexpr std::size_t kMostMorphed = std::size_t{1} << 22u;
/// The same of meshes that a file has at many times: 256 MiB, ten seconds of 55,000 points 30 times a second.
inline constexpr std::size_t kMostCached = std::size_t{1} << 24u;
/// In a list of targets by their numbers in the file: one that is left out.
inline constexpr std::uint32_t kNoMorph = 0xffffffffu;

/// What stands for a track that the file does not have: the rest transform's part.
void fillFromRest(Channel& channel, const Eigen::Affine3f& rest);

/// Seconds of the last key; 0 where there is none.
float lastTime(const Channel& channel);

/// Index of a name in `names`, at whose end it is put when it is new.
std::uint32_t indexOf(const std::string& name, std::unordered_map<std::string, std::uint32_t>& indices,
                      std::vector<std::string>& names);

/// The first three texts and how many more there are: "a; b; c; and 2 more".
std::string firstOf(const std::vector<std::string>& texts);

}  // namespace hairloom
