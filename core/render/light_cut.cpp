// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/light_cut.h"

#include <algorithm>
#include <cmath>

namespace hairloom::render {
namespace {

constexpr float kPointlike = 0.03f;  // radians: an extent below which no lobe sees one
constexpr int kNoPart = -1;

/// A light of the result, and what it may be cut into.
struct Piece {
    Light light;         ///< of kinds that shaders have
    float power = 0;     ///< luminance of its irradiance at the centre
    float extent = 0;    ///< radians, standard deviation of its directions there, by both axes
    Light area;          ///< a rectangle that the light stands for, where it is one
    int part = kNoPart;  ///< of the environment's bright parts, likewise
};

float luminance(const Vec3f& rgb) {
    return rgb.dot(Vec3f(0.2126f, 0.7152f, 0.0722f));
}

Vec3f irradianceAt(const Light& light, const Vec3f& place_ws) {
    if (light.kind == LightKind::directional) return light.irradiance;
    const Vec3f way = light.position_ws - place_ws;
    const float squared = std::max(way.squaredNorm(), 1e-6f);
    const float facing =
        light.facing_ws.isZero(0) ? 1.0f : std::max(-light.facing_ws.dot(way) / std::sqrt(squared), 0.0f);
    return light.intensity * (facing / squared);
}

Vec3f directionAt(const Light& light, const Vec3f& place_ws) {
    if (light.kind == LightKind::directional) return light.toLight_ws.normalized();
    const Vec3f way = light.position_ws - place_ws;
    return way.norm() > 0 ? Vec3f(way.normalized()) : Vec3f::UnitY();
}

Piece plain(const Light& light, const Vec3f& centre_ws) {
    Piece piece;
    piece.light = light;
    piece.power = luminance(irradianceAt(light, centre_ws));
    return piece;
}

/// A rectangle as the point in its middle. A disc is the square of its area, whose light is as much and comes
/// from as wide around.
Piece ofArea(Light area, const Vec3f& centre_ws) {
    if (area.kind == LightKind::disc) {
        const float side = 0.5f * std::sqrt(kPi);
        area.kind = LightKind::rectangle;
        area.halfAcross_ws *= side;
        area.halfUp_ws *= side;
    }
    Light point;
    point.kind = LightKind::point;
    point.castsShadow = area.castsShadow;
    point.position_ws = area.position_ws;
    point.facing_ws = area.halfAcross_ws.cross(area.halfUp_ws).normalized();
    const float metres2 = 4 * area.halfAcross_ws.cross(area.halfUp_ws).norm();
    point.intensity = area.radiance * metres2;
    Piece piece = plain(point, centre_ws);
    const float distance = std::max((area.position_ws - centre_ws).norm(), 1e-3f);
    piece.extent =
        std::sqrt((area.halfAcross_ws.squaredNorm() + area.halfUp_ws.squaredNorm()) / 3) / distance;
    piece.area = area;
    return piece;
}

Piece ofPart(const Environment& environment, int part) {
    const BrightPart& bright = environment.bright[static_cast<std::size_t>(part)];
    Piece piece;
    piece.light.toLight_ws = bright.toLight_ws;
    piece.light.irradiance = bright.irradiance;
    piece.power = luminance(bright.irradiance);
    piece.extent = bright.extent;
    piece.part = part;
    return piece;
}

class Cutter {
  public:
    Cutter(const Environment& environment, const Vec3f& centre_ws)
        : environment_(environment), centre_ws_(centre_ws) {}

    /// Cuts what is worth it until there are `count`.
    void cut(std::vector<Piece>& pieces, std::size_t count) const {
        while (pieces.size() < count) {
            const auto widest = std::ranges::max_element(pieces, {}, [&](const Piece& piece) {
                return canBeCut(piece) ? piece.power * piece.extent : 0;
            });
            if (widest == pieces.end() || !canBeCut(*widest)) return;
            const auto [first, second] = halves(*widest);
            *widest = first;
            pieces.push_back(second);
        }
    }

  private:
    bool canBeCut(const Piece& piece) const {
        if (!(piece.extent > kPointlike) || !(piece.power > 0)) return false;
        return piece.area.kind == LightKind::rectangle ||
               (piece.part != kNoPart &&
                environment_.bright[static_cast<std::size_t>(piece.part)].first != kNoPart);
    }

    std::pair<Piece, Piece> halves(const Piece& piece) const {
        if (piece.part != kNoPart) {
            const BrightPart& bright = environment_.bright[static_cast<std::size_t>(piece.part)];
            return {ofPart(environment_, bright.first), ofPart(environment_, bright.second)};
        }
        Light one = piece.area, other = piece.area;
        const bool acrossIsLonger = one.halfAcross_ws.squaredNorm() >= one.halfUp_ws.squaredNorm();
        for (Light* half : {&one, &other}) {
            Vec3f& longer = acrossIsLonger ? half->halfAcross_ws : half->halfUp_ws;
            longer *= 0.5f;
            half->position_ws += half == &one ? Vec3f(-longer) : longer;
        }
        return {ofArea(one, centre_ws_), ofArea(other, centre_ws_)};
    }

    const Environment& environment_;
    Vec3f centre_ws_;
};

}  // namespace

LightCut cutLights(std::span<const Light> lights, const Environment& environment, const Vec3f& centre_ws,
                   const LightBudget& budget) {
    LightCut result;
    result.rest = environment;
    std::vector<Piece> shadowed, open;
    for (const Light& light : lights) {
        const bool isArea = light.kind == LightKind::rectangle || light.kind == LightKind::disc;
        (light.castsShadow ? shadowed : open)
            .push_back(isArea ? ofArea(light, centre_ws) : plain(light, centre_ws));
    }
    for (const int root : environment.brightRoots) shadowed.push_back(ofPart(environment, root));
    result.rest.bright.clear();
    result.rest.brightRoots.clear();

    const auto keep = [&](std::vector<Piece>& pieces, std::size_t count) {
        // The lights' own order stays: sums of light depend on it.
        if (pieces.size() > count) {
            std::vector<float> powers;
            for (const Piece& piece : pieces) powers.push_back(piece.power);
            std::ranges::nth_element(powers, powers.begin() + static_cast<std::ptrdiff_t>(count),
                                     std::greater<>());
            const float least = powers[count];
            std::vector<Piece> kept;
            for (const Piece& piece : pieces) {
                if (piece.power > least && kept.size() < count) {
                    kept.push_back(piece);
                } else {
                    result.rest.add(directionAt(piece.light, centre_ws),
                                    irradianceAt(piece.light, centre_ws));
                }
            }
            pieces = std::move(kept);
        }
    };
    keep(shadowed, budget.shadowed);
    keep(open, budget.all - std::min<std::size_t>(shadowed.size(), budget.all));
    const Cutter cutter(environment, centre_ws);
    cutter.cut(shadowed, std::min<std::size_t>(budget.shadowed, budget.all - open.size()));
    cutter.cut(open, budget.all - shadowed.size());
    for (const auto* pieces : {&shadowed, &open}) {
        for (const Piece& piece : *pieces) result.lights.push_back(piece.light);
    }
    return result;
}

}  // namespace hairloom::render
