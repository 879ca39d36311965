// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/bake_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>

#include "core/base/parallel.h"
#include "core/geometry/mesh_solid.h"

namespace hairloom {
namespace {

using runtime::BodyField;

constexpr std::size_t kGrain = 64;
constexpr float kBand = 0.006f;    ///< metres before and behind the skin that blocks know
constexpr float kMargin = 0.012f;  ///< metres around the mesh that the table knows
constexpr float kCoarsest = 0.05f / BodyField::kBlockCells;
constexpr auto kBlockCells = static_cast<float>(BodyField::kBlockCells);
/// Bytes of each cell and of each of its corners.
constexpr double kPerCell = 2 * 3;

runtime::Float3 toEngine(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

/// What a mesh encloses, and its skin: parts that lie in others are no way out.
class Body {
  public:
    explicit Body(const ScalpMesh& mesh)
        : solid_(mesh.positions(), mesh.triangles()), faces_(solid_.skin()), skin_(cornersOf(mesh, faces_)) {}

    const MeshSolid& solid() const { return solid_; }
    bool contains(const Vec3f& point) const { return solid_.contains(point); }
    float distance(const Vec3f& point) const {
        const auto hit = skin_.closest(point);
        return hit ? static_cast<float>(hit->distance) : std::numeric_limits<float>::infinity();
    }
    float signedDistance(const Vec3f& point) const {
        return contains(point) ? -distance(point) : distance(point);
    }
    /// The nearest place of the skin; the triangle is the mesh's.
    std::optional<TriangleTree::Hit> nearest(const Vec3f& point) const {
        auto hit = skin_.closest(point);
        if (hit) hit->triangle = faces_[hit->triangle];
        return hit;
    }
    std::span<const std::uint32_t> faces() const { return faces_; }

  private:
    static std::vector<TriangleTree::Corners> cornersOf(const ScalpMesh& mesh,
                                                        std::span<const std::uint32_t> faces) {
        std::vector<TriangleTree::Corners> corners;
        for (const std::uint32_t face : faces) {
            const Triangle& t = mesh.triangles()[face];
            corners.push_back({mesh.positions()[t[0]], mesh.positions()[t[1]], mesh.positions()[t[2]]});
        }
        return corners;
    }

    MeshSolid solid_;
    std::vector<std::uint32_t> faces_;
    TriangleTree skin_;
};

/// Cells of a table over a mesh.
struct Table {
    float cell;
    Vec3f low;
    Eigen::Array3i size;

    /// `bounds` hold all that it is to know.
    Table(const Box3f& bounds, float cell_) : cell(cell_) {
        const Vec3f extent = bounds.sizes();
        size = (extent.array() / cell).ceil().max(1).cast<int>();
        low = bounds.center() - 0.5f * cell * size.cast<float>().matrix();
    }
    std::size_t cells() const { return static_cast<std::size_t>(size.cast<std::int64_t>().prod()); }
    std::size_t corners() const { return static_cast<std::size_t>((size + 1).cast<std::int64_t>().prod()); }
    Vec3f corner(std::size_t index) const { return low + cell * at(index, size + 1).cast<float>().matrix(); }
    Vec3f cellLow(std::size_t index) const { return low + cell * at(index, size).cast<float>().matrix(); }

    static Eigen::Array3i at(std::size_t index, const Eigen::Array3i& of) {
        const auto x = static_cast<std::size_t>(of.x()), y = static_cast<std::size_t>(of.y());
        return {static_cast<int>(index % x), static_cast<int>(index / x % y),
                static_cast<int>(index / (x * y))};
    }
};

/// The cells of a table that need a block.
std::vector<std::size_t> cellsNearSkin(const Table& table, const Body& body) {
    const float reach = kBand + 0.5f * std::sqrt(3.0f) * table.cell;
    std::vector<std::uint8_t> isNear(table.cells(), 0);
    parallelFor(isNear.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            isNear[i] = body.distance(table.cellLow(i) + Vec3f::Constant(0.5f * table.cell)) <= reach ? 1 : 0;
    });
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < isNear.size(); ++i) {
        if (isNear[i]) near.push_back(i);
    }
    return near;
}

double bytesOf(const Table& table, std::size_t blocks) {
    return kPerCell * static_cast<double>(table.corners()) +
           static_cast<double>(BodyField::kBlockValues) * static_cast<double>(blocks);
}

/// The finest table that fits, and its cells near the skin.
struct Fitting {
    Table table;
    std::vector<std::size_t> near;
    bool isFinest;
};

Result<Fitting> fittingTable(const ScalpMesh& mesh, const Body& body, const Box3f& bounds,
                             const BakeBodyOptions& options) {
    constexpr float kGrowth = 1.12f;
    constexpr double kForBones = 20'000;
    constexpr double kEnough = 1.25;  // of what is expected
    // A flat skin passes through about so many cells for each square of their size.
    constexpr double kLayers = 1.3;
    double area = 0;
    for (const std::uint32_t face : body.faces()) {
        if (bounds.contains(mesh.pointAt(face, Vec3f::Constant(1.0f / 3))))
            area += static_cast<double>(mesh.triangleArea(face));
    }
    const double most = static_cast<double>(options.mostBytes);
    const auto expectedCells = [&](const Table& table) {
        const double squares = area / static_cast<double>(table.cell * table.cell);
        return squares * (kLayers + static_cast<double>(2 * kBand / table.cell));
    };
    for (float fine = options.finest; fine <= kCoarsest; fine *= kGrowth) {
        const Table table(bounds, fine * kBlockCells);
        // Most sizes that do not fit need no counting.
        if (bytesOf(table, static_cast<std::size_t>(0.8 * expectedCells(table))) + kForBones > most) continue;
        std::vector<std::size_t> near = cellsNearSkin(table, body);
        if (bytesOf(table, near.size()) + kForBones > most || near.size() >= BodyField::kNoBlock) continue;
        return Fitting{table, std::move(near), fine == options.finest};
    }
    const Table table(bounds, kCoarsest * kBlockCells);
    const double bytes = bytesOf(table, static_cast<std::size_t>(expectedCells(table))) + kForBones;
    return fail(fmt::format("the body is {:.1f} m large and takes about {:.0f} kB in cells of {:.0f} mm",
                            static_cast<double>(bounds.sizes().maxCoeff()), 1e-3 * bytes,
                            1e3 * static_cast<double>(kCoarsest)),
                fmt::format("{:.0f} kB at most: allow {:.0f} kB, or import a head in metres, without what "
                            "hair never reaches",
                            1e-3 * most, 1e-3 * kEnough * bytes));
}

void measureCorners(const Table& table, const Body& body, BodyField& field) {
    std::vector<float> distances(table.corners());
    parallelFor(distances.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) distances[i] = body.signedDistance(table.corner(i));
    });
    float largest = 0;
    for (const float distance : distances) largest = std::max(largest, std::abs(distance));
    constexpr auto kSteps = static_cast<float>(std::numeric_limits<std::int16_t>::max());
    field.unit = std::max(largest / kSteps, 1e-6f);
    for (const float distance : distances)
        field.distances.push_back(static_cast<std::int16_t>(std::lround(distance / field.unit)));
}

