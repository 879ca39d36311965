// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/cap_fit.h"

#include <algorithm>
#include <limits>

#include "core/base/parallel.h"
#include "core/cards/cap_squares.h"
#include "core/cards/raster.h"

namespace hairloom::cards {
namespace {

constexpr float kDensest = 0.98f;
// Pixels²: squares of which less is seen stay nearly as they are.
constexpr float kHardlySeen = 0.05f;

/// What a pixel's middle sees of head and cap.
struct Nearest {
    float depth = -std::numeric_limits<float>::infinity();
    std::uint32_t chart = UINT32_MAX;  ///< none: the head or nothing
    Vec2f place = Vec2f::Zero();
};

class Sheet {
  public:
    Sheet(const View& view, std::uint32_t headPx)
        : view_(view), perMetre_(static_cast<float>(headPx) / kHeadHeight) {
        constexpr std::uint32_t kSquaresPerHead = 32;
        width_ = static_cast<int>(view.columns * headPx / kSquaresPerHead);
        height_ = static_cast<int>(view.rows * headPx / kSquaresPerHead);
        pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    }
    const std::vector<Nearest>& pixels() const { return pixels_; }

    void drawHead(const Hair& hair) {
        for (std::size_t t = 0; t + 2 < hair.headIndices.size(); t += 3) {
            std::array<Vec3f, 3> at;
            for (std::size_t k = 0; k < 3; ++k) at[k] = on(hair.headPositions_ws[hair.headIndices[t + k]]);
            draw(at, [](const Vec3f&) { return Nearest{}; });
        }
    }
    void drawChart(const CapChart& chart, std::uint32_t number) {
        for (std::size_t t = 0; t + 2 < chart.indices.size(); t += 3) {
            std::array<const CapChart::Vertex*, 3> v{};
            std::array<Vec3f, 3> at;
            for (std::size_t k = 0; k < 3; ++k)
                v[k] = &chart.vertices[chart.indices[t + k]], at[k] = on(v[k]->position_ws);
            draw(at, [&](const Vec3f& w) {
                return Nearest{0, number, w.x() * v[0]->place + w.y() * v[1]->place + w.z() * v[2]->place};
            });
        }
    }

  private:
    Vec3f on(const Vec3f& point_ws) const {
        const Vec3f d = point_ws - view_.corner_ws;
        return {d.dot(view_.right_ws) * perMetre_, -d.dot(view_.up_ws) * perMetre_, d.dot(view_.toEye_ws)};
    }
    template <class Seen>
    void draw(const std::array<Vec3f, 3>& at, const Seen& seen) {
        forSamplesOfTriangle(at[0].head<2>(), at[1].head<2>(), at[2].head<2>(), width_, height_,
                             [&](int x, int y, const Vec3f& w) {
                                 const float depth = w.dot(Vec3f(at[0].z(), at[1].z(), at[2].z()));
                                 Nearest& pixel =
                                     pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                             static_cast<std::size_t>(x)];
                                 if (depth <= pixel.depth) return;
                                 pixel = seen(w);
                                 pixel.depth = depth;
                             });
    }
    const View& view_;
    float perMetre_;
    int width_, height_;
    std::vector<Nearest> pixels_;
};

/// What is seen of the skin at a square: by strands, and by the level.
struct Skin {
    float strands = 0, level = 0;
};

}  // namespace

CapSight::CapSight(const Hair& hair, const std::vector<CapChart>& cap, std::span<const View> views,
                   std::uint32_t headPx)
    : pixels_(views.size()) {
    if (hair.headIndices.empty()) return;
    std::vector<CapSquares> squares(cap.begin(), cap.end());
    parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            Sheet sheet(views[v], headPx);
            sheet.drawHead(hair);
            for (std::uint32_t c = 0; c < cap.size(); ++c) sheet.drawChart(cap[c], c);
            const std::vector<Nearest>& seen = sheet.pixels();
            for (std::uint32_t i = 0; i < seen.size(); ++i)
                if (seen[i].chart != UINT32_MAX)
                    pixels_[v].push_back({i, seen[i].chart, squares[seen[i].chart].of(seen[i].place)});
        }
    });
}

void CapSight::fit(std::span<const Shot> strands, std::span<const Shot> level, Cards& cards) const {
    if (std::ranges::all_of(pixels_, [](const auto& pixels) { return pixels.empty(); })) return;
    const std::vector<CapSquares> squares(cards.cap.begin(), cards.cap.end());
    // Least squares over directions: one in which cards hide the cap says nothing of how dense it should be.
    std::vector<std::vector<float>> together, alone;
    for (const CapSquares& s : squares) together.emplace_back(s.count()), alone.emplace_back(s.count());
    for (std::size_t v = 0; v < pixels_.size(); ++v) {
        std::vector<std::vector<Skin>> skin;
        for (const CapSquares& s : squares) skin.emplace_back(s.count());
        for (const Pixel& pixel : pixels_[v]) {
            squares[pixel.chart].forNear(pixel.place, [&](std::size_t square, float weight) {
                Skin& seen = skin[pixel.chart][square];
                seen.strands += weight * strands[v].skin[pixel.at];
                seen.level += weight * level[v].skin[pixel.at];
            });
        }
        for (std::size_t c = 0; c < squares.size(); ++c) {
            for (std::size_t i = 0; i < skin[c].size(); ++i) {
                together[c][i] += skin[c][i].strands * skin[c][i].level;
                alone[c][i] += skin[c][i].level * skin[c][i].level;
            }
        }
    }
    const Picture& atlas = cards.atlas.levels[0];
    for (std::size_t c = 0; c < squares.size(); ++c) {
        const Rect& rect = cards.atlas.rects[cards.painters.size() + c];
        std::vector<float>& wanted = cards.cap[c].wanted;
        wanted = squares[c].means(rect.width, rect.height, [&](std::uint32_t x, std::uint32_t y) {
            return atlas.at(rect.x + x, rect.y + y).coverage;
        });
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const float more = (together[c][i] + kHardlySeen) / (alone[c][i] + kHardlySeen);
            wanted[i] = std::clamp(1 - (1 - wanted[i]) * more, 0.0f, kDensest);
        }
    }
}

}  // namespace hairloom::cards
