// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <iterator>
#include <numeric>

#include "core/base/output_batch.h"
#include "core/cost/scene_run.h"
#include "core/documents/guides_beside_hairs.h"
#include "core/documents/hair_looks.h"
#include "core/groom/strand_subset.h"
#include "core/interpolation/follow_hairs.h"
#include "core/levels/spring_fit.h"
#include "core/live/root_rotations.h"
#include "core/simulation/body_push.h"
#include "core/simulation/simulation.h"
#include "core/stability/certificate.h"
#include "exporters/card_files.h"

namespace hairloom {
namespace {

/// The name's suffix where formats have it that are not the writer's; else empty.
std::string suffixOfOtherFormat(const std::filesystem::path& path, const HairWriter& writer) {
    std::string suffix = path.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    if (!suffix.empty()) suffix.erase(0, 1);
    const bool isOthers =
        suffix != writer.suffix() &&
        std::ranges::find(hairWriters(), suffix, &HairWriter::suffix) != hairWriters().end();
    return isOthers ? suffix : std::string();
}

/// Follow hairs in a frame, wisps as wide as their speed makes them.
class MovingHairs {
  public:
    static Result<MovingHairs> make(const Groom& rest, const FollowBindings& bindings) {
        MovingHairs hairs(rest, bindings);
        if (!rest.body) return hairs;
        const auto baked = bakeFollowHairs(rest, bindings);
        if (!baked) return tl::unexpected(baked.error());
        hairs.push_ = makeBodyPush(rest, baked->offsets.view(), baked->positions());
        return hairs;
    }

    Result<std::vector<Vec3f>> at(const Groom& posed, const RecordedFrame& frame) {
        std::vector<Vec3f> guides = guidePositions(posed, bindings_);
        std::vector<Vec3f> velocities;
        for (std::size_t p = 0; p < before_.size(); ++p)
            velocities.push_back((guides[p] - before_[p]) * frame.framesPerSecond);
        const std::vector<Quatf> turns = rootRotations(rest_, posed, frame.pose);
        std::vector<Quatf> rotations;
        for (const std::uint32_t strand : bindings_.guideStrands) rotations.push_back(turns[strand]);
        std::vector<Vec3f> hairs(bindings_.hairCount() * bindings_.pointsPerHair);
        auto made = evaluateFollowHairs(bindings_, {guides, velocities, rotations}, hairs);
        before_ = std::move(guides);
        if (!made) return tl::unexpected(made.error());
        if (push_) pushOutOfBody(*push_, rest_, frame.pose, hairs);
        return hairs;
    }

  private:
    MovingHairs(const Groom& rest, const FollowBindings& bindings) : rest_(rest), bindings_(bindings) {}

