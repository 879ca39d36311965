// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/cards/cap_fit.h"
#include "core/cards/level_shots.h"
#include "core/cards/raster.h"
#include "core/cards/rig.h"

namespace hairloom::cards {
namespace {

constexpr std::uint32_t kFarthestPx = 16;  // of a head, 23 m away: as far as levels are looked at

/// All that levels are made from and held against.
struct Work {
    const Hair& hair;
    const HairLight& light;
    const std::vector<View>& views;
    const std::map<std::uint32_t, std::vector<Shot>>& strands;   ///< by pixels of a head
    double strandsMs;                                            ///< to draw them in a direction
    const std::map<std::uint32_t, std::vector<Print>>& between;  ///< likewise, from `viewsBetween`
    const std::vector<View>& viewsBetween;                       ///< where levels are measured, too
    const ChainOptions& options;
    const Stage& stage;
    const std::function<void()>& tick;  ///< called now and then while a level is made
    Cancel cancel;

    /// What coverage and brightness are set by: some directions at all heights, where pictures are small all.
    std::vector<std::size_t> viewsFor(const LevelSpec& spec) const {
        constexpr std::uint32_t kSmall = 64;  // pixels of a head
        if (spec.headPx <= kSmall && spec.kind != LevelKind::strands) return allViews();
        std::vector<std::size_t> some;
        for (std::size_t v = 0; v < views.size(); v += std::max<std::size_t>(1, views.size() / 6))
            some.push_back(v);
        return some;
    }
    std::vector<std::size_t> allViews() const {
        std::vector<std::size_t> all(views.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        return all;
    }
};

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& which) {
    std::vector<T> some;
    for (const std::size_t i : which) some.push_back(all[i]);
    return some;
}

/// Pictures of a level from some directions.
Shooting shoot(const Work& work, const Level& level, const std::vector<std::size_t>& which, std::uint32_t px,
               Shown shown = Shown::all) {
    return shoot(work.stage, level.content, chosen(work.views, which), px, kSamplesPerHead, shown);
}

Result<Shares> measured(const Work& work, const Level& level, Shown shown = Shown::all) {
    work.tick();
    const auto which = work.viewsFor(level.spec);
    const Shooting shooting = shoot(work, level, which, level.spec.headPx, shown);
    if (cancelled(work.cancel)) return stopped();
    return sharesOf(chosen(work.strands.at(level.spec.headPx), which), shooting.shots);
}

/// A level's light at a height of the head, times that of all strands, from some directions.
Result<double> lightAt(const Work& work, const Level& level, std::uint32_t px,
                       const std::vector<std::size_t>& which) {
    work.tick();
    const Shooting shooting = shoot(work, level, which, px);
    if (cancelled(work.cancel)) return stopped();
    const auto area = [](std::uint32_t pixels) { return static_cast<double>(pixels) * pixels; };
    // Pictures of strands are means of one plate: their light is that of any height.
    const double wanted =
        hairLuminance(chosen(work.strands.at(level.spec.headPx), which)) / area(level.spec.headPx);
    return wanted > 0 ? hairLuminance(shooting.shots) / area(px) / wanted : 1;
}

constexpr double kFarEnough = 0.004;  // from 1: what coverage and light are set to
constexpr int kRounds = 5;

Status makeStrands(const Work& work, Level& level) {
    if (level.spec.amount >= 1) {
        level.content = work.hair;
        return {};
    }
    auto widen = static_cast<float>(1 / level.spec.amount);
    for (int round = 0; round < kRounds; ++round) {
        level.content = thinned(work.hair, level.spec.amount, widen);
        const auto off = measured(work, level, Shown::coverage);
        if (!off) return tl::unexpected(off.error());
        if (std::abs(off->coverage - 1) < kFarEnough) break;
        // Of few hairs none may be seen.
        constexpr double kMost = 8;
        widen *= static_cast<float>(std::clamp(std::pow(off->coverage, -1.5), 1 / kMost, kMost));
    }
    return {};
}

/// Sets thickness and brightness of the level's cards and how dense its cap is, so that coverage and light
/// are those of the strands, and skin is seen where it is seen between these.
Status calibrate(const Work& work, Level& level) {
    // Measured where they lie: atlases take tens of megabytes.
    Cards& made = std::get<Cards>(level.content);
    // Coverage grows by some power of the thickness: 1 of thin hair, less where strands lie over each other.
    constexpr double kSmall = 0.1, kOfThickHair = 0.4, kLeast = 0.15;
    float thickness = 1;
    double power = 1, lastCover = 0, lastThick = 0;
    const auto which = work.viewsFor(level.spec);
    const auto strands = chosen(work.strands.at(level.spec.headPx), which);
    const CapSight sight(work.hair, made.cap, chosen(work.views, which), level.spec.headPx);
    constexpr int kCapRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
        work.tick();
        const Shooting shooting = shoot(work, level, which, level.spec.headPx);
        if (cancelled(work.cancel)) return stopped();
        const Shares off = sharesOf(strands, shooting.shots);
        const double brighter = 1 / std::max(off.light, 1e-9);
        made.brightness = std::clamp(made.brightness * static_cast<float>(brighter), 0.25f, 4.0f);
        const bool covers = std::abs(off.coverage - 1) < kFarEnough;
        const bool capIsFitted = round + 1 >= kCapRounds;
        if (!capIsFitted) sight.fit(strands, shooting.shots, made);
        if (!covers) {
            constexpr float kThinnest = 0.2f, kThickest = 8;
            const double cover = std::log(std::max(off.coverage, 1e-3));
            const auto thick = static_cast<double>(std::log(thickness));
            if (round == 0) power = std::abs(cover) < kSmall ? kOfThickHair : 1;
            if (round > 0 && thick != lastThick)
                power = std::clamp((cover - lastCover) / (thick - lastThick), kLeast, 1.0);
            lastCover = cover, lastThick = thick;
            thickness =
                std::clamp(thickness * static_cast<float>(std::exp(-cover / power)), kThinnest, kThickest);
        }
        if (!covers || !capIsFitted) {
            if (auto status = bakeAtlas(work.hair, work.light, thickness, made, work.cancel); !status)
                return status;
        }
        buildMesh(made);
        if (covers && capIsFitted && std::abs(off.light - 1) < kFarEnough) break;
    }
    // What was baked last has a light of its own. The middle of those where it takes over and where the next
    // one does, so that neither step is large.
    const auto near = lightAt(work, level, level.spec.headPx, which),
               far = lightAt(work, level, level.untilPx, which);
    if (!near || !far) return tl::unexpected((near ? far : near).error());
    const double light = std::sqrt(std::max(*near * *far, 0.0625));
    made.brightness = std::clamp(made.brightness / static_cast<float>(light), 0.25f, 4.0f);
    buildMesh(made);
    return {};
}

Status makeCardLevel(const Work& work, Level& level) {
    const float pixel = kHeadHeight / static_cast<float>(level.spec.headPx);
    CardOptions options;
    options.cards = static_cast<std::uint32_t>(level.spec.amount);
    options.textures = work.options.textures;
    options.segments = work.options.segments;
    options.mostSide = work.options.mostSide;
    options.texel = pixel / 1.5f;
    options.tolerance = pixel / 3;
    options.error = work.options.targetPx * pixel / 2;
    for (const HeldCard& held : work.options.held)
        if (held.level == options.cards) options.held.push_back(held);
    auto made = makeCards(work.hair, work.light, options, work.cancel);
    if (!made) return tl::unexpected(made.error());
    level.content = std::move(*made);
    if (auto status = calibrate(work, level); !status) return status;
    // Last: the other cards do not make up for what a hand has done.
    auto& shaped = std::get<Cards>(level.content);
    if (!options.held.empty()) shapeByHand(options.held, shaped);
    if (shaped.mesh.indices.empty())
        return fail(fmt::format("all cards of {} were deleted by hand", level.name),
                    "expected at least one that stays");
    return {};
}

Status makeShellLevel(const Work& work, Level& level) {
    const ShellField field = ShellField::make(work.hair, work.light);
    float low = 0.001f, high = 0.9f;
    constexpr int kHalvings = 10;
    Shell best;
    double nearest = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kHalvings && nearest > kFarEnough; ++step) {
        const float middle = std::sqrt(low * high);
        Shell shell = field.cut(middle, static_cast<std::uint32_t>(level.spec.amount));
        const bool empty = shell.indices.empty();
        level.content = shell;
        const auto off = measured(work, level);
        if (!off) return tl::unexpected(off.error());
        (empty || off->coverage < 1 ? high : low) = middle;
        // Few triangles make coverage jump: the last is not always the nearest.
        if (empty || std::abs(off->coverage - 1) >= nearest) continue;
        nearest = std::abs(off->coverage - 1);
        best = std::move(shell);
    }
    if (best.indices.empty())
        return fail("the hair is too thin for a shell", "expected levels without a shell");
    level.content = std::move(best);
    // Highlights do not grow with the albedo, so that light grows by some power of it, which two rounds tell.
    double power = 1, last = 0, factor = 1;
    for (int round = 0; round < 2 * kRounds; ++round) {
        const auto off = measured(work, level);
        if (!off) return tl::unexpected(off.error());
        if (std::abs(off->light - 1) < kFarEnough) break;
        const double light = std::log(std::max(off->light, 1e-3));
        constexpr double kWeakest = 0.1;
        if (round > 0) power = std::clamp((light - last) / std::log(factor), kWeakest, 1.0);
        last = light, factor = std::exp(-light / power);
        for (ShellVertex& v : std::get<Shell>(level.content).vertices) v.albedo *= static_cast<float>(factor);
    }
    return {};
}

