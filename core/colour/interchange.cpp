// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/colour/interchange.h"

#include <fmt/format.h>

#include <array>

namespace hairloom::colour {
namespace {

namespace ocio = OCIO_NAMESPACE;
using Eigen::Matrix3d;
using render::LinearSpace;

constexpr const char* kAcesRole = "aces_interchange";
/// Colour spaces of the ACES, Blender and other configs that are linear Rec. 709.
constexpr std::array kRec709Names{"lin_rec709_scene",
                                  "lin_rec709",
                                  "Linear Rec.709 (sRGB)",
                                  "Linear Rec.709",
                                  "lin_srgb",
                                  "Utility - Linear - sRGB",
                                  "Utility - Linear - Rec.709",
                                  "Linear BT.709 I-D65"};
/// Chromaticities and names of the ASWF's Color Interop Forum.
const std::array<LinearSpace, 5> kKnownSpaces{{
    {},
    {{0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f}, "lin_ap1_scene"},
    {{0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.0770f, 0.32168f, 0.33767f}, "lin_ap0_scene"},
    {{0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f}, "lin_rec2020_scene"},
    {{0.680f, 0.320f, 0.265f, 0.690f, 0.150f, 0.060f, 0.3127f, 0.3290f}, "lin_p3d65_scene"},
}};
const LinearSpace& aces() {
    return kKnownSpaces[2];
}

/// X, Y and Z of a colour of Y 1.
Vec3d xyzOf(double x, double y) {
    return {x / y, 1, (1 - x - y) / y};
}

/// SMPTE RP 177: white is the sum of the primaries.
Matrix3d xyzFrom(const LinearSpace& space) {
    const auto& c = space.chromaticities;
    Matrix3d primaries;
    for (int p = 0; p < 3; ++p) {
        const double x = c[static_cast<std::size_t>(2 * p)], y = c[static_cast<std::size_t>(2 * p + 1)];
        primaries.col(p) = Vec3d(x, y, 1 - x - y);
    }
    const Vec3d scale = primaries.inverse() * xyzOf(c[6], c[7]);
    return primaries * scale.asDiagonal();
}

}  // namespace

Matrix3d acesFrom(const LinearSpace& space) {
    // Lam 1985, as ICC profiles have it.
    const Matrix3d bradford =
        (Matrix3d() << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296).finished();
    const auto& from = space.chromaticities;
    const auto& to = aces().chromaticities;
    const Vec3d gain = (bradford * xyzOf(to[6], to[7])).cwiseQuotient(bradford * xyzOf(from[6], from[7]));
    const Matrix3d adapted = bradford.inverse() * gain.asDiagonal() * bradford;
    return xyzFrom(aces()).inverse() * adapted * xyzFrom(space);
}

Entry entryOf(const ocio::Config& config, const std::string& working) {
    if (config.hasRole(kAcesRole) && config.getColorSpace(kAcesRole)) return {kAcesRole, true};
    for (const char* const name : kRec709Names) {
        if (config.getColorSpace(name)) return {name};
    }
    return {working, false, true};
}

ocio::GroupTransformRcPtr fromRec709(const Entry& entry, const std::string& working) {
    auto group = ocio::GroupTransform::Create();
    if (entry.isAces) {
        const Matrix3d matrix = acesFrom({});
        std::array<double, 16> rows{};
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) rows[static_cast<std::size_t>(4 * r + c)] = matrix(r, c);
        }
        rows[15] = 1;
        auto step = ocio::MatrixTransform::Create();
        step->setMatrix(rows.data());
        group->appendTransform(step);
    }
    auto step = ocio::ColorSpaceTransform::Create();
    step->setSrc(entry.space.c_str());
    step->setDst(working.c_str());
    group->appendTransform(step);
    return group;
}

ocio::ColorSpaceTransformRcPtr toEntry(const Entry& entry, const std::string& working) {
    auto step = ocio::ColorSpaceTransform::Create();
    step->setSrc(working.c_str());
    step->setDst(entry.space.c_str());
    return step;
}

Result<LinearSpace> linearSpaceOf(const ocio::Config& config, const Entry& entry,
                                  const std::string& working) {
    if (entry.isAssumed) return LinearSpace{};
    const auto processor =
        config.getProcessor(toEntry(entry, working))
            ->getOptimizedCPUProcessor(ocio::BIT_DEPTH_F32, ocio::BIT_DEPTH_F32, ocio::OPTIMIZATION_LOSSLESS);
    // The basis, its double, and black: what takes them to a matrix's columns is one.
    std::array<float, 21> probes{1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0};
    for (std::size_t i = 0; i < probes.size(); i += 3) processor->applyRGB(&probes[i]);
    Matrix3d matrix;
    for (int p = 0; p < 3; ++p) {
        for (int c = 0; c < 3; ++c) {
            const auto at = static_cast<std::size_t>(3 * p + c);
            matrix(c, p) = probes[at];
            constexpr float kRounding = 1e-4f;
            if (!(std::abs(probes[at + 9] - 2 * probes[at]) < kRounding) ||
                !(std::abs(probes[static_cast<std::size_t>(18 + c)]) < kRounding))
                return fail(fmt::format("its scene-linear space '{}' is not linear", working),
                            "expected a role scene_linear or rendering that names a linear space");
        }
    }
    if (!entry.isAces) matrix = acesFrom({}) * matrix;
    constexpr double kFlat = 1e-9;
    if (!(std::abs(matrix.determinant()) > kFlat))
        return fail(fmt::format("its scene-linear space '{}' loses colours", working),
                    "expected a space of three primaries");
    // Configs round, and some adapt white by CAT02.
    constexpr double kSame = 5e-3;
    for (const LinearSpace& known : kKnownSpaces) {
        if ((matrix - acesFrom(known)).cwiseAbs().maxCoeff() < kSame) return known;
    }
    LinearSpace found{{}, {}};
    const Matrix3d xyz = xyzFrom(aces()) * matrix;
    for (int p = 0; p < 4; ++p) {
        const Vec3d colour = p < 3 ? Vec3d(xyz.col(p)) : Vec3d(xyz.rowwise().sum());
        found.chromaticities[static_cast<std::size_t>(2 * p)] = static_cast<float>(colour.x() / colour.sum());
        found.chromaticities[static_cast<std::size_t>(2 * p + 1)] =
            static_cast<float>(colour.y() / colour.sum());
    }
    return found;
}

}  // namespace hairloom::colour
