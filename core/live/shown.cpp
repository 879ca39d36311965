// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/shown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/live/hair_look.h"
#include "core/live/shown_parts.h"

namespace hairloom {
namespace {

using Model = render::ShadingModel;
using Json = nlohmann::ordered_json;

constexpr double kLargestInclination = 85;  // degrees

constexpr const char* nameOf(Model model) {
    return model == Model::kajiya ? "kajiya" : model == Model::marschner ? "marschner" : "sadeghi";
}

Model modelOf(const ShownHair& hair) {
    return shadingModel(hair.material, hair.view.fibre);
}

Result<Shown> curves(const ShownHair& hair) {
    const Model model = modelOf(hair);
    if (model == Model::kajiya) return kajiyaM(hair);
    auto m = model == Model::marschner ? marschnerM(hair) : sadeghiM(hair);
    auto n = model == Model::marschner ? marschnerN(hair) : sadeghiN(hair);
    if (!m || !n) return m ? n : m;
    m->plots.push_back(std::move(n->plots.front()));
    return m;
}

Result<Shown> tables(const ShownHair& hair) {
    switch (modelOf(hair)) {
        case Model::marschner:
            return marschnerTables(hair);
        case Model::sadeghi:
            return sadeghiTables(hair);
        case Model::kajiya:
            break;
    }
    return fail("Kajiya-Kay looks up no tables", "--shading marschner or sadeghi");
}

constexpr std::array<ShownKind, 11> kKinds{{
    {"curves", "Curves of this model", "M and N of the shading model that draws the hair", {}, false, curves},
    {"tables",
     "Tables of this model",
     "look-up tables of the shading model that draws the hair",
     {},
     false,
     tables},
    {"kajiya-m", "Kajiya-Kay along the fibre",
     "diffuse light and the two highlights of Kajiya-Kay along the fibre", Model::kajiya, false, kajiyaM},
    {"marschner-m", "Marschner: M along the fibre", "M_R, M_TT and M_TRT of Marschner along the fibre",
     Model::marschner, false, marschnerM},
    {"marschner-n", "Marschner: N around the fibre", "N_R, N_TT and N_TRT of Marschner around the fibre",
     Model::marschner, false, marschnerN},
    {"marschner-tables", "Marschner: tables", "look-up tables of Marschner (thesis, Figure 23)",
     Model::marschner, false, marschnerTables},
    {"sadeghi-m", "Sadeghi: M' along the fibre", "M' of Sadeghi's lobes along the fibre", Model::sadeghi,
     false, sadeghiM},
    {"sadeghi-n", "Sadeghi: N' around the fibre",
     "N' of Sadeghi's lobes around the fibre (thesis, Figure 14)", Model::sadeghi, false, sadeghiN},
    {"sadeghi-tables", "Sadeghi: tables", "look-up tables of Sadeghi (thesis, Figure 24)", Model::sadeghi,
     false, sadeghiTables},
    {"deep-opacity-map",
     "Deep opacity map",
     "the deep opacity map of a groom's hair, from the first light (thesis, Figure 29)",
     {},
     true,
     deepOpacityMap},
    {"opacity-maps",
     "Opacity maps",
     "the opacity maps of a groom's hair, from the first light",
     {},
     true,
     opacityMaps},
}};

Json curvesOf(const Plot& plot) {
    Json curves = Json::array();
    for (const Series& series : plot.series) {
        Json x = Json::array(), y = Json::array();
        for (const PlotPoint& point : series.points) {
            x.push_back(point.x);
            y.push_back(point.y);
        }
        curves.push_back(
            {{"chart", plot.title}, {"name", series.name}, {"x", std::move(x)}, {"y", std::move(y)}});
    }
    return curves;
}

}  // namespace

std::span<const ShownKind> shownKinds() {
    return kKinds;
}

const ShownKind* shownKind(std::string_view name) {
    const auto found = std::ranges::find(kKinds, name, [](const ShownKind& kind) { return kind.name; });
    return found != kKinds.end() ? &*found : nullptr;
}

Result<Shown> show(const ShownKind& kind, const ShownHair& hair) {
    if (!(std::abs(hair.inclinationDegrees) <= kLargestInclination))
        return fail("the light's inclination is out of its range", "-85 to 85 degrees");
    const auto& wanted = hair.view.fibre.model;
    if (kind.model && wanted && *wanted != *kind.model) {
        return fail(std::string(kind.name) + " is of " + nameOf(*kind.model) + ", but the shading model is " +
                        nameOf(*wanted),
                    std::string("--shading ") + nameOf(*kind.model) + ", or none");
    }
    return kind.make(hair);
}

render::FibreMaterial fibreOf(const ShownHair& hair, Model model) {
    FibreView view = hair.view.fibre;
    view.model = model;
    return fibreMaterial(hair.material, view);
}

Json shownNumbers(const Shown& shown) {
    Json report;
    report["parameters"] = Json::object();
    for (const ShownNumber& number : shown.parameters) {
        report["parameters"][number.name] =
            number.values.size() == 1 ? Json(number.values.front()) : Json(number.values);
    }
    report["curves"] = Json::array();
    for (const Plot& plot : shown.plots) {
        for (Json& curve : curvesOf(plot)) report["curves"].push_back(std::move(curve));
    }
    report["tables"] = Json::array();
    for (const ShownTable& table : shown.tables) {
        Json channels = Json::object();
        for (const ShownTable::Channel& channel : table.channels) channels[channel.name] = channel.values;
        report["tables"].push_back({{"name", table.name},
                                    {"x_name", table.xName},
                                    {"y_name", table.yName},
                                    {"x", table.x},
                                    {"y", table.y},
                                    {"channels", std::move(channels)}});
    }
    return report;
}

ChartImage shownImage(const Shown& shown, std::uint32_t width, std::uint32_t height) {
    // As many columns as leave charts nearest to the shape that reads well.
    constexpr double kShape = 1.5, kEasyWidth = 620, kEasyHeight = 400;  // pixels of a chart's layout
    const auto count = static_cast<std::uint32_t>(shown.plots.size());
    std::uint32_t columns = 1;
    double best = 1e30;
    for (std::uint32_t c = 1; c <= count; ++c) {
        const double shape = (double{1.0} * width / c) / (double{1.0} * height / ((count + c - 1) / c));
        const double off = std::abs(std::log(shape / kShape));
        if (off < best) {
            best = off;
            columns = c;
        }
    }
    const std::uint32_t rows = (count + columns - 1) / columns;
    const std::uint32_t wide = width / columns, high = height / rows;
    const double scale = std::clamp(std::min(wide / kEasyWidth, high / kEasyHeight), 0.5, 8.0);
    ChartImage all{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 255)};
    for (std::uint32_t i = 0; i < count; ++i) {
        Plot plot = shown.plots[i];
        plot.width = wide / scale;
        plot.height = high / scale;
        const ChartImage one = image(plot, scale);
        const std::uint32_t left = i % columns * wide, top = i / columns * high;
        for (std::uint32_t y = 0; y < std::min(one.height, height - top); ++y) {
            const auto row = one.rgba.begin() + std::ptrdiff_t{4} * y * one.width;
            std::copy_n(row, std::size_t{4} * std::min(one.width, width - left),
                        all.rgba.begin() + std::ptrdiff_t{4} * (std::size_t{top + y} * width + left));
        }
    }
    return all;
}

}  // namespace hairloom
