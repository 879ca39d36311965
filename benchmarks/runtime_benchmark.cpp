// SPDX-License-Identifier: GPL-3.0-or-later
// The runtime as a game has it, through hairloom.h and without threads: loading, memory, stepping, clips,
// read-out, crowds.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "benchmarks/measurement.h"
#include "benchmarks/sample_hair.h"
#include "benchmarks/temporary_file.h"
#include "core/base/file.h"
#include "core/base/stopwatch.h"
#include "exporters/seen_motion.h"
#include "exporters/strands.h"
#include "hairloom/hairloom.hpp"

namespace hairloom::benchmarks {
namespace {

constexpr std::size_t kCrowd = 50;
constexpr std::size_t kPlannedCrowd = 100;
constexpr int kFramesToSleep = 600;
/// Two blocks of the format, half a second.
constexpr std::uint64_t kClipFrames = 32;

Status refused(const hl_error& error) {
    return fail(error.words);
}

/// Strands that lie on a head of 10 cm, from its top outwards, and hang where it ends.
Groom cap(std::uint32_t strands, std::uint32_t points, float length) {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < strands; ++s) {
        const float around = 2.4f * static_cast<float>(s);
        const float top = std::sqrt((static_cast<float>(s) + 0.5f) / static_cast<float>(strands));
        for (std::uint32_t i = 0; i < points; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(points - 1);
            const float radius = 0.1f + 0.02f * t, angle = top + length * t / radius;
            const float fallen = std::max(angle - 1.5f, 0.0f) * radius, turned = std::min(angle, 1.5f);
            positions.emplace_back(radius * std::sin(turned) * std::cos(around),
                                   1.6f + radius * std::cos(turned) - fallen,
                                   radius * std::sin(turned) * std::sin(around));
        }
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    Groom groom = makeGroom(std::move(offsets), std::move(positions));
    groom.spheres = {{"head", Vec3f(0, 1.6f, 0), 0.095f, ""}};
    return groom;
}

struct Nod {
    std::array<float, 12> head{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    game::Frame frame;

    explicit Nod(float seconds, bool windy) {
        const float angle = 0.35f * std::sin(7.85f * seconds), c = std::cos(angle), s = std::sin(angle);
        head[5] = head[10] = c;
        head[6] = -s;
        head[9] = s;
        head[7] = 1.6f * (1 - c);
        head[11] = -1.6f * s;
        frame.time = static_cast<double>(seconds);
        frame.head = head.data();
        frame.wind = windy ? kWind.data() : nullptr;
    }
    static constexpr std::array<float, 3> kWind{3, 0, 0};
};

/// A crowd in wind, planned within 2 pixels, beside itself at the finest level.
class CrowdBeside {
  public:
    CrowdBeside(const game::Asset& asset, bool strict) : asset_(asset) { crowd_.limits.strict = strict; }

    Status play(game::Error& error) {
        game::Instance first;
        if (!first.make(asset_, HL_GUIDES | HL_LEVELS, nullptr, &error)) return refused(error);
        const hl_instance_info info = first.describe();
        std::vector<std::uint32_t> offsets(info.guides + 1), layers(info.guides);
        std::vector<Vec3f> rest(info.guide_points);
        std::uint32_t layerCount = 0;
        if (hl_instance_offsets(first.get(), offsets.data(), offsets.size(), &error) != HL_OK ||
            hl_asset_layers(asset_.get(), &layerCount, layers.data(), layers.size(), &error) != HL_OK ||
            !read(first, rest))
            return refused(error);
        for (std::size_t c = 0; c < kPlannedCrowd; ++c) {
            if (!finest_[c].copy(first, &error) || !planned_[c].copy(first, &error)) return refused(error);
            crowd_.characters[crowd_.add(planned_[c])].pixels_per_metre = static_cast<float>(pixels(c));
            seenFinest_.emplace_back(offsets, rest, layers);
            seenPlanned_.emplace_back(offsets, rest, layers);
        }
        for (int f = 1; f <= kFramesBefore + kFramesJudged; ++f) {
            if (auto status = step(f, error); !status) return status;
            for (std::size_t c = 0; f > kFramesBefore && c < kPlannedCrowd; ++c) add(c, rest);
        }
        return {};
    }
    double share() const { return 100 * plannedSeconds_ / finestSeconds_; }

