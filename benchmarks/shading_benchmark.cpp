// SPDX-License-Identifier: GPL-3.0-or-later
// What a moved control of the material costs: the model and all its tables anew. It does not depend on the
// hair.

#include "benchmarks/measurement.h"
#include "core/shading/melanin.h"
#include "core/shading/tables.h"

namespace hairloom::benchmarks {
namespace {

using namespace shading;

MarschnerParameters parameters(bool rough, double axisRatio) {
    MarschnerParameters result;
    result.azimuthal.absorption = absorption({0.3, 0});
    result.azimuthal.axisRatio = axisRatio;
    if (rough) {
        result.azimuthal.width = azimuthalWidth(0.3);
        result.azimuthal.causticWidth = 0;
    }
    return result;
}

Status bake(Rounds& rounds, const MarschnerParameters& p) {
    while (rounds.next()) {
        const Marschner model(p);
        keep(bakeMarschner(model));
        keep(bakeDual(DualScattering(model)));
    }
    return {};
}

Result<Outcome> runShading(const Options& options) {
    Timings timings(options);
    timings.measure("tables of Marschner, rough", [](Rounds& r) { return bake(r, parameters(true, 1)); });
    timings.measure("tables of Marschner, smooth", [](Rounds& r) { return bake(r, parameters(false, 1)); });
    timings.measure("tables of Marschner, elliptic",
                    [](Rounds& r) { return bake(r, parameters(true, 1.2)); });
    timings.measure("tables of Sadeghi", [](Rounds& rounds) -> Status {
        const SadeghiParameters p = sadeghiLike(Marschner(parameters(true, 1)));
        while (rounds.next()) {
            keep(bakeSadeghi(p));
            keep(bakeDual(DualScattering(p)));
        }
        return {};
    });
    return timings.outcome("shading");
}

}  // namespace

Benchmark shadingBenchmark() {
    return {"shading", "baking the tables of shading models", {"--quick"}, runShading};
}

}  // namespace hairloom::benchmarks
