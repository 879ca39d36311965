// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/card_tool.h"

#include <cmath>
#include <limits>

#include "editor/tools/surface_pick.h"

namespace hairloom::editor {
namespace {

/// Where a ray meets a triangle, along its direction; nothing beside it (Möller and Trumbore 1997).
std::optional<float> hitOf(const Ray& ray, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3f ab = b - a, ac = c - a;
    const Vec3f p = ray.direction_ws.cross(ac);
    const float determinant = ab.dot(p);
    if (std::abs(determinant) < 1e-14f) return std::nullopt;
    const Vec3f from = (ray.origin_ws - a) / determinant;
    const float u = from.dot(p);
    const Vec3f q = from.cross(ab);
    const float v = ray.direction_ws.dot(q);
    if (u < 0 || v < 0 || u + v > 1) return std::nullopt;
    return ac.dot(q);
}

}  // namespace

QString CardTool::hint() const {
    return mesh_ ? QString("%1. Press Delete to remove it").arg(info_.tip)
                 : QString("Create levels in the Levels panel first");
}

std::optional<std::uint32_t> CardTool::cardAt(const QPointF& at_px) const {
    if (!mesh_) return std::nullopt;
    const Ray ray = viewport_.camera().rayThrough(at_px, viewport_.viewSize_px());
    const BrushPlace skin = skinUnder(document_, viewport_, at_px);
    constexpr float kWithin = 0.005f;  // metres that cards may lie in the skin
    float nearest = std::numeric_limits<float>::infinity();
    if (skin.skin) nearest = (skin.position_ss - ray.origin_ws).dot(ray.direction_ws) + kWithin;
    std::optional<std::uint32_t> card;
    const auto& vertices = mesh_->vertices;
    const auto& indices = mesh_->indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const cards::CardVertex& a = vertices[indices[i]];
        if (a.card == cards::kOfCap) continue;
        const auto hit = hitOf(ray, a.position_ws, vertices[indices[i + 1]].position_ws,
                               vertices[indices[i + 2]].position_ws);
        if (hit && *hit < nearest) nearest = *hit, card = a.card;
    }
    return card;
}

void CardTool::press(const Pointer& pointer) {
    if (mesh_) Q_EMIT picked(cardAt(pointer.at_px));
}

bool CardTool::key(int key, Qt::KeyboardModifiers) {
    if (key != Qt::Key_Delete || !mesh_) return false;
    Q_EMIT deleteAsked();
    return true;
}

ToolMaker cardTool() {
    return [](const ToolParts& parts) { return oneTool<CardTool>(parts.document, parts.viewport); };
}

}  // namespace hairloom::editor
