// SPDX-License-Identifier: GPL-3.0-or-later
// make_bust FOLDER writes bust.obj, bust.mtl, bust.glb and spheres.json there.

#include <fmt/format.h>

#include "core/base/file.h"
#include "samples/bust/spheres.h"
#include "samples/bust/unwrap.h"
#include "samples/bust/writers.h"

namespace hairloom::bust {
namespace {

constexpr double kCell = 0.0025;
constexpr int kRounds = 9;

Status makeBust(const std::filesystem::path& folder) {
    PatchMesh half = marchHalf(kCell);
    cutIntoPatches(half);
    const PatchMesh whole = mirror(remeshHalf(half, kRounds));
    const auto unwrapped = unwrap(whole);
    if (!unwrapped) return tl::unexpected(unwrapped.error());
    fmt::print("{} vertices, {} triangles, {} charts\n", whole.positions.size(), whole.triangles.size(),
               unwrapped->charts);
    return writeFileAtomically(folder / "bust.obj", objText(whole, *unwrapped))
        .and_then([&] { return writeFileAtomically(folder / "bust.mtl", mtlText()); })
        .and_then([&] { return writeFileAtomically(folder / "bust.glb", glbBytes(*unwrapped)); })
        .and_then(
            [&] { return writeFileAtomically(folder / "spheres.json", spheresJson(fitSpheres(whole))); });
}

}  // namespace
}  // namespace hairloom::bust

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: make_bust FOLDER\n");
        return 2;
    }
    if (const auto status = hairloom::bust::makeBust(argv[1]); !status) {
        fmt::print(stderr, "make_bust: {}\n", status.error().message());
        return 1;
    }
    return 0;
}