double millisecondsOf(const std::function<void()>& work) {
    std::vector<double> times;
    constexpr int kTimes = 5;
    for (int i = 0; i < kTimes; ++i) {
        const Stopwatch watch;
        work();
        times.push_back(1000 * watch.seconds());
    }
    std::ranges::sort(times);
    return times[kTimes / 2];
}

/// The numbers of a level that no picture tells.
Status count(const Work& work, Level& level) {
    if (const auto* hair = std::get_if<Hair>(&level.content)) {
        level.hairs = hair->strandCount();
        level.triangles = 2 * (hair->positions_ws.size() - hair->strandCount());
        level.bytes = hair->positions_ws.size() * sizeof(Vec4f);  // position and radius
        const double share = static_cast<double>(level.hairs) / static_cast<double>(work.hair.strandCount());
        level.moveMs = share * work.options.strandsMoveMs;
    } else if (const auto* cards = std::get_if<Cards>(&level.content)) {
        constexpr std::size_t kVertexBytes = 84;  // as glb.cpp writes them
        constexpr std::size_t kTexelBytes = 8;    // colour and normal
        level.triangles = cards->mesh.indices.size() / 3;
        level.bytes = cards->mesh.vertices.size() * kVertexBytes + cards->mesh.indices.size() * 4;
        for (const Picture& picture : cards->atlas.levels) level.bytes += picture.texels.size() * kTexelBytes;
        const auto rig = makeRig(*cards, kChains, kJointsPerChain, work.cancel);
        if (!rig) return tl::unexpected(rig.error());
        const std::vector<Eigen::Affine3f> motions(rig->joints.size(), Eigen::Affine3f::Identity());
        const Binding binding = bind(*rig, *cards);
        std::vector<Vec3f> moved(cards->mesh.vertices.size());
        level.moveMs = millisecondsOf([&] { skin(binding, cards->mesh, motions, moved); });
    } else if (const auto* shell = std::get_if<Shell>(&level.content)) {
        level.triangles = shell->indices.size() / 3;
        level.bytes = shell->vertices.size() * sizeof(ShellVertex) + shell->indices.size() * 4;
        std::vector<Vec3f> moved(shell->vertices.size());
        const Eigen::Affine3f head = Eigen::Affine3f::Identity();
        level.moveMs = millisecondsOf([&] {
            for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = head * shell->vertices[v].position_ws;
        });
    }
    return {};
}

