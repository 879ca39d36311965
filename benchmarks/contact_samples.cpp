// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/contact_rows.h"
#include "benchmarks/sample_hair.h"
#include "core/documents/motions.h"
#include "core/documents/sample.h"
#include "core/groom/strand_subset.h"
#include "core/simulation/simulation.h"
#include "core/stability/certificate.h"
#include "importers/child_process.h"

namespace hairloom::benchmarks {
namespace {

constexpr double kMmPerMetre = 1000;

/// m/s of each strand's fastest point.
std::vector<float> speedsOf(const Groom& groom, const Simulation& simulation) {
    const std::vector<Vec3f> velocities = simulation.velocities_ws();
    std::vector<float> speeds(groom.strandCount());
    for (std::size_t s = 0; s < speeds.size(); ++s) {
        for (std::uint32_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p)
            speeds[s] = std::max(speeds[s], velocities[p].norm());
    }
    return speeds;
}
double countAbove(const std::vector<float>& speeds, float limit) {
    return static_cast<double>(std::ranges::count_if(speeds, [&](float speed) { return !(speed <= limit); }));
}

class OfSample {
  public:
    OfSample(std::string name, const Groom& groom, bool quick)
        : name_(std::move(name)), groom_(groom), quick_(quick) {}

    Status still(std::vector<ContactRow>& rows) const {
        auto simulation = Simulation::make(groom_, {});
        if (!simulation) return tl::unexpected(simulation.error());
        const int second = quick_ ? 2 : 60;
        for (int f = 0; f < 5 * second; ++f) simulation->step(runtime::kUsualFrame, HeadPose{});
        rows.push_back({fmt::format("{} at rest, strands above 1 mm/s after 5 s", name_),
                        countAbove(speedsOf(groom_, *simulation), 0.001f), "", 0,
                        "strands that lie on folds of the skin"});
        for (int f = 0; f < 5 * second; ++f) simulation->step(runtime::kUsualFrame, HeadPose{});
        rows.push_back({fmt::format("{} at rest, strands awake after 10 s", name_),
                        static_cast<double>(groom_.strandCount() - simulation->stats().restingStrands), "", 0,
                        "strands that lie on folds of the skin"});
        return {};
    }

    /// A sphere of 5 cm comes down from 15 cm above the scalp in a second, and lies on it.
    Status sphereOnTop(std::vector<ContactRow>& rows) const {
        auto simulation = Simulation::make(groom_, {});
        if (!simulation) return tl::unexpected(simulation.error());
        constexpr float kRadius = 0.05f, kAbove = 0.005f;
        Vec3f top = groom_.strand(0).front();
        for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
            if (groom_.strand(s).front().y() > top.y()) top = groom_.strand(s).front();
        }
        const int second = quick_ ? 2 : 60;
        std::vector<Vec3f> last;
        float jump = 0;
        for (int f = 1; f <= 7 * second; ++f) {
            const float left = std::max(0.0f, 1.0f - static_cast<float>(f) / static_cast<float>(second));
            std::vector<CollisionSphere> spheres = groom_.spheres;
            spheres.push_back({"hand", top + Vec3f(0, kRadius + kAbove + 0.1f * left, 0), kRadius, {}, -1});
            simulation->setSpheres(std::move(spheres));
            simulation->step(runtime::kUsualFrame, HeadPose{});
            const auto now = simulation->positions_ws();
            for (std::size_t p = 0; f > 6 * second && p < now.size(); ++p)
                jump = std::max(jump, (now[p] - last[p]).norm());
            last.assign(now.begin(), now.end());
        }
        rows.push_back({fmt::format("{} under a sphere of 5 cm, strands above 5 mm/s after 6 s", name_),
                        countAbove(speedsOf(groom_, *simulation), 0.005f), "", 0,
                        "strands between the sphere and the skin"});
        rows.push_back({fmt::format("{} under it, farthest that a point goes in a frame then", name_),
                        kMmPerMetre * static_cast<double>(jump), "mm", 0.1,
                        "strands between the sphere and the skin"});
        return {};
    }

    Status storms(std::vector<ContactRow>& rows) const {
        CertificateOptions options;
        options.storms = quick_ ? 2 : 200;
        const auto tally = runStorms(groom_, options);
        if (!tally) return tl::unexpected(tally.error());
        rows.push_back({fmt::format("{}, of {} storms not calm after 15 s", name_, options.storms),
                        static_cast<double>(options.storms - tally->calmLate), "", 0,
                        "the plane in place of folded skin differs from substep to substep"});
        rows.push_back({fmt::format("{}, of {} storms failed", name_, options.storms),
                        static_cast<double>(tally->failed.size()), "", 0, "what slips off a shoulder late"});
        return {};
    }

