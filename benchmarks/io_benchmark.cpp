// SPDX-License-Identifier: GPL-3.0-or-later
// Strand files in and out: 11,400 strands × 16 points, from memory for reading and with the read-back for
// writing.

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

#include "core/base/file.h"
#include "exporters/strands.h"
#include "importers/strands.h"

namespace {

using namespace hairloom;

constexpr std::uint32_t kStrands = 11400;
constexpr std::uint32_t kPoints = 16;

Groom head() {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        const float angle = 2.4f * static_cast<float>(s);
        const float out = 0.1f * std::sqrt(static_cast<float>(s) / kStrands);
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            const float t = static_cast<float>(i) / (kPoints - 1);
            positions.emplace_back(out * (1 + t) * std::cos(angle), 1.7f - 0.3f * t,
                                   out * (1 + t) * std::sin(angle));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

std::string objLines(const Groom& groom) {
    std::string text;
    for (const Vec3f& p : groom.positions()) {
        text +=
            "v " + std::to_string(p.x()) + ' ' + std::to_string(p.y()) + ' ' + std::to_string(p.z()) + '\n';
    }
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        text += 'l';
        for (std::uint32_t i = 1; i <= kPoints; ++i) text += ' ' + std::to_string(s * kPoints + i);
        text += '\n';
    }
    return text;
}

std::string objRibbons(const Groom& groom) {
    std::string text;
    for (const Vec3f& p : groom.positions()) {
        for (const float side : {0.0f, 0.001f}) {
            text += "v " + std::to_string(p.x() + side) + ' ' + std::to_string(p.y()) + ' ' +
                    std::to_string(p.z()) + '\n';
        }
    }
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        for (std::uint32_t i = 0; i + 1 < kPoints; ++i) {
            const std::uint32_t a = 2 * (s * kPoints + i) + 1;
            text += "f " + std::to_string(a) + ' ' + std::to_string(a + 1) + ' ' + std::to_string(a + 3) +
                    ' ' + std::to_string(a + 2) + '\n';
        }
    }
    return text;
}

/// A file in the system's temporary folder that goes when the benchmark ends.
struct TemporaryFile {
    std::filesystem::path path;
    explicit TemporaryFile(const char* name) : path(std::filesystem::temp_directory_path() / name) {}
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
};

void writeStrands(benchmark::State& state, const char* format) {
    const Groom groom = head();
    const TemporaryFile file("hairloom-io-benchmark");
    for (auto step : state) {
        if (!strandWriter(format).write(groom, file.path, {})) state.SkipWithError("cannot write");
    }
}

void readStrands(benchmark::State& state, const char* format) {
    const TemporaryFile file("hairloom-io-benchmark");
    if (!strandWriter(format).write(head(), file.path, {})) state.SkipWithError("cannot write");
    for (auto step : state) {
        auto imported = importStrands(file.path);
        if (!imported) state.SkipWithError("cannot read");
        benchmark::DoNotOptimize(imported);
    }
}

void readText(benchmark::State& state, std::string (*make)(const Groom&)) {
    const std::string text = make(head());
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    for (auto step : state) {
        auto imported = importStrandsFromMemory("benchmark.obj", bytes);
        if (!imported) state.SkipWithError("cannot read");
        benchmark::DoNotOptimize(imported);
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                            static_cast<std::int64_t>(text.size()));
}

BENCHMARK_CAPTURE(readStrands, hair, "hair")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(readStrands, tfx, "tfx")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(readText, objLines, objLines)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(readText, objRibbons, objRibbons)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(writeStrands, hair, "hair")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(writeStrands, tfx, "tfx")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
