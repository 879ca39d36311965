// SPDX-License-Identifier: GPL-3.0-or-later
// Saving and loading 100,000 strands of 16 points. "Disk" is one bare write and flush of as many bytes: what
// no file format can go below on the same disk.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <stdexcept>

#include "core/base/file.h"
#include "core/groom/file/project_file.h"

namespace {

using namespace hairloom;

constexpr std::uint32_t kStrands = 100000;
constexpr std::uint32_t kPoints = 16;

std::filesystem::path file() {
    return std::filesystem::temp_directory_path() / "hairloom-bench.hairloom";
}

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

void require(bool good) {
    if (!good) throw std::runtime_error("the benchmark's file cannot be written or read");
}

void saveProjectFile(benchmark::State& state) {
    const Groom groom = manyStrands();
    for (auto _ : state) require(saveProject(groom, file()).has_value());
    state.counters["MB"] = static_cast<double>(std::filesystem::file_size(file())) * 1e-6;
}

void loadProjectFile(benchmark::State& state) {
    require(saveProject(manyStrands(), file()).has_value());
    for (auto _ : state) {
        auto groom = loadProject(file());
        require(groom.has_value());
        benchmark::DoNotOptimize(groom);
    }
}

void disk(benchmark::State& state) {
    require(saveProject(manyStrands(), file()).has_value());
    const std::vector<std::byte> bytes(std::filesystem::file_size(file()), std::byte{1});
    for (auto _ : state) require(writeFileAtomically(file(), bytes).has_value());
}

BENCHMARK(saveProjectFile)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(loadProjectFile)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(disk)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
