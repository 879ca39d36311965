// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/cards/judge.h"
#include "core/cards/raster.h"

namespace hairloom::cards {
namespace {

constexpr std::uint32_t kSquaresPerHead = 32;

/// Rows of a plate that a processor keeps at hand.
int rowsAtHand(int width) {
    constexpr int kSamplesAtHand = 1 << 15;
    return std::max(8, kSamplesAtHand / std::max(width, 1));
}

const Vec3f kSkin(0.42f, 0.31f, 0.25f);
const Vec3f kBackground(0.20f, 0.21f, 0.23f);

Vec3f skinLight(const Vec3f& normal_ws) {
    return kSkin * (0.45f + 0.55f * std::max(0.0f, normal_ws.dot(toLamp_ws())));
}

}  // namespace

std::vector<View> viewsAround(const Hair& hair, std::uint32_t count, Around around) {
    constexpr float kHeights[3] = {0, 20, -12};  // degrees
    constexpr float kSquare = kHeadHeight / static_cast<float>(kSquaresPerHead);
    std::vector<View> views;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float ahead = around == Around::between ? 0.5f : 0.0f;
        const float turn = radians(360 * (static_cast<float>(i) + ahead) / static_cast<float>(count));
        const float height = radians(kHeights[(i + (around == Around::between ? 2 : 0)) % 3]);
        View view;
        view.toEye_ws =
            Vec3f(std::sin(turn) * std::cos(height), std::sin(height), std::cos(turn) * std::cos(height));
        view.right_ws = Vec3f::UnitY().cross(view.toEye_ws).normalized();
        view.up_ws = view.toEye_ws.cross(view.right_ws);
        Vec2f low = Vec2f::Constant(std::numeric_limits<float>::infinity()), high = -low;
        for (const Vec3f& point : hair.positions_ws) {
            const Vec2f at(point.dot(view.right_ws), point.dot(view.up_ws));
            low = low.cwiseMin(at), high = high.cwiseMax(at);
        }
        low -= Vec2f::Constant(2 * kSquare), high += Vec2f::Constant(2 * kSquare);
        constexpr float kMostSquares = 512;
        const Vec2f squares = ((high - low) / kSquare).cwiseMin(kMostSquares);
        view.columns = static_cast<std::uint32_t>(std::ceil(squares.x()));
        view.rows = static_cast<std::uint32_t>(std::ceil(squares.y()));
        view.corner_ws = low.x() * view.right_ws + high.y() * view.up_ws;
        views.push_back(view);
    }
    return views;
}

StrandLight strandLight(const Hair& hair, const HairLight& light) {
    StrandLight result{std::vector<float>(hair.positions_ws.size()),
                       std::vector<float>(hair.positions_ws.size())};
    parallelFor(hair.positions_ws.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            result.open[p] = light.open(hair.positions_ws[p]);
            result.lit[p] = light.lit(hair.positions_ws[p]);
        }
    });
    return result;
}

void Plate::start(const View& view, std::uint32_t samplesPerHead) {
    view_ = view;
    samplesPerHead_ = samplesPerHead;
    perMetre_ = static_cast<float>(samplesPerHead) / kHeadHeight;
    width_ = static_cast<int>(view.columns * (samplesPerHead / kSquaresPerHead));
    height_ = static_cast<int>(view.rows * (samplesPerHead / kSquaresPerHead));
    const std::size_t samples = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    depth_.assign(samples, -std::numeric_limits<float>::infinity());
    colour_.assign(samples, kBackground);
    isHair_.assign(samples, 0);
}

Vec3f Plate::onPlate(const Vec3f& point_ws) const {
    const Vec3f d = point_ws - view_.corner_ws;
    return {d.dot(view_.right_ws) * perMetre_, -d.dot(view_.up_ws) * perMetre_, d.dot(view_.toEye_ws)};
}

