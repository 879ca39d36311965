// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/fibre_tables.h"

#include <algorithm>
#include <cmath>

#include "core/shading/absorption_layers.h"

namespace hairloom::render {
namespace {

// Registers of the shaders.
constexpr std::uint32_t kLongitudinal = 11;
constexpr std::uint32_t kAzimuthal = 12;
constexpr std::uint32_t kSecondAzimuthal = 13;
constexpr std::uint32_t kProfile = 14;
constexpr std::uint32_t kAverages = 15;
constexpr std::uint32_t kSpreadFactors = 16;
constexpr std::uint32_t kSky = 17;

// Radians: a smooth fibre's light would leave parts of its width that are thinner than what is told apart.
constexpr double kLeastAcross = 0.1;

Result<gpu::TexturePtr> textureOf(gpu::Device& device, const char* name, const shading::Table& table) {
    std::vector<Eigen::half> halves;
    halves.reserve(table.rgba.size());
    for (const float value : table.rgba) halves.emplace_back(std::min(value, 65000.0f));
    gpu::TextureDesc desc;
    desc.name = name;
    desc.width = table.width;
    desc.height = table.height;
    desc.format = gpu::Format::Rgba16Float;
    return device.createTexture(desc, std::as_bytes(std::span(halves)));
}

shaders::float4 toFloat4(const Vec3d& v) {
    const Vec3f f = v.cast<float>();
    return {f.x(), f.y(), f.z(), 0};
}

/// In single scattering what meets a fibre is lost.
HairFlux fluxOf(const FibreMaterial& material, const shading::AverageScattering& across) {
    HairFlux flux{Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), true};
    if (material.scattering == Scattering::single) return flux;
    flux.scattered = (across.forward + across.backward).cast<float>();
    flux.first = across.first.cast<float>();
    flux.second = across.second.cast<float>();
    return flux;
}

/// Fibres of several absorptions that lie mixed: light obeys the mean of what they do to it.
shading::AverageScattering meanScattering(const shading::Table& averages,
                                          std::span<const Vec3d> absorptions) {
    shading::AverageScattering sum;
    const double part = 1 / static_cast<double>(absorptions.size());
    for (const Vec3d& absorption : absorptions) {
        const shading::AverageScattering one = shading::scatteringAcross(averages, absorption);
        sum.forward += part * one.forward;
        sum.backward += part * one.backward;
        sum.first += part * one.first;
        sum.second += part * one.second;
    }
    return sum;
}

/// With `varies` absorption colours Sadeghi's TT and TRT.
shaders::FibreConstants constantsOf(const FibreMaterial& material, bool varies) {
    shaders::FibreConstants c{};
    c.minSpread = static_cast<float>(shading::kMinSpread);
    c.maxSpread = static_cast<float>(shading::kLargestSpread);
    if (material.model == ShadingModel::marschner) {
        const auto& intensity = material.marschner.intensity;
        c.rIntensity = static_cast<float>(intensity[0]);
        c.ttIntensity = static_cast<float>(intensity[1]);
        c.trtIntensity = static_cast<float>(intensity[2]);
        const shading::AzimuthalParameters& section = material.marschner.azimuthal;
        c.ior = static_cast<float>(section.ior);
        c.azimuthalWidth = static_cast<float>(std::max(section.width, kLeastAcross));
        c.absorption = toFloat4(section.absorption);
        return c;
    }
    const shading::SadeghiParameters& model = material.sadeghi;
    c.rIntensity = c.ttIntensity = c.trtIntensity = 1;
    c.r = toFloat4(model.r.light());
    c.tt = toFloat4(varies ? Vec3d(model.tt.intensity * model.tt.tint) : model.tt.light());
    c.trt = toFloat4(varies ? Vec3d(model.trt.intensity * model.trt.tint) : model.trt.light());
    return c;
}

const shading::Table& spreadFactors() {
    static const shading::Table kTable = shading::bakeSpreadFactors();
    return kTable;
}

}  // namespace

/// Bakes what one material needs.
class FibreTables::Baker {
  public:
    explicit Baker(FibreTables& result) : result_(result) {}

    void even() {
        if (material().model == ShadingModel::marschner) {
            const shading::Marschner model(material().marschner);
            shading::MarschnerTables tables = shading::bakeMarschner(model);
            add(kLongitudinal, "longitudinal scattering", std::move(tables.longitudinal));
            add(kAzimuthal, "azimuthal scattering, R and TT", std::move(tables.transmitted));
            add(kSecondAzimuthal, "azimuthal scattering, TRT", std::move(tables.reflected));
            evenDual(shading::DualScattering(model));
        } else {
            shading::SadeghiTables tables = shading::bakeSadeghi(material().sadeghi);
            add(kLongitudinal, "longitudinal scattering", std::move(tables.longitudinal));
            add(kAzimuthal, "azimuthal scattering", std::move(tables.azimuthal));
            evenDual(shading::DualScattering(material().sadeghi));
        }
    }