void measureBlocks(const Table& table, std::span<const std::size_t> near, const Body& body,
                   BodyField& field) {
    constexpr std::uint32_t kCorners = BodyField::kBlockCorners;
    constexpr float kMost = std::numeric_limits<std::int8_t>::max();
    const float fine = table.cell / kBlockCells;
    field.blocks.assign(table.cells(), BodyField::kNoBlock);
    field.values.resize(near.size() * BodyField::kBlockValues);
    for (std::size_t b = 0; b < near.size(); ++b) field.blocks[near[b]] = static_cast<std::uint16_t>(b);
    parallelFor(near.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const Vec3f low = table.cellLow(near[b]);
            std::int8_t* value = field.values.data() + b * BodyField::kBlockValues;
            for (std::uint32_t z = 0; z < kCorners; ++z)
                for (std::uint32_t y = 0; y < kCorners; ++y) {
                    float before = 0;
                    for (std::uint32_t x = 0; x < kCorners; ++x) {
                        const Vec3f at = low + fine * Vec3f(static_cast<float>(x), static_cast<float>(y),
                                                            static_cast<float>(z));
                        const float distance = body.distance(at);
                        // No skin lies between two places whose distances reach each other.
                        const bool same = x > 0 && 1.001f * fine < distance + std::abs(before);
                        before = (same ? before < 0 : body.contains(at)) ? -distance : distance;
                        const float steps = std::clamp(before / BodyField::kFineUnit, -kMost, kMost);
                        *value++ = static_cast<std::int8_t>(std::lround(steps));
                    }
                }
        }
    });
}