    const Groom& rest_;
    const FollowBindings& bindings_;
    std::vector<Vec3f> before_;  ///< guides, a frame ago
    std::optional<runtime::BodyPush> push_;
};

std::vector<Vec3f> pointsOf(const Groom& whole, std::span<const std::uint32_t> strands,
                            std::span<const Vec3f> positions) {
    std::vector<Vec3f> points;
    for (const std::uint32_t s : strands) {
        const auto own = positions.subspan(whole.offsets[s], whole.offsets[s + 1] - whole.offsets[s]);
        points.insert(points.end(), own.begin(), own.end());
    }
    return points;
}

/// Of a part of the work, from one share to another.
cards::Progress progressOf(const HairToExport& wanted, double from, double to) {
    return [&wanted, from, to](std::string_view what, double share) {
        if (wanted.progress) wanted.progress(what, from + share * (to - from));
    };
}

/// The shapes of `rest` at the frames, and itself at the first of them.
struct Moving {
    Groom first;
    std::vector<std::vector<Vec3f>> shapes;
    std::vector<std::vector<Vec3f>> guides;  ///< where `shapes` are of hairs that follow: of what they follow
    std::size_t inFile = 0;                  ///< the first of them that is in the file
};
Result<Moving> movingHair(const Groom& whole, std::span<const std::uint32_t> strands, const Groom& guides,
                          const HairToExport& wanted, const FollowBindings* bindings,
                          const cards::Progress& progress) {
    Moving moving;
    moving.inFile = wanted.framesBefore;
    std::optional<MovingHairs> hairs;
    if (bindings) {
        auto made = MovingHairs::make(guides, *bindings);
        if (!made) return tl::unexpected(made.error());
        hairs.emplace(std::move(*made));
    }
    const auto push =
        bindings ? std::nullopt : makeBodyPush(guides, guides.offsets.view(), guides.positions());
    for (const RecordedFrame& frame : wanted.frames) {
        if (cards::cancelled(wanted.cancel)) return cards::stopped();
        progress("frames",
                 static_cast<double>(moving.shapes.size()) / static_cast<double>(wanted.frames.size()));
        const Groom posed = posedGroom(guides, pointsOf(whole, strands, frame.positions_ws), frame.pose);
        std::vector<Vec3f> shape(posed.positions().begin(), posed.positions().end());
        if (hairs) {
            moving.guides.push_back(guidePoints(guides, *bindings, posed.positions()));
            auto made = hairs->at(posed, frame);
            if (!made) return tl::unexpected(made.error());
            shape = std::move(*made);
        }
        if (push) pushOutOfBody(*push, guides, frame.pose, shape);
        if (moving.shapes.size() == moving.inFile) {
            moving.first = posed;
            if (push) moving.first.pointAttributes.set(attribute::kPosition, shape);
            if (bindings) {
                auto baked = bakeFollowHairs(guides, *bindings);
                if (!baked) return tl::unexpected(baked.error());
                moving.first = std::move(*baked);
                moving.first.scalp = posed.scalp;
                moving.first.pointAttributes.set(attribute::kPosition, shape);
            }
        }
        moving.shapes.push_back(std::move(shape));
    }
    return moving;
}

/// Likewise of every frame.
void putGuidesBeside(const Groom& guides, const FollowBindings& bindings, Moving& moving, Groom& shown) {
    shown = guidesBesideHairs(guides, bindings, shown);
    for (std::size_t f = 0; f < moving.shapes.size(); ++f)
        moving.shapes[f].insert(moving.shapes[f].begin(), moving.guides[f].begin(), moving.guides[f].end());
    if (!moving.shapes.empty()) shown.pointAttributes.set(attribute::kPosition, moving.shapes[moving.inFile]);
}

MotionSampling samplingOf(const HairToExport& wanted) {
    MotionSampling sampling;
    sampling.recordRate = static_cast<double>(wanted.frames.front().framesPerSecond);
    sampling.before = wanted.framesBefore;
    sampling.after = wanted.framesAfter;
    sampling.framesPerSecond = wanted.framesPerSecond > 0 ? wanted.framesPerSecond : sampling.recordRate;
    sampling.firstFrame = wanted.firstFrame;
    sampling.shutter = wanted.shutter;
    return sampling;
}

void sayHowSampled(const SampledMotion& sampled, const MotionSampling& sampling,
                   std::vector<Finding>& findings) {
    const std::size_t all = sampled.frames.points.size();
    if (sampled.between > 0)
        findings.push_back(
            {Severity::Info,
             fmt::format("{} of {} samples lie between frames of the record, on curves through these",
                         sampled.between, all),
             "time",
             fmt::format("record at a multiple of {:.6g} frames a second to have simulated ones",
                         sampling.framesPerSecond)});
    if (sampled.beyond > 0)
        findings.push_back(
            {Severity::Warning,
             fmt::format(
                 "{} of {} samples lie before or behind the record, where points go on as they move at "
                 "its end",
                 sampled.beyond, all),
             "time", "simulate more frames at both ends, and export those between them"});
}

/// Levels that cards and shells take over from.
std::vector<WrittenLevel> strandLevels(const cards::Chain& chain) {
    std::vector<WrittenLevel> levels;
    for (const cards::Level& level : chain.levels) {
        if (level.spec.kind != cards::LevelKind::strands) continue;
        const cards::Difference& off = level.difference;
        levels.push_back({level.name, 0, level.triangles, level.bytes, cards::distanceOf(level.spec.headPx),
                          off.coverage, off.flip, off.light});
    }
    return levels;
}

Result<ExportReport> writeCards(const Groom& groom, const HairToExport& wanted, const HairWriter& writer,
                                const std::filesystem::path& path, const StrandExportOptions& options) {
    if (options.metresPerUnit != 1 || options.up != UpAxis::Y || options.pointsPerStrand > 0)
        return fail("another unit, axis or number of points was requested, which cards do not have",
                    "expected none: glTF, OBJ and USD of cards are in metres, FBX in centimetres, Y up");
    const auto chain =
        makeLevels(groom, wanted.levels, LevelsMade::cardsAndShell, progressOf(wanted, 0, 1), wanted.cancel);
    if (!chain) return tl::unexpected(chain.error());
    const std::vector<cards::Collider> colliders = collidersOf(groom);
    auto written = std::get<WriteCards>(writer.writer)({*chain, colliders, groom, wanted.cancel}, path);
    if (!written) return tl::unexpected(written.error());
    ExportReport report = levelReport(*chain, groom);
    if (holdsStrandLevels(writer)) {
        const std::vector<WrittenLevel> nearer = strandLevels(*chain);
        report.levels.insert(report.levels.begin(), nearer.begin(), nearer.end());
        std::ranges::stable_sort(report.levels, {}, &WrittenLevel::distance);
        for (const cards::Level& level : chain->levels) {
            if (const auto* hair = std::get_if<cards::Hair>(&level.content))
                report.points += hair->positions_ws.size();
        }
    }
    report.format = writer.name;
    report.bytes = std::filesystem::file_size(whereWritten(path));
    report.companions = std::move(written->companions);
    if (!written->holdsSprings) {
        std::erase_if(report.findings, [](const Finding& finding) { return finding.where == kSpringsPlace; });
        report.springHz = 0;
    }
    std::ranges::move(written->leftBehind, std::back_inserter(report.leftBehind));
    std::ranges::move(written->findings, std::back_inserter(report.findings));
    return report;
}

/// Of the strands as a game plays them.
Result<SafeLimits> safeLimits(const Groom& guides, std::uint32_t pointsPerStrand, const HairToExport& wanted,
                              const cards::Progress& progress) {
    CertificateOptions options;
    options.storms = wanted.storms;
    std::atomic<std::size_t> most = 0;
    options.progress = [&](std::size_t done, std::size_t total) {
        // Threads report out of order; a bar must not go back.
        std::size_t before = most;
        while (before < done && !most.compare_exchange_weak(before, done)) {
        }
        if (before < done) progress("storms", static_cast<double>(done) / static_cast<double>(total));
    };
    options.cancelled = [&] { return wanted.cancel != nullptr && *wanted.cancel; };
    const SceneHair all = sampleStrands(guides, guides.strandCount(), 0);
    const auto made =
        certify(pointsPerStrand > 0 ? resampledHair(all, pointsPerStrand).groom : guides, options);
    if (!made) return tl::unexpected(made.error());
    const StormStrength& limits = made->limits;
    return SafeLimits{static_cast<float>(limits.step),
                      static_cast<float>(limits.rootSpeed),
                      static_cast<float>(limits.turn),
                      static_cast<float>(limits.wind),
                      made->storms,
                      static_cast<std::uint32_t>(made->failed.size())};
}

}  // namespace

Result<ExportReport> exportHair(const Groom& groom, const HairToExport& wanted, const HairWriter& writer,
                                const std::filesystem::path& path, const StrandExportOptions& options) {
    const std::size_t around = wanted.framesBefore + wanted.framesAfter;
    if (wanted.frames.size() < around + (around > 0 ? 1 : 0))
        return fail(fmt::format("{} frames, of which {} are not in the file", wanted.frames.size(), around),
                    "expected at least one in it");
    const bool moves =
        !wanted.frames.empty() && (wanted.frames.size() > around + 1 || wanted.shutter.samples > 1);
    if (wanted.hair == ExportedHair::all && !writer.marksGuides && !writer.keepsGuides)
        return fail(writer.name + " does not keep guides apart from hairs",
                    "expected one of usda, usdc, abc-unreal");
    if (options.physics && (moves || !writer.holdsPhysics))
        return fail(moves ? "physics was requested of hair that moves"
                          : "physics was requested, which " + writer.name + " does not hold",
                    "expected it of hair at rest, in one of usda, usdc");
    if (moves && !writer.animates) {
        std::string formats;
        for (const HairWriter& other : strandWriters()) {
            if (other.animates) formats += (formats.empty() ? "" : ", ") + other.name;
        }
        return fail(fmt::format("{} holds a single pose, but {} frames were requested", writer.name,
                                wanted.frames.size() - around),
                    "expected one frame, or one of " + formats);
    }
    std::vector<std::uint32_t> strands(groom.strandCount());
    std::iota(strands.begin(), strands.end(), 0u);
    if (!wanted.layers.empty()) {
        auto found = strandsOfLayers(groom, wanted.layers);
        if (!found) return tl::unexpected(found.error());
        strands = std::move(*found);
    }
    Groom guides = wanted.layers.empty() ? groom : strandsOf(groom, strands);
    // What simulates cards meets their spheres alone, and so does what measures them.
    const bool losesBody = groom.body && writer.holdsCards();
    if (losesBody) guides.body.reset();
    const std::uint32_t perGuide = guides.interpolation.followPerGuide;
    const bool isBaked = wanted.hair != ExportedHair::guides && perGuide > 0 && !writer.holdsCards();
    FollowBindings bindings;
    Groom shown = guides;
    if (isBaked) {
        auto bound = bindFollowHairs(guides, guides.interpolation);
        if (!bound) return tl::unexpected(bound.error());
        bindings = std::move(*bound);
    }
    StrandExportOptions exporting = options;
    const double framesEnd = wanted.frames.empty() ? 0 : 0.4, stormsEnd = wanted.storms > 0 ? 0.9 : framesEnd;
    exporting.watch.cancelled = wanted.cancel;
    exporting.watch.progress = [toFile = progressOf(wanted, stormsEnd, 1)](double share) {
        toFile("file", share);
    };
    std::vector<Finding> findings;
    const bool marksGuides = isBaked && (writer.marksGuides || wanted.hair == ExportedHair::all);
    if (!wanted.frames.empty()) {
        auto moving = movingHair(groom, strands, guides, wanted, isBaked ? &bindings : nullptr,
                                 progressOf(wanted, 0, framesEnd));
        if (!moving) return tl::unexpected(moving.error());
        shown = std::move(moving->first);
        if (marksGuides) putGuidesBeside(guides, bindings, *moving, shown);
        if (moves) {
            const MotionSampling sampling = samplingOf(wanted);
            SampledMotion sampled = sampleMotion(moving->shapes, sampling, wanted.cancel);
            if (cards::cancelled(wanted.cancel)) return cards::stopped();
            shown.pointAttributes.set(attribute::kPosition, sampled.frames.points.front());
            sayHowSampled(sampled, sampling, findings);
            exporting.frames = std::make_shared<const StrandFrames>(std::move(sampled.frames));
        }
    } else if (isBaked) {
        auto baked = bakeFollowHairs(guides, bindings);
        if (!baked) return tl::unexpected(baked.error());
        shown = marksGuides ? guidesBesideHairs(guides, bindings, *baked) : std::move(*baked);
    }
    if (isBaked) {
        // Hairs are written, and settings beside them where a format has these.
        shown.simulation = guides.simulation;
        shown.spheres = guides.spheres;
        shown.body = guides.body;
        shown.placement = guides.placement;
    }
    if (wanted.storms > 0) {
        const auto limits = safeLimits(guides, isBaked ? 0 : exporting.pointsPerStrand, wanted,
                                       progressOf(wanted, framesEnd, stormsEnd));
        if (!limits) return tl::unexpected(limits.error());
        exporting.safeLimits = *limits;
    }
    if (writer.holdsLooks) {
        auto looks = hairLooks(shown);
        if (!looks) return tl::unexpected(looks.error());
        exporting.looks = std::make_shared<const HairLooks>(std::move(*looks));
    }
    if (cards::cancelled(wanted.cancel)) return cards::stopped();
    // With what lies beside it, or not at all; also where it reads back as something else.
    OutputBatch batch;
    auto report = writer.holdsCards() ? writeCards(shown, wanted, writer, path, exporting)
                                      : writer.write(shown, path, exporting);
    if (report) report->safeLimits = exporting.safeLimits;
    if (report) std::ranges::move(findings, std::back_inserter(report->findings));
    if (report && losesBody)
        report->findings.push_back(
            {Severity::Warning,
             fmt::format("the skin collider is left out: hair meets {} spheres there", groom.spheres.size()),
             "body", "fit spheres to the skin (spheres --fit)"});
    if (report && marksGuides)
        report->findings.push_back(
            {Severity::Info,
             fmt::format("{} guides, flagged, and {} hairs with the guides that they follow",
                         bindings.guideCount(), bindings.hairCount()),
             "groom_guide", ""});
    if (report && !writer.holdsCards() && perGuide > 0 && !isBaked && !writer.generatesFollowHairs) {
        report->findings.push_back({Severity::Warning,
                                    fmt::format("{} follow hairs per guide are left out", perGuide),
                                    "interpolation", "export hairs to write the rendered hairs"});
    }
    if (!report) return report;
    if (const std::string other = suffixOfOtherFormat(path, writer); !other.empty())
        report->findings.push_back(
            {Severity::Warning, fmt::format("the name ends in .{}, but the file is {}", other, writer.name),
             path.filename().string(),
             fmt::format("name it .{}: other programs choose their reader by the name", writer.suffix())});
    if (cards::cancelled(wanted.cancel)) return cards::stopped();
    if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
    return report;
}

}  // namespace hairloom