void Plate::drawHead(const Hair& hair) {
    for (std::size_t t = 0; t + 2 < hair.headIndices.size(); t += 3) {
        std::array<Vec3f, 3> world, at;
        for (std::size_t k = 0; k < 3; ++k) {
            world[k] = hair.headPositions_ws[hair.headIndices[t + k]];
            at[k] = onPlate(world[k]);
        }
        const Vec3f normal = (world[1] - world[0]).cross(world[2] - world[0]);
        if (!(normal.norm() > 0)) continue;
        const Vec3f colour = skinLight(normal.normalized());
        forSamplesOfTriangle(at[0].head<2>(), at[1].head<2>(), at[2].head<2>(), width_, height_,
                             [&](int x, int y, const Vec3f& b) {
                                 const float depth =
                                     b.x() * at[0].z() + b.y() * at[1].z() + b.z() * at[2].z();
                                 const std::size_t i = index(x, y);
                                 if (depth <= depth_[i]) return;
                                 depth_[i] = depth, colour_[i] = colour, isHair_[i] = 0;
                             });
    }
}

void Plate::project(const Hair& hair, const StrandLight* light, std::size_t strand) {
    const Reflection fibre{hair.specular, hair.shininess};
    const std::size_t first = hair.offsets[strand], end = hair.offsets[strand + 1];
    for (std::size_t p = first; p < end; ++p) {
        const Vec3f at = onPlate(hair.positions_ws[p]);
        projected_.xs.push_back(at.x()), projected_.ys.push_back(at.y());
        projected_.radii.push_back(std::max(1e-4f, hair.radii[p] * perMetre_));
        projected_.depths.push_back(at.z());
        if (light == nullptr) continue;
        const Vec3f step =
            hair.positions_ws[std::min(p + 1, end - 1)] - hair.positions_ws[p == first ? p : p - 1];
        const Vec3f along = step.norm() > 0 ? Vec3f(step.normalized()) : Vec3f(0, -1, 0);
        projected_.colours.push_back(
            reflected(fibre, hair.albedo[p], along, view_.toEye_ws, light->open[p], light->lit[p]));
    }
}

/// Calls draw(sample, depth, segment, t). Strands come in their order at every sample, but sample by sample
/// of some rows that a processor keeps at hand, not of the whole plate.
template <class Draw>
void Plate::forStrandSamples(const Hair& hair, const StrandLight* light, const Draw& draw) {
    constexpr std::size_t kPointsAtOnce = 1u << 19u;
    const int rows = rowsAtHand(width_);
    auto& [xs, ys, radii, depths, colours, bands] = projected_;
    bands.resize(static_cast<std::size_t>((height_ + rows - 1) / rows));
    const auto place = [&](std::size_t p) { return LinePoint{{xs[p], ys[p]}, Vec2f::Constant(radii[p])}; };
    for (std::size_t s = 0; s < hair.strandCount();) {
        xs.clear(), ys.clear(), radii.clear(), depths.clear(), colours.clear();
        for (auto& band : bands) band.clear();
        do {
            const std::size_t first = xs.size();
            project(hair, light, s);
            for (std::size_t p = first; p + 1 < xs.size(); ++p) {
                const Rows touched = rowsOfLine(place(p), place(p + 1), height_);
                for (int band = touched.first / rows; band * rows < touched.end; ++band)
                    bands[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(p));
            }
        } while (++s < hair.strandCount() && xs.size() < kPointsAtOnce);
        for (std::size_t band = 0; band < bands.size(); ++band) {
            const int top = static_cast<int>(band) * rows;
            const Rows inBand{top, std::min(top + rows, height_)};
            for (const std::uint32_t p : bands[band]) {
                forSamplesOfLine(place(p), place(p + 1), width_, inBand, [&](int x, int y, float t) {
                    draw(index(x, y), depths[p] + t * (depths[p + 1] - depths[p]), p, t);
                });
            }
        }
    }
}

void Plate::drawStrands(const Hair& hair, const StrandLight& light) {
    const std::vector<Vec3f>& colours = projected_.colours;
    forStrandSamples(hair, &light, [&](std::size_t at, float depth, std::size_t p, float t) {
        if (depth <= depth_[at]) return;
        depth_[at] = depth, isHair_[at] = 1;
        colour_[at] = (1 - t) * colours[p] + t * colours[p + 1];
    });
}

