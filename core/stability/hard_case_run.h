// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One run of a hard case: the engine, and what it may not do while it runs.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/stability/hard_case_engine.h"
#include "core/stability/stability.h"
#include "core/stability/strand_set.h"

namespace hairloom {

inline constexpr float kFrame = 1.0f / 60.0f;  // seconds

class HardCaseRun {
  public:
    HardCaseRun(const StabilityMethod& method, const StabilityOptions& options)
        : method_(method), options_(options) {}

    /// Starts the engine with these strands at rest. Takes the method of the trial and, where its integrator
    /// needs them for frames of `longestFrame` seconds, more substeps; rods take two.
    void start(StrandSet strands, runtime::SimulationSettings settings = {}, float longestFrame = kFrame);
    /// As start(), in the middle of a case: what was measured stays.
    void restart(StrandSet strands, runtime::SimulationSettings settings) {
        start(std::move(strands), settings);
    }

    const StabilityOptions& options() const { return options_; }
    const StabilityMethod& method() const { return method_; }
    const StrandSet& strands() const { return strands_; }
    HardCaseEngine& engine() { return *engine_; }
    /// Another one with these strands, at rest.
    std::unique_ptr<HardCaseEngine> another(const runtime::SimulationSettings& settings);
    /// As the trial runs them.
    runtime::SimulationSettings settings() const { return engine_->settings(); }
    /// Takes other settings; the substeps and integrator stay as given.
    void change(const runtime::SimulationSettings& settings);

    /// A frame with the roots and spheres of now, which stay until changed.
    void frame(float dt = kFrame);
    void frames(int count, float dt = kFrame);
    void moveRoots(runtime::Float3 shift, runtime::Quat turn = {}) { roots_ = strands_.roots(shift, turn); }
    void setRoots(std::vector<runtime::RootFrame> roots) { roots_ = std::move(roots); }
    void setSpheres(std::vector<runtime::Sphere> spheres) { spheres_ = std::move(spheres); }
    /// The roots swing along x for a second: 3 cm at 2 Hz.
    void shakeRoots();

    /// From the next frame on, points may not lie in spheres by more than 0.5 mm.
    void watchSpheres(bool on = true) { watchingSpheres_ = on; }
    /// From the next frame on nothing feeds the hair; its kinetic energy may not exceed what it was.
    void sourceEnds() { sourceEnded_ = true; }
    /// Without a source, runs until `most` seconds have passed; all speeds have to be below 5 mm/s for good
    /// before.
    void settle(double maximum = 5.0);
    /// What comes is beyond what the method claims, for this reason.
    void disclaim(const std::string& reason) {
        if (limit_.empty()) limit_ = reason;
    }

    /// Another threshold.
    void expect(const std::string& what, const std::string& unit, double worst, double threshold);
    /// Another that is about energy: not claimed by every integrator (StabilityThreshold::claimed).
    void expectEnergy(const std::string& what, const std::string& unit, double worst, double threshold);

    std::vector<runtime::Float3> positions() const;
    /// Of all points, m/s.
    double greatestSpeed() const;
    /// The case lies outside of what the integrator claims and has broken: nothing more is run.
    bool over() const { return !limit_.empty() && failedAt_.has_value(); }
    double time() const { return time_; }

    StabilityResult result() const;

  private:
    void inspect();
    void raise(const std::string& what, const std::string& unit, double value, double threshold,
               bool claimed);
    /// Whether the integrator promises rest and a bound of the energy with these settings.
    bool holdsRest() const;

    StabilityMethod method_;
    StabilityOptions options_;
    StrandSet strands_;
    std::unique_ptr<HardCaseEngine> engine_;
    std::vector<runtime::RootFrame> roots_;
    std::vector<runtime::Sphere> spheres_;
    std::vector<StabilityThreshold> thresholds_;
    std::string limit_;
    std::optional<std::uint64_t> failedAt_;
    std::uint64_t substeps_ = 0;
    double time_ = 0.0;
    double maxEnergy_ = 0.0;  ///< kinetic, while there was a source
    bool watchingSpheres_ = false;
    bool sourceEnded_ = false;
};

}  // namespace hairloom
