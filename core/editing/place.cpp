// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/place.h"

#include <algorithm>
#include <cmath>

#include "core/editing/delta_command.h"
#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/geometry/placement.h"

namespace hairloom::editing {
namespace {

double maskedShare(const Groom& groom, const FaceSet& region) {
    const auto area = [&](const FaceSet& faces) {
        return maskedArea(*groom.scalp, faces, groom.scalpDensity);
    };
    const double whole = area(groom.scalpSelection);
    return whole > 0 ? area(region) / whole : 0;
}

/// Strands that a placement takes away.
std::vector<std::uint32_t> strandsToReplace(const Groom& groom, const FaceSet& region) {
    std::vector<std::uint32_t> strands;
    if (region.empty()) {
        for (std::uint32_t s = 0; s < groom.strandCount(); ++s) strands.push_back(s);
        return strands;
    }
    const auto triangles = groom.strandAttributes.view<std::uint32_t>(attribute::kRootTriangle);
    std::vector<std::uint8_t> inside(groom.scalp->triangleCount(), 0);
    for (const std::uint32_t face : region) inside[face] = 1;
    for (std::uint32_t s = 0; s < groom.strandCount(); ++s) {
        if (s < triangles.size() && inside[triangles[s]]) strands.push_back(s);
    }
    return strands;
}

Status checkRegion(const Groom& groom, const FaceSet& region) {
    if (!groom.scalp) return fail("there is no head to place hair on", "open or import one first");
    if (groom.scalpSelection.empty())
        return fail("no face of the head is selected", "select the scalp first");
    if (std::includes(groom.scalpSelection.begin(), groom.scalpSelection.end(), region.begin(), region.end()))
        return {};
    return fail("the region reaches beyond the scalp selection", "expected only selected faces");
}

}  // namespace

Result<std::vector<SurfacePoint>> placeRoots(const Groom& groom, const PlaceRequest& request) {
    if (auto status = checkRegion(groom, request.region); !status) return tl::unexpected(status.error());
    const FaceSet& faces = request.region.empty() ? groom.scalpSelection : request.region;
    PlacementRequest wanted;
    wanted.densityPerCm2 = static_cast<double>(groom.placement.densityPerCm2);
    wanted.count = groom.placement.count;
    wanted.mask = groom.scalpDensity;
    wanted.seed = groom.placement.seed;
    if (!request.region.empty() && wanted.densityPerCm2 == 0) {
        wanted.count = static_cast<std::size_t>(std::max(
            1.0, std::round(static_cast<double>(wanted.count) * maskedShare(groom, request.region))));
    }
    auto placed = groom.placement.placement == PlacementMethod::random
                      ? placeRandom(*groom.scalp, faces, wanted)
                      : placeDarts(*groom.scalp, faces, wanted);
    if (!placed) return tl::unexpected(placed.error());
    if (request.region.empty() || !(placed->radius > 0)) return std::move(placed->roots);
    const std::vector<std::uint32_t> going = strandsToReplace(groom, request.region);
    RootGrid staying(placed->radius);
    for (std::uint32_t s = 0; s < groom.strandCount(); ++s) {
        const bool goes = std::binary_search(going.begin(), going.end(), s);
        if (!goes && !groom.strand(s).empty()) staying.add(s, groom.strand(s)[0]);
    }
    std::erase_if(placed->roots, [&](const SurfacePoint& root) {
        return staying.anyWithin(groom.scalp->pointAt(root.triangle, root.barycentric), placed->radius);
    });
    return std::move(placed->roots);
}

Result<std::unique_ptr<Command>> place(const Groom& groom, const PlaceRequest& request, const KeepOut& skin) {
    const auto roots = placeRoots(groom, request);
    if (!roots) return tl::unexpected(roots.error());
    Model trial{groom, {}};
    constexpr float kShortestCell = 0.005f;  // metres
    const RootGrid before = gridOfRoots(trial.groom, std::max(kShortestCell, request.reach));
    std::vector<std::unique_ptr<Command>> steps;

    TakenStrands strands = makeStrands(trial.groom, before, *roots, request.reach, skin);
    Deltas removal;
    removal.strands.remove(trial.groom, strandsToReplace(trial.groom, request.region));
    for (std::size_t k = 0; k < strands.indices.size(); ++k)
        strands.indices[k] = static_cast<std::uint32_t>(trial.groom.strandCount() + k);
    if (auto command = commandOf("Place", std::move(removal))) steps.push_back(std::move(command));
    Deltas insertion;
    insertion.strands.insert(trial.groom, strands);
    if (auto command = commandOf("Place", std::move(insertion))) steps.push_back(std::move(command));
    if (steps.empty()) return fail("no root was placed", "use a larger region or density");
    auto triangulation =
        triangulateRoots(*trial.groom.scalp, trial.groom.scalpSelection, trial.groom.rootBindings());
    if (triangulation) trial.groom.triangulation = std::move(*triangulation);

    auto whole = std::make_unique<CommandGroup>("Place", std::move(steps), true);
    whole->exchange(trial);
    whole->setRecord(recordOf("place", {{"region", runsOf(request.region)},
                                        {"reach", readableDecimal(request.reach)},
                                        {"collide", skin.query != nullptr},
                                        {"clearance", readableDecimal(skin.clearance)}}));
    return whole;
}

// --- As operations of a script ---

namespace {

MakeCommand readPlace(JsonReader& reader) {
    PlaceRequest request;
    request.region = readRuns(reader, "region");
    request.reach = static_cast<float>(reader.number("reach", 0, 10, "m"));
    const bool collide = reader.boolean("collide");
    const auto clearance = static_cast<float>(reader.number("clearance", 0, 0.01, "m"));
    return [request, collide, clearance](const Document& document) -> CommandResult {
        return place(document.groom(), request, KeepOut{collide ? document.skinField() : nullptr, clearance});
    };
}

constexpr RecordedOperation kPlaceRecords[] = {
    {"place", readPlace},
};

}  // namespace

RecordList placeRecords() {
    return kPlaceRecords;
}

}  // namespace hairloom::editing
