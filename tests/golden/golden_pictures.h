// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The golden pictures: what each shows, how it is drawn, and how near a new one has to be.

#include <filesystem>
#include <string>
#include <vector>

#include "core/live/groom_scene.h"
#include "core/render/flip.h"
#include "core/render/picture.h"

namespace hairloom::golden {

/// Mean FLIP that nobody sees in pictures of this size, and that another version of a driver or compiler
/// stays below; a light that is missing, another shadow or another model are far above (tests).
inline constexpr double kTolerance = 0.008;
inline constexpr std::uint32_t kSize = 160;  ///< pixels along a side

struct Case {
    std::string name;             ///< of the file, without its ending
    std::string sample;           ///< hairstyle of samples/hairstyles
    std::string material{};       ///< of samples/materials; empty: the sample's own
    std::size_t everyStrand = 1;  ///< the others are left out
    render::ShadingModel model = render::ShadingModel::kajiya;
    render::Scattering scattering = render::Scattering::dual;
    render::RenderOptions options;
};

/// The three samples in each model; then one of them with each kind of shadows, edges, ribbons, transparency,
/// and the sample materials.
std::vector<Case> cases();

/// Draws cases; keeps the sample that it drew last, for cases come sample by sample.
class Painter {
  public:
    explicit Painter(gpu::Device& device) : device_(&device) {}
    Result<render::Image> draw(const Case& which);
    /// From here on.
    void use(gpu::Device& device) { device_ = &device; }

  private:
    gpu::Device* device_;
    std::string sample_;
    Groom groom_;
};

std::filesystem::path pathOf(const Case& which);
/// Of the picture in the repository. Error: there is none, or it does not read.
Result<render::Image> acceptedPicture(const Case& which);

}  // namespace hairloom::golden
