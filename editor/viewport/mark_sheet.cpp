// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/mark_sheet.h"

#include <algorithm>
#include <cmath>

#include "core/gpu/device.h"
#include "core/software/marks.h"
#include "core/software/mesh_depth.h"

namespace hairloom::editor {
namespace {

struct ReachInView {
    float left = 1e9f, top = 1e9f, right = -1e9f, bottom = -1e9f;  ///< device pixels
};

/// From before the nearest point to behind the farthest, of marks and head.
Mat4f clipFromWorld(const render::Camera& camera, float aspect, const Box3f& box) {
    const Mat4f view = render::viewMatrix(camera);
    float nearest = 1e30f, farthest = 0.1f;
    for (int i = 0; i < 8; ++i) {
        const float distance = -(view * box.corner(static_cast<Box3f::CornerType>(i)).homogeneous()).z();
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
    const float margin = 0.01f * (farthest - nearest) + 1e-3f;
    const float farPlane = farthest + margin;
    float nearPlane = nearest - margin;
    if (!camera.isOrthographic()) nearPlane = std::clamp(nearPlane, farPlane * 1e-4f, farPlane * 0.9f);
    return render::projectionMatrix(camera, aspect, nearPlane, farPlane) * view;
}

/// The pixels that marks may reach; all of the view where one comes near the eye or behind it.
QRect reachOf(const render::Overlay& marks, const Mat4f& clip, const QSize& size_px, float scale) {
    const QRect whole(QPoint(), size_px);
    const auto width = static_cast<float>(size_px.width()), height = static_cast<float>(size_px.height());
    ReachInView reach;
    for (const render::OverlayBatch& batch : marks.batches) {
        const float around = 0.5f * scale * batch.size + 2;
        for (const render::OverlayVertex& vertex : batch.vertices) {
            const Vec4f at = clip * Vec4f(vertex.position_ws.head<3>().homogeneous());
            if (!(at.w() > 1e-3f)) return whole;
            const float x = (0.5f + 0.5f * at.x() / at.w()) * width;
            const float y = (0.5f - 0.5f * at.y() / at.w()) * height;
            reach.left = std::min(reach.left, x - around);
            reach.right = std::max(reach.right, x + around);
            reach.top = std::min(reach.top, y - around);
            reach.bottom = std::max(reach.bottom, y + around);
        }
    }
    if (!(reach.right > 0 && reach.bottom > 0 && reach.left < width && reach.top < height)) return {};
    return QRect(QPoint(static_cast<int>(std::max(reach.left, 0.0f)),
                        static_cast<int>(std::max(reach.top, 0.0f))),
                 QPoint(static_cast<int>(std::min(reach.right, width - 1)),
                        static_cast<int>(std::min(reach.bottom, height - 1))))
        .intersected(whole);
}

/// A part of the view as a view of its own.
Mat4f cropped(Mat4f clip, const QSize& size_px, const QRect& part) {
    const auto wide = [](int whole, int of) { return static_cast<float>(whole) / static_cast<float>(of); };
    const float x = wide(size_px.width(), part.width()), y = wide(size_px.height(), part.height());
    clip.row(0) = x * clip.row(0) + (x - wide(2 * part.left(), part.width()) - 1) * clip.row(3);
    clip.row(1) = y * clip.row(1) - (y - wide(2 * part.top(), part.height()) - 1) * clip.row(3);
    return clip;
}

std::array<float, 16> columnsOf(const Mat4f& matrix) {
    std::array<float, 16> values{};
    std::copy_n(matrix.data(), values.size(), values.begin());  // Eigen's are column-major
    return values;
}

std::vector<shaders::OverlayVertex> shaderVertices(const render::OverlayBatch& batch) {
    const auto four = [](const Vec4f& v) { return shaders::float4{v.x(), v.y(), v.z(), v.w()}; };
    std::vector<shaders::OverlayVertex> vertices;
    vertices.reserve(batch.vertices.size());
    for (const render::OverlayVertex& vertex : batch.vertices)
        vertices.push_back({four(vertex.position_ws), four(vertex.colour)});
    return vertices;
}

std::shared_ptr<software::HostTexture> sheetOf(const QSize& size_px) {
    gpu::TextureDesc desc;
    desc.name = "marks";
    desc.width = static_cast<std::uint32_t>(size_px.width());
    desc.height = static_cast<std::uint32_t>(size_px.height());
    desc.format = gpu::Format::Rgba8Unorm;
    auto made = software::HostTexture::make(desc, {});
    return made ? *made : nullptr;
}

}  // namespace

std::span<const float> MarkSheet::depthOfHead(const Mat4f& clip, const QSize& size_px,
                                              std::span<const Vec3f> positions_ws, const ScalpMesh& head) {
    if (clip == seenAs_ && size_px == size_px_ && std::ranges::equal(positions_ws, positions_ws_))
        return depths_;
    seenAs_ = clip;
    size_px_ = size_px;
    positions_ws_.assign(positions_ws.begin(), positions_ws.end());
    depths_.assign(static_cast<std::size_t>(size_px.width()) * static_cast<std::size_t>(size_px.height()), 1);
    const auto columns = static_cast<std::uint32_t>(size_px.width());
    const auto rows = static_cast<std::uint32_t>(size_px.height());
    software::drawDepth({depths_, columns, 0, 0, columns, rows}, columnsOf(clip),
                        {positions_ws.front().data(), 3 * positions_ws.size()},
                        {head.triangles().front().data(), 3 * head.triangles().size()});
    return depths_;
}

MarkSheet::Sheet MarkSheet::draw(const render::Overlay& marks, const render::Camera& camera,
                                 const QSize& size_px, float scale, const Groom& groom, const HeadPose* pose,
                                 bool showsHead) {
    if (marks.batches.empty() || size_px.isEmpty() || !render::check(marks)) return {};
    Box3f box;
    bool needsDepth = false;
    for (const render::OverlayBatch& batch : marks.batches) {
        for (const render::OverlayVertex& vertex : batch.vertices) box.extend(vertex.position_ws.head<3>());
        needsDepth = needsDepth || (!batch.onTop && !batch.vertices.empty());
    }
    if (box.isEmpty()) return {};
    std::span<const Vec3f> positions;
    std::vector<Vec3f> moved;
    if (needsDepth && showsHead && groom.scalp && !groom.scalp->triangles().empty()) {
        positions = groom.scalp->positions();
        if (pose && pose->scalpPositions_ws.size() == positions.size()) {
            positions = pose->scalpPositions_ws;
        } else if (pose) {
            for (const Vec3f& at : positions) moved.push_back(pose->head_ws * at);
            positions = moved;
        }
        for (const Vec3f& at : positions) box.extend(at);
    }
    const float aspect = static_cast<float>(size_px.width()) / static_cast<float>(size_px.height());
    Mat4f clip = clipFromWorld(camera, aspect, box);
    const QRect part = reachOf(marks, clip, size_px, scale);
    if (part.isEmpty()) return {};
    clip = cropped(clip, size_px, part);
    const auto sheet = sheetOf(part.size());
    if (!sheet) return {};
    std::span<const float> depths;
    if (!positions.empty()) depths = depthOfHead(clip, part.size(), positions, *groom.scalp);
    shaders::OverlayConstants constants{};
    std::ranges::copy(columnsOf(clip), std::begin(constants.clipFromWorld.m));
    constants.width = static_cast<float>(part.width());
    constants.height = static_cast<float>(part.height());
    constants.keepsSrgb = 1;
    for (const bool onTop : {false, true}) {
        for (const render::OverlayBatch& batch : marks.batches) {
            if (batch.onTop != onTop) continue;
            constants.shape = static_cast<std::uint32_t>(batch.shape);
            constants.markRadius = 0.5f * scale * batch.size;
            const auto vertices = shaderVertices(batch);
            const std::size_t corners = batch.shape == render::OverlayShape::triangles ? vertices.size()
                                        : batch.shape == render::OverlayShape::lines   ? 3 * vertices.size()
                                                                                       : 6 * vertices.size();
            software::drawMarks(*sheet, onTop ? std::span<const float>() : depths, constants, vertices,
                                static_cast<std::uint32_t>(corners));
        }
    }
    Sheet drawn{QImage(part.size(), QImage::Format_RGBA8888_Premultiplied), part};
    sheet->copyTo(std::as_writable_bytes(
        std::span(drawn.image.bits(), static_cast<std::size_t>(drawn.image.sizeInBytes()))));
    return drawn;
}

}  // namespace hairloom::editor
