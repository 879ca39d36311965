// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/groom_comparison.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "cli/documents.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/groom/file/json_diff.h"
#include "core/groom/groom_diff.h"
#include "hairloom/asset.h"

namespace hairloom::cli {
namespace {

Report rowOf(const GroomDifference& one) {
    Report row{{"where", one.where}, {"what", one.what}, {"before", one.before}, {"after", one.after}};
    if (!one.unit.empty()) row["unit"] = one.unit;
    if (one.count > 0) row["count"] = one.count;
    if (one.of > 0) row["of"] = one.of;
    if (one.largest) row[one.isLength ? "max_mm" : "max"] = *one.largest;
    row["words"] = inWords(one);
    return row;
}

/// What an asset for games has beside the groom that is read from it: each section by its content. Null for
/// other files.
Result<Report> assetContent(const std::string& path) {
    const auto bytes = readFile(path);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto opened = runtime::Asset::open(*bytes);
    if (!opened.asset) return Report(nullptr);
    const runtime::Asset& asset = *opened.asset;
    Report sections = Report::object();
    for (const runtime::AssetSection& section : asset.sections())
        sections[std::string(section.kind)] = {
            {"records", section.count},
            {"bytes", section.bytes},
            {"hash",
             fmt::format("{:016x}", hashBytes(std::span(*bytes).subspan(section.offset, section.bytes)))}};
    return Report{{"version", fmt::format("{}.{}", asset.major(), asset.minor())},
                  {"follow_hairs", asset.hairCount()},
                  {"bones", asset.bones.size()},
                  {"sections", std::move(sections)}};
}

Status addAssets(const std::string& before, const std::string& after, std::vector<GroomDifference>& all) {
    const auto old = assetContent(before), now = assetContent(after);
    if (!old) return tl::unexpected(old.error());
    if (!now) return tl::unexpected(now.error());
    for (JsonDifference& one : differences(Report{{"asset", *old}}, Report{{"asset", *now}}))
        all.push_back({std::move(one.where),
                       std::move(one.what),
                       std::move(one.before),
                       std::move(one.after),
                       0,
                       0,
                       {},
                       false,
                       {}});
    return {};
}

std::string summaryOf(std::size_t count, ComparedParts parts, const std::string& before,
                      const std::string& after) {
    const std::string between = fmt::format("between {} and {}", before, after);
    const std::string in = parts == ComparedParts::hair ? " in strands and their attributes" : "";
    if (count == 0) return fmt::format("no differences{} {}", in, between);
    return fmt::format("{} difference{}{} {}", count, count == 1 ? "" : "s", in, between);
}

}  // namespace

Result<Report> compareFiles(const std::string& before, const std::string& after, const std::string& unit) {
    const auto old = openAny(before, unit);
    if (!old) return tl::unexpected(old.error());
    const auto now = openAny(after, unit);
    if (!now) return tl::unexpected(now.error());
    const bool areHeads = old->groom.strandCount() == 0 && now->groom.strandCount() == 0;
    const ComparedParts parts =
        old->format == now->format || areHeads ? ComparedParts::all : ComparedParts::hair;
    GroomComparison comparison = compare({old->groom, before}, {now->groom, after}, parts);
    if (old->format == kAssetFormat && now->format == kAssetFormat) {
        if (auto status = addAssets(before, after, comparison.differences); !status)
            return tl::unexpected(status.error());
    }
    Report rows = Report::array();
    for (const GroomDifference& one : comparison.differences) rows.push_back(rowOf(one));
    Report report{{"summary", summaryOf(rows.size(), parts, before, after)},
                  {"differences", std::move(rows)}};
    report["formats"] = {old->format, now->format};
    report["compared"] = parts == ComparedParts::all ? "all" : "hair";
    report["strands_matched_by"] = strandMatchName(comparison.match);
    return report;
}

}  // namespace hairloom::cli