void Plate::coverByStrands(const Hair& hair) {
    forStrandSamples(hair, nullptr, [&](std::size_t at, float depth, std::size_t, float) {
        if (depth > depth_[at]) isHair_[at] = 1;
    });
}

namespace {

/// Level of the atlas between whose texels pixels lie, by area, as anisotropic filters have it.
float levelOf(const Cards& cards, const std::array<const CardVertex*, 3>& v, float areaPx) {
    const auto side = static_cast<float>(cards.atlas.side());
    const Vec2f e = (v[1]->uv - v[0]->uv) * side, f = (v[2]->uv - v[0]->uv) * side;
    const float texels = 0.5f * std::abs(e.x() * f.y() - e.y() * f.x());
    const float level = 0.5f * std::log2(std::max(texels, 1e-6f) / std::max(areaPx, 1e-6f));
    return std::clamp(level, 0.0f, static_cast<float>(cards.atlas.levels.size() - 1));
}

/// Triangles as an eye meets them: what lies behind needs no look at its texture.
std::vector<std::uint32_t> nearestFirst(const CardMesh& mesh, const Vec3f& toEye_ws) {
    std::vector<std::pair<float, std::uint32_t>> keyed(mesh.indices.size() / 3);
    for (std::uint32_t t = 0; t < keyed.size(); ++t) {
        float away = 0;
        for (std::size_t k = 0; k < 3; ++k)
            away -= mesh.vertices[mesh.indices[3 * std::size_t{t} + k]].position_ws.dot(toEye_ws);
        keyed[t] = {away, t};
    }
    std::ranges::sort(keyed);
    std::vector<std::uint32_t> order;
    for (const auto& [away, t] : keyed) order.push_back(t);
    return order;
}

/// A triangle of cards on the plate.
struct Face {
    std::uint32_t triangle, dither;
    std::array<const CardVertex*, 3> v;
    Vec3f a, b, c;                   ///< samples, and metres towards the eye
    CoverageSampler finer, coarser;  ///< of the levels of the atlas on both sides of its own
    float share;                     ///< of the coarser one
    float most;                      ///< that it covers a sample by
};

/// What lies behind samples that were drawn. Most of a triangle does.
struct BehindDrawn {
    const float* depths;
    int width;
    Vec3f corners;  ///< depths of the triangle's
    float nearest;  ///< no sample of the triangle is nearer, however it is rounded

    BehindDrawn(const float* drawn, int columns, const Face& face)
        : depths(drawn), width(columns), corners(face.a.z(), face.b.z(), face.c.z()) {
        constexpr float kRounding = 1e-5f;
        nearest = corners.maxCoeff() + kRounding * corners.cwiseAbs().maxCoeff();
    }
    bool operator()(int x, int y) const { return x + kSamplesAtOnce <= width && !(at(x, y) < nearest).any(); }
    bool operator()(int x, int y, const SampleRow& u, const SampleRow& v, const SampleRow& w) const {
        if (x + kSamplesAtOnce > width) return false;
        const SampleRow own = u * corners.x() + v * corners.y() + w * corners.z();
        return !(own > at(x, y)).any();
    }

  private:
    Eigen::Map<const SampleRow> at(int x, int y) const {
        return Eigen::Map<const SampleRow>(depths + static_cast<std::ptrdiff_t>(y) * width + x);
    }
};

template <class T>
T mixed(const Vec3f& b, const T& x, const T& y, const T& z) {
    return b.x() * x + b.y() * y + b.z() * z;
}

}  // namespace

