// SPDX-License-Identifier: GPL-3.0-or-later
// Operators and brushes that leave the way of hair as it is fold no strand: on every sample and on hair at
// random, none turns more than 30° further between two segments than it did. Roots and lengths stay.

#include <gmock/gmock.h>

#include <algorithm>
#include <map>

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

TEST(Folds, NoOperatorMakesAnyThatGathersSmoothsOrShortensHair) {
    for (const std::string_view op : {"clump", "smooth", "straighten", "noise", "flyaways", "trim"}) {
        std::size_t changed = 0;
        for (const auto& [name, before] : hairstyles()) {
            Operator one = newOperator(op);
            for (const FieldRow& row : findStackOperator(op)->fields)
                if (op == "trim" && row.info.name == std::string_view("maxLength"))
                    setSettingOf(one, row.info, 0.04, 0);
            Groom after = before;
            after.operators = {one};
            after.pointAttributes.set(attribute::kBasePosition, std::vector<Vec3f>(before.positions().begin(),
                                                                                   before.positions().end()));
            StackCache cache;
            const auto shape = evaluateStack(after, cache);
            ASSERT_TRUE(shape) << op << ": " << shape.error().message();
            const auto made = std::get<CowArray<Vec3f>>(*shape).view();
            after.pointAttributes.set(attribute::kPosition, std::vector<Vec3f>(made.begin(), made.end()));
            const Folds folds = foldsOf(before, after);
            changed += folds.changed;
            EXPECT_TRUE(rootsStay(before, after)) << op << " on " << name;
            EXPECT_EQ(folds.folded, 0u) << op << " on " << name << ", worst " << folds.worst;
        }
        EXPECT_GT(changed, 100u) << op;
    }
}

TEST(Folds, NoBrushMakesAnyThatSmoothsLiftsOrCutsHair) {
    for (const std::string_view brush : {"smooth", "straighten", "puff", "noise", "cut"}) {
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
            const Folds folds = foldsOf(before, after);
            changed += folds.changed;
            EXPECT_TRUE(rootsStay(before, after)) << brush << " on " << name;
            if (editing::brushInfo(brush).keepsLengths) {
                EXPECT_LT(longestStretch(before, after), 1e-3f) << brush << " on " << name;
            }
            EXPECT_EQ(folds.folded, 0u) << brush << " on " << name << ", worst " << folds.worst;
        }
        EXPECT_GT(changed, 20u) << brush;
    }
}

}  // namespace
}  // namespace hairloom
