// SPDX-License-Identifier: GPL-3.0-or-later
// Strand files in and out: reading, and writing with the read-back.

#include <fmt/format.h>

#include <cmath>

#include "benchmarks/measurement.h"
#include "benchmarks/peak_memory.h"
#include "benchmarks/sample_hair.h"
#include "benchmarks/temporary_file.h"
#include "exporters/strands.h"
#include "importers/child_process.h"
#include "importers/strands.h"

namespace hairloom::benchmarks {
namespace {

constexpr std::uint32_t kStrands = 11400;
constexpr std::uint32_t kStrandPoints = 16;

Groom head(std::uint32_t strands = kStrands) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < strands; ++s) {
        const float angle = 2.4f * static_cast<float>(s);
        const float out = 0.1f * std::sqrt(static_cast<float>(s) / static_cast<float>(strands));
        for (std::uint32_t i = 0; i < kStrandPoints; ++i) {
            const float t = static_cast<float>(i) / (kStrandPoints - 1);
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
        for (std::uint32_t i = 1; i <= kStrandPoints; ++i)
            text += ' ' + std::to_string(s * kStrandPoints + i);
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
        for (std::uint32_t i = 0; i + 1 < kStrandPoints; ++i) {
            const std::uint32_t a = 2 * (s * kStrandPoints + i) + 1;
            text += "f " + std::to_string(a) + ' ' + std::to_string(a + 1) + ' ' + std::to_string(a + 3) +
                    ' ' + std::to_string(a + 2) + '\n';
        }
    }
    return text;
}

/// In every format that can be written.
void measureFormats(Timings& timings, const std::string& name, const Groom& groom) {
    for (const HairWriter& writer : strandWriters()) {
        // Of its own: a file of another kind is not replaced.
        const TemporaryFile file("hairloom-io-benchmark." + writer.suffix());
        timings.measure("write ." + writer.name + ", " + name, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                const auto written = writer.write(groom, file.path, {});
                if (!written) return tl::unexpected(written.error());
            }
            return {};
        });
        timings.measure("read ." + writer.name + ", " + name, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                const auto imported = importStrands(file.path);
                if (!imported) return tl::unexpected(imported.error());
                keep(*imported);
            }
            return {};
        });
    }
}

void measureText(Timings& timings, const std::string& name, const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    timings.measure(name, [&](Rounds& rounds) -> Status {
        while (rounds.next()) {
            const auto imported = importStrandsFromMemory("benchmark.obj", bytes);
            if (!imported) return tl::unexpected(imported.error());
            keep(*imported);
        }
        return {};
    });
}

/// What `import` and `export` of a full head take at most, as shares of the file's size; nothing where the
/// system does not tell.
void measureMemory(Timings& timings, std::uint32_t strands) {
    const std::string program = (programFolder() / "hairloom-cli").string();
    const TemporaryFile project("hairloom-io-benchmark.hairloom");
    std::optional<Groom> groom = head(strands);
    for (const HairWriter& writer : strandWriters()) {
        if (writer.suffix() == "hairrt") continue;  // quantised, so its size says nothing of the hair's
        const TemporaryFile file("hairloom-io-benchmark." + writer.suffix());
        const bool isFirst = !std::filesystem::exists(project.path);
        if (isFirst && !writer.write(*groom, file.path, {})) return;
        const auto measure = [&](const std::string& what, const std::vector<std::string>& command) {
            const auto bytes = peakMemory(command);
            std::error_code code;
            const auto size = std::filesystem::file_size(file.path, code);
            if (!bytes || code) return;
            timings.add({fmt::format("memory to {} .{}, {} strands of {} points", what, writer.name, strands,
                                     kStrandPoints),
                         "times the file",
                         {static_cast<double>(*bytes) / static_cast<double>(size)}});
        };
        const std::vector<std::string> import{
            program, "import", file.path.string(), "-o", project.path.string(), "--force"};
        if (isFirst && !peakMemory(import)) return;
        groom.reset();
        measure("export", {program, "export", project.path.string(), "--format", writer.name, "-o",
                           file.path.string(), "--force"});
        std::filesystem::remove(file.path.string() + ".report.json");
        measure("import", import);
    }
}

Result<Outcome> runIo(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    Timings timings(options);
    for (const Sample& sample : *hairstyles) measureFormats(timings, sample.name, sample.groom);
    const std::string made = "11,400 strands of 16 points";
    const Groom groom = head();
    measureFormats(timings, made, groom);
    measureText(timings, "read .obj of lines, " + made, objLines(groom));
    measureText(timings, "read .obj of ribbons, " + made, objRibbons(groom));
    constexpr std::uint32_t kMany = 1'000'000, kFew = 20'000;
    measureMemory(timings, options.quick ? kFew : kMany);
    return timings.outcome("io");
}

}  // namespace

Benchmark ioBenchmark() {
    return {"io", "reading and writing strand files", {}, runIo};
}

}  // namespace hairloom::benchmarks
