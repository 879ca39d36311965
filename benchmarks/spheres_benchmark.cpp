// SPDX-License-Identifier: GPL-3.0-or-later
// A hierarchy of bubbles beside the engine's lists of near spheres, by the number of spheres.

#include <fmt/format.h>

#include <cmath>

#include "benchmarks/measurement.h"
#include "core/charts/plot.h"
#include "core/cost/machine.h"
#include "core/cost/sphere_tree.h"
#include "core/cost/step_cost.h"

namespace hairloom::benchmarks {
namespace {

using runtime::Float3;
using runtime::Sphere;

constexpr std::uint32_t kStrands = 300, kPointsEach = 16;

/// A body of that many spheres: a head, and the others over the shoulders, which they cover alike however
/// many they are.
std::vector<Sphere> bodyOf(std::uint32_t count) {
    std::vector<Sphere> spheres{{{0.0f, 0.0f, 0.0f}, 0.088f}};
    const auto others = static_cast<float>(count - 1);
    for (std::uint32_t i = 0; i + 1 < count; ++i) {
        const float height = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / others;
        const float turn = static_cast<float>(i) * scenes::HeadOfHair::kGoldenTurn;
        const float ring = std::sqrt(1.0f - height * height);
        spheres.push_back(
            {{0.2f * ring * std::cos(turn), -0.24f + 0.08f * height, 0.12f * ring * std::sin(turn)},
             0.16f / std::sqrt(others)});
    }
    return spheres;
}

class HeadWithBody : public MovingStrands {
  public:
    explicit HeadWithBody(std::vector<Sphere> spheres)
        : head_(kStrands, kPointsEach), spheres_(std::move(spheres)) {}
    runtime::StrandsView view() const override { return head_.view(); }
    void move(double time, std::vector<runtime::RootFrame>& roots,
              std::vector<Sphere>& spheres) const override {
        head_.placeRoots(time, roots);
        spheres = spheres_;
    }

  private:
    scenes::HeadOfHair head_;
    std::vector<Sphere> spheres_;
};

struct Row {
    std::uint32_t spheres = 0;
    Measurement all, tree, build;        ///< µs that a pass over all points takes
    Measurement springs, rods;           ///< ms that a frame takes
    std::size_t touches = 0, found = 0;  ///< pairs that a pass finds by either
};

runtime::SimulationSettings settingsOf(runtime::StrandModel model) {
    return scenes::settingsFor(scenes::ActiveForces::windAndSpheres, model);
}

class Bench {
  public:
    explicit Bench(const Options& options) : options_(options) {
        counts_ = {3, 10, 30, 100, 300, 1000, 3000};
        if (options.quick) counts_ = {3, 30}, seconds_ = 0.02;
    }

    Outcome run() {
        for (const std::uint32_t count : counts_) {
            rows_.push_back(measure(count));
            if (options_.progress) options_.progress("spheres", rows_.size(), counts_.size());
        }
        Report rows = Report::array();
        for (const Row& row : rows_) {
            for (const Measurement* one : {&row.all, &row.tree, &row.build, &row.springs, &row.rods})
                rows.push_back(rowOf(*one));
        }
        return {Report{{"name", "spheres"}, {"rows", std::move(rows)}},
                {},
                {{"spheres.md", markdown()}, {"spheres.svg", figure()}}};
    }

  private:
    template <class Work>
    Measurement repeated(std::string name, std::string unit, double factor, const Work& work) const {
        Measurement result{std::move(name), std::move(unit), {}};
        for (int r = 0; r < options_.repetitions.value_or(5); ++r) {
            Rounds rounds(seconds_);
            while (rounds.next()) work();
            result.values.push_back(factor * rounds.milliseconds());
        }
        return result;
    }

