// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pipelines, each made when it is first asked for.

#include <map>
#include <string_view>
#include <utility>

#include "core/gpu/device.h"

namespace hairloom::render {

enum class Blend {
    replace,
    over,
    weighedAndRest,  ///< first target: adds; second: times what the source leaves
};

/// What tells one graphics pipeline of this room from another. Names are those of shaders.
struct GraphicsNeeds {
    std::string_view vertex;
    std::string_view pixel{};  ///< empty: depth only
    std::string_view hull{};   ///< with domain, or empty
    std::string_view domain{};
    gpu::Topology topology = gpu::Topology::TriangleList;
    gpu::Format colour = gpu::Format::Unknown;
    gpu::Format secondColour = gpu::Format::Unknown;
    bool depthTest = false;
    bool depthWrite = false;
    Blend blend = Blend::replace;
    std::uint32_t samples = 1;

    auto operator<=>(const GraphicsNeeds&) const = default;
};

/// Depth of the meshes alone, from a light or the eye.
inline constexpr GraphicsNeeds kMeshDepth{.vertex = "mesh_depth.vert", .depthTest = true, .depthWrite = true};

class Pipelines {
  public:
    explicit Pipelines(gpu::Device& device) : device_(device) {}

    /// Nothing after an error, which takeStatus() has.
    gpu::GraphicsPipelinePtr graphics(const GraphicsNeeds& needs);
    gpu::ComputePipelinePtr compute(std::string_view name);
    /// The first error since the last call.
    Status takeStatus() { return std::exchange(status_, Status()); }

  private:
    gpu::ShaderPtr shader(std::string_view name, gpu::ShaderStage stage);

    gpu::Device& device_;
    std::map<GraphicsNeeds, gpu::GraphicsPipelinePtr> graphics_;
    std::map<std::string_view, gpu::ComputePipelinePtr> compute_;
    std::map<std::string_view, gpu::ShaderPtr> shaders_;
    Status status_;
};

}  // namespace hairloom::render