std::string nameFor(const LevelSpec& spec) {
    if (spec.kind == LevelKind::strands) return fmt::format("strands-{:g}", 100 * spec.amount);
    return fmt::format("{}-{:g}", nameOf(spec.kind), spec.amount);
}

/// Heights of a head in pixels at which one who walks away looks.
constexpr std::array kWalk{512u, 384u, 256u, 192u, 128u, 96u, 64u, 48u, 32u, 24u, 16u};

/// The lights of a level.
Status walk(const Work& work, Level& level) {
    for (const std::uint32_t px : kWalk) {
        if (px > level.spec.headPx || px < level.untilPx) continue;
        // Hairs are drawn on one plate for all heights.
        const bool isKnown = px == level.spec.headPx || level.spec.kind == LevelKind::strands;
        const Result<double> light =
            isKnown ? level.difference.light : lightAt(work, level, px, work.allViews());
        if (!light) return tl::unexpected(light.error());
        level.lights.push_back({px, *light});
    }
    return {};
}

/// Beside all strands from where it takes over on, at the distances of all levels, so that levels can be
/// compared with each other.
Status compareAlike(const Work& work, Level& level) {
    constexpr std::size_t kDirections = 4;
    std::vector<std::size_t> which;
    for (std::size_t v = 0; v < work.views.size();
         v += std::max<std::size_t>(1, work.views.size() / kDirections))
        which.push_back(v);
    const bool isAll = level.spec.kind == LevelKind::strands && level.spec.amount >= 1;
    for (auto at = work.strands.rbegin(); at != work.strands.rend(); ++at) {
        const auto& [px, strands] = *at;
        if (px > level.spec.headPx) continue;  // nobody sees it from there
        if (isAll) {
            level.flips.push_back({px, 0});
            continue;
        }
        work.tick();
        const bool isOwn = px == level.spec.headPx;
        const auto shots = isOwn ? chosen(level.shots, which) : shoot(work, level, which, px).shots;
        if (cancelled(work.cancel)) return stopped();
        const auto off = difference(chosen(strands, which), shots);
        if (!off) return tl::unexpected(off.error());
        level.flips.push_back({px, off->flip});
    }
    return {};
}