    /// Fewer substeps and other frame rates beside many, in the clip.
    Status steps(std::vector<ContactRow>& rows) const {
        Groom some = fewStrands();
        const double seconds = quick_ ? 1.0 / 3 : 2.0;
        const auto usual = play(some, 60, seconds);
        if (!usual) return tl::unexpected(usual.error());
        const auto fine = play(some, 240, seconds);
        if (!fine) return tl::unexpected(fine.error());
        for (const int rate : {24, 30, 60, 120}) {
            if (quick_ && rate != 30) continue;
            const auto coarse = rate == 60 ? usual : play(some, rate, seconds);
            if (!coarse) return tl::unexpected(coarse.error());
            rows.push_back({fmt::format("{} in a clip, {} frames a second beside 240", name_, rate),
                            kMmPerMetre * apart(*coarse, *fine), "mm", 0.5,
                            "what slips a moment later falls to the other side"});
        }
        some.simulation.substeps = quick_ ? 4 : runtime::kMaxSubsteps;
        const auto many = play(some, 60, seconds);
        if (!many) return tl::unexpected(many.error());
        rows.push_back(
            {fmt::format("{} in a clip, default substeps beside {}", name_, some.simulation.substeps),
             kMmPerMetre * apart(*usual, *many), "mm", 1,
             "what slips a moment later falls to the other side"});
        return {};
    }

  private:
    Groom fewStrands() const {
        constexpr std::size_t kStrands = 300;
        std::vector<std::uint32_t> strands;
        const std::size_t count = std::min(kStrands, groom_.strandCount());
        for (std::size_t i = 0; i < count; ++i)
            strands.push_back(static_cast<std::uint32_t>(i * groom_.strandCount() / count));
        return strandsOf(groom_, strands);
    }

    /// Points six times a second: what all rates have in common.
    static Result<std::vector<Vec3f>> play(const Groom& groom, int rate, double seconds) {
        const auto motion = makeMotion("clip:nod_and_turn", "", groom);
        if (!motion) return tl::unexpected(motion.error());
        auto simulation = Simulation::make(groom, (*motion)->poseAt(0.0f));
        if (!simulation) return tl::unexpected(simulation.error());
        std::vector<Vec3f> points;
        const int frames = static_cast<int>(std::lround(seconds * rate));
        for (int f = 1; f <= frames; ++f) {
            const HeadPose pose = (*motion)->poseAt(static_cast<float>(f) / static_cast<float>(rate));
            simulation->step(1.0f / static_cast<float>(rate), pose);
            if (f % (rate / 6) != 0) continue;
            const auto now = simulation->positions_ws();
            points.insert(points.end(), now.begin(), now.end());
        }
        return points;
    }

    /// Root mean square, metres.
    static double apart(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
        double sum = 0;
        for (std::size_t p = 0; p < a.size(); ++p) sum += (a[p] - b[p]).cast<double>().squaredNorm();
        return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
    }

    std::string name_;
    const Groom& groom_;
    bool quick_;
};

std::vector<std::string> wantedSamples(const Options& options) {
    if (!options.grooms.empty()) return options.grooms;
    if (options.quick) return {"short"};
    return {"short", "shoulder", "long", "bob", "afro", "braid"};
}

}  // namespace

std::size_t contactStepsOfSamples(const Options& options) {
    return 5 * wantedSamples(options).size();
}

Result<std::vector<ContactRow>> contactsOfSamples(const Options& options, const std::function<void()>& next) {
    const auto folder = sampleFolder();
    if (!folder) return tl::unexpected(folder.error());
    std::vector<ContactRow> rows;
    for (const std::string& name : wantedSamples(options)) {
        const auto groom = makeSample(*folder, name, SampleColliders::skin);
        if (!groom) return tl::unexpected(groom.error());
        next();
        if (auto status = contactsAtRest(name, *groom, options.quick, rows); !status)
            return tl::unexpected(status.error());
        const OfSample sample(name, *groom, options.quick);
        for (const auto part :
             {&OfSample::still, &OfSample::sphereOnTop, &OfSample::storms, &OfSample::steps}) {
            next();
            if (auto status = (sample.*part)(rows); !status) return tl::unexpected(status.error());
        }
    }
    return rows;
}

}  // namespace hairloom::benchmarks
