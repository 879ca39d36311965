// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes whose points a file has at many times, as caches of any rig: what moves as a whole becomes a bone,
// so that colliders go along, and the rest a morph target for each time.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "importers/raw_scene.h"

namespace hairloom {

class PointCache {
  public:
    explicit PointCache(RawScene& scene) : scene_(scene) {}

    /// A mesh whose points are those of the scene's soup from `first` on.
    struct Mesh {
        std::string name;
        std::uint32_t first = 0, points = 0;
        std::vector<float> seconds;  ///< of its samples, on the clip
        /// The points of a sample in the soup's space. Errors: damage of the file.
        std::function<Result<std::vector<Vec3f>>(std::size_t sample)> read;
        bool isCarried = false;  ///< bones move it already
    };
    /// Takes a mesh for finish(), up to which what `read` reads must live.
    void add(Mesh mesh);
    /// Makes bones and morph targets, and the tracks that play them. Samples that do not fit their mesh leave
    /// it at rest, which is told. Errors: those of reading.
    Status finish(Clip& clip);

  private:
    Status play(const Mesh& mesh, std::size_t every, Clip& clip);

    RawScene& scene_;
    std::vector<Mesh> meshes_;
    std::size_t moved_ = 0;  ///< vertices, by all targets
};

}  // namespace hairloom
