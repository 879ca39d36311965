// SPDX-License-Identifier: MIT
#include "engine/body_gpu.h"

#include <algorithm>
#include <bit>

namespace hairloom::runtime {
namespace {

static_assert(HAIRLOOM_BODY_BLOCK_CELLS == BodyField::kBlockCells);
static_assert(HAIRLOOM_BODY_BLOCK_QUADS == BodyTable::kBlockQuads);
static_assert(HAIRLOOM_BODY_NO_BLOCK == BodyField::kNoBlock);
static_assert(static_cast<float>(HAIRLOOM_BODY_FINE_UNIT) == BodyField::kFineUnit);
static_assert(static_cast<float>(HAIRLOOM_BODY_FINE_REACH) == BodyField::kFineReach);
static_assert(static_cast<float>(HAIRLOOM_BODY_FINE_END) == BodyField::kFineEnd);
static_assert(HAIRLOOM_ROD_FOLD_PLANES == kFoldPlanes);

void putRows(const BonePose& pose, Vector<shaders::float4>& rows) {
    rows.push_back({pose.x.x, pose.y.x, pose.z.x, pose.origin.x});
    rows.push_back({pose.x.y, pose.y.y, pose.z.y, pose.origin.y});
    rows.push_back({pose.x.z, pose.y.z, pose.z.z, pose.origin.z});
}

void putPalette(const PosedBody& posed, Vector<shaders::float4>& rows) {
    for (const BonePose& pose : posed.palette()) putRows(pose, rows);
}

void putBone(const BonePose& inverse, const BonePose& before, shaders::float4 facts,
             Vector<shaders::float4>& rows) {
    putRows(inverse, rows);
    putRows(before, rows);
    rows.push_back(facts);
}

}  // namespace

GpuBody gpuBodyOf(const BodyField& field, const BodyTable& table) {
    GpuBody body{};
    const auto append = [&](const Vector<std::int32_t>& words) {
        const auto first = static_cast<std::uint32_t>(body.table.size());
        for (const std::int32_t word : words) body.table.push_back(static_cast<std::uint32_t>(word));
        return first;
    };
    shaders::BodyConstants& c = body.constants;
    append(table.cells);
    c.quads = append(table.quads);
    c.pairs = append(table.pairs);
    c.refinements = append(table.refinements);
    c.finer = append(table.finer);
    c.skins = append(table.skins);
    c.skinBones = append(table.skinBones);
    c.skinWeights = append(table.skinWeights);
    c.boxes = static_cast<std::uint32_t>(body.table.size());
    for (const BodyField::Box& box : field.boxes) {
        for (const float number : {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z})
            body.table.push_back(std::bit_cast<std::uint32_t>(number));
    }
    c.hasBoxes = field.boxes.empty() ? 0 : 1;
    c.low = {field.low_ss.x, field.low_ss.y, field.low_ss.z, field.cell};
    c.size = {field.size[0], field.size[1], field.size[2], 1};
    c.unit = field.unit;
    return body;
}

void putBodyPoses(const MovingBody& body, std::uint32_t substeps, shaders::BodyConstants& constants,
                  Vector<shaders::float4>& rows) {
    rows.clear();
    // All bones alike in the whole frame, or none is.
    const bool isWhole = body.isWhole(0);
    std::size_t palette = body.posed(0).palette().size();
    for (std::uint32_t i = 1; i <= substeps; ++i) palette = std::max(palette, body.posed(i).palette().size());
    const std::size_t bones = isWhole ? 1 : body.inverses(0).size();
    for (std::uint32_t i = 0; i <= substeps; ++i) {
        putPalette(body.posed(i), rows);
        // A body whose bones are alike for a moment has one pose then, which all of its skin has.
        const std::size_t end = (std::size_t{i} + 1) * palette * HAIRLOOM_BODY_POSE_ROWS;
        const Vector<shaders::float4> first(rows.end() - HAIRLOOM_BODY_POSE_ROWS, rows.end());
        while (rows.size() < end) rows.insert(rows.end(), first.begin(), first.end());
    }
    constants.bonesAt = static_cast<std::uint32_t>(rows.size());
    for (std::uint32_t i = 0; i <= substeps; ++i) {
        // Poses of the start are those of the end of the step before; nothing is looked for in their spaces.
        const std::uint32_t step = i == 0 ? 0 : i - 1;
        const auto carriers = body.carriers(step);
        for (std::size_t b = 0; b < bones; ++b) {
            const auto carrier = std::find_if(carriers.begin(), carriers.end(),
                                              [&](const auto& own) { return isWhole || own.bone == b; });
            const bool carries = i > 0 && carrier != carriers.end() && carrier->usable;
            if (i == 0) {
                const BonePose start = body.starts()[b];
                const float least = leastStretch(start);
                putBone(least > 0.0f ? inverseOf(start) : BonePose{}, {}, {least, 0.0f, 0.0f, 0.0f}, rows);
                continue;
            }
            const shaders::float4 facts{body.leasts(step)[b], carries ? carrier->apart : 0.0f,
                                        carries ? 1.0f : 0.0f, 0.0f};
            putBone(body.inverses(step)[b], carries ? carrier->before : BonePose{}, facts, rows);
        }
    }
    constants.size.w = static_cast<std::uint32_t>(bones);
    constants.palette = static_cast<std::uint32_t>(palette);
    constants.steps = substeps;
    constants.moves = body.moves() ? 1 : 0;
}

}  // namespace hairloom::runtime
