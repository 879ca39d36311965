// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_blend.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "core/base/parallel.h"
#include "core/documents/open.h"
#include "core/editing/records.h"
#include "core/editing/root_grid.h"
#include "core/editing/stack_commands.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/curve.h"
#include "core/operations/length_constraint.h"
#include "core/operations/skin_field.h"
#include "core/operations/stack.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 64;
constexpr std::size_t kNeighbours = 3;
constexpr float kSamePlace = 1e-4f;  // metres
constexpr float kClearance = 0.0005f;

constexpr Field<BlendSettings> kFields[] = {
    field<&BlendSettings::weight>("weight", "", 0, 1, "share of the way to the shape of the other hair"),
    field<&BlendSettings::reach>("reach", "m", 0.0001, 0.5,
                                 "distance between roots within which the other hair counts"),
};

using Neighbours = std::vector<editing::RootGrid::Neighbour>;

/// The other hair, as strands take its shape.
class OtherHair {
  public:
    OtherHair(const Groom& groom, const Groom& other, float reach)
        : groom_(groom), other_(other), reach_(reach), grid_(reach), skin_(sharedSkin(groom.scalp)) {
        if (groom.scalp) tree_.emplace(*groom.scalp, groom.scalpSelection);
        for (std::uint32_t s = 0; s < other.strandCount(); ++s) {
            if (other.strand(s).size() >= 2) grid_.add(s, other.strand(s)[0]);
        }
    }

    /// Distance of the nearest root; nothing, and no change, where none is within reach.
    std::optional<float> reshape(std::span<Vec3f> points) const {
        Neighbours near = grid_.nearest(points[0], kNeighbours, reach_);
        if (near.empty()) return std::nullopt;
        const float nearest = near[0].distance;
        if (nearest < kSamePlace) near.resize(1);
        std::vector<float> weights;
        float sum = 0;
        for (const auto& neighbour : near) {
            weights.push_back(1 / std::max(neighbour.distance, kSamePlace));
            sum += weights.back();
        }
        const Vec3f root = points[0], normal = normalAt(root);
        std::vector<float> lengths(points.size() - 1, 0.0f);
        std::ranges::fill(points, root);
        for (std::size_t k = 0; k < near.size(); ++k) {
            const auto own = other_.strand(near[k].strand);
            const std::vector<Vec3f> even =
                own.size() == points.size() ? std::vector<Vec3f>() : resampleEvenly(own, points.size());
            const std::span<const Vec3f> from = even.empty() ? own : std::span<const Vec3f>(even);
            const Quatf turn = shortestArc(normalAt(from[0]), normal);
            const float weight = weights[k] / sum;
            for (std::size_t p = 1; p < points.size(); ++p) {
                points[p] += weight * (turn * Vec3f(from[p] - from[0]));
                lengths[p - 1] += weight * (from[p] - from[p - 1]).norm();
            }
        }
        // The mean of strands that point apart is shorter than they are.
        if (near.size() > 1) restoreLengthsByDirection(points, lengths);
        if (skin_) keepOutside(points, lengths, *skin_, kClearance);
        return nearest;
    }

  private:
    Vec3f normalAt(const Vec3f& root) const {
        if (!tree_) return Vec3f::UnitY();
        const SurfacePoint at = tree_->closest(root).surface;
        return groom_.scalp->normalAt(at.triangle, at.barycentric);
    }

    const Groom& groom_;
    const Groom& other_;
    float reach_;
    editing::RootGrid grid_;
    std::shared_ptr<const SkinField> skin_;
    std::optional<SurfaceTree> tree_;
};

BlendSettings readSettings(JsonReader& reader) {
    BlendSettings settings;
    reader.fields(settings);
    settings.mask = readMask(reader);
    return settings;
}

std::string recordOfBlend(const std::string& path, const BlendSettings& settings) {
    nlohmann::ordered_json record = fieldsToJson(settings);
    record["file"] = std::filesystem::absolute(path).string();
    if (!settings.mask.isWhole()) record["mask"] = toJson(settings.mask);
    return editing::recordOf("blend", std::move(record));
}

RunOperation readBlend(JsonReader& reader) {
    const std::string path = reader.string("file");
    const BlendSettings settings = readSettings(reader);
    return [path, settings](Groom& groom) -> Result<std::size_t> {
        editing::Model model{groom, {}};
        auto blend = blendWithFile(model, path, settings);
        if (!blend) return tl::unexpected(blend.error());
        if (blend->command) blend->command->exchange(model);
        groom = std::move(model.groom);
        return blend->shape.matched;
    };
}

}  // namespace

std::span<const Field<BlendSettings>> fieldsOf(const BlendSettings&) {
    return kFields;
}

Result<OtherShape> shapeOfOther(const Groom& groom, const Groom& other, float reach) {
    if (groom.strandCount() == 0) return fail("there is no hair to blend", "place or import some first");
    if (other.strandCount() == 0) return fail("has no hair to blend with", "a hairstyle with strands");
    const OtherHair hair(groom, other, reach);
    OtherShape shape{{groom.positions().begin(), groom.positions().end()}};
    std::vector<float> distances(groom.strandCount(), -1.0f);
    parallelFor(groom.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
            if (count < 2) continue;
            distances[s] = hair.reshape(std::span(shape.points).subspan(first, count)).value_or(-1.0f);
        }
    });
    shape.matched =
        static_cast<std::size_t>(std::ranges::count_if(distances, [](float d) { return d >= 0; }));
    shape.farthest = std::max(0.0f, *std::ranges::max_element(distances));
    if (shape.matched == 0) {
        return fail(fmt::format("none of its {} strands grows within {} mm of a root of this hair",
                                other.strandCount(), readableDecimal(1e3f * reach)),
                    "hair on the same head: transfer it to this head first, or allow a larger reach");
    }
    return shape;
}

Result<HairBlend> blendWithFile(const editing::Model& model, const std::string& path,
                                const BlendSettings& settings) {
    if (auto status = checkFields("blend", settings); !status) return tl::unexpected(status.error());
    const auto other = openGroom(path);
    if (!other) return tl::unexpected(other.error());
    auto shape = shapeOfOther(model.groom, *other, settings.reach);
    if (!shape) return tl::unexpected(inFile(shape.error(), path));
    Operator sculpt = newOperator(kSculpt);
    sculpt.weight = settings.weight;
    setMaskOf(sculpt, settings.mask);
    const std::string name = fmt::format("Blend with {}", std::filesystem::path(path).filename().string());
    auto command =
        editing::addShape(model, shape->points, std::move(sculpt), name, recordOfBlend(path, settings));
    if (!command) return tl::unexpected(command.error());
    return HairBlend{std::move(*shape), std::move(*command)};
}

ScriptExtension blendExtension() {
    return {"blend", readBlend};
}

}  // namespace hairloom
