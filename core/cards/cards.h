// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards: textured strips that stand for bundles of strands.

#include <array>
#include <optional>

#include "core/cards/cap.h"
#include "core/cards/clusters.h"
#include "core/cards/texture.h"

namespace hairloom::cards {

/// A card that somebody shaped by hand.
struct HeldCard {
    std::uint32_t level = 200;           ///< the level of so many cards
    std::vector<std::uint32_t> strands;  ///< ascending, at least one, each in one card of a level
    std::optional<Strip> strip;          ///< pinned: kStations; nothing: it follows its strands
    float width = 1;                     ///< factor, > 0
    float bend = 0;                      ///< added: how far edges lie outwards, as a share of half the width
    bool deleted = false;
};

struct CardOptions {
    std::uint32_t cards = 200;  ///< at most, 1 … 4096
    /// At most, 1 … 256; cards that look alike share one. 0: as many as the atlas holds that kSharedTextures
    /// need, with texels up to kLongestTexel times as long as wide.
    std::uint32_t textures = 0;
    float error = 0;              ///< metres off their strips that strands may be; fewer cards where they are
    float texel = 0.0007f;        ///< metres, the finest that textures are
    float tolerance = 0.0005f;    ///< metres that a strip may be off its curve
    std::uint32_t segments = 24;  ///< of a strip, at most, 1 … 24
    std::uint32_t mostSide = 2048;  ///< texels along the atlas, 64 … 8192, a power of two
    /// Their strands are parted no further; the others share what is left of `cards`.
    std::vector<HeldCard> held = {};
};

constexpr std::uint32_t kSharedTextures = 32;  ///< what an atlas is sized by where no number is set
constexpr float kLongestTexel = 3;             ///< along a card, times its width: hair changes slowly there
constexpr float kClearOfSkin = 0.0025f;        ///< metres above it, from where on cards show hair
constexpr std::uint32_t kOfCap = UINT32_MAX;   ///< CardVertex::card of the cap's vertices
constexpr std::uint32_t kStations = 25;        ///< of a card's strip: 24 segments at most

struct Card {
    Strip strip;  ///< as its strands have it, or as it is pinned
    std::vector<std::uint32_t> strands;
    std::array<Vec3f, kStations> albedo;  ///< means of its strands
    std::array<float, kStations> open;
    /// World space, unit: the way that its strands take there on average, which is not the strip's where it
    /// lies on the scalp and they rise from that.
    std::array<Vec3f, kStations> flow_ws;
    /// Where its hair is thick by its width: a strip at right angles to the first, which is flat then.
    std::optional<Strip> crossing;
    std::uint32_t texture = 0;
    float widen = 1;  ///< factor on the width, by which a shared texture covers as much as its own strands do

    // By hand.
    std::int32_t held = -1;  ///< place among CardOptions::held
    float width = 1, bend = 0;
    bool pinned = false;   ///< its strip is not by its strands
    bool deleted = false;  ///< it is not in the mesh
};

struct CardVertex {
    Vec3f position_ws;
    Vec3f normal_ws;  ///< unit, outwards
    Vec3f along_ws;   ///< unit, as strands go, perpendicular to the normal: what the flow of a texel is in
    Vec2f uv;         ///< in the atlas, 0 … 1; v grows downwards, as rows do
    Vec2f place;      ///< in the card's own picture, 0 … 1
    Vec3f tint =
        Vec3f::Ones();          ///< factor on the albedo: what the card has beside the texture that it shares
    float open = 1;             ///< factor on the ambient occlusion, likewise
    float hangs = 0;            ///< share of the way to the tip, of what moves it
    std::uint32_t card = 0;     ///< or kOfCap
    bool crosses = false;       ///< it is of the card's crossing strip
    std::uint32_t texture = 0;  ///< of the atlas
};

/// Triangles of inner cards come first, so that blending in order looks right from outside.
struct CardMesh {
    std::vector<CardVertex> vertices;
    std::vector<std::uint32_t> indices;
};

struct Cards {
    std::vector<Card> cards;
    std::vector<std::uint32_t> painters;  ///< of each texture, the card whose strands it shows
    std::vector<CapChart> cap;            ///< under the cards; its textures come behind theirs
    Atlas atlas;
    CardMesh mesh;
    float texel = 0;  ///< metres, as the atlas had room for
    float tolerance = 0;
    std::uint32_t segments = kStations - 1;  ///< of a strip, at most
    float brightness = 1;                    ///< factor on the albedo
    Box3f bounds_ws;                         ///< of all hair
};

/// The same for any number of threads. Cards by hand have their strands and their place, but not yet width,
/// bend and deletion, which shapeByHand() gives them. `hair` passed check(). Errors: options out of range, an
/// atlas that cannot hold the textures at any size, stopped.
Result<Cards> makeCards(const Hair& hair, const HairLight& light, const CardOptions& options, Cancel cancel);

/// Bakes the textures anew, with strands `thickness` times as thick. The cap's are by where the mesh lies.
Status bakeAtlas(const Hair& hair, const HairLight& light, float thickness, Cards& cards, Cancel cancel);

/// Gives held cards their shape and makes the mesh anew.
void shapeByHand(std::span<const HeldCard> held, Cards& cards);

/// The mesh of cards as they are. Of the atlas it needs the rects and the size.
void buildMesh(Cards& cards);

}  // namespace hairloom::cards
