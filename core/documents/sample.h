// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sample hairstyles of the folder `samples`, made from their descriptions: what samples/make_hairstyle.sh
// does with jobs of the command line.

#include <filesystem>
#include <string>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

/// The folder that holds bust/ and hairstyles/: named by the environment variable HAIRLOOM_SAMPLES, else
/// share/hairloom/samples or samples beside `programFolder` or a folder above it; empty where there is none.
std::filesystem::path findSamples(const std::filesystem::path& programFolder);

/// Names of the hairstyles there, in order of name.
std::vector<std::string> sampleNames(const std::filesystem::path& samples);

enum class SampleColliders {
    spheres,  ///< alone, which all methods and the GPU know
    skin,     ///< and the skin (fitBody()), which takes seconds: as people get samples
};

/// Head, scalp, roots, grooming, colliders and settings of one hairstyle. Errors: a file that is missing or
/// does not read, those of fitBody().
Result<Groom> makeSample(const std::filesystem::path& samples, const std::string& name,
                         SampleColliders colliders = SampleColliders::spheres);

}  // namespace hairloom
