// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/render_work.h"

#include <QElapsedTimer>
#include <algorithm>
#include <cmath>

namespace hairloom::editor {
namespace {

constexpr double kMovingBudget = 50;  // ms
constexpr float kSmallestScale = 0.4f;
constexpr std::uint32_t kFramesWhenStill = 8;

std::vector<render::Light> lightsOf(const PictureRequest& request) {
    std::vector<render::Light> lights = render::studioLights(request.camera);
    const Mat3f turn = Eigen::AngleAxisf(radians(request.lightTurn), Vec3f::UnitY()).toRotationMatrix();
    for (render::Light& light : lights) light.toLight_ws = turn * light.toLight_ws;
    return lights;
}

/// The same strands are in streaks and dyed, as strands and not the material say.
bool hasSameShares(const HairMaterial& a, const HairMaterial& b) {
    return a.streakShare == b.streakShare && a.streakWidth == b.streakWidth &&
           a.streakSoftness == b.streakSoftness && a.streakSeed == b.streakSeed &&
           a.dyeStrength == b.dyeStrength;
}

/// Same strands, of which at most the points have moved.
bool differsInPositionsOnly(const Groom& a, const Groom& b) {
    const auto sameButPositions = [](const AttributeSet& x, const AttributeSet& y) {
        if (x.all().size() != y.all().size()) return false;
        return std::ranges::all_of(x.all(), [&y](const auto& entry) {
            return entry.first == attribute::kPosition || versionOf(entry.second) == y.version(entry.first);
        });
    };
    return a.offsets.version() == b.offsets.version() &&
           sameButPositions(a.pointAttributes, b.pointAttributes) &&
           sameButPositions(a.strandAttributes, b.strandAttributes) && a.scalp == b.scalp &&
           a.scalpSelection == b.scalpSelection && a.interpolation.followPerGuide == 0 &&
           b.interpolation.followPerGuide == 0 && a.material.rootColour == b.material.rootColour &&
           hasSameShares(a.material, b.material) && a.layers.size() == b.layers.size();
}

/// As a groom shown without its follow hairs.
Groom withoutFollowHairs(Groom groom) {
    groom.interpolation.followPerGuide = 0;
    return groom;
}

}  // namespace

RenderWork::RenderWork(std::unique_ptr<gpu::Device> device)
    : device_(std::move(device)), renderer_(*device_) {}

Status RenderWork::setWindow(const std::optional<gpu::NativeWindow>& window) {
    swapChain_.reset();
    target_.reset();
    width_ = height_ = 0;
    window_ = window;
    if (!window) return {};
    auto made = device_->createSwapChain({*window, 1, 1, true});
    if (!made) {
        window_.reset();
        return tl::unexpected(made.error());
    }
    swapChain_ = std::move(*made);
    return {};
}

Status RenderWork::take(PictureRequest request) {
    const bool draft = request.moving && needsDraft_;
    if (auto taken = takeScene(request, draft); !taken) return taken;
    if (auto set = renderer_.setCamera(request.camera); !set) return set;
    if (auto set = renderer_.setLights(lightsOf(request)); !set) return set;
    if (!last_ || last_->background != request.background) renderer_.setBackground(request.background);
    if (auto set = renderer_.setOverlay(request.marks); !set) return set;
    last_ = std::move(request);
    return {};
}

Status RenderWork::takeScene(const PictureRequest& request, bool draft) {
    const bool sameShown = last_ && request.showHair == hairShown_ && request.showHead == headShown_;
    if (!scene_ || !sameShown || draft != draft_) return replaceScene(request, draft);
    if (request.groom != last_->groom) {
        const bool onlyMoved = draft_ ? differsInPositionsOnly(withoutFollowHairs(*request.groom),
                                                               withoutFollowHairs(*last_->groom))
                                      : differsInPositionsOnly(*request.groom, *last_->groom);
        if (!onlyMoved) return replaceScene(request, draft);
    } else if (request.pose == last_->pose) {
        return {};
    }
    return movePoints(request);
}

Status RenderWork::replaceScene(const PictureRequest& request, bool draft) {
    auto made = GroomScene::make(draft ? withoutFollowHairs(*request.groom) : *request.groom, nullptr,
                                 nullptr, {}, {});
    if (!made) return tl::unexpected(made.error());
    scene_ = std::move(*made);
    draft_ = draft;
    hairShown_ = request.showHair;
    headShown_ = request.showHead;
    if (request.pose && request.pose->positions_ws.size() == request.groom->pointCount()) {
        if (auto posed = scene_->pose(request.pose->positions_ws, request.pose->head); !posed) return posed;
    }
    render::RenderScene shown = scene_->scene();
    if (!request.showHair) shown.strands.clear();
    if (!request.showHead) shown.meshes.clear();
    shown.camera = request.camera;
    shown.lights = lightsOf(request);
    shown.background = request.background;
    return renderer_.setScene(shown);
}

Status RenderWork::movePoints(const PictureRequest& request) {
    const bool posed = request.pose && request.pose->positions_ws.size() == request.groom->pointCount();
    auto moved = posed ? scene_->pose(request.pose->positions_ws, request.pose->head)
                       : scene_->pose(request.groom->positions(), {});
    if (!moved) return moved;
    const render::RenderScene shown = scene_->scene();
    if (request.showHead && !shown.meshes.empty()) {
        const render::RenderMesh& mesh = shown.meshes.front();
        if (auto set = renderer_.setMeshPositions(0, mesh.positions_ws, mesh.normals_ws); !set) return set;
    }
    if (!request.showHair || shown.strands.empty()) return {};
    if (auto set = renderer_.setStrandPositions(0, shown.strands.front().positions_ws); !set) return set;
    return renderer_.setMaterial(0, shown.strands.front().material);
}

render::RenderOptions RenderWork::options() const {
    render::RenderOptions options;
    options.width = width_;
    options.height = height_;
    options.exposure = last_->exposure;
    options.samples = last_->moving ? 1 : 4;
    options.frames = last_->moving ? 1 : kFramesWhenStill;
    options.subdivisions = last_->moving ? 1 : 2;
    options.shadowResolution = last_->moving ? 512 : 1024;
    options.detail = last_->moving ? 0.5f : 0.0f;
    return options;
}

Status RenderWork::resize(std::uint32_t width, std::uint32_t height) {
    if (width == width_ && height == height_) return {};
    if (swapChain_) {
        if (auto resized = swapChain_->resize(width, height); !resized) return resized;
    } else {
        gpu::TextureDesc desc;
        desc.name = "viewport";
        desc.width = width;
        desc.height = height;
        desc.format = gpu::Format::Bgra8Unorm;
        desc.usage = gpu::Usage::RenderTarget;
        auto made = device_->createTexture(desc);
        if (!made) return tl::unexpected(made.error());
        target_ = std::move(*made);
    }
    width_ = width;
    height_ = height;
    return {};
}

Result<std::pair<QImage, PictureReport>> RenderWork::draw() {
    QElapsedTimer clock;
    clock.start();
    const float scale = last_->moving && !swapChain_ ? scale_ : 1.0f;
    const auto side = [scale](std::uint32_t pixels) {
        return std::max(16u, static_cast<std::uint32_t>(static_cast<float>(pixels) * scale));
    };
    if (auto resized = resize(side(last_->width), side(last_->height)); !resized) {
        return tl::unexpected(resized.error());
    }
    auto list = device_->createCommandList();
    if (!list) return tl::unexpected(list.error());
    const auto recorded =
        renderer_.record(**list, options(), swapChain_ ? swapChain_->backBuffer() : target_);
    if (!recorded) return tl::unexpected(recorded.error());
    const auto submitted = device_->submit(std::move(*list));
    if (!submitted) return tl::unexpected(submitted.error());
    std::pair<QImage, PictureReport> result;
    if (swapChain_) {
        if (auto shown = swapChain_->present(); !shown) return tl::unexpected(shown.error());
        if (auto done = (*submitted)->wait(); !done) return tl::unexpected(done.error());
    } else {
        auto image = readBack();
        if (!image) return tl::unexpected(image.error());
        result.first = std::move(*image);
    }
    PictureReport& report = result.second;
    report.milliseconds = static_cast<double>(clock.nsecsElapsed()) * 1e-6;
    report.hairs = renderer_.strands();
    report.frames = renderer_.accumulated();
    report.moving = last_->moving;
    report.presented = swapChain_ != nullptr;
    if (last_->moving) adapt(report.milliseconds);
    return result;
}

Result<QImage> RenderWork::readBack() const {
    QImage image(static_cast<int>(width_), static_cast<int>(height_), QImage::Format_RGB32);
    // Rows of 32-bit pixels have no gaps.
    const std::span<uchar> bytes(image.bits(), static_cast<std::size_t>(image.sizeInBytes()));
    if (auto read = device_->readTexture(target_, std::as_writable_bytes(bytes)); !read) {
        return tl::unexpected(read.error());
    }
    return image;
}

bool RenderWork::isComplete() const {
    return !last_ || renderer_.accumulated() >= options().frames;
}

void RenderWork::adapt(double milliseconds) {
    const auto wish = static_cast<float>(std::sqrt(kMovingBudget / std::max(milliseconds, 1.0)));
    if (!swapChain_) scale_ = std::clamp(scale_ * std::clamp(wish, 0.6f, 1.2f), kSmallestScale, 1.0f);
    if (milliseconds > 3 * kMovingBudget && (swapChain_ || scale_ <= kSmallestScale)) needsDraft_ = true;
}

}  // namespace hairloom::editor
