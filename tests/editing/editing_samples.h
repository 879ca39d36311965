// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the tests of this room share.

#include "core/editing/brush_list.h"
#include "core/editing/document.h"
#include "core/editing/replay.h"
#include "core/geometry/curve.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "tests/groom/groom_samples.h"

namespace hairloom::editing {

inline constexpr float kHeadRadius = 0.09f;
inline const Vec3f kHeadCentre(0, 1.6f, 0);

/// Straight hair of 12 cm on the upper half of a sphere.
inline Groom hairOnHead(std::size_t strands = 300, std::uint32_t points = 16) {
    return straightHair(sphereScalp(kHeadRadius, 4, kHeadCentre), strands, points, 0.12f);
}

/// A stroke over the top of the head, at half the hair's height, from left to right.
inline Stroke strokeOverTop(std::string_view tool, float height = 0.05f) {
    Stroke stroke;
    stroke.tool = tool;
    stroke.settings.radius = 0.04f;
    stroke.settings.strength = 0.8f;
    for (int i = 0; i < 9; ++i) {
        const float angle = radians(-40.0f + 10.0f * static_cast<float>(i));
        const Vec3f out(std::sin(angle), std::cos(angle), 0.1f);
        stroke.dabs.push_back(
            dabAt(stroke.settings, kHeadCentre + out.normalized() * (kHeadRadius + height)));
    }
    return stroke;
}

/// The tools' strokes, each such that it finds something to do; with a view where the tool wants one.
inline Stroke strokeFor(std::string_view tool) {
    const bool onSkin = tool == "delete" || tool == "add" || tool == "scalp_paint" ||
                        tool == "density_paint" || tool == "part" || tool == "slide";
    Stroke stroke = strokeOverTop(tool, onSkin ? 0.0f : 0.05f);
    stroke.settings.invert = tool == "scalp_paint";  // all that it reaches is selected already
    if (tool == "cut_line") {
        stroke.settings.depth = 0.3f;
        for (Dab& dab : stroke.dabs) dab.direction_ss = -Vec3f::UnitZ();
    }
    return stroke;
}

inline std::vector<float> segmentLengths(const Groom& groom) {
    std::vector<float> lengths;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto points = groom.strand(s);
        for (std::size_t p = 1; p < points.size(); ++p) lengths.push_back((points[p] - points[p - 1]).norm());
    }
    return lengths;
}

/// Nearest that any point but the roots comes to the skin, metres; negative inside.
inline float nearestToSkin(const Groom& groom) {
    const Skin skin(groom.scalp);
    float nearest = 1;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (const Vec3f& point : groom.strand(s).subspan(1))
            nearest = std::min(nearest, skin.at(point).distance);
    }
    return nearest;
}

/// The strand whose root is nearest to the top, in a document of its own.
struct TopStrand {
    Document document{hairOnHead()};
    std::uint32_t strand = 0;

    TopStrand() {
        for (std::uint32_t s = 0; s < document.groom().strandCount(); ++s) {
            if (document.groom().strand(s)[0].y() > document.groom().strand(strand)[0].y()) strand = s;
        }
    }
    std::span<const Vec3f> points() const { return document.groom().strand(strand); }
    float length() const { return polylineLength(points()); }
    Stroke at(std::string_view tool, std::initializer_list<Vec3f> places, float radius = 0.015f) const {
        Stroke stroke;
        stroke.tool = tool;
        stroke.settings.radius = radius;
        stroke.settings.strength = 1;
        for (const Vec3f& place : places) stroke.dabs.push_back(dabAt(stroke.settings, place));
        return stroke;
    }
};

/// The document's script makes of hairOnHead() what the document has become of it.
inline void expectScriptMakesTheSame(const Document& document) {
    const auto text = document.script();
    ASSERT_TRUE(text) << text.error().message();
    const auto script = parseScript("s.json", *text, scriptExtensions());
    ASSERT_TRUE(script) << script.error().message();
    Groom scripted = hairOnHead();
    const auto run = runScript(*script, scripted);
    ASSERT_TRUE(run) << run.error().message();
    EXPECT_EQ(contentHash(scripted), contentHash(document.groom()));
}

}  // namespace hairloom::editing