/// Which bones move a place, as shares of 255.
class SkinTable {
  public:
    SkinTable(const ScalpMesh& mesh, const SkinWeights& skin, const Body& body)
        : mesh_(mesh), skin_(skin), body_(body) {}

    using Shares = std::array<std::pair<std::uint32_t, std::uint8_t>, 4>;  ///< strongest first

    /// `steps` of 255 at most: fewer make fewer different ones.
    Shares at(const Vec3f& point, float steps) const {
        Shares shares{};
        const auto hit = body_.nearest(point);
        if (!hit) return shares;
        std::map<std::uint32_t, double> sums;
        const Triangle& triangle = mesh_.triangles()[hit->triangle];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = triangle[corner];
            for (std::size_t i = 0; i < kBonesOfVertex; ++i) {
                const double weight = hit->barycentric[static_cast<Eigen::Index>(corner)] *
                                      static_cast<double>(skin_.weights[v][i]);
                if (weight > 0) sums[skin_.bones[v][i]] += weight;
            }
        }
        std::vector<std::pair<std::uint32_t, double>> sorted(sums.begin(), sums.end());
        std::ranges::stable_sort(sorted, std::greater<>(), &std::pair<std::uint32_t, double>::second);
        if (sorted.size() > 4) sorted.resize(4);
        double total = 0;
        for (const auto& [bone, weight] : sorted) total += weight;
        int left = 255;
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            const double share = std::round(sorted[i].second / total * static_cast<double>(steps));
            const auto weight = static_cast<int>(std::lround(share / static_cast<double>(steps) * 255));
            const int given = std::min(weight, left);
            shares[i] = {sorted[i].first, static_cast<std::uint8_t>(given)};
            left -= given;
        }
        if (!sorted.empty()) shares[0].second = static_cast<std::uint8_t>(shares[0].second + left);
        return shares;
    }

  private:
    const ScalpMesh& mesh_;
    const SkinWeights& skin_;
    const Body& body_;
};

/// The skin of all corners; false where there are too many different ones in so many steps.
bool fillSkins(const Table& table, const SkinTable& skins, float steps, std::vector<std::uint32_t>& bones,
               BodyField& field) {
    constexpr std::size_t kMostPalette = 2000;
    std::vector<SkinTable::Shares> ofCorners(table.corners());
    parallelFor(ofCorners.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ofCorners[i] = skins.at(table.corner(i), steps);
    });
    std::map<std::uint32_t, std::uint8_t> numbers;
    std::map<SkinTable::Shares, std::uint16_t> known;
    field.skins.clear();
    field.palette.clear();
    bones.clear();
    for (const SkinTable::Shares& shares : ofCorners) {
        const auto [found, isNew] =
            known.try_emplace(shares, static_cast<std::uint16_t>(field.palette.size()));
        field.skins.push_back(found->second);
        if (!isNew) continue;
        if (field.palette.size() >= kMostPalette) return false;
        BodyField::Skin skin;
        for (std::size_t i = 0; i < shares.size(); ++i) {
            if (shares[i].second == 0) continue;
            const auto [bone, first] =
                numbers.try_emplace(shares[i].first, static_cast<std::uint8_t>(bones.size()));
            if (first) bones.push_back(shares[i].first);
            skin.bones[i] = bone->second;
            skin.weights[i] = shares[i].second;
        }
        field.palette.push_back(skin);
    }
    return true;
}

