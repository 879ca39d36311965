// SPDX-License-Identifier: GPL-3.0-or-later
// No operator or brush folds strands: on every sample and on hair at random, none turns more than 30° further
// between two segments than it did, unless its definition asks for that. Roots and lengths stay.

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "core/documents/sample.h"
#include "core/editing/brush_list.h"
#include "core/editing/document.h"
#include "core/groom/strand_subset.h"
#include "core/groom/validate.h"
#include "core/operations/stack.h"
#include "tests/groom/groom_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

constexpr std::size_t kStrands = 240;  ///< of each hairstyle
constexpr float kFold = 30;            ///< degrees beyond what there was

/// Some strands of each sample, spread over the head, and waves at random on a sphere.
const std::map<std::string, Groom>& hairstyles() {
    static const std::map<std::string, Groom> kAll = [] {
        std::map<std::string, Groom> all;
        const auto samples = sourceDir() / "samples";
        for (const std::string& name : sampleNames(samples)) {
            Groom whole = makeSample(samples, name).value();
            dropOperators(whole);
            std::vector<std::uint32_t> some;
            const std::size_t step = std::max<std::size_t>(1, whole.strandCount() / kStrands);
            for (std::size_t s = 0; s < whole.strandCount(); s += step)
                some.push_back(static_cast<std::uint32_t>(s));
            all.emplace(name, strandsOf(whole, some));
        }
        Groom waves = straightHair(sphereScalp(0.09f, 4), kStrands, 20, 0.2f);
        auto& points = waves.pointAttributes.edit<Vec3f>(attribute::kPosition);
        Random random(7, 1);
        for (std::size_t s = 0; s < waves.strandCount(); ++s) {
            const float phase = random.uniform(-kPi, kPi), size = random.uniform(0, 0.006f);
            const Vec3f out = (points[waves.offsets[s] + 1] - points[waves.offsets[s]]).normalized();
            const Vec3f aside = out.unitOrthogonal(), other = out.cross(aside);
            for (std::uint32_t p = waves.offsets[s] + 1; p < waves.offsets[s + 1]; ++p) {
                const float t = static_cast<float>(p - waves.offsets[s]);
                points[p] += size * (std::sin(0.7f * t + phase) * aside + std::cos(0.5f * t) * other);
            }
        }
        all.emplace("random", std::move(waves));
        return all;
    }();
    return kAll;
}

/// Strands that fold, and the worst turn.
struct Folds {
    std::size_t changed = 0, folded = 0;
    float worst = 0;  ///< degrees
};
Folds foldsOf(const Groom& before, const Groom& after) {
    Folds folds;
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        const auto a = before.strand(s), b = after.strand(s);
        if (std::ranges::equal(a, b)) continue;
        ++folds.changed;
        const float turn = largestTurn(b);
        if (turn <= largestTurn(a) + kFold) continue;
        ++folds.folded;
        folds.worst = std::max(folds.worst, turn);
    }
    return folds;
}
float longestStretch(const Groom& before, const Groom& after) {
    float most = 0;
    for (std::size_t s = 0; s < before.strandCount(); ++s) {
        const auto a = before.strand(s), b = after.strand(s);
        for (std::size_t p = 1; p < a.size(); ++p) {
            const float was = (a[p] - a[p - 1]).norm();
            most = std::max(most, std::abs((b[p] - b[p - 1]).norm() - was) / std::max(was, 1e-5f));
        }
    }
    return most;
}
bool rootsStay(const Groom& before, const Groom& after) {
    for (std::size_t s = 0; s < before.strandCount(); ++s)
        if (before.strand(s)[0] != after.strand(s)[0]) return false;
    return true;
}

/// Why an operator or a brush may turn hair sharply: it is what its definition asks for.
using Asked = std::map<std::string_view, std::string_view>;
const Asked& askedOfOperators() {
    static const Asked kAsked{
        {"curl", "winds hair with a radius, which its points follow as well as they lie"},
        {"wave", "swings hair to and fro, down to four segments a wave"},
        {"frizz", "sets waves at random upon hair"},
        {"braid", "leads hair to a curve, where three locks cross over and back"},
        {"bun", "gathers hair to a place and rolls it up there"},
        {"mirror", "copies shapes of other strands with the turns that those have"},
    };
    return kAsked;
}
const Asked& askedOfBrushes() {
    static const Asked kAsked{
        {"curl", "winds hair with a radius, which its points follow as well as they lie"},
        {"mirror", "copies shapes of other strands with the turns that those have"},
        {"add", "makes new hair"},
        {"delete", "removes hair"},
        {"freeze", "moves none"},
        {"slide", "moves roots to other places, which its own tests try"},
    };
    return kAsked;
}

