// SPDX-License-Identifier: GPL-3.0-or-later
// Hair does not fold: no operator and no brush that gives segments their lengths back makes turns between
// neighbouring segments that it was not made for.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/documents/sample.h"
#include "core/editing/brush_list.h"
#include "core/editing/document.h"
#include "core/editing/replay.h"
#include "core/geometry/curve.h"
#include "core/operations/length_constraint.h"
#include "core/operations/skin_field.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

const std::filesystem::path kSamples = sourceDir() / "samples";

constexpr float kNewTurn = 30;       ///< degrees that count as a kink
constexpr float kFold = 120;         ///< no strand may turn back by this, at the skin either
constexpr float kNearSkin = 0.004f;  ///< metres within which it may be the skin that turns a strand

/// Degrees between the segments that meet at each inner point; 0 where one has no length.
std::vector<float> turnsOf(std::span<const Vec3f> points) {
    std::vector<float> turns(points.size(), 0);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const Vec3f a = points[i] - points[i - 1], b = points[i + 1] - points[i];
        if (!(a.norm() > 1e-7f) || !(b.norm() > 1e-7f)) continue;
        turns[i] = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi;
    }
    return turns;
}

struct Kinks {
    std::size_t made = 0;    ///< strands with a new turn beyond what was asked for, away from the skin
    std::size_t folded = 0;  ///< strands that turn back where they did not
    float worst = 0;         ///< degrees
    std::size_t changed = 0;
};

/// A turn is new where it exceeds those that the strand had there, and next to it, by more than `asked`.
Kinks newTurns(const Groom& before, const Groom& after, float asked) {
    const auto skin = after.scalp ? sharedSkin(after.scalp) : nullptr;
    Kinks kinks;
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        const auto was = before.strand(s), is = after.strand(s);
        if (std::ranges::equal(was, is)) continue;
        ++kinks.changed;
        const auto old = turnsOf(was), now = turnsOf(is);
        bool kinked = false, folded = false;
        for (std::size_t i = 1; i + 1 < is.size(); ++i) {
            const float had = std::max({old[i - 1], old[i], old[i + 1]});
            if (now[i] <= had + asked) continue;
            folded = folded || now[i] > std::max(kFold, had + asked);
            bool atSkin = false;
            for (std::size_t k = i - 1; skin && k <= i + 1; ++k)
                atSkin = atSkin || skin->distanceUpTo(is[k], kNearSkin).distance < kNearSkin;
            if (atSkin) continue;
            kinked = true;
            kinks.worst = std::max(kinks.worst, now[i]);
        }
        kinks.made += kinked;
        kinks.folded += folded;
    }
    return kinks;
}

/// What holds whatever is done: roots, lengths, out of the skin as far as they were.
void expectSound(const Groom& before, const Groom& after, bool keepsLengths) {
    const auto skin = after.scalp ? sharedSkin(after.scalp) : nullptr;
    std::size_t roots = 0, lengths = 0, inside = 0;
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        const auto was = before.strand(s), is = after.strand(s);
        roots += was[0] != is[0];
        for (std::size_t i = 1; i < is.size(); ++i) {
            const float length = (was[i] - was[i - 1]).norm();
            lengths += std::abs((is[i] - is[i - 1]).norm() - length) > 2e-6f + 1e-4f * length;
            inside += skin && is[i] != was[i] && skin->distanceAt(is[i]).distance < -3e-4f;
        }
    }
    EXPECT_EQ(roots, 0u) << "roots moved";
    if (keepsLengths) {
        EXPECT_EQ(lengths, 0u) << "segments changed their lengths";
    }
    EXPECT_EQ(inside, 0u) << "points were moved into the skin";
}

Vec3f anyDirection(Random& random) {
    const float x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    return Vec3f(x, y, random.uniform(-1, 1) + 1e-3f).normalized();
}

