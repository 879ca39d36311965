// SPDX-License-Identifier: GPL-3.0-or-later
// Root placement on the samples' scalps and on a cap of about 500 cm², and repair of a mesh of 20,000
// vertices.

#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/geometry/shapes.h"

namespace hairloom::benchmarks {
namespace {

using Place = Result<Placement> (*)(const ScalpMesh&, const FaceSet&, const PlacementRequest&);

void measurePlacing(Timings& timings, const std::string& name, const ScalpMesh& mesh, const FaceSet& faces,
                    std::size_t count, Place place) {
    PlacementRequest request;
    request.count = count;
    request.seed = 1;
    timings.measure(name, [&](Rounds& rounds) -> Status {
        while (rounds.next()) {
            const auto placed = place(mesh, faces, request);
            if (!placed) return tl::unexpected(placed.error());
            keep(*placed);
        }
        return {};
    });
}

void measureCap(Timings& timings) {
    const ScalpMesh mesh = shapes::meshOf(shapes::icosphere(4, 0.09f));
    const FaceSet faces = *selectFaces(mesh, "cap:90");
    measurePlacing(timings, "at random, 100,000 roots", mesh, faces, 100'000, placeRandom);
    for (const std::size_t count : {std::size_t{10'000}, std::size_t{100'000}}) {
        const char* const name = count == 10'000 ? "by darts, 10,000 roots" : "by darts, 100,000 roots";
        measurePlacing(timings, name, mesh, faces, count, placeDarts);
    }
}

Result<Outcome> runPlace(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    Timings timings(options);
    for (const Sample& sample : *hairstyles) {
        const std::size_t roots = sample.groom.strandCount();
        measurePlacing(timings, "by darts, " + sample.name + ", " + std::to_string(roots) + " roots",
                       *sample.groom.scalp, sample.groom.scalpSelection, roots, placeDarts);
    }
    measureCap(timings);
    timings.measure("repair a mesh of 20,000 vertices", [](Rounds& rounds) -> Status {
        const PolygonSoup soup = shapes::grid(141, 1);
        while (rounds.next()) keep(ScalpMesh::make(soup));
        return {};
    });
    return timings.outcome("place");
}

}  // namespace

Benchmark placeBenchmark() {
    return {"place", "placing roots", {"--quick"}, runPlace};
}

}  // namespace hairloom::benchmarks