Result<Groom> operated(const Groom& before, const Operator& one) {
    Groom after = before;
    after.operators = {one};
    after.pointAttributes.set(attribute::kBasePosition,
                              std::vector<Vec3f>(before.positions().begin(), before.positions().end()));
    StackCache cache;
    const auto shape = evaluateStack(after, cache);
    if (!shape) return tl::unexpected(shape.error());
    const auto made = std::get<CowArray<Vec3f>>(*shape).view();
    after.pointAttributes.set(attribute::kPosition, std::vector<Vec3f>(made.begin(), made.end()));
    return after;
}

/// At its defaults, with a curve over the head, and with something to do. The flow may bend within two
/// segments of this hair, which its default does not leave it.
Operator operatorToTry(const StackOperator& known, const Groom& hair) {
    Operator one = newOperator(known.name);
    if (known.hasCurve) {
        const Vec3f top = hair.scalp->bounds().max();
        setCurveOf(one, {{Vec3f(0.01f, top.y() - 0.03f, 0.07f), Vec3f(0.01f, top.y() - 0.005f, 0.03f),
                          Vec3f(0.01f, top.y() - 0.01f, -0.03f)}});
    }
    for (const FieldRow& row : known.fields) {
        if (known.name == "trim" && row.info.name == std::string_view("maxLength"))
            setSettingOf(one, row.info, 0.04, 0);
        if (known.name == "flow" && row.info.name == std::string_view("bend"))
            setSettingOf(one, row.info, 0.03, 0);
    }
    return one;
}

TEST(Folds, NoOperatorMakesAnyThatItsDefinitionDoesNotAskFor) {
    std::set<std::string_view> met;
    for (const StackOperator& known : stackOperators()) {
        if (known.name == kSculpt) continue;  // keeps what brushes did
        std::size_t changed = 0;
        for (const auto& [name, before] : hairstyles()) {
            const auto after = operated(before, operatorToTry(known, before));
            ASSERT_TRUE(after) << known.name << ": " << after.error().message();
            const Folds folds = foldsOf(before, *after);
            changed += folds.changed;
            EXPECT_TRUE(rootsStay(before, *after)) << known.name << " on " << name;
            if (askedOfOperators().contains(known.name)) {
                if (folds.folded > 0) met.insert(known.name);
                continue;
            }
            EXPECT_EQ(folds.folded, 0u) << known.name << " on " << name << ", worst " << folds.worst;
        }
        if (known.name != "collide") {
            EXPECT_GT(changed, 100u) << known.name;
        }
    }
    for (const auto& [name, why] : askedOfOperators())
        EXPECT_TRUE(met.contains(name)) << name << " folds nothing any more: take it from the list";
}

TEST(Folds, NoBrushMakesAnyThatItsDefinitionDoesNotAskFor) {
    for (const std::string_view brush : editing::brushNames()) {
        const editing::BrushInfo& info = editing::brushInfo(brush);
        if (!info.movesHair) continue;
        std::size_t changed = 0;
        for (const auto& [name, before] : hairstyles()) {
            editing::Document document(before);
            editing::Stroke stroke;
            stroke.tool = brush;
            stroke.settings.radius = 0.05f;
            stroke.settings.strength = 0.8f;
            stroke.settings.depth = 0.2f;
            const Box3f box = before.bounds();
            for (int i = 0; i < 8; ++i) {
                const float across = 0.12f * (static_cast<float>(i) / 7 - 0.5f);
                const Vec3f at(across, box.max().y() - 0.03f, box.center().z() + 0.05f);
                stroke.dabs.push_back(editing::dabAt(stroke.settings, at, -Vec3f::UnitZ()));
            }
            const auto touched = document.replay(stroke);
            ASSERT_TRUE(touched) << brush << " on " << name << ": " << touched.error().message();
            const Groom& after = document.groom();
            if (after.pointCount() != before.pointCount()) continue;
            const Folds folds = foldsOf(before, after);
            changed += folds.changed;
            if (askedOfBrushes().contains(brush)) continue;
            EXPECT_TRUE(rootsStay(before, after)) << brush << " on " << name;
            if (info.keepsLengths) {
                EXPECT_LT(longestStretch(before, after), 1e-3f) << brush << " on " << name;
            }
            EXPECT_EQ(folds.folded, 0u) << brush << " on " << name << ", worst " << folds.worst;
        }
        if (!askedOfBrushes().contains(brush)) {
            EXPECT_GT(changed, 20u) << brush;
        }
    }
}

}  // namespace
}  // namespace hairloom