void Plate::drawCards(const Hair& hair, const HairLight& light, const Cards& cards, std::uint32_t headPx) {
    const float perPx = static_cast<float>(samplesPerHead_) / static_cast<float>(headPx);
    seen_.assign(depth_.size(), {});
    std::vector<float> levels(cards.mesh.indices.size() / 3);
    const auto corners = [&](std::size_t triangle) {
        std::array<const CardVertex*, 3> v{};
        for (std::size_t k = 0; k < 3; ++k) v[k] = &cards.mesh.vertices[cards.mesh.indices[3 * triangle + k]];
        return v;
    };
    const int rows = rowsAtHand(width_);
    std::vector<Face> faces;
    std::vector<std::vector<std::uint32_t>> bands(static_cast<std::size_t>((height_ + rows - 1) / rows));
    for (const std::uint32_t t : nearestFirst(cards.mesh, view_.toEye_ws)) {
        const auto v = corners(t);
        const Vec3f a = onPlate(v[0]->position_ws), b = onPlate(v[1]->position_ws),
                    c = onPlate(v[2]->position_ws);
        const float area = 0.5f * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
        if (area == 0 || !std::isfinite(area)) continue;
        const float level = levels[t] = levelOf(cards, v, area / (perPx * perPx));
        const auto low = static_cast<std::size_t>(level);
        const std::size_t high = std::min(low + 1, cards.atlas.levels.size() - 1);
        const float share = level - static_cast<float>(low);
        const Rect& rect = cards.atlas.rects[v[0]->texture];
        const CoverageSampler finer(cards.atlas, rect, low), coarser(cards.atlas, rect, high);
        const Vec2f least = v[0]->place.cwiseMin(v[1]->place).cwiseMin(v[2]->place);
        const Vec2f largest = v[0]->place.cwiseMax(v[1]->place).cwiseMax(v[2]->place);
        // Most samples of thin hair fail by this alone.
        const float most = (1 - share) * finer.most(least, largest) + share * coarser.most(least, largest);
        const Rows touched = rowsOfTriangle(a.head<2>(), b.head<2>(), c.head<2>(), {0, height_});
        for (int band = touched.first / rows; band * rows < touched.end; ++band)
            bands[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(faces.size()));
        // Both strips of a card that has two are dithered by themselves.
        const std::uint32_t own = 2 * v[0]->card + (v[0]->crosses ? 1 : 0);
        faces.push_back({t, own, v, a, b, c, finer, coarser, share, most});
    }
    // A band at a time: every sample meets the triangles in the same order.
    const auto draw = [&](const Face& face, Rows inBand) {
        const Vec3f &a = face.a, &b = face.b, &c = face.c;
        forSamplesOfTriangle(
            a.head<2>(), b.head<2>(), c.head<2>(), width_, inBand,
            [&](int x, int y, const Vec3f& w) {
                const std::size_t i = index(x, y);
                const float depth = mixed(w, a.z(), b.z(), c.z());
                if (depth <= depth_[i]) return;
                const float dither =
                    hashUnit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), face.dither);
                if (face.most <= dither) return;
                const Vec2f place = mixed<Vec2f>(w, face.v[0]->place, face.v[1]->place, face.v[2]->place);
                const float alpha = (1 - face.share) * face.finer.at(place.x(), place.y()) +
                                    face.share * face.coarser.at(place.x(), place.y());
                if (alpha <= dither) return;
                depth_[i] = depth, isHair_[i] = 1;
                seen_[i] = {face.triangle, w.x(), w.y()};
            },
            BehindDrawn(depth_.data(), width_, face));
    };
    for (std::size_t band = 0; band < bands.size(); ++band) {
        const int top = static_cast<int>(band) * rows;
        for (const std::uint32_t f : bands[band]) draw(faces[f], {top, std::min(top + rows, height_)});
    }
    const Reflection fibre{hair.specular, hair.shininess};
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        if (seen_[i].triangle == UINT32_MAX) continue;
        const auto v = corners(seen_[i].triangle);
        const Vec3f w(seen_[i].b0, seen_[i].b1, 1 - seen_[i].b0 - seen_[i].b1);
        const Vec2f place = mixed<Vec2f>(w, v[0]->place, v[1]->place, v[2]->place);
        const auto level = static_cast<std::size_t>(levels[seen_[i].triangle] + 0.5f);
        const Texel texel =
            sample(cards.atlas, cards.atlas.rects[v[0]->texture], level, place.x(), place.y());
        const Vec3f normal = mixed<Vec3f>(w, v[0]->normal_ws, v[1]->normal_ws, v[2]->normal_ws).normalized();
        const Vec3f strip = mixed<Vec3f>(w, v[0]->along_ws, v[1]->along_ws, v[2]->along_ws).normalized();
        const Vec3f along = (texel.flow.y() * strip + texel.flow.x() * normal.cross(strip)).normalized();
        const Vec3f tint = mixed<Vec3f>(w, v[0]->tint, v[1]->tint, v[2]->tint);
        const float open = std::min(1.0f, texel.open * mixed(w, v[0]->open, v[1]->open, v[2]->open));
        // Depths are off the first strip.
        const float depth = v[0]->crosses ? 0 : texel.depth;
        const Vec3f at =
            mixed<Vec3f>(w, v[0]->position_ws, v[1]->position_ws, v[2]->position_ws) + depth * normal;
        colour_[i] =
            reflected(fibre, texel.albedo.cwiseProduct(tint), along, view_.toEye_ws, open, light.lit(at));
    }
}

