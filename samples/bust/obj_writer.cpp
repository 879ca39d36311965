// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <iterator>

#include "samples/bust/writers.h"

namespace hairloom::bust {

Vec3d groupColour(Group group) {
    switch (group) {
        case Group::Scalp:
            return {0.60, 0.47, 0.40};
        case Group::Face:
            return {0.72, 0.56, 0.47};
        case Group::Ears:
            return {0.72, 0.54, 0.46};
        case Group::Neck:
            return {0.70, 0.55, 0.46};
        case Group::Shoulders:
            break;
    }
    return {0.69, 0.54, 0.46};
}

std::string objText(const PatchMesh& welded, const UnwrappedMesh& mesh) {
    std::string text = "# A bust made by make_bust; metres, Y up, facing +Z. CC0 1.0.\nmtllib bust.mtl\n";
    const auto out = std::back_inserter(text);
    for (const Vec3d& p : welded.positions)
        fmt::format_to(out, "v {:.5f} {:.5f} {:.5f}\n", p.x(), p.y(), p.z());
    for (const Vec2d& q : mesh.uv) fmt::format_to(out, "vt {:.5f} {:.5f}\n", q.x(), q.y());
    for (int group = 0; group < kGroupCount; ++group) {
        fmt::format_to(out, "g {0}\nusemtl {0}\n", kGroupNames[group]);
        for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
            if (static_cast<int>(groupOf(mesh.mesh.patches[t])) != group) continue;
            text += 'f';
            for (const int v : mesh.mesh.triangles[t])
                fmt::format_to(out, " {}/{}", mesh.original[v] + 1, v + 1);
            text += '\n';
        }
    }
    return text;
}

std::string mtlText() {
    std::string text;
    for (int group = 0; group < kGroupCount; ++group) {
        const Vec3d c = groupColour(static_cast<Group>(group));
        fmt::format_to(std::back_inserter(text),
                       "newmtl {}\nKd {:.3f} {:.3f} {:.3f}\nKs 0.04 0.04 0.04\nNs 20\n", kGroupNames[group],
                       c.x(), c.y(), c.z());
    }
    return text;
}

}  // namespace hairloom::bust
