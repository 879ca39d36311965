// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/bright_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

namespace hairloom::render {
namespace {

/// Light and its directions, added up.
struct Moments {
    double light = 0;
    Vec3d directed = Vec3d::Zero();

    void add(const Moments& other) {
        light += other.light;
        directed += other.directed;
    }
    /// Summed squares of the distance to the mean direction.
    double spread() const { return light > 0 ? std::max(light - directed.squaredNorm() / light, 0.0) : 0; }
};

double luminance(const Vec3d& rgb) {
    return rgb.dot(Vec3d(0.2126, 0.7152, 0.0722));
}

Moments momentsOf(const BrightPixel& pixel) {
    const double light = luminance(pixel.irradiance);
    return {light, light * pixel.toLight_ws};
}

struct Region {
    std::span<BrightPixel> pixels;
    int part = 0;
    double spread = 0;
};

struct Cut {
    bool alongRows = false;
    std::uint32_t first = 0;  ///< row or column of the second half
    double spread = 1e300;    ///< of both
};

/// The best cut between rows or columns; none where there is only one.
void tryCuts(std::span<const BrightPixel> pixels, bool alongRows, Cut& best) {
    std::map<std::uint32_t, Moments> lines;
    Moments all;
    for (const BrightPixel& pixel : pixels) {
        const Moments moments = momentsOf(pixel);
        lines[alongRows ? pixel.y : pixel.x].add(moments);
        all.add(moments);
    }
    Moments before;
    for (const auto& [line, moments] : lines) {
        if (line != lines.begin()->first) {
            const Moments after{all.light - before.light, all.directed - before.directed};
            const double spread = before.spread() + after.spread();
            if (spread < best.spread) best = {alongRows, line, spread};
        }
        before.add(moments);
    }
}

class PartTree {
  public:
    explicit PartTree(std::vector<BrightPart>& parts) : parts_(parts) {}

    Region append(std::span<BrightPixel> pixels) {
        Region region{pixels, static_cast<int>(parts_.size()), 0};
        Moments all;
        Vec3d irradiance = Vec3d::Zero();
        for (const BrightPixel& pixel : pixels) {
            all.add(momentsOf(pixel));
            irradiance += pixel.irradiance;
        }
        region.spread = all.spread();
        BrightPart part;
        part.toLight_ws = all.directed.normalized().cast<float>();
        part.irradiance = irradiance.cast<float>();
        part.extent = static_cast<float>(std::sqrt(region.spread / all.light));
        parts_.push_back(part);
        return region;
    }

    /// False: it cannot be cut.
    bool cut(Region& region, Region& other) {
        Cut best;
        tryCuts(region.pixels, false, best);
        tryCuts(region.pixels, true, best);
        if (best.spread >= 1e300) return false;
        const auto middle = std::stable_partition(
            region.pixels.begin(), region.pixels.end(),
            [&](const BrightPixel& pixel) { return (best.alongRows ? pixel.y : pixel.x) < best.first; });
        const auto count = static_cast<std::size_t>(middle - region.pixels.begin());
        const int part = region.part;
        other = append(region.pixels.subspan(count));
        region = append(region.pixels.first(count));
        parts_[static_cast<std::size_t>(part)].first = region.part;
        parts_[static_cast<std::size_t>(part)].second = other.part;
        return true;
    }

  private:
    std::vector<BrightPart>& parts_;
};

}  // namespace

int cutBrightPixels(std::vector<BrightPixel> pixels, std::size_t count, double extent,
                    std::vector<BrightPart>& parts) {
    PartTree tree(parts);
    std::vector<Region> regions{tree.append(pixels)};
    const int root = regions.front().part;
    while (regions.size() < count) {
        const auto worst = std::ranges::max_element(regions, {}, &Region::spread);
        const BrightPart& part = parts[static_cast<std::size_t>(worst->part)];
        if (static_cast<double>(part.extent) <= extent) break;
        Region other;
        if (!tree.cut(*worst, other)) break;
        regions.push_back(other);
    }
    return root;
}

}  // namespace hairloom::render