/// Beside all strands, from all directions, but for how it moves.
Status measure(const Work& work, Level& level) {
    work.tick();
    const double pixelMm = pixelMillimetres(level.measuredPx());
    const std::uint32_t finer = level.spec.headPx / level.measuredPx();
    // Textures have mip maps by pixels, hairs have none.
    const std::uint32_t px = level.spec.kind == LevelKind::strands ? level.measuredPx() : level.spec.headPx;
    const std::size_t own = work.views.size(), between = work.viewsBetween.size();
    Shooting aside = shoot(work.stage, level.content, work.viewsBetween, px, kSamplesBetween);
    if (cancelled(work.cancel)) return stopped();
    std::vector<ViewMeasures> views(own + between);
    parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Print shown = v < own ? coarser(printOf(level.shots[v]), finer)
                                        : coarser(printOf(aside.shots[v - own]), px / level.measuredPx());
            const Print strands = v < own ? coarser(printOf(level.strands[v]), finer)
                                          : work.between.at(level.measuredPx())[v - own];
            views[v] = measureView(strands, shown, pixelMm);
        }
    });
    level.measures = combined(views);
    return {};
}

Status finish(const Work& work, Level& level) {
    level.strands = work.strands.at(level.spec.headPx);
    const bool isAll = level.spec.kind == LevelKind::strands && level.spec.amount >= 1;
    Shooting shooting = isAll ? Shooting{level.strands, work.strandsMs}
                              : shoot(work, level, work.allViews(), level.spec.headPx);
    if (cancelled(work.cancel)) return stopped();
    if (!isAll) {
        const auto off = difference(level.strands, shooting.shots);
        if (!off) return tl::unexpected(off.error());
        level.difference = *off;
    }
    level.shots = std::move(shooting.shots);
    level.drawMs = shooting.drawMs;
    const double target = static_cast<double>(work.options.targetPx);
    const double outlines = level.difference.silhouettePx;
    if (target > 0 && level.spec.kind == LevelKind::cards && outlines > target) {
        return fail(fmt::format("the outline error of {} is {:.2f} pixels, more than the {:g} asked for",
                                level.name, outlines, target),
                    fmt::format("use a limit of {:.2f} pixels, which these cards reach, or more cards",
                                outlines + 0.005));
    }
    if (work.options.measure) {
        if (auto status = measure(work, level); !status) return status;
    }
    if (work.options.walk) {
        if (auto status = walk(work, level); !status) return status;
    }
    if (work.options.alike) {
        if (auto status = compareAlike(work, level); !status) return status;
    }
    return count(work, level);
}

}  // namespace

std::vector<double> lightSteps(const std::vector<Level>& levels) {
    std::vector<double> steps;
    std::optional<double> last;
    for (const Level& level : levels) {
        double largest = 0;
        for (const LightAt& at : level.lights) {
            if (last) largest = std::max(largest, std::abs(at.light / std::max(*last, 1e-9) - 1));
            last = at.light;
        }
        steps.push_back(largest);
    }
    return steps;
}

