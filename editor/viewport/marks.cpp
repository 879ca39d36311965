// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/marks.h"

#include <cmath>

namespace hairloom::editor {
namespace {

render::OverlayVertex vertex(const Vec3f& at_ws, const QColor& colour) {
    return {{at_ws.x(), at_ws.y(), at_ws.z(), 1},
            {colour.redF(), colour.greenF(), colour.blueF(), colour.alphaF()}};
}

}  // namespace

render::OverlayBatch& Marks::batch(render::OverlayShape shape, float size, Depth depth) {
    const bool onTop = depth == Depth::OnTop;
    for (render::OverlayBatch& batch : overlay_.batches) {
        if (batch.shape == shape && batch.size == size && batch.onTop == onTop) return batch;
    }
    overlay_.batches.push_back({shape, size, onTop, {}});
    return overlay_.batches.back();
}

void Marks::line(const Vec3f& a_ws, const Vec3f& b_ws, const QColor& colour, float width_px, Depth depth) {
    auto& vertices = batch(render::OverlayShape::lines, width_px, depth).vertices;
    vertices.push_back(vertex(a_ws, colour));
    vertices.push_back(vertex(b_ws, colour));
}

void Marks::point(const Vec3f& at_ws, const QColor& colour, float diameter_px, Depth depth) {
    batch(render::OverlayShape::points, diameter_px, depth).vertices.push_back(vertex(at_ws, colour));
}

void Marks::triangle(const std::array<Vec3f, 3>& corners_ws, const QColor& colour, Depth depth) {
    triangle(corners_ws, {colour, colour, colour}, depth);
}

void Marks::triangle(const std::array<Vec3f, 3>& corners_ws, const std::array<QColor, 3>& colours,
                     Depth depth) {
    auto& vertices = batch(render::OverlayShape::triangles, 1, depth).vertices;
    for (std::size_t i = 0; i < 3; ++i) vertices.push_back(vertex(corners_ws[i], colours[i]));
}

void Marks::circle(const Vec3f& centre_ws, const Vec3f& normal_ws, float radius, const QColor& colour,
                   float width_px, Depth depth) {
    constexpr int kSegments = 48;
    const Vec3f normal = normal_ws.normalized();
    const Vec3f u = normal.unitOrthogonal();
    const Vec3f v = normal.cross(u);
    Vec3f last = centre_ws + radius * u;
    for (int i = 1; i <= kSegments; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / kSegments;
        const Vec3f next = centre_ws + radius * (std::cos(angle) * u + std::sin(angle) * v);
        line(last, next, colour, width_px, depth);
        last = next;
    }
}

void Marks::path(std::span<const QPointF> points_px, bool closed, const QColor& colour,
                 const OrbitCamera& camera, const QSizeF& view_px) {
    if (points_px.size() < 2) return;
    // Any depth will do: marks on top are not hidden. The target's is safely between near and far.
    const render::Camera seen = camera.camera();
    const float depth = (seen.target_ws - seen.eye_ws).norm();
    const auto at = [&](const QPointF& point_px) -> Vec3f {
        const Ray ray = camera.rayThrough(point_px, view_px);
        return ray.origin_ws + ray.direction_ws * (depth / ray.direction_ws.dot(camera.forward_ws()));
    };
    for (std::size_t i = 1; i < points_px.size(); ++i) {
        line(at(points_px[i - 1]), at(points_px[i]), colour, 1.5f, Depth::OnTop);
    }
    if (closed) line(at(points_px.back()), at(points_px.front()), colour, 1.5f, Depth::OnTop);
}

}  // namespace hairloom::editor
