// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/software/hlsl.h"

namespace hairloom::software {
namespace {

constexpr std::uint32_t kPoints = 0, kTriangles = 2;  // OverlayConstants::shape
constexpr float kLift = 0.002f, kNear = 1e-4f;        // as overlay.vert.hlsl has them
constexpr std::size_t kBand = 32;                     // rows that one thread draws

struct Corner {
    float4 clip, colour;
};

/// A mark on the screen, in pixels. Of a triangle, edges are homogeneous: (x, y, 1) times them is a corner's
/// share divided by its w.
struct Mark {
    float2 middle{0.0f}, along{1.0f, 0.0f};
    float halfLength = 0, radius = 0;
    float3 edges[3];
    float4 colours[3];
    float depths[3] = {0, 0, 0};  ///< z / w of both ends; of a triangle z
    float inverseW[2] = {1, 1};
    int left = 0, right = -1, top = 0, bottom = -1;  ///< the last included
};

class Marks {
  public:
    Marks(HostTexture& target, std::span<const float> hides, const shaders::OverlayConstants& constants,
          std::span<const shaders::OverlayVertex> vertices)
        : target_(target),
          hides_(hides),
          constants_(constants),
          vertices_(vertices),
          columns_(static_cast<int>(target.desc().width)),
          rows_(static_cast<int>(target.desc().height)) {}

    void draw(std::uint32_t corners) {
        const bool triangles = constants_.shape == kTriangles;
        const std::uint32_t count = corners / (triangles ? 3 : 6);
        marks_.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            Mark mark;
            if (triangles ? setUpTriangle(i, mark) : setUpStroke(i, mark)) marks_.push_back(mark);
        }
        parallelFor(static_cast<std::size_t>(rows_), kBand, [&](std::size_t begin, std::size_t end) {
            for (const Mark& mark : marks_)
                drawRows(mark, static_cast<int>(begin), static_cast<int>(end) - 1);
        });
    }

  private:
    Corner cornerAt(std::uint32_t index) const {
        const std::size_t at = std::size_t{constants_.firstVertex} + index;
        if (at >= vertices_.size()) return {float4(0, 0, 0, -1), float4(0.0f)};
        const shaders::OverlayVertex& v = vertices_[at];
        const auto& m = constants_.clipFromWorld.m;
        const auto row = [&](std::size_t r) {
            return m[r] * v.position_ws.x + m[4 + r] * v.position_ws.y + m[8 + r] * v.position_ws.z +
                   m[12 + r];
        };
        Corner corner{float4(row(0), row(1), row(2), row(3)),
                      float4(v.colour.x, v.colour.y, v.colour.z, v.colour.w)};
        float4& clip = corner.clip;
        clip.z -= kLift * std::fabs(clip.w) * (1.0f - saturate(clip.z / max(clip.w, 1e-6f)));
        return corner;
    }

    float2 onScreen(const float4& clip) const {
        return {(0.5f + 0.5f * clip.x / clip.w) * static_cast<float>(columns_),
                (0.5f - 0.5f * clip.y / clip.w) * static_cast<float>(rows_)};
    }

    /// False where no pixel has some of it.
    bool bound(Mark& mark, float lowX, float lowY, float highX, float highY) const {
        if (!(highX >= 0 && highY >= 0 && lowX < static_cast<float>(columns_) &&
              lowY < static_cast<float>(rows_)))
            return false;
        mark.left = std::max(0, static_cast<int>(max(lowX, 0.0f)));
        mark.top = std::max(0, static_cast<int>(max(lowY, 0.0f)));
        mark.right = static_cast<int>(min(highX, static_cast<float>(columns_ - 1)));
        mark.bottom = static_cast<int>(min(highY, static_cast<float>(rows_ - 1)));
        return true;
    }

    bool setUpStroke(std::uint32_t index, Mark& mark) const {
        const bool point = constants_.shape == kPoints;
        Corner a = cornerAt(point ? index : 2 * index);
        Corner b = point ? a : cornerAt(2 * index + 1);
        if (a.clip.w < kNear && b.clip.w < kNear) return false;
        // Lines end where they come near what lies behind the eye.
        const auto cut = [](Corner& behind, const Corner& before) {
            const float share = (kNear - behind.clip.w) / (before.clip.w - behind.clip.w);
            behind.clip += (before.clip - behind.clip) * share;
            behind.colour += (before.colour - behind.colour) * share;
        };
        if (a.clip.w < kNear) cut(a, b);
        if (b.clip.w < kNear) cut(b, a);
        const float2 from = onScreen(a.clip), to = onScreen(b.clip);
        const float2 way = to - from;
        const float length = std::sqrt(dot(way, way));
        if (!(length < 1e8f) || !(std::fabs(from.x) < 1e8f) || !(std::fabs(from.y) < 1e8f)) return false;
        mark.middle = (from + to) * 0.5f;
        mark.along = length > 1e-6f ? way / length : float2(1.0f, 0.0f);
        mark.halfLength = 0.5f * length;
        mark.radius = constants_.markRadius;
        mark.colours[0] = a.colour;
        mark.colours[1] = b.colour;
        mark.depths[0] = a.clip.z / a.clip.w;
        mark.depths[1] = b.clip.z / b.clip.w;
        mark.inverseW[0] = 1 / a.clip.w;
        mark.inverseW[1] = 1 / b.clip.w;
        const float reach = mark.radius + 1;
        const float2 low = min(from, to) - reach;
        const float2 high = max(from, to) + reach;
        return bound(mark, low.x, low.y, high.x, high.y);
    }

