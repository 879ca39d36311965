// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/cards.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/cards/looks.h"

namespace hairloom::cards {
namespace {

// Texels around a picture, of their own: as far as mip maps reach that a level is seen with before the next
// one takes over.
constexpr std::uint32_t kPadding = 2;
constexpr std::uint32_t kLeastSide = 64;
constexpr std::uint32_t kMostTextures = 256;
constexpr float kCapTexels = 1.5f;          // of the cap's textures beside those of cards
constexpr float kCoarsestCap = 2.5f;        // likewise, where cards get textures of their own instead
constexpr float kCoarser = 1.25f;           // than asked for, that texels may be
constexpr float kWidest = 1.6f;             // likewise, where cards get textures of their own instead
constexpr std::uint32_t kHairStations = 9;  // of strands, while they are sorted into bundles

Status check(const CardOptions& options) {
    if (options.cards < 1 || options.cards > 4096)
        return fail(fmt::format("{} cards", options.cards), "1 to 4096");
    if (options.textures > kMostTextures)
        return fail(fmt::format("{} textures", options.textures),
                    "1 to 256, or 0 for as many as fit the atlas that 32 need");
    const std::uint32_t side = options.mostSide;
    if (side < kLeastSide || side > 8192 || (side & (side - 1)) != 0)
        return fail(fmt::format("an atlas of {} texels", side), "a power of two from 64 to 8192");
    if (!(options.texel > 0) || !(options.tolerance > 0) || !(options.error >= 0))
        return fail("a size of texels or a tolerance that is not above 0");
    if (options.segments < 1 || options.segments > kStations - 1)
        return fail(fmt::format("{} segments", options.segments), "1 to 24");
    return {};
}

/// Directions from their sums, smoothed: stations of few strands, of none or of some that lie all ways go as
/// their neighbours or, at last, as the strip does. A strip by hand takes its strands along.
void setFlow(Card& card) {
    const auto sums = card.flow_ws;
    constexpr float kNoWay = 0.2f;  // of the length that directions of one way sum up to
    float longest = 0;
    for (const Vec3f& sum : sums) longest = std::max(longest, sum.norm());
    for (std::size_t k = 0; k < kStations; ++k) {
        Vec3f sum = 2 * sums[k];
        if (k > 0) sum += sums[k - 1];
        if (k + 1 < kStations) sum += sums[k + 1];
        const Vec3f& strip = card.strip.along[k];
        const bool isClear = sum.norm() > 1e-3f * longest && sum.dot(strip) > kNoWay * sum.norm();
        card.flow_ws[k] = isClear && !card.pinned ? Vec3f(sum.normalized()) : strip;
    }
}

/// What strands are like by stations of their card: means, and those of a neighbour where there are none.
void measure(const Hair& hair, const HairLight& light, Card& card) {
    std::array<float, kStations> weights{};
    card.albedo.fill(Vec3f::Zero());
    card.open.fill(0);
    card.flow_ws.fill(Vec3f::Zero());
    for (const std::uint32_t s : card.strands) {
        const auto places = placesOn(card.strip, hair.strand(s));
        for (std::size_t p = hair.offsets[s]; p < hair.offsets[s + 1]; ++p) {
            const std::size_t k = places[p - hair.offsets[s]].nearest();
            const float weight = hair.radii[p] + 1e-9f;
            card.albedo[k] += weight * hair.albedo[p];
            card.open[k] += weight * light.open(hair.positions_ws[p]);
            const std::size_t before = p > hair.offsets[s] ? p - 1 : p;
            const std::size_t behind = p + 1 < hair.offsets[s + 1] ? p + 1 : p;
            card.flow_ws[k] += weight * (hair.positions_ws[behind] - hair.positions_ws[before]).normalized();
            weights[k] += weight;
        }
    }
    setFlow(card);
    for (std::size_t k = 0; k < kStations; ++k) {
        if (weights[k] > 0) card.albedo[k] /= weights[k], card.open[k] /= weights[k];
    }
    for (std::size_t k = 1; k < kStations; ++k) {
        if (weights[k] <= 0 && weights[k - 1] > 0)
            card.albedo[k] = card.albedo[k - 1], card.open[k] = card.open[k - 1], weights[k] = weights[k - 1];
    }
    for (std::size_t k = kStations - 1; k-- > 0;) {
        if (weights[k] <= 0)
            card.albedo[k] = card.albedo[k + 1], card.open[k] = card.open[k + 1], weights[k] = 1;
    }
}

float meanWidth(const Strip& strip) {
    float sum = 0;
    for (const float half : strip.halfWidth) sum += 2 * half;
    return sum / static_cast<float>(strip.stations());
}

/// The strips of a card. Thick hair gets a second one: seen from its edge a strip shows nothing, and strands
/// show as much from each side. Two flat strips have as many triangles as a bent one.
void setStrips(const EvenHair& hair, std::span<const Vec3f> rootNormals_ws, float tolerance, Card& card) {
    constexpr float kThick = 0.2f;  // of the width, from where on it pays
    const Strip fitted = fitStrip(hair, card.strands, rootNormals_ws);
    const Strip own = finishStrip(hair, card.strands, fitted, kStations, rootNormals_ws);
    if (!card.pinned) card.strip = own;
    const Strip crossing = crossingStrip(hair, card.strands, own, card.strip);
    const float thick = meanWidth(crossing);
    if (thick < kThick * meanWidth(own) || thick < tolerance) return;
    card.crossing = crossing;
    if (!card.pinned) std::ranges::fill(card.strip.bend, 0.0f);
}

std::uint32_t texelsOf(float metres, float texel, float least) {
    return static_cast<std::uint32_t>(std::clamp(metres / texel, least, 16384.0f));
}

/// Width of texels in metres, their length by it, and how much wider those of the cap are.
struct TexelSize {
    float width, longer = 1, cap = kCapTexels;
};

/// Rects of all textures with texels of that size; empty where they do not fit.
std::vector<Rect> rectsFor(const Cards& cards, const TexelSize& texel, std::uint32_t side) {
    std::vector<std::array<std::uint32_t, 2>> sizes;
    for (const std::uint32_t painter : cards.painters) {
        const Strip& strip = cards.cards[painter].strip;
        sizes.push_back({texelsOf(meanWidth(strip), texel.width, 4),
                         texelsOf(strip.length(), texel.longer * texel.width, 8)});
    }
    // Hairs on the cap lie side by side as cards have them, and are mostly hidden by these.
    const float ofCap = texel.cap * texel.width;
    for (const CapChart& chart : cards.cap)
        sizes.push_back(
            {texelsOf(meanWidth(chart.plane), ofCap, 4), texelsOf(chart.plane.length(), ofCap, 4)});
    return packed(sizes, side, kPadding);
}

struct Layout {
    std::vector<Rect> rects;
    std::uint32_t side = 0;
    float texel = 0;
};
/// The smallest atlas that holds the textures as fine as they are asked for; the largest with texels as fine
/// as fit there.
Result<Layout> layOut(const Cards& cards, const CardOptions& options) {
    for (std::uint32_t side = kLeastSide; side <= options.mostSide; side *= 2) {
        for (const float coarser : {1.0f, kCoarser}) {  // rather than four times the memory
            auto rects = rectsFor(cards, {coarser * options.texel}, side);
            if (!rects.empty()) return Layout{std::move(rects), side, coarser * options.texel};
        }
    }
    constexpr int kSteps = 48;
    float texel = options.texel;
    for (int step = 0; step < kSteps; ++step) {
        texel *= 1.1f;
        auto rects = rectsFor(cards, {texel}, options.mostSide);
        if (!rects.empty()) return Layout{std::move(rects), options.mostSide, texel};
    }
    return fail(
        fmt::format("{} textures do not fit an atlas of {} texels", cards.painters.size(), options.mostSide),
        "fewer textures or a larger atlas");
}

/// The textures of the cards in the same atlas, as fine as fit there: with longer texels, then coarser ones
/// on the cap, then wider ones, up to kWidest times what is asked for or, where that is more, than the layout
/// has.
std::optional<Layout> filled(const Cards& cards, const Layout& layout, float texel) {
    const float widest = std::max(layout.texel, kWidest * texel);
    std::vector<TexelSize> sizes{{texel}, {texel, 2}};
    constexpr float kStep = 1.125f;
    for (float width = texel;; width = std::min(kStep * width, widest)) {
        for (const float cap : {kCapTexels, kCoarsestCap})
            sizes.push_back({width, kLongestTexel, std::max(1.0f, cap * texel / width)});
        if (width >= widest) break;
    }
    for (const TexelSize& size : sizes) {
        auto rects = rectsFor(cards, size, layout.side);
        if (!rects.empty()) return Layout{std::move(rects), layout.side, size.width};
    }
    return std::nullopt;
}

/// Textures of the cards, and where they lie.
Result<Layout> shareAtlas(const std::vector<Look>& looks, const CardOptions& options, Cards& cards) {
    cards.painters =
        shareLooks(looks, options.textures > 0 ? options.textures : kSharedTextures, cards.cards);
    auto layout = layOut(cards, options);
    if (options.textures > 0 || !layout) return layout;
    const auto all = static_cast<std::uint32_t>(std::min<std::size_t>(looks.size(), kMostTextures));
    for (std::uint32_t most = all; most > kSharedTextures; most -= most / 8) {
        cards.painters = shareLooks(looks, most, cards.cards);
        if (auto more = filled(cards, *layout, options.texel)) return std::move(*more);
    }
    cards.painters = shareLooks(looks, kSharedTextures, cards.cards);
    return layout;
}

/// Strands of a card.
struct Bundle {
    std::vector<std::uint32_t> strands;
    std::int32_t held = -1;
};
/// Those of held cards as they are, all others in what cards are left, at least one; by their first strands.
Result<std::vector<Bundle>> bundlesOf(const Hair& hair, const CardOptions& options, Cancel cancel) {
    std::vector<Bundle> bundles;
    std::vector<bool> isHeld(hair.strandCount(), false);
    for (std::size_t h = 0; h < options.held.size(); ++h) {
        bundles.push_back({options.held[h].strands, static_cast<std::int32_t>(h)});
        for (const std::uint32_t s : options.held[h].strands) isHeld[s] = true;
    }
    std::vector<std::uint32_t> others;
    for (std::uint32_t s = 0; s < isHeld.size(); ++s)
        if (!isHeld[s]) others.push_back(s);
    if (!others.empty()) {
        const auto held = static_cast<std::uint32_t>(options.held.size());
        const std::uint32_t left = options.cards > held ? options.cards - held : 1;
        auto clusters = clusterHair(evenHair(hair, kHairStations), std::move(others), hair.rootNormals_ws,
                                    {left, options.error}, cancel);
        if (!clusters) return tl::unexpected(clusters.error());
        for (Cluster& cluster : *clusters) bundles.push_back({std::move(cluster.strands), -1});
    }
    std::ranges::sort(bundles, {}, [](const Bundle& bundle) { return bundle.strands.front(); });
    return bundles;
}

/// Triangles of the cards, without the cap's.
std::vector<WornTriangle> wornBy(const CardMesh& mesh, std::span<const Picture> pictures) {
    std::vector<WornTriangle> worn;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const CardVertex& first = mesh.vertices[mesh.indices[i]];
        if (first.card == kOfCap) continue;
        WornTriangle triangle{&pictures[first.texture], {}, {}};
        for (std::size_t k = 0; k < 3; ++k) {
            const CardVertex& v = mesh.vertices[mesh.indices[i + k]];
            triangle.at_ws[k] = v.position_ws, triangle.place[k] = v.place;
        }
        worn.push_back(triangle);
    }
    return worn;
}

}  // namespace