/// Around the corners that a bone moves, as far as hair may be from its skin.
void boxBones(const Table& table, std::size_t bones, BodyField& field) {
    constexpr float kFar = 0.05f;  // metres
    std::vector<Box3f> boxes(bones);
    for (std::size_t i = 0; i < field.skins.size(); ++i) {
        if (field.unit * static_cast<float>(field.distances[i]) > kFar + table.cell) continue;
        const BodyField::Skin& skin = field.palette[field.skins[i]];
        for (std::size_t k = 0; k < skin.bones.size(); ++k) {
            if (skin.weights[k] > 0) boxes[skin.bones[k]].extend(table.corner(i));
        }
    }
    field.boxes.clear();
    for (const Box3f& box : boxes) {
        const Vec3f around = Vec3f::Constant(table.cell);
        field.boxes.push_back(
            box.isEmpty() ? BodyField::Box{}
                          : BodyField::Box{toEngine(box.min() - around), toEngine(box.max() + around)});
    }
}

/// Vertices and middles of the skin's triangles, and with `between` three more places of each.
std::vector<Vec3f> placesOfSkin(const ScalpMesh& mesh, const Body& body, bool between) {
    std::vector<std::uint8_t> isSkin(mesh.vertexCount(), 0);
    std::vector<Vec3f> places;
    for (const std::uint32_t face : body.faces()) {
        places.push_back(mesh.pointAt(face, Vec3f::Constant(1.0f / 3)));
        for (Eigen::Index corner = 0; between && corner < 3; ++corner) {
            Vec3f shares = Vec3f::Constant(1.0f / 6);
            shares[corner] = 2.0f / 3;
            places.push_back(mesh.pointAt(face, shares));
        }
        for (const std::uint32_t v : mesh.triangles()[face]) {
            if (!isSkin[v]) places.push_back(mesh.positions()[v]);
            isSkin[v] = 1;
        }
    }
    return places;
}