    struct Judged {
        double outline = 0, worstOutline = 0, worstShape = 0, decibels = 0, paths = 0;
    };
    Judged judge() const {
        Judged judged;
        for (std::size_t c = 0; c < kPlannedCrowd; ++c) {
            const auto apart = SeenMotion::between(seenFinest_[c], seenPlanned_[c], 1 / pixels(c));
            const double outline = static_cast<double>(apart.outline) * pixels(c);
            judged.outline += outline * outline / kPlannedCrowd;
            judged.worstOutline = std::max(judged.worstOutline, outline);
            judged.worstShape = std::max(judged.worstShape, static_cast<double>(apart.shape) * pixels(c));
            judged.decibels = std::max(judged.decibels, static_cast<double>(apart.decibels));
        }
        judged.outline = std::sqrt(judged.outline);
        judged.paths = std::sqrt(squares_ / (kPlannedCrowd * kFramesJudged));
        return judged;
    }

  private:
    static constexpr int kFramesBefore = 60, kFramesJudged = 300;

    /// A metre, of 1080 lines of 40 degrees.
    static double pixels(std::size_t c) {
        return 1484 / (1 + 15 * static_cast<double>(c) / (kPlannedCrowd - 1));
    }
    static bool read(const game::Instance& hair, std::vector<Vec3f>& points) {
        const hl_out out{points.data(), points.size() * sizeof(Vec3f), sizeof(Vec3f)};
        return hl_instance_read_guides(hair.get(), out, game::kNothing, game::kNothing, nullptr) == HL_OK;
    }
    Status step(int f, game::Error& error) {
        const auto all = [&](std::vector<game::Instance>& hairs) {
            return std::ranges::all_of(hairs, [&](game::Instance& hair) {
                game::Frame frame;
                frame.time = f / 60.0 + 0.37 * static_cast<double>(&hair - hairs.data());
                frame.wind = Nod::kWind.data();
                return hair.step(frame, &error);
            });
        };
        const Stopwatch finest;
        if (!all(finest_)) return refused(error);
        const double before = finest.seconds();
        const Stopwatch planned;
        if (!crowd_.plan(&error) || !all(planned_)) return refused(error);
        if (f <= kFramesBefore) return {};
        finestSeconds_ += before;
        plannedSeconds_ += planned.seconds();
        return {};
    }
    void add(std::size_t c, std::vector<Vec3f>& points) {
        std::vector<Vec3f> others(points.size());
        read(finest_[c], points);
        read(planned_[c], others);
        seenFinest_[c].add(points);
        seenPlanned_[c].add(others);
        double squares = 0;
        for (std::size_t p = 0; p < points.size(); ++p)
            squares += static_cast<double>((points[p] - others[p]).squaredNorm());
        squares_ += squares / static_cast<double>(points.size()) * pixels(c) * pixels(c);
    }

    const game::Asset& asset_;
    game::Crowd crowd_;
    std::vector<game::Instance> finest_{kPlannedCrowd}, planned_{kPlannedCrowd};
    std::vector<SeenMotion> seenFinest_, seenPlanned_;
    double finestSeconds_ = 0, plannedSeconds_ = 0, squares_ = 0;
};

Result<std::vector<std::byte>> exported(const Groom& groom,
                                        std::shared_ptr<const ClipToWrite> clip = nullptr) {
    const TemporaryFile file("hairloom-runtime-benchmark");
    StrandExportOptions options;
    options.clip = std::move(clip);
    const auto written = strandWriter("runtime").write(groom, file.path, options);
    if (!written) return tl::unexpected(written.error());
    return readFile(file.path);
}

/// What an asset comes to that nods in wind, for a clip. Frames are simulated as they are asked for, so that
/// none is held.
class NodToWrite {
  public:
    explicit NodToWrite(const game::Asset& asset) : asset_(asset) {}