Hair thinned(const Hair& hair, double share, float widen) {
    std::vector<std::uint32_t> order(hair.strandCount());
    for (std::uint32_t s = 0; s < order.size(); ++s) order[s] = s;
    std::ranges::sort(order, {}, [](std::uint32_t s) { return std::pair(hashUnit(s, 5, 0), s); });
    order.resize(std::clamp<std::size_t>(
        static_cast<std::size_t>(share * static_cast<double>(order.size()) + 0.5), 1, order.size()));
    std::ranges::sort(order);
    Hair thin;
    thin.specular = hair.specular, thin.shininess = hair.shininess;
    for (const std::uint32_t s : order) {
        for (std::size_t p = hair.offsets[s]; p < hair.offsets[s + 1]; ++p) {
            thin.positions_ws.push_back(hair.positions_ws[p]);
            thin.radii.push_back(widen * hair.radii[p]);
            thin.albedo.push_back(hair.albedo[p]);
        }
        thin.offsets.push_back(static_cast<std::uint32_t>(thin.positions_ws.size()));
        thin.rootNormals_ws.push_back(hair.rootNormals_ws[s]);
    }
    return thin;
}

Result<Chain> makeChain(const Hair& hair, const std::vector<LevelSpec>& specs, const ChainOptions& options,
                        const Progress& progress, Cancel cancel) {
    if (auto status = check(hair); !status) return tl::unexpected(status.error());
    const double steps = static_cast<double>(specs.size()) + 1;
    progress("strands", 0);
    const auto light = HairLight::make(hair, cancel);
    if (!light) return tl::unexpected(light.error());
    Chain chain;
    chain.strands = hair.strandCount();
    for (std::size_t s = 0; s < chain.strands; ++s) chain.roots_ws.push_back(hair.strand(s)[0]);
    chain.views = viewsAround(hair, options.directions);
    const StrandLight onStrands = strandLight(hair, *light);
    Plates plates;
    const Stage stage{hair, *light, plates, cancel};
    std::vector<std::uint32_t> heights;
    for (const LevelSpec& spec : specs) heights.push_back(spec.headPx);
    const auto shots = shootStrands(stage, onStrands, chain.views, heights);
    if (!shots) return tl::unexpected(shots.error());
    std::vector<View> viewsBetween;
    if (options.measure) viewsBetween = viewsAround(hair, options.directions, Around::between);
    for (std::uint32_t& px : heights) px = std::min(px, kNearestMeasuredPx);
    const auto between = printStrands(stage, onStrands, viewsBetween, heights);
    if (!between) return tl::unexpected(between.error());
    double share = 1 / steps;
    std::string_view making;
    // Nobody knows how many rounds a level takes: each does a tenth of what is left of it.
    const std::function<void()> tick = [&] {
        const double end = (2 + static_cast<double>(chain.levels.size())) / steps;
        progress(making, share += 0.1 * (end - share));
    };
    const Work work{hair,         *light,  chain.views, shots->shots, shots->drawMs, *between,
                    viewsBetween, options, stage,       tick,         cancel};
    for (std::size_t i = 0; i < specs.size(); ++i) {
        Level level;
        level.spec = specs[i];
        level.name = nameFor(specs[i]);
        level.untilPx = i + 1 < specs.size() ? specs[i + 1].headPx : kFarthestPx;
        making = level.name;
        progress(making, share = (1 + static_cast<double>(i)) / steps);
        const Stopwatch watch;
        const Status status = level.spec.kind == LevelKind::strands ? makeStrands(work, level)
                              : level.spec.kind == LevelKind::cards ? makeCardLevel(work, level)
                                                                    : makeShellLevel(work, level);
        if (!status) return tl::unexpected(status.error());
        chain.makeSeconds += watch.seconds();
        if (auto finished = finish(work, level); !finished) return tl::unexpected(finished.error());
        chain.levels.push_back(std::move(level));
    }
    for (const Level& level : chain.levels) {
        const auto* cards = std::get_if<Cards>(&level.content);
        if (cards == nullptr) continue;
        auto rig = makeRig(*cards, kChains, kJointsPerChain, cancel);
        if (!rig) return tl::unexpected(rig.error());
        chain.rig = std::move(*rig);
        break;
    }
    chain.springs.resize(chain.rig.chains());
    return chain;
}

}  // namespace hairloom::cards
