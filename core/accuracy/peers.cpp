// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/peers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <utility>

namespace hairloom {

/// Of recorded_peers.cpp, which CMake writes.
std::string_view recordedPeersCsv();

namespace {

constexpr std::string_view kHead =
    "peer,version,setting,strands,ms_per_frame,ms_lowest,ms_highest,error_rms_mm,error_max_mm,"
    "stretch_mean_percent,stretch_max_percent,cantilever_mm,converged,doubt_mm,machine,date,load";
constexpr std::size_t kCells = 17;

/// RFC 4180, without lines inside cells.
std::vector<std::string> cellsOf(std::string_view line) {
    std::vector<std::string> cells(1);
    bool isQuoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool isMark = line[i] == '"';
        if (isMark && isQuoted && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[++i];
        else if (isMark)
            isQuoted = !isQuoted;
        else if (line[i] == ',' && !isQuoted)
            cells.emplace_back();
        else
            cells.back() += line[i];
    }
    return cells;
}

bool parseInto(const std::string& cell, double& number) {
    const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    return code == std::errc() && end == cell.data() + cell.size();
}

Result<PeerRun> runOf(const std::vector<std::string>& cells, const std::string& source, std::uint64_t line) {
    if (cells.size() != kCells)
        return failIn(source, Line{line}, fmt::format("has {} cells", cells.size()),
                      fmt::format("expected {}", kCells));
    PeerRun run;
    run.name = cells[0];
    run.version = cells[1];
    run.setting = cells[2];
    run.reference = cells[12];
    run.machine = cells[14];
    run.date = cells[15];
    double strands = 0;
    const std::pair<std::size_t, double*> numbers[] = {{3, &strands},
                                                       {4, &run.milliseconds},
                                                       {5, &run.lowestMs},
                                                       {6, &run.highestMs},
                                                       {7, &run.errorMm},
                                                       {8, &run.errorMaxMm},
                                                       {9, &run.stretchPercent},
                                                       {10, &run.stretchMaxPercent},
                                                       {11, &run.cantileverMm},
                                                       {13, &run.referenceUncertaintyMm},
                                                       {16, &run.load}};
    for (const auto& [cell, number] : numbers) {
        if (!parseInto(cells[cell], *number))
            return failIn(source, Line{line}, fmt::format("'{}' is not a number", cells[cell]),
                          "expected a number, or nan for a run that broke");
    }
    constexpr double kMostStrands = 1e9;
    if (!(strands >= 1 && strands <= kMostStrands))
        return failIn(source, Line{line}, fmt::format("is of {} strands", strands), "expected at least one");
    run.strands = static_cast<std::uint32_t>(strands);
    return run;
}

}  // namespace

std::string_view peerScene() {
    return "300 gently curved strands of 16 points and 0.3 m, without contact or air, on a head that turns "
           "by "
           "0.8 radians to either side once a second, for two seconds at 60 frames a second. Each simulator "
           "is compared with its own run with many steps";
}

Result<std::vector<PeerRun>> parsePeers(std::string_view csv, const std::string& source) {
    std::vector<PeerRun> runs;
    std::uint64_t number = 0;
    while (!csv.empty()) {
        const std::size_t end = std::min(csv.find('\n'), csv.size());
        std::string_view line = csv.substr(0, end);
        csv.remove_prefix(std::min(end + 1, csv.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++number;
        if (number == 1) {
            if (line == kHead) continue;
            return failIn(source, Line{1}, "is no table of simulators",
                          "expected a CSV written by ./dev peers, which begins with its columns");
        }
        if (line.empty()) continue;
        auto run = runOf(cellsOf(line), source, number);
        if (!run) return tl::unexpected(run.error());
        runs.push_back(std::move(*run));
    }
    if (runs.empty())
        return failIn(source, {}, "has no run", "expected a CSV written by ./dev peers, with one a line");
    return runs;
}

const std::vector<PeerRun>& recordedPeers() {
    static const std::vector<PeerRun> runs = [] {
        auto parsed = parsePeers(recordedPeersCsv(), "the recorded peers");
        assert(parsed);  // a test reads it
        return std::move(*parsed);
    }();
    return runs;
}

}  // namespace hairloom