    Measurement engine(std::uint32_t count, runtime::StrandModel model, const char* name) const {
        StepRun run(std::make_unique<HeadWithBody>(bodyOf(count)), settingsOf(model), false);
        const std::uint32_t frames = run.framesFor(seconds_);
        Measurement result{fmt::format("{}, {} spheres, frame", name, count), "ms", {}};
        for (int r = 0; r < options_.repetitions.value_or(5); ++r)
            result.values.push_back(run.milliseconds(frames));
        return result;
    }

    Row measure(std::uint32_t count) const {
        Row row;
        row.spheres = count;
        const scenes::HeadOfHair head(kStrands, kPointsEach);
        const std::vector<Sphere> spheres = bodyOf(count);
        row.all = repeated(fmt::format("every sphere, {} spheres, pass", count), "µs", 1e3, [&] {
            row.touches = 0;
            for (const Float3& p : head.positions) {
                for (const Sphere& sphere : spheres) {
                    const Float3 from = p - sphere.center_ws;
                    row.touches += dot(from, from) < sphere.radius * sphere.radius ? 1 : 0;
                }
            }
            keep(row.touches);
        });
        row.build = repeated(fmt::format("hierarchy, {} spheres, build", count), "µs", 1e3,
                             [&] { keep(SphereTree(spheres).nodeCount()); });
        const SphereTree tree(spheres);
        std::vector<std::uint32_t> found;
        row.tree = repeated(fmt::format("hierarchy, {} spheres, pass", count), "µs", 1e3, [&] {
            row.found = 0;
            for (const Float3& p : head.positions) {
                found.clear();
                tree.find(p, 0.0f, found);
                row.found += found.size();
            }
            keep(row.found);
        });
        row.springs = engine(count, runtime::StrandModel::springs, "springs, near lists");
        row.rods = engine(count, runtime::StrandModel::rods, "rods, touchable lists");
        return row;
    }

    std::string markdown() const {
        std::string text = fmt::format(
            "{} strands of {} points on a turning head, one thread of a {}. A pass tests all points once, in "
            "microseconds; a frame is the whole engine, in milliseconds, with {} substeps of springs and {} "
            "of "
            "rods. `{}`\n\n| spheres | every sphere | hierarchy | its build | springs, frame | rods, frame "
            "|\n|---|---|---|---|---|---|\n",
            kStrands, kPointsEach, thisMachine().processor,
            settingsOf(runtime::StrandModel::springs).substeps,
            settingsOf(runtime::StrandModel::rods).substeps, options_.commandLine);
        for (const Row& row : rows_)
            text += fmt::format("| {} | {:.0f} | {:.0f} | {:.1f} | {:.2f} | {:.2f} |\n", row.spheres,
                                row.all.median(), row.tree.median(), row.build.median(), row.springs.median(),
                                row.rods.median());
        return text;
    }

    std::string figure() const {
        Plot plot;
        plot.title = "Finding spheres";
        plot.note = fmt::format("{} points, one pass, one thread", kStrands * kPointsEach);
        plot.x = {.title = "spheres", .scale = Scale::Logarithmic};
        plot.y = {.title = "time", .unit = "µs", .scale = Scale::Logarithmic};
        Series all{.name = "every sphere", .marker = Marker::Circle, .line = LineStyle::Solid};
        Series tree{.name = "hierarchy", .marker = Marker::Square, .line = LineStyle::Solid};
        for (const Row& row : rows_) {
            all.points.push_back({static_cast<double>(row.spheres), row.all.median()});
            tree.points.push_back({static_cast<double>(row.spheres), row.tree.median()});
        }
        plot.series = {std::move(all), std::move(tree)};
        return svg(plot);
    }

    const Options& options_;
    double seconds_ = 0.1;
    std::vector<std::uint32_t> counts_;
    std::vector<Row> rows_;
};

Result<Outcome> runSpheres(const Options& options) {
    return Bench(options).run();
}

}  // namespace

Benchmark spheresBenchmark() {
    return {
        "spheres", "a hierarchy of spheres beside lists of near ones", {"--quick", "--output"}, runSpheres};
}

}  // namespace hairloom::benchmarks