    ClipToWrite::Frame frame(std::uint64_t number, game::Error& error, Status& status) {
        ClipToWrite::Frame frame;
        if (number == 0 && !hair_.make(asset_, HL_GUIDES, nullptr, &error)) status = refused(error);
        const Nod nod(static_cast<float>(number + 1) / 60, true);
        if (status && !(hair_.step(nod.frame, &error) && hair_.readGuides(points_, &error)))
            status = refused(error);
        for (std::size_t p = 0; status && p < points_.size(); p += 3)
            frame.positions_ws.emplace_back(points_[p], points_[p + 1], points_[p + 2]);
        for (std::size_t i = 0; i < nod.head.size(); ++i)
            frame.head_ws(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = nod.head[i];
        return frame;
    }

  private:
    const game::Asset& asset_;
    game::Instance hair_;
    std::vector<float> points_;
};

/// One asset through everything.
class Played {
  public:
    Played(Timings& timings, std::vector<Measurement>& memory, std::string name, std::vector<std::byte> bytes)
        : timings_(timings), memory_(memory), name_(std::move(name)), bytes_(std::move(bytes)) {}

    void measureLoading() {
        timings_.measure("open, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                if (!asset_.open(bytes_.data(), bytes_.size(), &error_)) return refused(error_);
            }
            return {};
        });
        timings_.measure("check, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                if (!asset_.check(&error_)) return refused(error_);
            }
            return {};
        });
        timings_.measure("make an instance, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                if (!hair_.make(asset_, HL_HAIRS, nullptr, &error_)) return refused(error_);
            }
            return {};
        });
        if (!hair_.get()) return;
        timings_.measure("copy an instance, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                game::Instance copy;
                if (!copy.copy(hair_, &error_)) return refused(error_);
            }
            return {};
        });
        const double held = static_cast<double>(hair_.describe().bytes) / 1e3;
        const hl_asset_info info = asset_.describe();
        memory_.push_back({"file, " + name_, "KB", {static_cast<double>(bytes_.size()) / 1e3}});
        memory_.push_back({"memory of an instance, " + name_, "KB", {held}});
        memory_.push_back({"memory stated before, " + name_,
                           "KB",
                           {static_cast<double>(info.guides_memory + info.hairs_memory) / 1e3}});
    }

    void measureFrames() {
        float seconds = 0;
        timings_.measure("step nodding in wind, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                const Nod nod(seconds += 1 / 60.0f, true);
                if (!hair_.step(nod.frame, &error_)) return refused(error_);
            }
            return {};
        });
        std::vector<float> points;
        timings_.measure("read guides, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                if (!hair_.readGuides(points, &error_)) return refused(error_);
            }
            return {};
        });
        if (hair_.describe().hairs == 0) return;
        timings_.measure("read " + std::to_string(hair_.describe().hairs) + " hairs, " + name_,
                         [&](Rounds& rounds) -> Status {
                             while (rounds.next()) {
                                 if (!hair_.readHairs(points, &error_)) return refused(error_);
                             }
                             return {};
                         });
    }

    /// The same motion as a clip, over and over, on the same head.
    Status measureClip(const Groom& groom) {
        NodToWrite nods(asset_);
        auto clip = std::make_shared<ClipToWrite>();
        clip->frames = kClipFrames;
        clip->frame = [&](std::uint64_t number) -> Result<ClipToWrite::Frame> {
            Status status;
            ClipToWrite::Frame frame = nods.frame(number, error_, status);
            if (!status) return tl::unexpected(status.error());
            return frame;
        };
        const auto bytes = exported(groom, std::move(clip));
        if (!bytes) return tl::unexpected(bytes.error());
        game::Asset asset;
        if (!asset.open(bytes->data(), bytes->size(), &error_)) return refused(error_);
        game::Instance hair;
        if (!hair.make(asset, HL_HAIRS, nullptr, &error_)) return refused(error_);
        for (const int way : {1, -1}) {
            hl_play play;
            hl_play_init(&play);
            play.loop = HL_LOOP_ALWAYS;
            timings_.measure((way > 0 ? "play a clip, " : "play a clip backwards, ") + name_,
                             [&](Rounds& rounds) -> Status {
                                 while (rounds.next()) {
                                     play.time += way / 60.0;
                                     const Nod nod(static_cast<float>(play.time), true);
                                     if (!hair.play(asset, nod.frame, play, &error_)) return refused(error_);
                                 }
                                 return {};
                             });
        }
        const hl_clip found = asset.clip();
        memory_.push_back({"clip of " + std::to_string(kClipFrames) + " frames in the file, " + name_,
                           "KB",
                           {static_cast<double>(found.bytes) / 1e3}});
        memory_.push_back({"memory that a clip adds to an instance, " + name_,
                           "KB",
                           {static_cast<double>(found.memory) / 1e3}});
        return {};
    }

    /// Guides of `kCrowd` characters, each at its own time of the nod.
    void measureCrowd() {
        std::vector<game::Instance> crowd(kCrowd);
        const auto step = [&](float seconds, bool resting) {
            for (std::size_t c = 0; c < kCrowd; ++c) {
                const Nod nod(resting ? 0 : seconds + 0.1f * static_cast<float>(c), !resting);
                if (!crowd[c].step(nod.frame, &error_)) return false;
            }
            return true;
        };
        const std::string which = "crowd of " + std::to_string(kCrowd);
        float seconds = 0;
        bool resting = false;
        timings_.measure(which + ", nodding in wind, " + name_, [&](Rounds& rounds) -> Status {
            for (game::Instance& hair : crowd) {
                if (hair.get()) continue;
                const bool first = &hair == &crowd.front();
                if (!(first ? hair.make(asset_, HL_GUIDES, nullptr, &error_)
                            : hair.copy(crowd.front(), &error_)))
                    return refused(error_);
            }
            while (rounds.next()) {
                if (!step(seconds += 1 / 60.0f, false)) return refused(error_);
            }
            return {};
        });
        timings_.measure(which + ", asleep, " + name_, [&](Rounds& rounds) -> Status {
            // Once is enough: they sleep on from repetition to repetition.
            for (int f = 0; f < kFramesToSleep && !resting; ++f) {
                if (f == 0 && !std::ranges::all_of(
                                  crowd, [&](auto& hair) { return hair.set("windSpeed", 0, &error_); }))
                    return refused(error_);
                if (!step(0, true)) return refused(error_);
            }
            resting = true;
            while (rounds.next()) {
                if (!step(0, true)) return refused(error_);
            }
            return {};
        });
        if (!resting) return;
        std::size_t asleep = 0, guides = 0;
        for (const game::Instance& hair : crowd) {
            asleep += hair.describe().asleep;
            guides += hair.describe().guides;
        }
        memory_.push_back(
            {"asleep of the crowd, " + name_,
             "%",
             {100 * static_cast<double>(asleep) / static_cast<double>(std::max<std::size_t>(guides, 1))}});
    }

    /// Guides of `kPlannedCrowd` characters in rows of ten, the first 1 m from the eye, at the finest level
    /// and at those within 2 pixels on 1080 lines of 40 degrees.
    void measureLevels() {
        std::vector<game::Instance> hairs(kPlannedCrowd);
        game::Crowd crowd;
        timings_.measure("make an instance with levels, " + name_, [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                if (!hairs[0].make(asset_, HL_GUIDES | HL_LEVELS, nullptr, &error_)) return refused(error_);
            }
            for (game::Instance& hair : hairs) {
                if (&hair != &hairs[0] && !hair.get() && !hair.copy(hairs[0], &error_))
                    return refused(error_);
            }
            return {};
        });
        if (!hairs.back().get()) return;
        for (std::size_t c = 0; c < kPlannedCrowd; ++c)
            crowd.characters[crowd.add(hairs[c])].pixels_per_metre =
                1480 / (1 + 1.5f * static_cast<float>(c / 10));
        float seconds = 0;
        const auto step = [&](Rounds& rounds) -> Status {
            while (rounds.next()) {
                seconds += 1 / 60.0f;
                if (!crowd.plan(&error_)) return refused(error_);
                for (std::size_t c = 0; c < kPlannedCrowd; ++c) {
                    if (!hairs[c].step(Nod(seconds + 0.1f * static_cast<float>(c), true).frame, &error_))
                        return refused(error_);
                }
            }
            return {};
        };
        const std::string which = "crowd of " + std::to_string(kPlannedCrowd) + ", nodding in wind, ";
        crowd.limits.error_pixels = 0;
        timings_.measure(which + "all at the finest level, " + name_, step);
        crowd.limits = game::Crowd().limits;
        timings_.measure(which + "within 2 pixels, " + name_, step);
        memory_.push_back(
            {"the same, predicted, " + name_, "ms", {static_cast<double>(crowd.report.milliseconds)}});
        crowd.limits.milliseconds = 5;
        timings_.measure(which + "within 5 ms, " + name_, step);
        memory_.push_back(
            {"the same, error, " + name_, "pixels", {static_cast<double>(crowd.report.error_pixels)}});
        timings_.measure("plan a crowd of " + std::to_string(kPlannedCrowd) + ", " + name_,
                         [&](Rounds& rounds) -> Status {
                             while (rounds.next()) {
                                 if (!crowd.plan(&error_)) return refused(error_);
                             }
                             return {};
                         });
        memory_.push_back({"memory of guides with levels, " + name_,
                           "KB",
                           {static_cast<double>(hairs[0].describe().bytes) / 1e3}});
    }

    /// `kPlannedCrowd` characters at 1 to 16 m in wind, planned within 2 pixels by what is seen and strictly,
    /// beside all at the finest level: what that saves, and how far off it is.
    Status judgeLevels() {
        for (const bool strict : {false, true}) {
            const std::string which = "crowd of " + std::to_string(kPlannedCrowd) +
                                      " in wind, within 2 pixels " + (strict ? "strictly, " : "as seen, ");
            CrowdBeside crowd(asset_, strict);
            if (auto status = crowd.play(error_); !status) return status;
            const auto row = [&](const char* what, const char* unit, double value) {
                memory_.push_back({which + what + ", " + name_, unit, {value}});
            };
            row("share of the time of all at the finest level", "%", crowd.share());
            const CrowdBeside::Judged judged = crowd.judge();
            row("outlines, root mean square", "pixels", judged.outline);
            row("outlines, worst character", "pixels", judged.worstOutline);
            row("mean shapes over 5 s, worst character", "pixels", judged.worstShape);
            row("strength of motion, worst octave of what moves a pixel", "dB", judged.decibels);
            row("paths, root mean square", "pixels", judged.paths);
        }
        return {};
    }

  private:
    Timings& timings_;
    std::vector<Measurement>& memory_;
    std::string name_;
    std::vector<std::byte> bytes_;
    game::Asset asset_;
    game::Instance hair_;
    game::Error error_;
};