/// Hair of all kinds on a round head: of 8 to 40 points, three centimetres to half a metre, straight to wavy,
/// with segments of unlike lengths, and as on a head the hair beside it goes much the same way.
Groom randomHair(std::uint64_t seed) {
    Groom groom =
        straightHair(sphereScalp(0.09f, 4), 400, 8 + static_cast<std::uint32_t>(seed % 3) * 16, 0.2f, seed);
    const auto skin = sharedSkin(groom.scalp);
    std::vector<Vec3f> positions(groom.positions().begin(), groom.positions().end());
    Random random(seed);
    const Vec3f lean = anyDirection(random), axis = anyDirection(random), across = anyDirection(random);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
        const Vec3f root = positions[first];
        const float place = 20 * root.dot(across);
        const float length = 0.03f * std::pow(15.0f, 0.5f + 0.5f * std::sin(place)) * random.uniform(0.7f, 1);
        Vec3f direction = (positions[first + 1] - root).normalized();
        direction = (direction + 0.7f * lean + 0.2f * anyDirection(random)).normalized();
        for (std::size_t i = 1; i < count; ++i) {
            const float share = static_cast<float>(i) / static_cast<float>(count - 1);
            const float step = length / static_cast<float>(count - 1) * random.uniform(0.6f, 1.4f);
            const float bend = radians(12 * std::sin(place + 14 * share)) * (seed == 2 ? 0.2f : 1.0f);
            direction = (Eigen::AngleAxisf(bend, axis) * direction).normalized();
            const Vec3f& from = positions[first + i - 1];
            positions[first + i] = placeOutside(*skin, from, direction, step, std::min(0.0015f, 0.4f * step));
            direction = (positions[first + i] - from).normalized();
        }
    }
    groom.pointAttributes.set(attribute::kPosition, std::move(positions));
    return groom;
}

struct Hair {
    std::string name;
    Groom groom;
};

/// The samples as they are before their stack has clumped and bent them, and as they are made; random hair.
const std::vector<Hair>& allHair() {
    static const std::vector<Hair> all = [] {
        std::vector<Hair> hair;
        for (const std::string& name : sampleNames(kSamples)) {
            auto made = makeSample(kSamples, name);
            if (!made) {
                ADD_FAILURE() << name << ": " << made.error().message();
                continue;
            }
            made->operators.clear();
            hair.push_back({name, std::move(*made)});
        }
        for (const std::uint64_t seed : {1, 2, 3})
            hair.push_back({"random" + std::to_string(seed), randomHair(seed)});
        return hair;
    }();
    return all;
}

Box3f headOf(const Groom& groom) {
    Box3f box;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) box.extend(groom.strand(s)[0]);
    return box;
}

/// With a curve over the head from front to back where it takes one.
Operator operatorFor(std::string_view name, const Groom& groom) {
    Operator made = newOperator(name);
    const StackOperator& known = *findStackOperator(name);
    if (!known.hasCurve) return made;
    const Box3f head = headOf(groom);
    const Vec3f middle = head.center(), half = 0.5f * head.sizes();
    const bool parts = name == "part";
    const std::vector<Vec3f> parting{middle + Vec3f(0, half.y(), half.z()),
                                     middle + Vec3f(0, 1.05f * half.y(), 0),
                                     middle + Vec3f(0, half.y(), -half.z())};
    const std::vector<Vec3f> down{middle - Vec3f(0, 0, 1.2f * half.z()),
                                  middle - Vec3f(0, half.y(), 1.4f * half.z()),
                                  middle - Vec3f(0, 0.3f, 1.4f * half.z())};
    setCurveOf(made, {parts ? parting : down});
    return made;
}

/// Degrees between neighbouring segments that an operator is there to make, where that is more than kNewTurn:
/// waves and curls of four segments each, hair laid anew along a path or out of its skin.
float askedOf(std::string_view name) {
    if (name == "curl" || name == "wave" || name == "frizz" || name == "noise" || name == "flyaways")
        return 95;
    if (name == "braid" || name == "bun" || name == "flow" || name == "mirror" || name == "bend") return 95;
    return kNewTurn;
}

bool keepsLengths(std::string_view name) {
    return name != "trim" && name != "set_length" && name != "mirror" && name != "braid" && name != "sculpt";
}