void shapeByHand(std::span<const HeldCard> held, Cards& cards) {
    for (Card& card : cards.cards) {
        if (card.held < 0) continue;
        const HeldCard& edit = held[static_cast<std::size_t>(card.held)];
        card.width = edit.width, card.bend = edit.bend, card.deleted = edit.deleted;
    }
    buildMesh(cards);
}

Status bakeAtlas(const Hair& hair, const HairLight& light, float thickness, Cards& cards, Cancel cancel) {
    const std::size_t painters = cards.painters.size();
    std::vector<Picture> pictures(painters + cards.cap.size());
    const LaidRoots laid = laidRoots(hair);
    parallelFor(pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !cancelled(cancel); ++i) {
            const Rect& rect = cards.atlas.rects[i];
            if (i >= painters) {
                pictures[i] =
                    bakeCap(hair, laid, light, cards.cap[i - painters], thickness, rect.width, rect.height);
                continue;
            }
            const Card& card = cards.cards[cards.painters[i]];
            pictures[i] = bake(hair, light, card.strip, card.strands,
                               {.thickness = thickness, .clear = kClearOfSkin}, rect.width, rect.height);
        }
    });
    if (cancelled(cancel)) return stopped();
    const std::vector<WornTriangle> worn = wornBy(cards.mesh, pictures);
    parallelFor(cards.cap.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !cancelled(cancel); ++i)
            leaveToCards(worn, cards.cap[i], pictures[painters + i]);
    });
    if (cancelled(cancel)) return stopped();
    cards.atlas = makeAtlas(std::move(pictures), std::move(cards.atlas.rects), cards.atlas.side());
    return {};
}

