// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/looks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace hairloom::cards {
namespace {

constexpr float kSize = 0.25f;  // what a size e times as large counts beside coverage
// What hair e times as dense counts: a sparse card that wears a dense texture is a flap where skin should be
// seen, however small both coverages are.
constexpr float kDensity = 0.4f;
constexpr float kLeastCoverage = 0.02f;  // below it densities look alike
constexpr int kRounds = 8;

struct Medoids {
    std::vector<std::uint32_t> cards;
    std::vector<std::uint32_t> of;  ///< of each card, index into `cards`
};

void assign(const std::vector<Look>& looks, Medoids& medoids) {
    for (std::size_t i = 0; i < looks.size(); ++i) {
        float best = std::numeric_limits<float>::infinity();
        for (std::uint32_t m = 0; m < medoids.cards.size(); ++m) {
            const float distance = looks[i] - looks[medoids.cards[m]];
            if (distance < best) best = distance, medoids.of[i] = m;
        }
    }
}

/// Of each group the card that is nearest to the others by the hair that they show.
bool mend(const std::vector<Look>& looks, Medoids& medoids) {
    bool changed = false;
    for (std::uint32_t m = 0; m < medoids.cards.size(); ++m) {
        std::uint32_t best = medoids.cards[m];
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t i = 0; i < looks.size(); ++i) {
            if (medoids.of[i] != m) continue;
            float sum = 0;
            for (std::size_t j = 0; j < looks.size(); ++j)
                if (medoids.of[j] == m) sum += looks[j].covered * (looks[i] - looks[j]);
            if (sum < least) least = sum, best = i;
        }
        changed = changed || best != medoids.cards[m];
        medoids.cards[m] = best;
    }
    return changed;
}

}  // namespace

float Look::operator-(const Look& other) const {
    float sum = 0, own = 0, others = 0;
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        sum += std::abs(coverage[i] - other.coverage[i]);
        own += coverage[i], others += other.coverage[i];
    }
    const auto count = static_cast<float>(coverage.size());
    const float denser = std::log((own / count + kLeastCoverage) / (others / count + kLeastCoverage));
    return sum / count + kDensity * std::abs(denser) +
           kSize * (std::abs(std::log(width / other.width)) + std::abs(std::log(length / other.length)));
}

std::vector<Look> looksOf(const Hair& hair, const HairLight& light, const std::vector<Card>& cards) {
    std::vector<Look> looks(cards.size());
    parallelFor(cards.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const Strip& strip = cards[c].strip;
            constexpr std::uint32_t kFiner = 4;
            Picture picture = bake(hair, light, strip, cards[c].strands, {.clear = kClearOfSkin},
                                   Look::kAcross * kFiner, Look::kAlong * kFiner);
            for (std::uint32_t size = kFiner; size > 1; size /= 2) picture = halved(picture);
            Look& look = looks[c];
            float mean = 0;
            for (std::size_t i = 0; i < look.coverage.size(); ++i)
                mean += (look.coverage[i] = picture.texels[i].coverage) /
                        static_cast<float>(look.coverage.size());
            for (const float half : strip.halfWidth)
                look.width += 2 * half / static_cast<float>(strip.stations());
            look.length = strip.length();
            look.covered = mean * look.width * look.length;
        }
    });
    return looks;
}

std::vector<std::uint32_t> shareLooks(const std::vector<Look>& looks, std::uint32_t most,
                                      std::vector<Card>& cards) {
    Medoids medoids;
    medoids.of.assign(looks.size(), 0);
    std::uint32_t largest = 0;
    for (std::uint32_t i = 0; i < looks.size(); ++i)
        if (looks[i].covered > looks[largest].covered) largest = i;
    medoids.cards = {largest};
    std::vector<float> nearest(looks.size(), std::numeric_limits<float>::infinity());
    while (medoids.cards.size() < std::min<std::size_t>(most, looks.size())) {
        std::uint32_t farthest = 0;
        float distance = -1;
        for (std::uint32_t i = 0; i < looks.size(); ++i) {
            nearest[i] = std::min(nearest[i], looks[i] - looks[medoids.cards.back()]);
            const float counts = nearest[i] * looks[i].covered;
            if (counts > distance) distance = counts, farthest = i;
        }
        if (!(distance > 0)) break;
        medoids.cards.push_back(farthest);
    }
    assign(looks, medoids);
    for (int round = 0; round < kRounds && mend(looks, medoids); ++round) assign(looks, medoids);
    constexpr float kMostWider = 1.5f;
    for (std::size_t c = 0; c < cards.size(); ++c) {
        cards[c].texture = medoids.of[c];
        const Look &own = looks[c], &worn = looks[medoids.cards[medoids.of[c]]];
        const float share = worn.covered / (worn.width * worn.length);
        const float wider = own.covered / std::max(share * own.width * own.length, 1e-12f);
        cards[c].widen = std::clamp(wider, 1 / kMostWider, kMostWider);
    }
    return medoids.cards;
}

}  // namespace hairloom::cards