    /// For absorption that changes from place to place.
    void layers() {
        if (material().model == ShadingModel::marschner) {
            shading::MarschnerLayers tables = shading::bakeMarschnerLayers(material().marschner);
            add(kLongitudinal, "longitudinal scattering", std::move(tables.longitudinal));
            add(kAzimuthal, "azimuthal scattering by absorption", std::move(tables.azimuthal));
            dualLayers(shading::bakeDualLayers(material().marschner));
        } else {
            const shading::AzimuthalParameters& fibre = material().marschner.azimuthal;
            shading::SadeghiLayers layers = shading::bakeSadeghiLayers(material().sadeghi, fibre);
            add(kLongitudinal, "longitudinal scattering", std::move(layers.tables.longitudinal));
            add(kAzimuthal, "azimuthal scattering", std::move(layers.tables.azimuthal));
            add(kSecondAzimuthal, "energies by absorption", std::move(layers.energies));
            dualLayers(shading::bakeDualLayers(material().sadeghi, fibre));
        }
    }

  private:
    const FibreMaterial& material() const { return result_.material_; }
    bool isDual() const { return result_.material_.scattering != Scattering::single; }
    void add(std::uint32_t slot, const char* name, shading::Table table) {
        result_.waiting_.push_back({slot, name, std::move(table)});
    }
    void evenDual(const shading::DualScattering& dual) {
        add(kSky, "light from around", shading::bakeSky(dual));
        if (isDual()) {
            shading::DualTables tables = shading::bakeDual(dual);
            add(kProfile, "azimuthal scattering of all lobes", std::move(tables.profile));
            add(kAverages, "average scattering", std::move(tables.averages));
            add(kSpreadFactors, "wide lobes", spreadFactors());
        }
        result_.across_ = dual.at(0).average;
    }
    void dualLayers(shading::DualLayers layers) {
        add(kSky, "light from around by absorption", std::move(layers.sky));
        if (isDual()) {
            add(kProfile, "azimuthal scattering of all lobes by absorption", std::move(layers.profile));
            add(kAverages, "average scattering by absorption", layers.averages);
            add(kSpreadFactors, "wide lobes", spreadFactors());
        }
        const Vec3d own = material().marschner.azimuthal.absorption;
        result_.across_ = meanScattering(layers.averages, std::span(&own, 1));
        result_.averages_ = std::move(layers.averages);
    }

    FibreTables& result_;
};

FibreTables FibreTables::bake(const FibreMaterial& material, bool varies) {
    FibreTables result;
    result.material_ = material;
    result.varies_ = varies;
    if (material.model == ShadingModel::kajiya) return result;
    result.constants_ = constantsOf(material, varies);
    Baker baker(result);
    if (varies) {
        baker.layers();
    } else {
        baker.even();
    }
    return result;
}

Status FibreTables::upload(gpu::Device& device) {
    if (waiting_.empty()) return {};
    for (const Waiting& waiting : waiting_) {
        auto texture = textureOf(device, waiting.name, waiting.table);
        if (!texture) return tl::unexpected(texture.error());
        textures_.push_back({waiting.slot, std::move(*texture)});
    }
    waiting_.clear();
    auto sampler = device.createSampler({});
    if (!sampler) return tl::unexpected(sampler.error());
    sampler_ = std::move(*sampler);
    return {};
}

Result<FibreTables> FibreTables::make(gpu::Device& device, const FibreMaterial& material, bool varies) {
    FibreTables result = bake(material, varies);
    if (auto status = result.upload(device); !status) return tl::unexpected(status.error());
    return result;
}

bool FibreTables::hasShaderFor(const StrandShading& material) const {
    return varies_ == material.look.has_value() && material_.model == material.fibre.model &&
           (material_.scattering == Scattering::single) == (material.fibre.scattering == Scattering::single);
}

HairFlux FibreTables::flux(std::span<const Vec3d> absorptions) const {
    if (material_.model == ShadingModel::kajiya) return {};
    const bool own = absorptions.empty() || averages_.rgba.empty();
    return fluxOf(material_, own ? across_ : meanScattering(averages_, absorptions));
}

const char* FibreTables::shader() const {
    const bool dual = material_.scattering != Scattering::single;
    switch (material_.model) {
        case ShadingModel::kajiya:
            break;
        case ShadingModel::marschner:
            if (varies_) return dual ? "shade_marschner_dual_look.comp" : "shade_marschner_look.comp";
            return dual ? "shade_marschner_dual.comp" : "shade_marschner.comp";
        case ShadingModel::sadeghi:
            if (varies_) return dual ? "shade_sadeghi_dual_look.comp" : "shade_sadeghi_look.comp";
            return dual ? "shade_sadeghi_dual.comp" : "shade_sadeghi.comp";
    }
    return varies_ ? "shade_look.comp" : "shade.comp";
}

const char* FibreTables::acrossShader() const {
    if (!knowsSection()) return "shade_across.comp";
    return varies_ ? "shade_across_marschner_look.comp" : "shade_across_marschner.comp";
}

void FibreTables::bind(gpu::CommandList& list) const {
    if (textures_.empty()) return;
    list.setConstants(1, gpu::bytesOf(constants_));
    std::vector<gpu::Binding> bindings{gpu::Binding::sample(0, sampler_)};
    for (const Bound& bound : textures_) bindings.push_back(gpu::Binding::read(bound.slot, bound.texture));
    list.bind(bindings);
}

std::uint64_t FibreTables::bytes() const {
    std::uint64_t sum = 0;
    for (const Bound& bound : textures_) {
        const gpu::TextureDesc& desc = bound.texture->desc();
        sum += std::uint64_t{desc.width} * desc.height * gpu::bytesPerTexel(desc.format);
    }
    return sum;
}

}  // namespace hairloom::render
