// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A studio's colours: an OpenColorIO config (https://opencolorio.org), its displays and views, and the space
// that its renders are in. Only this folder knows the library.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/render/colour_transform.h"
#include "core/render/linear_space.h"

namespace hairloom::colour {

/// Whether this program was built with OpenColorIO.
bool hasOpenColorIO();

/// A display and how it can be looked at, the config's default first.
struct Display {
    std::string name;
    std::vector<std::string> views;
};

/// The space of a config's scene-linear files: that of its role scene_linear, else rendering.
struct WorkingSpace {
    std::string name;  ///< as the config calls it
    render::LinearSpace linear;
    /// From linear light in the primaries of Rec. 709.
    std::shared_ptr<const render::ColourTransform> fromRec709;
    std::string note;  ///< what had to be assumed; empty: nothing
};

/// One that has been read; copies share it.
class ColourConfig {
  public:
    /// Errors, with the line where the file is no config: missing, larger than 64 MiB, damaged, newer than
    /// the library, no display, no scene-linear role, one whose transform cannot be made.
    static Result<ColourConfig> read(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    /// Those that the config has switched on, in its order, the default first.
    const std::vector<Display>& displays() const { return displays_; }
    const WorkingSpace& working() const { return working_; }

    /// From linear light in the primaries of Rec. 709, through the working space, to code values of a
    /// display. Errors: no such display or view, with what there is; a file that the view needs and that is
    /// missing or damaged.
    Result<std::shared_ptr<const render::ColourTransform>> view(const std::string& display,
                                                                const std::string& view) const;

  private:
    struct Library;
    std::shared_ptr<const Library> library_;
    std::filesystem::path path_;
    std::vector<Display> displays_;
    WorkingSpace working_;
};

}  // namespace hairloom::colour