    bool setUpTriangle(std::uint32_t index, Mark& mark) const {
        float3 v[3];
        float2 low(1e9f), high(-1e9f);
        float least = 1e9f, most = -1e9f;
        for (std::uint32_t i = 0; i < 3; ++i) {
            const Corner c = cornerAt(3 * index + i);
            v[i] = float3(0.5f * (c.clip.w + c.clip.x) * static_cast<float>(columns_),
                          0.5f * (c.clip.w - c.clip.y) * static_cast<float>(rows_), c.clip.w);
            mark.colours[i] = c.colour;
            mark.depths[i] = c.clip.z;
            least = min(least, c.clip.w);
            most = max(most, c.clip.w);
            if (c.clip.w <= 1e-6f) continue;
            low = min(low, onScreen(c.clip));
            high = max(high, onScreen(c.clip));
        }
        const float determinant = dot(v[0], cross(v[1], v[2]));
        if (!(most > 0) || !(std::fabs(determinant) >= 1e-20f)) return false;
        mark.edges[0] = cross(v[1], v[2]) / determinant;
        mark.edges[1] = cross(v[2], v[0]) / determinant;
        mark.edges[2] = cross(v[0], v[1]) / determinant;
        if (least <= 1e-6f) {
            low = float2(0.0f);
            high = float2(static_cast<float>(columns_), static_cast<float>(rows_));
        }
        return bound(mark, low.x, low.y, high.x, high.y);
    }

    void drawRows(const Mark& mark, int from, int to) {
        const bool triangle = constants_.shape == kTriangles;
        const float reach = mark.radius + 1;
        for (int y = std::max(from, mark.top); y <= std::min(to, mark.bottom); ++y) {
            int left = mark.left, right = mark.right;
            // A steep line is in few columns of each row.
            if (!triangle && std::fabs(mark.along.y) > 1e-3f) {
                const float slope = mark.along.x / mark.along.y;
                const float x = mark.middle.x + (static_cast<float>(y) + 0.5f - mark.middle.y) * slope;
                const float half = reach / std::fabs(mark.along.y) + 1;
                left = std::max(left, static_cast<int>(std::floor(max(x - half, -1.0f))));
                right = std::min(right, static_cast<int>(std::ceil(min(x + half, 1e8f))));
            }
            for (int x = left; x <= right; ++x) {
                const float2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                triangle ? triangleAt(mark, at, x, y) : strokeAt(mark, at, x, y);
            }
        }
    }

    void strokeAt(const Mark& mark, float2 at, int x, int y) {
        const float2 d = at - mark.middle;
        const float along = dot(d, mark.along);
        const float across = d.y * mark.along.x - d.x * mark.along.y;
        const float beyond = max(std::fabs(along) - mark.halfLength, 0.0f);
        const float off = std::sqrt(beyond * beyond + across * across);
        const float edge = saturate(mark.radius + 0.5f - off) - saturate(0.5f - mark.radius - off);
        if (!(edge > 0)) return;
        const float ends = mark.halfLength + mark.radius + 1;
        const float share = saturate(0.5f + 0.5f * along / ends);
        const float depth = mark.depths[0] + (mark.depths[1] - mark.depths[0]) * share;
        const float w0 = (1 - share) * mark.inverseW[0], w1 = share * mark.inverseW[1];
        const float4 colour = (mark.colours[0] * w0 + mark.colours[1] * w1) / (w0 + w1);
        blend(x, y, depth, colour, colour.w * edge);
    }

    void triangleAt(const Mark& mark, float2 at, int x, int y) {
        const float3 place(at.x, at.y, 1.0f);
        const float3 shares(dot(mark.edges[0], place), dot(mark.edges[1], place), dot(mark.edges[2], place));
        const float sum = shares.x + shares.y + shares.z;
        if (!(sum > 0) || min(shares.x, min(shares.y, shares.z)) < 0) return;
        const float depth = shares.x * mark.depths[0] + shares.y * mark.depths[1] + shares.z * mark.depths[2];
        const float4 colour =
            (mark.colours[0] * shares.x + mark.colours[1] * shares.y + mark.colours[2] * shares.z) / sum;
        blend(x, y, depth, colour, colour.w);
    }

    void blend(int x, int y, float depth, const float4& colour, float alpha) {
        if (!(depth >= 0 && depth <= 1)) return;
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
        if (!hides_.empty() && depth > hides_[pixel]) return;
        const float* const below = target_.texels().data() + 4 * pixel;
        const auto decoded = [&](float shown) {
            if (constants_.keepsSrgb > 0) return shown;
            return shown <= 0.04045f ? shown / 12.92f : std::pow((shown + 0.055f) / 1.055f, 2.4f);
        };
        const bool encodes = target_.desc().format == gpu::Format::Rgba8UnormSrgb;
        const float cover = saturate(alpha);
        std::array<float, 4> mixed{};
        const float own[3] = {colour.x, colour.y, colour.z};
        for (std::size_t c = 0; c < 3; ++c) {
            const float behind = encodes ? decoded(below[c]) : below[c];
            mixed[c] = decoded(own[c]) * cover + behind * (1 - cover);
        }
        mixed[3] = cover + below[3] * (1 - cover);
        target_.write(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), mixed.data());
    }

    HostTexture& target_;
    std::span<const float> hides_;
    const shaders::OverlayConstants& constants_;
    std::span<const shaders::OverlayVertex> vertices_;
    int columns_, rows_;
    std::vector<Mark> marks_;
};

}  // namespace

void drawMarks(HostTexture& target, std::span<const float> hides, const shaders::OverlayConstants& constants,
               std::span<const shaders::OverlayVertex> vertices, std::uint32_t corners) {
    if (target.channels() != 4 || corners == 0) return;
    Marks(target, hides, constants, vertices).draw(corners);
}

}  // namespace hairloom::software