TEST(StrandTurns, NoOperatorFoldsHair) {
    for (const Hair& hair : allHair()) {
        for (const StackOperator& known : stackOperators()) {
            if (known.name == kSculpt) continue;
            SCOPED_TRACE(hair.name + ", " + std::string(known.name));
            Groom after = hair.groom;
            after.pointAttributes.set(attribute::kBasePosition,
                                      std::vector<Vec3f>(after.positions().begin(), after.positions().end()));
            after.operators = {operatorFor(known.name, after)};
            StackCache cache;
            auto made = evaluateStack(after, cache);
            ASSERT_TRUE(made) << made.error().message();
            after.pointAttributes.set(attribute::kPosition, std::move(*made));
            const Kinks kinks = newTurns(hair.groom, after, askedOf(known.name));
            if (std::getenv("TURNS"))
                std::fprintf(stderr, "%s %s: changed %zu kinked %zu folded %zu worst %.0f\n",
                             hair.name.c_str(), std::string(known.name).c_str(), kinks.changed, kinks.made,
                             kinks.folded, double(kinks.worst));
            EXPECT_EQ(kinks.made, 0u) << "strands of " << kinks.changed << ", up to " << kinks.worst << "°";
            EXPECT_EQ(kinks.folded, 0u);
            expectSound(hair.groom, after, keepsLengths(known.name));
        }
    }
}

/// Over the hair at random: nine dabs along a way.
editing::Stroke randomStroke(std::string_view tool, const Groom& groom, Random& random) {
    editing::Stroke stroke;
    stroke.tool = tool;
    const Box3f head = headOf(groom);
    stroke.settings.radius = random.uniform(0.015f, 0.06f);
    stroke.settings.strength = random.uniform(0.3f, 1);
    stroke.settings.invert = random.below(3) == 0;
    stroke.settings.seed = 1 + random.below(100);
    const auto strand = groom.strand(random.below(static_cast<std::uint32_t>(groom.strandCount())));
    const bool onSkin = tool == "part";
    Vec3f at = onSkin ? strand[0] : strand[strand.size() / 2];
    const Vec3f way = anyDirection(random) * random.uniform(0.1f, 0.5f) * stroke.settings.radius;
    for (int i = 0; i < 9; ++i, at += way) stroke.dabs.push_back(editing::dabAt(stroke.settings, at));
    return stroke;
}

float askedOfBrush(std::string_view name) {
    // They turn what lies under the brush and not what lies beside it, as far as the stroke says.
    if (name == "comb" || name == "grab" || name == "brush" || name == "puff" || name == "twist" ||
        name == "pinch" || name == "part" || name == "clump")
        return 95;
    return name == "curl" || name == "noise" || name == "mirror" ? 95 : kNewTurn;
}

TEST(StrandTurns, NoBrushFoldsHair) {
    Random random(11);
    for (const Hair& hair : allHair()) {
        for (const std::string_view name : editing::brushNames()) {
            const editing::BrushInfo& info = editing::brushInfo(name);
            if (!info.movesHair || !info.keepsLengths || name == "add") continue;
            SCOPED_TRACE(hair.name + ", " + std::string(name));
            editing::Document document(hair.groom);
            for (int i = 0; i < 3; ++i) {
                const Groom before = document.groom();
                ASSERT_TRUE(document.replay(randomStroke(name, before, random)));
                if (document.groom().strandCount() != before.strandCount()) break;
                const Kinks kinks = newTurns(before, document.groom(), askedOfBrush(name));
                if (std::getenv("TURNS"))
                    std::fprintf(stderr, "%s %s: changed %zu kinked %zu folded %zu worst %.0f\n",
                                 hair.name.c_str(), std::string(name).c_str(), kinks.changed, kinks.made,
                                 kinks.folded, double(kinks.worst));
                EXPECT_EQ(kinks.made, 0u)
                    << "strands of " << kinks.changed << ", up to " << kinks.worst << "°";
                EXPECT_EQ(kinks.folded, 0u);
                expectSound(before, document.groom(), true);
            }
        }
    }
}

}  // namespace
}  // namespace hairloom
