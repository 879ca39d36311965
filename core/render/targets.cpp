// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/targets.h"

#include "core/render/light.h"

namespace hairloom::render {
namespace {

using gpu::Format;

/// A target that is wanted or, with a width of 0, is not.
struct Wanted {
    const char* name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    Format format = Format::Unknown;
    std::uint32_t samples = 1;
};

class Fitting {
  public:
    explicit Fitting(gpu::Device& device) : device_(device) {}

    /// Whether the texture is a new one.
    bool operator()(gpu::TexturePtr& texture, const Wanted& wanted) {
        if (wanted.width == 0 || !status) {
            texture = nullptr;
            return false;
        }
        if (texture != nullptr && texture->desc().width == wanted.width &&
            texture->desc().height == wanted.height && texture->desc().samples == wanted.samples) {
            return false;
        }
        gpu::TextureDesc desc;
        desc.name = wanted.name;
        desc.width = wanted.width;
        desc.height = wanted.height;
        desc.format = wanted.format;
        desc.samples = wanted.samples;
        desc.usage = wanted.format == Format::D32Float ? gpu::Usage::DepthStencil : gpu::Usage::RenderTarget;
        if (wanted.samples == 1) desc.usage = desc.usage | gpu::Usage::ShaderRead;
        texture = nullptr;
        auto made = device_.createTexture(desc);
        if (made) {
            texture = std::move(*made);
        } else {
            status = tl::unexpected(made.error());
        }
        return true;
    }
    Status status;

  private:
    gpu::Device& device_;
};

}  // namespace

Result<TargetChanges> fitTargets(gpu::Device& device, const RenderOptions& options, std::uint32_t samples,
                                 bool overlayNeedsDepth, Targets& t) {
    const std::uint32_t atlasHeight = options.shadowResolution;
    const std::uint32_t atlasWidth = atlasHeight * static_cast<std::uint32_t>(kMaxLights);
    const std::uint32_t width = options.width;
    const std::uint32_t height = options.height;
    const auto ifWanted = [&](bool wanted) { return wanted ? width : 0; };
    Fitting fit(device);
    TargetChanges changes;
    changes.shadows = fit(t.headDepth, {"head depth", atlasWidth, atlasHeight, Format::D32Float, 1});
    fit(t.firstHair, {"first hair", atlasWidth, atlasHeight, Format::D32Float, 1});
    fit(t.opacity, {"opacity layers", atlasWidth, atlasHeight, Format::Rgba16Unorm, 1});
    changes.picture = fit(t.colour, {"colour", width, height, kColourFormat, samples});
    fit(t.resolved, {"resolved", ifWanted(samples > 1), height, kColourFormat, 1});
    fit(t.depth, {"depth", width, height, Format::D32Float, samples});
    changes.picture |= fit(t.sum, {"sum", width, height, Format::Rgba32Float, 1});
    fit(t.overlayDepth, {"overlay depth", ifWanted(overlayNeedsDepth), height, Format::D32Float, 1});
    if (!fit.status) return tl::unexpected(fit.status.error());
    return changes;
}

}  // namespace hairloom::render
