// SPDX-License-Identifier: GPL-3.0-or-later
// Dabs, strokes, undo and picking, of every brush: on the samples along the middles of strands, then on
// combedHair(). A dab has a radius of 2 cm. Times are those of what the name says alone; bench_window has
// them as a person waits for them.

#include <cmath>

#include "benchmarks/combed_hair.h"
#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "core/editing/brush_list.h"
#include "core/editing/document.h"
#include "core/editing/picking.h"

namespace hairloom::benchmarks {
namespace {

using editing::Document;
using editing::Stroke;

constexpr int kDabs = 24;

/// From ear to ear over the crown.
std::vector<Vec3f> overTheCrown() {
    std::vector<Vec3f> points;
    for (int i = 0; i < kDabs; ++i) points.push_back(onCombedHair(-60.0f + 5.0f * static_cast<float>(i)));
    return points;
}

/// The middles of strands that are spread over all.
std::vector<Vec3f> throughTheHair(const Groom& groom) {
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < kDabs; ++i) {
        const auto strand = groom.strand(i * groom.strandCount() / kDabs);
        points.push_back(strand[strand.size() / 2]);
    }
    return points;
}

Stroke strokeOf(std::string_view tool, const std::vector<Vec3f>& points) {
    Stroke stroke;
    stroke.tool = tool;
    if (tool == "cut_line") stroke.settings.depth = 0.05f;
    if (tool == "add") stroke.settings.parameters["density"] = 500;  // twice what combedHair() has
    for (const Vec3f& point : points) {
        stroke.dabs.push_back(editing::dabAt(stroke.settings, point));
        if (tool == "cut_line") stroke.dabs.back().direction_ss = -Vec3f::UnitZ();
    }
    return stroke;
}

/// One dab after the other of a stroke that is begun anew when it ends; what skin there is to measure is
/// measured before.
Status dab(Rounds& rounds, Document& document, const Stroke& stroke) {
    static_cast<void>(document.replay(stroke));
    document.undo();
    std::size_t next = 0;
    if (auto begun = document.beginStroke(stroke); !begun) return begun;
    while (rounds.next()) {
        keep(document.dab(stroke.dabs[next]));
        if (++next < stroke.dabs.size()) continue;
        rounds.pause();
        next = 0;
        document.cancelStroke();
        if (auto begun = document.beginStroke(stroke); !begun) return begun;
        rounds.resume();
    }
    document.cancelStroke();
    return {};
}

Status undoStroke(Rounds& rounds, Document& document, const Stroke& stroke) {
    static_cast<void>(document.replay(stroke));
    while (rounds.next()) {
        keep(document.undo());
        rounds.pause();
        document.redo();
        rounds.resume();
    }
    document.undo();
    return {};
}

Status pickOneStrand(Rounds& rounds, Document& document) {
    const Vec3f eye(0, 0.05f, 0.8f);
    Mat4f view = Mat4f::Identity();
    view.topRightCorner<3, 1>() = -eye;
    Mat4f projection = Mat4f::Zero();
    const float scale = 1 / std::tan(radians(12.0f));
    projection(0, 0) = scale * 9 / 16;
    projection(1, 1) = scale;
    projection(2, 2) = -1.01f;
    projection(2, 3) = -0.101f;
    projection(3, 2) = -1;
    const editing::View seen(view, projection, Vec2f(1920, 1080));
    document.bounds();
    document.surface();
    float x = 700;
    while (rounds.next()) {
        keep(editing::pickStrand(document.groom(), document.bounds(), document.surface(), seen,
                                 Vec2f(x, 400)));
        x = x < 1200 ? x + 7 : 700;
    }
    return {};
}

void measureHair(Timings& timings, const std::string& name, const Groom& groom,
                 const std::vector<Vec3f>& points) {
    Document document(groom);
    for (const std::string_view tool : editing::brushNames()) {
        const Stroke stroke = strokeOf(tool, points);
        timings.measure(std::string(tool) + ", a dab, " + name,
                        [&](Rounds& rounds) { return dab(rounds, document, stroke); });
        timings.measure(std::string(tool) + ", undo of a stroke, " + name,
                        [&](Rounds& rounds) { return undoStroke(rounds, document, stroke); });
    }
}

Result<Outcome> runBrush(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    Timings timings(options);
    for (const Sample& sample : *hairstyles)
        measureHair(timings, sample.name, sample.groom, throughTheHair(sample.groom));
    const Groom combed = combedHair();
    measureHair(timings, "100,000 strands of 16 points", combed, overTheCrown());
    Document document(combed);
    timings.measure("picking a strand, 100,000 strands of 16 points",
                    [&](Rounds& rounds) { return pickOneStrand(rounds, document); });
    return timings.outcome("brush");
}

}  // namespace

Benchmark brushBenchmark() {
    return {"brush", "dabs, strokes, undo and picking", {"--quick"}, runBrush};
}

}  // namespace hairloom::benchmarks
