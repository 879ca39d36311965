// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/validate.h"

#include <algorithm>
#include <cmath>

#include "core/groom/file/fields.h"
#include "core/groom/findings.h"
#include "core/groom/poses.h"
#include "core/groom/spheres.h"
#include "core/groom/time_line.h"

namespace hairloom {
namespace {

void findSpheres(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    for (const CollisionSphere& sphere : groom.spheres) {
        const bool good = sphere.centre.allFinite() && std::isfinite(sphere.radius) && sphere.radius > 0;
        if (!good) places.named(fmt::format("sphere '{}' (radius {} m)", sphere.name, sphere.radius));
    }
    places.report(findings, Severity::Error,
                  "a collision sphere has no finite position or no positive radius",
                  "delete the sphere or set its centre and radius");
    Places joints;
    for (std::size_t s = 0; s < groom.spheres.size(); ++s) {
        const std::int32_t joined = groom.spheres[s].joined;
        if (joined < 0) continue;
        const auto other = static_cast<std::size_t>(joined);
        if (other >= groom.spheres.size() || other == s)
            joints.named(fmt::format("sphere '{}' (joined to sphere {} of {})", groom.spheres[s].name, joined,
                                     groom.spheres.size()));
    }
    joints.report(findings, Severity::Error, "a capsule has no second sphere",
                  "join the sphere to another one, or to none");
    const std::size_t capsules = capsulesOf(groom.spheres).size();
    if (capsules > runtime::kMaxCapsules)
        findings.push_back({Severity::Error, fmt::format("there are {} capsules", capsules), "spheres",
                            fmt::format("use at most {}", runtime::kMaxCapsules)});
}

void findLayers(const Groom& groom, std::vector<Finding>& findings) {
    if (!groom.layers.empty()) return;
    findings.push_back(
        {Severity::Error, "there are no layers", "layers", "add one; every groom has at least one"});
}

void findWeights(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    for (std::size_t i = 0; i < groom.operators.size(); ++i) {
        if (!withinRange(static_cast<double>(groom.operators[i].weight), 0, 1)) places.other("operator", i);
    }
    places.report(findings, Severity::Error, "the weight of an operator is not within 0 to 1",
                  "set it within its range");
    if (groom.operators.size() > kMaxOperators)
        findings.push_back({Severity::Error, fmt::format("there are {} operators", groom.operators.size()),
                            "operators", fmt::format("keep at most {}", kMaxOperators)});
}

void findSettings(const Groom& groom, std::vector<Finding>& findings) {
    const auto report = [&](std::string_view which, const std::vector<std::string>& problems) {
        for (const std::string& problem : problems) {
            findings.push_back({Severity::Error, problem, std::string(which), "set it within its range"});
        }
    };
    report("material", fieldsOutOfRange(groom.material));
    for (const Layer& layer : groom.layers) {
        const std::string which = "layer " + layer.name;
        if (layer.material) report(which, fieldsOutOfRange(*layer.material));
        if (withinRange(static_cast<double>(layer.density), 0, static_cast<double>(kMaxLayerDensity)))
            continue;
        report(which, {fmt::format("its density is {}; expected 0 to {}", layer.density, kMaxLayerDensity)});
    }
    report("shadows", fieldsOutOfRange(groom.shadows));
    report("interpolation", fieldsOutOfRange(groom.interpolation));
    report("placement", fieldsOutOfRange(groom.placement));
    report("simulation", runtime::validate(groom.simulation));
}

void findTimeLine(const Groom& groom, std::vector<Finding>& findings) {
    for (const TimeLineProblem& problem : problemsOf(timeLineOf(groom)))
        findings.push_back({Severity::Error, problem.what, "time_line/" + problem.where, problem.expected});
}

void findPoses(const Groom& groom, std::vector<Finding>& findings) {
    for (Finding& problem : findPoseProblems(groom)) findings.push_back(std::move(problem));
}

}  // namespace

std::string_view severityName(Severity severity) {
    switch (severity) {
        case Severity::Info:
            return "info";
        case Severity::Warning:
            return "warning";
        case Severity::Error:
            break;
    }
    return "error";
}

std::vector<Finding> validateSettings(const Groom& groom) {
    std::vector<Finding> findings;
    findLayers(groom, findings);
    findSpheres(groom, findings);
    findWeights(groom, findings);
    findSettings(groom, findings);
    findTimeLine(groom, findings);
    findPoses(groom, findings);
    return findings;
}

std::vector<Finding> validate(const Groom& groom) {
    std::vector<Finding> findings = validateSettings(groom);
    if (!findStructure(groom, findings)) return findings;
    findGeometry(groom, findings);
    findBinding(groom, findings);
    return findings;
}

Status checkStructure(const Groom& groom) {
    std::vector<Finding> findings;
    if (findStructure(groom, findings)) return {};
    return fail(fmt::format("{} ({})", findings.front().what, findings.front().where), findings.front().fix);
}

bool hasErrors(const std::vector<Finding>& findings) {
    return std::any_of(findings.begin(), findings.end(),
                       [](const Finding& finding) { return finding.severity == Severity::Error; });
}

}  // namespace hairloom
