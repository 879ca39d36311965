// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair for tests of the runtime asset, and files of it in memory.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/geometry/scalp_mesh.h"
#include "core/groom/groom.h"
#include "exporters/strands.h"
#include "hairloom/asset.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {

/// Has a folder of the running test's own.
class ExportTest : public testing::Test {
  protected:
    const TemporaryFolder own_;
    const std::filesystem::path& folder = own_.path();
};

class AssetTest : public ExportTest {
  protected:
    /// The file of that groom; the test fails where it cannot be written.
    std::vector<std::byte> written(const Groom& groom, ExportReport* report = nullptr,
                                   const StrandExportOptions& options = {}) const {
        const auto path = folder / "a.hairrt";
        const auto made = strandWriter("runtime").write(groom, path, options);
        EXPECT_TRUE(made) << made.error().message();
        if (!made) return {};
        if (report) *report = *made;
        return readFile(path).value();
    }
};

/// The upper three rows of a matrix, as games give it.
template <class Matrix>
std::array<float, 12> rows(const Matrix& matrix) {
    std::array<float, 12> values{};
    for (int i = 0; i < 12; ++i) values[static_cast<std::size_t>(i)] = matrix(i / 4, i % 4);
    return values;
}

/// Strand s has counts[s] points on a helix that hangs from (1 cm · s, 1.7 m, 0).
inline Groom helices(const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::size_t s = 0; s < counts.size(); ++s) {
        for (std::uint32_t i = 0; i < counts[s]; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(counts[s] - 1);
            positions.emplace_back(0.01f * static_cast<float>(s) + 0.02f * std::cos(4 * t), 1.7f - 0.2f * t,
                                   0.02f * std::sin(4 * t));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

/// Strands on a dome of 2 · side² triangles, 10 cm wide; `copies` roots in each `step`-th of them.
inline Groom dome(std::uint32_t side, std::uint32_t step, std::uint32_t points, float length,
                  std::uint32_t copies = 1) {
    PolygonSoup soup;
    const auto vertex = [&](std::uint32_t x, std::uint32_t z) { return z * (side + 1) + x; };
    for (std::uint32_t z = 0; z <= side; ++z) {
        for (std::uint32_t x = 0; x <= side; ++x) {
            const float u = 0.1f * (static_cast<float>(x) / static_cast<float>(side) - 0.5f);
            const float v = 0.1f * (static_cast<float>(z) / static_cast<float>(side) - 0.5f);
            soup.positions.emplace_back(u, 1.6f + std::sqrt(0.01f - u * u - v * v), v);
        }
    }
    const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        soup.corners.insert(soup.corners.end(), {a, b, c});
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    };
    for (std::uint32_t z = 0; z < side; ++z) {
        for (std::uint32_t x = 0; x < side; ++x) {
            face(vertex(x, z), vertex(x, z + 1), vertex(x + 1, z + 1));
            face(vertex(x, z), vertex(x + 1, z + 1), vertex(x + 1, z));
        }
    }
    auto mesh = std::make_shared<const ScalpMesh>(ScalpMesh::make(soup).value());
    FaceSet all;
    std::vector<SurfacePoint> roots;
    for (std::uint32_t t = 0; t < mesh->triangleCount(); ++t) {
        all.push_back(t);
        for (std::uint32_t c = 0; t % step == 0 && c < copies; ++c) {
            const float share = 0.7f * static_cast<float>(c) / static_cast<float>(copies);
            roots.push_back({t, Vec3f(0.8f - share, share, 0.2f)});
        }
    }
    return growStraight(mesh, all, roots, length, points).value();
}

/// Made-up looks of so many follow hairs: a material of fibres with tables.
inline StrandExportOptions withLooks(std::size_t hairs) {
    auto looks = std::make_shared<HairLooks>();
    runtime::asset::Material material{};
    material.rootLook = {0.5f, 0.25f, 0.125f, 0};
    material.absorbs = 1;
    material.ownScale = -0.2f;
    material.tilts = {-0.03f, 0.02f, 0.05f, 3};
    material.widths = {0.1f, 0.05f, 0.2f, 0.15f};
    material.scales = {1, 1, 1, 0.75f};
    material.model = runtime::asset::kMarschner;
    material.bounded = 1;
    material.axisRatio = 1;
    looks->materials = {material};
    for (std::uint32_t i = 0; i < runtime::asset::kTableHalves; ++i)
        looks->tables.push_back(static_cast<std::uint16_t>(0x3000u + i % 1024u));
    for (std::size_t h = 0; h < hairs; ++h)
        looks->hairs.push_back({static_cast<std::uint16_t>(h), static_cast<std::uint16_t>(2 * h), 4096, 100});
    StrandExportOptions options;
    options.looks = std::move(looks);
    return options;
}

/// With wind, follow hairs and a sphere.
inline Groom wholeGroom() {
    Groom groom = dome(4, 2, 12, 0.1f);
    groom.interpolation.followPerGuide = 6;
    groom.simulation.windSpeed = 3;
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0), 0.09f, ""}};
    return groom;
}

}  // namespace hairloom::test
