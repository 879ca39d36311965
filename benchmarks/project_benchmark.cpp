// SPDX-License-Identifier: GPL-3.0-or-later
// Saving and loading projects. "Disk" is one bare write and flush of as many bytes: what no file format can
// go below on the same disk.

#include <filesystem>

#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "benchmarks/temporary_file.h"
#include "core/base/file.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"

namespace hairloom::benchmarks {
namespace {

constexpr std::uint32_t kStrands = 100'000;
constexpr std::uint32_t kPoints = 16;

Groom manyStrands() {
    std::vector<std::uint32_t> offsets(kStrands + 1);
    std::vector<Vec3f> positions(std::size_t{kStrands} * kPoints);
    for (std::uint32_t s = 0; s <= kStrands; ++s) offsets[s] = s * kPoints;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto strand = static_cast<float>(i / kPoints);
        positions[i] = Vec3f(strand * 1e-5f, static_cast<float>(i % kPoints) * 0.01f, 0.1f);
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    groom.pointAttributes.set(attribute::kRadius, std::vector<float>(std::size_t{kStrands} * kPoints, 4e-5f));
    return groom;
}

void measure(Timings& timings, const std::string& name, const Groom& groom) {
    const TemporaryFile file("hairloom-project-benchmark");
    timings.measure("save, " + name, [&](Rounds& rounds) -> Status {
        while (rounds.next()) {
            if (auto saved = saveProject(groom, file.path); !saved) return saved;
        }
        return {};
    });
    timings.measure("load, " + name, [&](Rounds& rounds) -> Status {
        while (rounds.next()) {
            const auto loaded = openProject(file.path);
            if (!loaded) return tl::unexpected(loaded.error());
            keep(*loaded);
        }
        return {};
    });
    timings.measure("disk, " + name, [&](Rounds& rounds) -> Status {
        const std::vector<std::byte> bytes(std::filesystem::file_size(file.path), std::byte{1});
        while (rounds.next()) {
            if (auto written = writeFileAtomically(file.path, bytes); !written) return written;
        }
        return {};
    });
}

Result<Outcome> runProject(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    Timings timings(options);
    for (const Sample& sample : *hairstyles) measure(timings, sample.name, sample.groom);
    measure(timings, "100,000 strands of 16 points", manyStrands());
    return timings.outcome("project");
}

}  // namespace

Benchmark projectBenchmark() {
    return {"project", "saving and loading projects", {"--quick"}, runProject};
}

}  // namespace hairloom::benchmarks
