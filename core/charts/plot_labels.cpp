// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/plot_labels.h"

#include <algorithm>
#include <array>
#include <limits>

namespace hairloom {
namespace {

/// From the point to the label's nearest corner or edge; the first stands right beside the marker.
constexpr std::array<double, 4> kDistances = {7, 14, 24, 38};
constexpr double kFar = 12;

struct Direction {
    double x, y;
};
/// In the order of preference where nothing is in the way.
constexpr std::array<Direction, 8> kDirections = {
    {{0.8, -0.6}, {1, 0}, {0.8, 0.6}, {0, -1}, {0, 1}, {-0.8, -0.6}, {-1, 0}, {-0.8, 0.6}}};

PixelBox boxAt(const LabelRequest& request, const Direction& direction, double distance) {
    const double x = request.x + direction.x * distance;
    const double y = request.y + direction.y * distance;
    const double alongX = direction.x > 0 ? 0 : direction.x < 0 ? 1 : 0.5;
    const double alongY = direction.y > 0 ? 0 : direction.y < 0 ? 1 : 0.5;
    // Beside its point a label is centred in height; a slanting direction shifts it by half of that.
    return {x - alongX * request.width,
            y - (direction.x == 0 ? alongY : 0.25 + 0.5 * alongY) * request.height, request.width,
            request.height};
}

double costOf(const PixelBox& box, const std::vector<PixelSegment>& lines, std::size_t direction,
              double distance) {
    const auto crossings = std::ranges::count_if(
        lines, [&](const PixelSegment& line) { return clipped(line, box).has_value(); });
    return 30.0 * static_cast<double>(crossings) + distance + 0.5 * static_cast<double>(direction);
}

}  // namespace

std::optional<PixelSegment> clipped(const PixelSegment& s, const PixelBox& box) {
    double from = 0, to = 1;
    const double dx = s.x1 - s.x0, dy = s.y1 - s.y0;
    const auto cut = [&](double p, double q) {  // p t <= q
        if (p == 0) return q >= 0;
        const double t = q / p;
        if (p < 0)
            from = std::max(from, t);
        else
            to = std::min(to, t);
        return from <= to;
    };
    const bool inside = cut(-dx, s.x0 - box.x) && cut(dx, box.x + box.width - s.x0) &&
                        cut(-dy, s.y0 - box.y) && cut(dy, box.y + box.height - s.y0);
    if (!inside) return std::nullopt;
    return PixelSegment{s.x0 + from * dx, s.y0 + from * dy, s.x0 + to * dx, s.y0 + to * dy};
}

std::vector<std::optional<LabelPlace>> placeLabels(const std::vector<LabelRequest>& requests,
                                                   const PixelBox& frame,
                                                   const std::vector<PixelBox>& obstacles,
                                                   const std::vector<PixelSegment>& lines) {
    std::vector<PixelBox> taken = obstacles;
    std::vector<std::optional<LabelPlace>> places;
    for (const LabelRequest& request : requests) {
        std::optional<LabelPlace> best;
        double bestCost = std::numeric_limits<double>::infinity();
        for (const double distance : kDistances) {
            for (std::size_t d = 0; d < kDirections.size(); ++d) {
                const PixelBox box = boxAt(request, kDirections[d], distance);
                const bool free = frame.contains(box) && std::ranges::none_of(taken, [&](const auto& other) {
                                      return box.overlaps(other);
                                  });
                if (!free) continue;
                const double cost = costOf(box, lines, d, distance);
                if (cost >= bestCost) continue;
                bestCost = cost;
                best = LabelPlace{box, distance > kFar};
            }
        }
        if (best) taken.push_back(best->box);
        places.push_back(best);
    }
    return places;
}

}  // namespace hairloom