void Plate::drawShell(const Hair& hair, const HairLight& light, const Shell& shell) {
    const Reflection fibre{hair.specular, hair.shininess};
    std::vector<Vec3f> at, colours;
    for (const ShellVertex& v : shell.vertices) {
        at.push_back(onPlate(v.position_ws));
        colours.push_back(
            reflected(fibre, v.albedo, v.along_ws, view_.toEye_ws, v.open, light.lit(v.position_ws)));
    }
    for (std::size_t t = 0; t + 2 < shell.indices.size(); t += 3) {
        const std::uint32_t a = shell.indices[t], b = shell.indices[t + 1], c = shell.indices[t + 2];
        forSamplesOfTriangle(at[a].head<2>(), at[b].head<2>(), at[c].head<2>(), width_, height_,
                             [&](int x, int y, const Vec3f& w) {
                                 const float depth = mixed(w, at[a].z(), at[b].z(), at[c].z());
                                 const std::size_t i = index(x, y);
                                 if (depth <= depth_[i]) return;
                                 depth_[i] = depth, isHair_[i] = 1;
                                 colour_[i] = mixed<Vec3f>(w, colours[a], colours[b], colours[c]);
                             });
    }
}

Shot Plate::developed(std::uint32_t headPx) const {
    const std::uint32_t finer = samplesPerHead_ / headPx;
    Shot shot;
    shot.width = static_cast<std::uint32_t>(width_) / finer;
    shot.height = static_cast<std::uint32_t>(height_) / finer;
    const float share = 1 / static_cast<float>(finer * finer);
    const std::size_t pixels = std::size_t{shot.width} * shot.height;
    shot.coverage.reserve(pixels), shot.skin.reserve(pixels);
    shot.hair.reserve(pixels), shot.all.reserve(pixels);
    for (std::uint32_t y = 0; y < shot.height; ++y) {
        for (std::uint32_t x = 0; x < shot.width; ++x) {
            float coverage = 0, skin = 0;
            Vec3f hair = Vec3f::Zero(), all = Vec3f::Zero();
            for (std::uint32_t j = 0; j < finer; ++j) {
                const std::size_t first = index(static_cast<int>(x * finer), static_cast<int>(y * finer + j));
                for (std::size_t at = first; at < first + finer; ++at) {
                    all += colour_[at];
                    if (isHair_[at] == 0) {
                        if (std::isfinite(depth_[at])) skin += 1;
                        continue;
                    }
                    coverage += 1, hair += colour_[at];
                }
            }
            shot.coverage.push_back(share * coverage);
            shot.skin.push_back(share * skin);
            shot.hair.push_back(share * hair);
            shot.all.push_back(share * all);
        }
    }
    return shot;
}

}  // namespace hairloom::cards
