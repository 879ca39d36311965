// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What `render --burn-in` writes into images.

#include <cstdint>
#include <string>

#include "cli/job.h"
#include "cli/render_options.h"
#include "core/groom/groom.h"
#include "core/render/image.h"

namespace hairloom::cli {

class BurnIn {
  public:
    BurnIn(const RenderJobOptions& options, const Groom& groom) : options_(options), groom_(groom) {}

    /// Into the image of the shot, which is number `index` of the sequence. Errors: as readFrame(), of the
    /// records.
    Status draw(const Shot& shot, std::size_t index, render::Image& image);
    /// With --against: error_mm and error_mm_max of each image.
    void report(Report& report) const;

  private:
    std::string frameText(const Shot& shot, std::size_t index) const;
    std::string takeText() const;
    Result<std::string> errorText(const Shot& shot);

    const RenderJobOptions& options_;
    const Groom& groom_;
    Report errors_ = Report::array();
};

}  // namespace hairloom::cli