/// Distances that are right at corners are not between them. Changes those beside the skin by as little as
/// makes the table 0 there (Kaczmarz's rows in turn, one place each).
void fitBlocks(const Table& table, std::span<const std::size_t> near, std::span<const Vec3f> places,
               BodyField& field) {
    constexpr int kPasses = 12;
    constexpr float kMost = 0.002f, kShare = 0.7f, kSteps = std::numeric_limits<std::int8_t>::max();
    constexpr std::uint32_t kCorners = BodyField::kBlockCorners, kCells = BodyField::kBlockCells;
    const Eigen::Array3i size = static_cast<int>(kCells) * table.size + 1;
    const auto indexOf = [&](const Eigen::Array3i& at) {
        return (static_cast<std::size_t>(at.z()) * static_cast<std::size_t>(size.y()) +
                static_cast<std::size_t>(at.y())) *
                   static_cast<std::size_t>(size.x()) +
               static_cast<std::size_t>(at.x());
    };
    // Blocks share the corners between them.
    struct Corner {
        float measured, change = 0;
    };
    std::unordered_map<std::size_t, Corner> corners;
    const auto forEachValue = [&](auto&& visit) {
        for (std::size_t b = 0; b < near.size(); ++b) {
            const Eigen::Array3i low = static_cast<int>(kCells) * Table::at(near[b], table.size);
            std::int8_t* value = field.values.data() + b * BodyField::kBlockValues;
            for (int z = 0; z < static_cast<int>(kCorners); ++z)
                for (int y = 0; y < static_cast<int>(kCorners); ++y)
                    for (int x = 0; x < static_cast<int>(kCorners); ++x)
                        visit(indexOf(low + Eigen::Array3i(x, y, z)), *value++);
        }
    };
    forEachValue([&](std::size_t corner, std::int8_t value) {
        corners.try_emplace(corner, Corner{BodyField::kFineUnit * static_cast<float>(value)});
    });
    const float perFine = static_cast<float>(kCells) / table.cell;
    for (int pass = 0; pass < kPasses; ++pass) {
        for (const Vec3f& place : places) {
            const Vec3f at = (place - table.low) * perFine;
            const Eigen::Array3i low = at.array().floor().cast<int>();
            if ((low < 0).any() || (low + 1 >= size).any()) continue;
            const Vec3f in = at - low.cast<float>().matrix();
            std::array<Corner*, 8> around{};
            std::array<float, 8> weights{};
            float distance = 0, squares = 0;
            bool known = true;
            for (std::size_t i = 0; i < 8 && known; ++i) {
                const Eigen::Array3i step(static_cast<int>(i & 1), static_cast<int>(i >> 1 & 1),
                                          static_cast<int>(i >> 2));
                const auto found = corners.find(indexOf(low + step));
                known = found != corners.end();
                if (!known) break;
                around[i] = &found->second;
                weights[i] = (step.x() ? in.x() : 1 - in.x()) * (step.y() ? in.y() : 1 - in.y()) *
                             (step.z() ? in.z() : 1 - in.z());
                distance += weights[i] * (around[i]->measured + around[i]->change);
                squares += weights[i] * weights[i];
            }
            if (!known) continue;
            for (std::size_t i = 0; i < 8; ++i)
                around[i]->change =
                    std::clamp(around[i]->change - kShare * distance * weights[i] / squares, -kMost, kMost);
        }
    }
    forEachValue([&](std::size_t corner, std::int8_t& value) {
        const Corner& c = corners.at(corner);
        const float steps = std::clamp((c.measured + c.change) / BodyField::kFineUnit, -kSteps, kSteps);
        value = static_cast<std::int8_t>(std::lround(steps));
    });
}

BodyFit fitOf(const ScalpMesh& mesh, const Body& body, const BodyField& field) {
    const std::vector<Vec3f> places = placesOfSkin(mesh, body, true);
    std::vector<float> distances(places.size());
    parallelFor(places.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        // Beyond the table the field knows nothing: infinite, and left out.
        for (std::size_t i = begin; i < end; ++i) distances[i] = field.at(toEngine(places[i])).distance;
    });
    BodyFit fit;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const float distance = distances[i];
        if (!std::isfinite(distance)) continue;
        ++count;
        sum += static_cast<double>(std::max(distance, 0.0f));
        fit.worstBulge = std::max(fit.worstBulge, -distance);
        if (distance <= fit.worstGap) continue;
        fit.worstGap = distance;
        fit.worstGapAt_ss = places[i];
    }
    fit.meanGap = count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0;
    return fit;
}

}  // namespace

Box3f reachOfHair(const Groom& groom) {
    constexpr float kBeyond = 0.02f;  // metres
    Box3f box;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto strand = groom.strand(s);
        float length = kBeyond;
        for (std::size_t p = 1; p < strand.size(); ++p) length += (strand[p] - strand[p - 1]).norm();
        box.extend(Vec3f(strand[0] - Vec3f::Constant(length)));
        box.extend(Vec3f(strand[0] + Vec3f::Constant(length)));
    }
    return box;
}

BodyFit measureBody(const ScalpMesh& mesh, const BodyField& field) {
    const Body body(mesh);
    return body.faces().empty() ? BodyFit{} : fitOf(mesh, body, field);
}

