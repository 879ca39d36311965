// SPDX-License-Identifier: GPL-3.0-or-later
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/cards/cards.h"

namespace hairloom::cards {
namespace {

/// Stations that a strip needs to be nowhere farther than the tolerance from the whole one; the ends first,
/// then where it is farthest, `most` at most.
std::vector<std::size_t> keptStations(const Strip& strip, float widen, float tolerance, std::size_t most) {
    std::vector<std::size_t> kept{0, strip.stations() - 1};
    while (kept.size() < most) {
        std::size_t worst = 0;
        float farthest = tolerance;
        for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
            for (std::size_t k = kept[i] + 1; k < kept[i + 1]; ++k) {
                const float t = static_cast<float>(k - kept[i]) / static_cast<float>(kept[i + 1] - kept[i]);
                for (const float x : {-widen, 0.0f, widen}) {
                    const Vec3f on = (1 - t) * strip.at(kept[i], x) + t * strip.at(kept[i + 1], x);
                    const float off = (strip.at(k, x) - on).norm();
                    if (off > farthest) farthest = off, worst = k;
                }
            }
        }
        if (worst == 0) return kept;
        kept.insert(std::ranges::upper_bound(kept, worst), worst);
    }
    return kept;
}

bool isBent(const Strip& strip, float tolerance) {
    for (std::size_t k = 0; k < strip.stations(); ++k) {
        if (std::abs(strip.bend[k]) * strip.halfWidth[k] * strip.halfWidth[k] > tolerance) return true;
    }
    return false;
}

/// The strip of a card with what was done to it by hand.
Strip shapedStrip(const Card& card) {
    Strip strip = card.strip;
    if (card.width == 1 && card.bend == 0) return strip;
    for (std::size_t k = 0; k < strip.stations(); ++k) {
        float& half = strip.halfWidth[k];
        // Its own bow as a share of half the width stays.
        strip.bend[k] = (strip.bend[k] * half + card.bend) / (card.width * half);
        strip.spread[k] *= card.width * card.width;
        half *= card.width;
    }
    return strip;
}

class Builder {
  public:
    explicit Builder(Cards& cards) : cards_(cards) {}

    void add(std::uint32_t c) {
        const Card& card = cards_.cards[c];
        addStrip(c, shapedStrip(card), Blade::first);
        if (card.crossing) addStrip(c, *card.crossing, Blade::crossing);
    }

    /// What is seen between cards where they rise from the skin.
    void addCap() {
        for (std::size_t i = 0; i < cards_.cap.size(); ++i) {
            const CapChart& chart = cards_.cap[i];
            const auto first = static_cast<std::uint32_t>(cards_.mesh.vertices.size());
            for (const CapChart::Vertex& at : chart.vertices) {
                CardVertex v;
                v.position_ws = at.position_ws, v.normal_ws = at.normal_ws;
                const Vec3f& along = chart.plane.along[0];
                v.along_ws = (along - along.dot(at.normal_ws) * at.normal_ws).normalized();
                v.tint = Vec3f::Constant(cards_.brightness);
                v.card = kOfCap, v.texture = static_cast<std::uint32_t>(cards_.painters.size() + i);
                setPlace(at.place, v);
                cards_.mesh.vertices.push_back(v);
            }
            for (const std::uint32_t index : chart.indices) cards_.mesh.indices.push_back(first + index);
        }
    }

  private:
    enum class Blade { first, crossing };
    static constexpr float kCoarser = 4;  // tolerance of crossing strips: half as many stations

    void addStrip(std::uint32_t c, const Strip& strip, Blade blade) {
        const float tolerance = (blade == Blade::crossing ? kCoarser : 1.0f) * cards_.tolerance;
        const std::vector<std::size_t> kept =
            keptStations(strip, cards_.cards[c].widen, tolerance, cards_.segments + 1);
        const bool bent = isBent(strip, cards_.tolerance);
        const std::vector<float> columns = bent ? std::vector<float>{-1, 0, 1} : std::vector<float>{-1, 1};
        const auto first = static_cast<std::uint32_t>(cards_.mesh.vertices.size());
        for (const std::size_t k : kept) {
            for (const float x : columns) {
                cards_.mesh.vertices.push_back(vertex(c, strip, k, x, bent));
                cards_.mesh.vertices.back().crosses = blade == Blade::crossing;
            }
        }
        const auto count = static_cast<std::uint32_t>(columns.size());
        for (std::uint32_t i = 0; i + 1 < kept.size(); ++i) {
            for (std::uint32_t j = 0; j + 1 < count; ++j) {
                const std::uint32_t a = first + i * count + j, b = a + count;
                for (const std::uint32_t v : {a, a + 1, b, b, a + 1, b + 1}) cards_.mesh.indices.push_back(v);
            }
        }
    }