Result<Cards> makeCards(const Hair& hair, const HairLight& light, const CardOptions& options, Cancel cancel) {
    if (auto status = check(options); !status) return tl::unexpected(status.error());
    auto bundles = bundlesOf(hair, options, cancel);
    if (!bundles) return tl::unexpected(bundles.error());
    Cards cards;
    for (const Vec3f& point : hair.positions_ws) cards.bounds_ws.extend(point);
    cards.tolerance = options.tolerance;
    cards.segments = options.segments;
    cards.cards.resize(bundles->size());
    const EvenHair fine = evenHair(hair, kStations);
    parallelFor(bundles->size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            Card& card = cards.cards[c];
            card.strands = std::move((*bundles)[c].strands);
            card.held = (*bundles)[c].held;
            card.pinned =
                card.held >= 0 && options.held[static_cast<std::size_t>(card.held)].strip.has_value();
            if (card.pinned) card.strip = *options.held[static_cast<std::size_t>(card.held)].strip;
            setStrips(fine, hair.rootNormals_ws, options.tolerance, card);
            measure(hair, light, card);
        }
    });
    if (cancelled(cancel)) return stopped();
    const auto looks = looksOf(hair, light, cards.cards);
    auto cap = makeCap(hair, options.tolerance, cancel);
    if (!cap) return tl::unexpected(cap.error());
    cards.cap = std::move(*cap);
    auto layout = shareAtlas(looks, options, cards);
    if (!layout) return tl::unexpected(layout.error());
    cards.texel = layout->texel;
    cards.atlas.rects = std::move(layout->rects);
    cards.atlas.levels = {Picture{layout->side, layout->side, {}}};
    buildMesh(cards);
    if (auto status = bakeAtlas(hair, light, 1, cards, cancel); !status)
        return tl::unexpected(status.error());
    return cards;
}

}  // namespace hairloom::cards
