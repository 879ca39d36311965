// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Curves and tables of the shading models as charts (Rünz 2012, Figures 14, 23 and 24), from the same code
// that bakes what shaders look up, and opacity maps (Figure 29): for `render --show` and the Look panel.

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

#include "core/charts/plot.h"
#include "core/groom/groom.h"
#include "core/live/view_file.h"

namespace hairloom {

struct ShownHair {
    HairMaterial material;
    ViewFile view;                       ///< its members of fibres come first, as when hair is drawn
    double inclinationDegrees = 0;       ///< of the light for M, −85…85; |θ_d| for N
    std::shared_ptr<const Groom> groom;  ///< whose shadows are shown; null: none
    render::RenderOptions shadows;       ///< of them: layers, slices, resolution
};

/// A look-up table, or what one holds. Row after row from the lowest.
struct ShownTable {
    struct Channel {
        std::string name;
        std::vector<float> values;  ///< rows · columns
    };
    std::string name;
    std::string xName, yName;
    std::vector<double> x, y;  ///< the middles of columns and rows
    std::vector<Channel> channels;
};

struct ShownNumber {
    std::string name;  ///< with its unit, as "light_deg"
    std::vector<double> values;
};

/// All that a chart shows, and what it follows from.
struct Shown {
    std::vector<Plot> plots;  ///< curves are their series
    std::vector<ShownTable> tables;
    std::vector<ShownNumber> parameters;
};

struct ShownKind {
    const char* name;     ///< as --show takes it
    const char* label;    ///< as the window has it
    const char* meaning;  ///< a line of help
    /// Whose it is; nothing: of the model that hair is drawn with.
    std::optional<render::ShadingModel> model;
    bool ofGroom = false;  ///< it shows the hair itself, not its material
    Result<Shown> (*make)(const ShownHair& hair);
};

/// All there are, in the order of help.
std::span<const ShownKind> shownKinds();
/// Null where there is none.
const ShownKind* shownKind(std::string_view name);

/// What `hair` looks like as `kind` has it. Errors: an inclination out of its range, a view whose model is
/// another, a model without tables.
Result<Shown> show(const ShownKind& kind, const ShownHair& hair);

/// curves (chart, name, x, y), tables, parameters.
nlohmann::ordered_json shownNumbers(const Shown& shown);

/// On `width` × `height` pixels, at least kMinShownWidth × kMinShownHeight.
ChartImage shownImage(const Shown& shown, std::uint32_t width, std::uint32_t height);
inline constexpr std::uint32_t kMinShownWidth = 320, kMinShownHeight = 240;

}  // namespace hairloom