    /// A place of the texture that it has.
    void setPlace(const Vec2f& place, CardVertex& v) const {
        const Rect& rect = cards_.atlas.rects[v.texture];
        v.place = place;
        v.uv = Vec2f(static_cast<float>(rect.x) + place.x() * static_cast<float>(rect.width),
                     static_cast<float>(rect.y) + place.y() * static_cast<float>(rect.height)) /
               static_cast<float>(cards_.atlas.side());
    }

    /// A place of its texture, with the colour that the card has at a station.
    void wear(const Card& card, const Vec2f& place, std::size_t station, CardVertex& v) const {
        const Card& painter = cards_.cards[cards_.painters[card.texture]];
        v.texture = card.texture;
        setPlace(place, v);
        const auto painted = static_cast<std::size_t>(place.y() * static_cast<float>(kStations - 1) + 0.5f);
        constexpr float kMost = 4;
        for (int i = 0; i < 3; ++i) {
            v.tint[i] = cards_.brightness *
                        std::clamp(card.albedo[station][i] / std::max(painter.albedo[painted][i], 1e-4f),
                                   1 / kMost, kMost);
        }
        v.open = std::clamp(card.open[station] / std::max(painter.open[painted], 1e-4f), 1 / kMost, kMost);
    }

    CardVertex vertex(std::uint32_t c, const Strip& strip, std::size_t k, float x, bool bent) const {
        const Card& card = cards_.cards[c];
        CardVertex v;
        const float across = x * card.widen;
        v.position_ws = bent ? strip.at(k, across)
                             : Vec3f(strip.centre[k] + across * strip.halfWidth[k] * strip.cross[k]);
        const float slope = bent ? 2 * strip.bend[k] * across * strip.halfWidth[k] : 0.0f;
        // Lit as strands are that rise from it.
        v.along_ws = card.flow_ws[k];
        const Vec3f out = strip.normal[k] - slope * strip.cross[k];
        v.normal_ws = (out - out.dot(v.along_ws) * v.along_ws).normalized();
        v.hangs = static_cast<float>(k) / static_cast<float>(kStations - 1);
        wear(card, Vec2f(0.5f + 0.5f * x, v.hangs), k, v);
        v.card = c;
        return v;
    }

    Cards& cards_;
};

}  // namespace

void buildMesh(Cards& cards) {
    const Box3f& box = cards.bounds_ws;
    // The middle of what hair lies around: an upright line that ends below the crown.
    const float top = box.max().y() - 0.4f * std::min(box.sizes().y(), box.sizes().x());
    std::vector<float> depth(cards.cards.size());
    for (std::size_t c = 0; c < depth.size(); ++c) {
        const Vec3f& at = cards.cards[c].strip.centre[kStations / 2];
        const Vec3f middle(box.center().x(), std::min(at.y(), top), box.center().z());
        depth[c] = (at - middle).norm();
    }
    std::vector<std::uint32_t> order(depth.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return depth[a] < depth[b]; });
    cards.mesh = {};
    Builder builder(cards);
    const auto isThere = [](const Card& card) { return !card.deleted; };
    if (std::ranges::any_of(cards.cards, isThere)) builder.addCap();
    for (const std::uint32_t c : order)
        if (!cards.cards[c].deleted) builder.add(c);
    std::vector<CardVertex> inOrder(cards.mesh.vertices.size());
    meshopt_optimizeVertexFetch(inOrder.data(), cards.mesh.indices.data(), cards.mesh.indices.size(),
                                cards.mesh.vertices.data(), inOrder.size(), sizeof(CardVertex));
    cards.mesh.vertices = std::move(inOrder);
}

}  // namespace hairloom::cards