Result<BakedBody> bakeBody(const ScalpMesh& mesh, const SkinWeights& skin,
                           std::span<const std::string> boneNames, const BakeBodyOptions& options) {
    const bool isSkinned = skin.vertexCount() > 0;
    if (isSkinned && skin.vertexCount() != mesh.vertexCount())
        return fail(fmt::format("weights of {} vertices", skin.vertexCount()),
                    fmt::format("the {} of the mesh", mesh.vertexCount()));
    const Body body(mesh);
    if (!body.solid().enclosesAnything() || body.faces().empty())
        return fail("the mesh encloses no space, so that it has no inside to keep hair out of",
                    "expected a body; it may be open at the neck. Spheres cover a sheet");
    Box3f bounds = body.solid().bounds();
    bounds.min() -= Vec3f::Constant(kMargin);
    bounds.max() += Vec3f::Constant(kMargin);
    if (!options.where.isEmpty()) bounds = bounds.intersection(options.where);
    if (bounds.isEmpty()) return fail("hair reaches no skin", "expected hair on the head");
    const auto fitting = fittingTable(mesh, body, bounds, options);
    if (!fitting) return tl::unexpected(fitting.error());
    const Table& table = fitting->table;

    BakedBody baked;
    const auto made = std::make_shared<BodyField>();
    BodyField& field = *made;
    field.low_ss = toEngine(table.low);
    field.cell = table.cell;
    for (Eigen::Index i = 0; i < 3; ++i)
        field.size[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(table.size[i]);
    baked.cell = table.cell / kBlockCells;
    measureCorners(table, body, field);
    measureBlocks(table, fitting->near, body, field);
    fitBlocks(table, fitting->near, placesOfSkin(mesh, body, false), field);
    std::vector<std::uint32_t> bones;
    if (isSkinned) {
        const SkinTable skins(mesh, skin, body);
        bool filled = false;
        for (const float steps : {255.0f, 51.0f, 15.0f, 5.0f}) {
            filled = fillSkins(table, skins, steps, bones, field);
            if (filled) break;
        }
        if (!filled || bones.size() > 255)
            return fail(fmt::format("{} bones move the body in too many ways", bones.size()),
                        "255 bones at most");
        for (const std::uint32_t bone : bones)
            field.bones.emplace_back(bone < boneNames.size() ? boneNames[bone]
                                                             : fmt::format("bone {}", bone));
        boxBones(table, field.bones.size(), field);
    } else {
        field.palette.resize(1);
        field.skins.assign(table.corners(), 0);
    }
    baked.fit = fitOf(mesh, body, field);
    baked.field = made;
    if (!fitting->isFinest)
        baked.notes.push_back(fmt::format("distances are {:.1f} mm apart, not {:.1f}, to fit into {:.0f} kB",
                                          1e3 * static_cast<double>(baked.cell),
                                          1e3 * static_cast<double>(options.finest),
                                          1e-3 * static_cast<double>(options.mostBytes)));
    return baked;
}

Result<BakedBody> bakeBodyOf(const Groom& groom, const Actor* actor, const BakeBodyOptions& given) {
    if (!groom.scalp)
        return fail("there is no head to keep hair out of",
                    "expected a head, which `create` and `import --mesh` set");
    BakeBodyOptions options = given;
    if (options.where.isEmpty()) options.where = reachOfHair(groom);
    if (!actor || actor->skin().vertexCount() == 0) return bakeBody(*groom.scalp, {}, {}, options);
    if (actor->mesh().vertexCount() != groom.scalp->vertexCount())
        return fail(fmt::format("the character's mesh has {} vertices", actor->mesh().vertexCount()),
                    fmt::format("the {} of the groom's head", groom.scalp->vertexCount()));
    std::vector<std::string> names;
    for (const Bone& bone : actor->skeleton().bones()) names.push_back(bone.name);
    return bakeBody(*groom.scalp, actor->skin(), names, options);
}

}  // namespace hairloom
