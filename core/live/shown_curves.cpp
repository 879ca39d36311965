// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/live/hair_look.h"
#include "core/live/shown_parts.h"
#include "core/shading/kajiya_kay.h"

namespace hairloom {
namespace {

using shading::kDegree;
using shading::Lobe;

constexpr std::array kLobeNames{"R", "TT", "TRT"};
constexpr double kGlintPlace = 0.5;  // of the strand that is shown, between glintNear and glintFar

Series curve(std::string name, std::string colour, double from, double to, double step,
             const std::function<double(double degrees)>& value) {
    Series series;
    series.name = std::move(name);
    series.colour = std::move(colour);
    series.marker = Marker::None;
    series.line = LineStyle::Solid;
    const auto steps = static_cast<int>(std::lround((to - from) / step));
    for (int i = 0; i <= steps; ++i) {
        const double x = from + i * step;
        series.points.push_back({x, value(x)});
    }
    return series;
}

AxisTick degrees(int value) {
    return {double(value), (value < 0 ? "\u2212" : "") + std::to_string(std::abs(value))};
}

Axis angleAxis(const char* title, int most) {
    Axis axis;
    axis.title = title;
    axis.unit = "°";
    axis.low = -most;
    axis.high = most;
    for (int at = -most; at <= most; at += most / 2) axis.ticks.push_back(degrees(at));
    return axis;
}

Plot lobePlot(const std::string& title, Axis angle, const char* value, const char* unit) {
    Plot plot;
    plot.title = title;
    plot.x = std::move(angle);
    plot.y = {.title = value, .unit = unit, .low = 0.0};
    return plot;
}

Plot longitudinalPlot(const std::string& title, const char* value, const char* unit) {
    return lobePlot(title, angleAxis("inclination of the view θ_o", 90), value, unit);
}

Plot azimuthalPlot(const std::string& title, const char* value, const char* unit) {
    return lobePlot(title, angleAxis("azimuth of the view against the light φ", 180), value, unit);
}

std::string lightNote(const ShownHair& hair) {
    return "Light at θ_i = " + std::to_string(std::lround(hair.inclinationDegrees)) + "°.";
}

void addM(Plot& plot, double inclinationDegrees,
          const std::function<double(Lobe, double thetaIn, double thetaOut)>& m) {
    for (const Lobe lobe : shading::kLobes) {
        const std::size_t p = shading::index(lobe);
        plot.series.push_back(curve(kLobeNames[p], paletteColour(p), -90, 90, 0.5, [&](double at) {
            return m(lobe, inclinationDegrees * kDegree, at * kDegree);
        }));
    }
}

ShownNumber light(const ShownHair& hair) {
    return {"light_deg", {hair.inclinationDegrees}};
}

}  // namespace

Result<Shown> kajiyaM(const ShownHair& hair) {
    ShownHair seen = hair;
    seen.view.fibre.model = render::ShadingModel::kajiya;
    const render::StrandShading m = strandShading(seen.material, seen.view);
    const double thetaIn = hair.inclinationDegrees * kDegree;
    // In the plane of fibre and light, both on one side.
    const auto direction = [](double theta) { return Vec3d(std::sin(theta), std::cos(theta), 0); };
    const Vec3d tangent = Vec3d::UnitX(), toLight = direction(thetaIn);
    const double meets = shading::kajiyaDiffuse(tangent, toLight) / std::numbers::pi;
    const auto highlight = [&](double strength, double exponent, double shiftDegrees, double view) {
        const double shift = shiftDegrees * kDegree;
        const Vec3d tilted(std::cos(shift), std::sin(shift), 0);
        return strength * meets / shading::kajiyaReflectance(exponent) *
               shading::kajiyaSpecular(tilted, toLight, direction(view * kDegree), exponent);
    };
    const auto number = [](float value) { return static_cast<double>(value); };
    const Vec3d albedo = (m.look ? m.look->root : Vec3d(m.albedo.cast<double>()));
    const double brightness = albedo.dot(Vec3d(0.2126, 0.7152, 0.0722));
    Shown shown;
    Plot plot = longitudinalPlot("Kajiya-Kay: light along the fibre", "radiance per irradiance", "1/sr");
    plot.series.push_back(curve("diffuse", paletteColour(0), -90, 90, 0.5, [&](double) {
        return number(m.diffuse) * brightness * meets / shading::kajiyaReflectance(0);
    }));
    plot.series.push_back(curve("first highlight", paletteColour(1), -90, 90, 0.5, [&](double view) {
        return highlight(number(m.primary.x()), number(m.primaryExponent), number(m.primaryShift), view);
    }));
    plot.series.push_back(curve("second highlight", paletteColour(2), -90, 90, 0.5, [&](double view) {
        return highlight(number(m.secondary.x()) * brightness, number(m.secondaryExponent),
                         number(m.secondaryShift), view);
    }));
    plot.note =
        lightNote(hair) + " View and light on one side. Luminance at the root, before the bound on energy.";
    shown.plots.push_back(std::move(plot));
    shown.parameters = {light(hair),
                        {"albedo_luminance", {brightness}},
                        {"diffuse", {number(m.diffuse)}},
                        {"specular", {number(m.primary.x()), number(m.secondary.x())}},
                        {"exponent", {number(m.primaryExponent), number(m.secondaryExponent)}},
                        {"shift_deg", {number(m.primaryShift), number(m.secondaryShift)}}};
    return shown;
}

Result<Shown> marschnerM(const ShownHair& hair) {
    const shading::Marschner model(fibreOf(hair, render::ShadingModel::marschner).marschner);
    Shown shown;
    Plot plot = longitudinalPlot("Marschner: M along the fibre", "M", "1/rad");
    addM(plot, hair.inclinationDegrees,
         [&](Lobe lobe, double in, double out) { return model.longitudinal(lobe, in, out); });
    plot.note = lightNote(hair);
    shown.plots.push_back(std::move(plot));
    shown.parameters = parametersOf(model.parameters());
    shown.parameters.push_back(light(hair));
    return shown;
}

Result<Shown> marschnerN(const ShownHair& hair) {
    const shading::MarschnerParameters model = fibreOf(hair, render::ShadingModel::marschner).marschner;
    const double thetaD = std::abs(hair.inclinationDegrees) * kDegree;
    const shading::AzimuthalProfile::Grid grid = shading::AzimuthalProfile(model.azimuthal, thetaD).grid();
    static_assert(shading::AzimuthalProfile::kGridSize == 181, "a degree a step");
    const auto at = [](const auto& row, double phi) {
        return static_cast<double>(row[static_cast<std::size_t>(std::lround(std::abs(phi)))]);
    };
    Shown shown;
    Plot plot = azimuthalPlot("Marschner: N around the fibre", "N", "1/rad");
    plot.series.push_back(curve("R", "#000000", -180, 180, 1, [&](double phi) { return at(grid.r, phi); }));
    constexpr std::array kChannels{"red", "green", "blue"};
    constexpr std::array kColours{"#d62728", "#2ca02c", "#1f77b4"};
    for (std::size_t c = 0; c < 3; ++c) {
        plot.series.push_back(curve(std::string("TT ") + kChannels[c], kColours[c], -180, 180, 1,
                                    [&](double phi) { return at(grid.tt[c], phi); }));
    }
    for (std::size_t c = 0; c < 3; ++c) {
        plot.series.push_back(curve(std::string("TRT ") + kChannels[c], kColours[c], -180, 180, 1,
                                    [&](double phi) { return at(grid.trt[c], phi); }));
        plot.series.back().line = LineStyle::Dashed;
    }
    plot.note = "At |θ_d| = " + std::to_string(std::lround(std::abs(hair.inclinationDegrees))) +
                "°. 0 is back towards the light.";
    shown.plots.push_back(std::move(plot));
    shown.parameters = parametersOf(model);
    shown.parameters.push_back(light(hair));
    return shown;
}

Result<Shown> sadeghiM(const ShownHair& hair) {
    const shading::SadeghiParameters model = fibreOf(hair, render::ShadingModel::sadeghi).sadeghi;
    const shading::SadeghiLongitudinal m(model);
    Shown shown;
    Plot plot = longitudinalPlot("Sadeghi: M' along the fibre", "M'", "");
    addM(plot, hair.inclinationDegrees, [&](Lobe lobe, double in, double out) { return m(lobe, in, out); });
    plot.note = lightNote(hair) +
                (model.bounded ? " Bounded by the light that meets the fibre." : " As published (Eq. 52).");
    shown.plots.push_back(std::move(plot));
    shown.parameters = parametersOf(model);
    shown.parameters.push_back(light(hair));
    return shown;
}

Result<Shown> sadeghiN(const ShownHair& hair) {
    const shading::SadeghiParameters model = fibreOf(hair, render::ShadingModel::sadeghi).sadeghi;
    Shown shown;
    Plot plot = azimuthalPlot("Sadeghi: N' around the fibre", "N'", "");
    for (const Lobe lobe : shading::kLobes) {
        const std::size_t p = shading::index(lobe);
        plot.series.push_back(curve(kLobeNames[p], paletteColour(p), -180, 180, 1, [&](double phi) {
            return shading::sadeghiAzimuthal(model, lobe, phi * kDegree, kGlintPlace);
        }));
    }
    plot.note = "Glints of a strand halfway between the nearest and the farthest.";
    shown.plots.push_back(std::move(plot));
    shown.parameters = parametersOf(model);
    shown.parameters.push_back({"glint_place", {kGlintPlace}});
    return shown;
}

std::vector<ShownNumber> parametersOf(const shading::MarschnerParameters& model) {
    const shading::AzimuthalParameters& a = model.azimuthal;
    const auto degreesOf = [](const std::array<double, 3>& angles) {
        return std::vector<double>{angles[0] / kDegree, angles[1] / kDegree, angles[2] / kDegree};
    };
    return {{"index_of_refraction", {a.ior}},
            {"absorption_per_radius", {a.absorption.x(), a.absorption.y(), a.absorption.z()}},
            {"azimuthal_width_deg", {a.width / kDegree}},
            {"axis_ratio", {a.axisRatio}},
            {"caustic_width_deg", {a.causticWidth / kDegree}},
            {"caustic_fade", {a.causticFade}},
            {"caustic_intensity", {a.glint}},
            {"cubic", {a.roots == shading::RootMethod::Cubic ? 1.0 : 0.0}},
            {"tilt_deg", degreesOf(model.tilt)},
            {"width_deg", degreesOf(model.width)},
            {"intensity", {model.intensity[0], model.intensity[1], model.intensity[2]}}};
}

std::vector<ShownNumber> parametersOf(const shading::SadeghiParameters& model) {
    std::vector<double> shifts, widths, intensities;
    for (const Lobe lobe : shading::kLobes) {
        shifts.push_back(model.lobe(lobe).shift / kDegree);
        widths.push_back(model.lobe(lobe).width / kDegree);
        intensities.push_back(model.lobe(lobe).intensity);
    }
    return {{"shift_deg", shifts},
            {"width_deg", widths},
            {"intensity", intensities},
            {"tt_azimuthal_width_deg", {model.ttAzimuthalWidth / kDegree}},
            {"glint_intensity", {model.glintIntensity}},
            {"glint_width_deg", {model.glintWidth / kDegree}},
            {"glint_range_deg", {model.glintNear / kDegree, model.glintFar / kDegree}},
            {"bounded", {model.bounded ? 1.0 : 0.0}}};
}

}  // namespace hairloom
