// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/sample_hair.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "core/cost/benchmark_scenes.h"
#include "core/documents/open.h"
#include "core/documents/sample.h"
#include "core/geometry/curve.h"
#include "core/simulation/scene_input.h"
#include "importers/child_process.h"

namespace hairloom::benchmarks {
namespace {

constexpr std::string_view kMany = "100000x16";

double meanLength(const Groom& groom) {
    double sum = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) sum += polylineLength(groom.strand(s));
    return sum / static_cast<double>(groom.strandCount());
}

Result<std::vector<Sample>> makeSamples() {
    const auto folder = sampleFolder();
    if (!folder) return tl::unexpected(folder.error());
    std::vector<Sample> made;
    // Those that have been measured since the beginning, so that rows can be compared.
    for (const std::string name : {"long", "short", "shoulder"}) {
        auto groom = makeSample(*folder, name);
        if (!groom) return tl::unexpected(groom.error());
        made.push_back({name + " sample", std::move(*groom)});
    }
    std::ranges::sort(made, {}, [](const Sample& sample) { return meanLength(sample.groom); });
    return made;
}

Result<Sample> hairNamed(const std::string& name) {
    if (name == kMany) return manyHairs();
    if (std::filesystem::exists(name)) {
        auto opened = openGroom(name);
        if (!opened) return tl::unexpected(opened.error());
        return Sample{name, std::move(*opened)};
    }
    const auto& known = samples();
    if (!known) return tl::unexpected(known.error());
    const auto sample = std::ranges::find(*known, name + " sample", &Sample::name);
    if (sample == known->end())
        return fail(fmt::format("there is no hairstyle '{}'", name),
                    "expected a sample, a file, or 100000x16");
    return *sample;
}

class NoddingHair : public MovingStrands {
  public:
    NoddingHair(SceneInput scene, std::unique_ptr<HeadMotion> motion)
        : scene_(std::move(scene)), motion_(std::move(motion)) {}

    runtime::StrandsView view() const override { return scene_.strands(); }
    void move(double time, std::vector<runtime::RootFrame>& roots,
              std::vector<runtime::Sphere>& spheres) const override {
        const HeadPose pose = motion_->poseAt(static_cast<float>(time));
        roots = scene_.rootsAt(pose);
        spheres = scene_.spheresAt(pose);
    }

  private:
    SceneInput scene_;
    std::unique_ptr<HeadMotion> motion_;
};

}  // namespace

Result<std::filesystem::path> sampleFolder() {
    auto folder = findSamples(programFolder());
    if (folder.empty())
        return fail("the sample hairstyles are not beside this program",
                    "expected the environment variable HAIRLOOM_SAMPLES to name their folder");
    return folder;
}

const Result<std::vector<Sample>>& samples() {
    static const Result<std::vector<Sample>> made = makeSamples();
    return made;
}

Sample manyHairs() {
    const scenes::HeadOfHair head(10'000, 16);
    std::vector<Vec3f> positions;
    for (const runtime::Float3& p : head.positions) positions.emplace_back(p.x, p.y, p.z);
    Groom groom = makeGroom(head.offsets, std::move(positions));
    for (const runtime::Sphere& sphere : head.spheres) {
        CollisionSphere placed;
        placed.centre = {sphere.center_ws.x, sphere.center_ws.y, sphere.center_ws.z};
        placed.radius = sphere.radius;
        groom.spheres.push_back(placed);
    }
    groom.interpolation.followPerGuide = 10;
    return {std::string(kMany), std::move(groom)};
}

Result<std::vector<Sample>> wantedHair(const Options& options) {
    if (options.grooms.empty()) return samples();
    std::vector<Sample> hair;
    for (const std::string& name : options.grooms) {
        auto found = hairNamed(name);
        if (!found) return tl::unexpected(found.error());
        hair.push_back(std::move(*found));
    }
    return hair;
}

Result<std::unique_ptr<MovingStrands>> nodding(const Groom& groom) {
    auto scene = SceneInput::make(groom);
    if (!scene) return tl::unexpected(scene.error());
    auto motion = makeRigidMotion("nod", groom);
    if (!motion) return tl::unexpected(motion.error());
    return std::make_unique<NoddingHair>(std::move(*scene), std::move(*motion));
}

}  // namespace hairloom::benchmarks