Result<Outcome> runRuntime(const Options& options) {
    const auto& hairstyles = samples();
    if (!hairstyles) return tl::unexpected(hairstyles.error());
    std::vector<std::pair<std::string, Groom>> grooms;
    for (const Sample& sample : *hairstyles) {
        grooms.emplace_back(sample.name, sample.groom);
        if (options.quick) break;
    }
    grooms.emplace_back("300x24 with 30,000 hairs", cap(300, 24, 0.25f));
    grooms.back().second.interpolation.followPerGuide = 100;
    grooms.emplace_back(options.quick ? "1,000x16" : "100,000x16",
                        cap(options.quick ? 1000 : 100'000, 16, 0.25f));
    Timings timings(options);
    std::vector<Measurement> memory;
    for (auto& [name, groom] : grooms) {
        auto bytes = exported(groom);
        if (!bytes) return tl::unexpected(bytes.error());
        Played played(timings, memory, name, std::move(*bytes));
        played.measureLoading();
        played.measureFrames();
        if (auto status = played.measureClip(groom); !status) return tl::unexpected(status.error());
        if (!name.starts_with("300x24")) continue;
        played.measureCrowd();
        played.measureLevels();
        if (options.quick) continue;
        if (auto status = played.judgeLevels(); !status) return tl::unexpected(status.error());
    }
    auto outcome = timings.outcome("runtime");
    if (!outcome) return outcome;
    for (const Measurement& measurement : memory) outcome->report["rows"].push_back(rowOf(measurement));
    return outcome;
}

}  // namespace

Benchmark runtimeBenchmark() {
    return {
        "runtime", "assets in a game: load, memory, step, clips, read-out, crowds", {"--quick"}, runRuntime};
}

}  // namespace hairloom::benchmarks
