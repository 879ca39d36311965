// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The look-up tables of one material on the device.

#include <span>

#include "core/gpu/device.h"
#include "core/render/scene.h"
#include "core/shading/tables.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

/// How light sinks through hair to the skin; that of Kajiya-Kay is an artist's.
struct HairFlux {
    /// What a fibre scatters, and the moments of it (AverageScattering); of Kajiya-Kay the logarithm of what
    /// it takes. Linear RGB.
    Vec3f scattered = Vec3f::Constant(0.5f);
    Vec3f first = Vec3f::Zero(), second = Vec3f::Zero();
    /// False for Kajiya-Kay; else what has met no fibre is known by itself, as shadow maps resolve it.
    bool ofFibres = false;
};

/// Only what the model needs is made: none for Kajiya-Kay, those of dual scattering where it is on, several
/// absorptions (core/shading/absorption_layers.h) where hair does not look the same everywhere.
class FibreTables {
  public:
    /// Bakes on all cores and leaves the upload to the device: nothing waits.
    static Result<FibreTables> make(gpu::Device& device, const FibreMaterial& material, bool varies = false);
    /// The same in two steps, of which the first needs no device: on any thread.
    static FibreTables bake(const FibreMaterial& material, bool varies);
    Status upload(gpu::Device& device);

    bool isFor(const FibreMaterial& material, bool varies) const {
        return varies_ == varies && material_ == material;
    }
    /// Of the same kinds of tables, though perhaps of other numbers.
    bool hasShaderFor(const StrandShading& material) const;
    /// The compute shader that shades with this material.
    const char* shader() const;
    /// That which finds how its light changes over a hair's width, or says that it does not.
    const char* acrossShader() const;
    /// The model knows how light leaves a fibre's section, and so which side of it is brighter.
    bool knowsSection() const { return material_.model == ShadingModel::marschner; }
    /// Tables and constants, registers b1, s0 and from t11 on; nothing for Kajiya-Kay.
    void bind(gpu::CommandList& list) const;

    const shaders::FibreConstants& constants() const { return constants_; }
    /// Of hair in which the fibres absorb these, RGB per fibre radius, as many each; of the material's own
    /// absorption where the tables hold no others.
    HairFlux flux(std::span<const Vec3d> absorptions = {}) const;
    std::uint64_t bytes() const;  ///< of all tables on the device

  private:
    struct Bound {
        std::uint32_t slot;
        gpu::TexturePtr texture;
    };
    struct Waiting {
        std::uint32_t slot;
        const char* name;
        shading::Table table;
    };
    class Baker;

    FibreMaterial material_;
    bool varies_ = false;
    shaders::FibreConstants constants_{};
    shading::AverageScattering across_;  ///< of the material's own absorption
    shading::Table averages_;       ///< shading::DualLayers::averages, where tables hold several absorptions
    std::vector<Waiting> waiting_;  ///< for their upload
    std::vector<Bound> textures_;
    gpu::SamplerPtr sampler_;
};

}  // namespace hairloom::render
