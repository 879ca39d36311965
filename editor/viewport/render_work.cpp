// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/viewport/render_work.h"

#include <QElapsedTimer>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/groom/move_strands.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "core/groom/time_line.h"
#include "core/live/moving_picture.h"
#include "core/software/device.h"

namespace hairloom::editor {
namespace {

constexpr double kMovingBudget = 50;  // ms
constexpr float kSmallestScale = 0.4f;

std::vector<render::Light> lightsOf(const PictureRequest& request) {
    std::vector<render::Light> lights = render::studioLights(request.camera);
    const Mat3f turn = Eigen::AngleAxisf(radians(request.lightTurn), Vec3f::UnitY()).toRotationMatrix();
    for (render::Light& light : lights) {
        light.toLight_ws = turn * light.toLight_ws;
        light.irradiance *= request.lightScale;
    }
    return lights;
}

render::Environment environmentOf(const PictureRequest& request) {
    render::Environment environment = render::RenderScene().environment;
    for (Vec3f& coefficient : environment.coefficients) coefficient *= request.environment;
    return environment;
}

/// Same strands on the same head, of which at most points have moved, and dye, widths and material have
/// changed.
bool sameStrands(const Groom& a, const Groom& b) {
    const auto same = [](const AttributeSet& x, const AttributeSet& y,
                         std::initializer_list<std::string_view> others) {
        if (x.all().size() != y.all().size()) return false;
        return std::ranges::all_of(x.all(), [&](const auto& entry) {
            const bool mayDiffer = std::ranges::find(others, entry.first) != others.end();
            return mayDiffer ? y.has(entry.first) : versionOf(entry.second) == y.version(entry.first);
        });
    };
    return drawSameHairs(a, b) &&
           same(a.pointAttributes, b.pointAttributes,
                {attribute::kPosition, attribute::kPointDye, attribute::kWidthChange}) &&
           same(a.strandAttributes, b.strandAttributes, {}) && a.scalpSelection == b.scalpSelection;
}

bool samePoints(const Groom& a, const Groom& b) {
    return a.pointAttributes.version(attribute::kPosition) == b.pointAttributes.version(attribute::kPosition);
}

ViewFile viewOf(const PictureRequest& request) {
    ViewFile view;
    view.fibre.scattering = request.quality.scattering;
    return view;
}

/// Of guides that stand for their follow hairs: as wide as these side by side, so that they hide as much, but
/// for a few guides of many hairs, which would be ribbons.
float draftRadius(float radius, const Groom& groom) {
    constexpr float kWidest = 0.0005f;  // metres
    const float all = radius * static_cast<float>(groom.interpolation.followPerGuide);
    return std::max(radius, std::min(all, kWidest));
}

void widenMaterials(Groom& groom) {
    groom.material.rootRadius = draftRadius(groom.material.rootRadius, groom);
    for (Layer& layer : groom.layers) {
        if (layer.material) layer.material->rootRadius = draftRadius(layer.material->rootRadius, groom);
    }
}

/// Ribbons in their place.
void leaveTubes(Groom& groom) {
    groom.material.tubes = false;
    for (Layer& layer : groom.layers) {
        if (layer.material) layer.material->tubes = false;
    }
}

bool sameCamera(const render::Camera& a, const render::Camera& b) {
    return a.eye_ws == b.eye_ws && a.target_ws == b.target_ws && a.up_ws == b.up_ws &&
           a.verticalFov == b.verticalFov && a.orthographicHeight == b.orthographicHeight;
}

/// Guides alone.
Groom draftOf(Groom groom) {
    if (groom.pointAttributes.has(attribute::kRadius)) {
        for (float& radius : groom.pointAttributes.edit<float>(attribute::kRadius))
            radius = draftRadius(radius, groom);
    }
    widenMaterials(groom);
    groom.interpolation.followPerGuide = 0;
    return groom;
}

/// From light times coverage, as the renderer leaves it, to colour and coverage. Both are encoded as sRGB, of
/// which a power of 2.2 is close enough here.
void straighten(QImage& image) {
    constexpr float kGamma = 2.2f;
    std::array<float, 256> factor{};
    for (std::size_t a = 1; a < factor.size(); ++a) {
        factor[a] = std::pow(255.0f / static_cast<float>(a), 1 / kGamma);
    }
    for (int y = 0; y < image.height(); ++y) {
        auto* const row = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < image.width(); ++x) {
            const int alpha = qAlpha(row[x]);
            if (alpha == 255) continue;
            const auto straight = [&](int value) {
                return std::min(255, static_cast<int>(factor[static_cast<std::size_t>(alpha)] *
                                                      static_cast<float>(value)));
            };
            row[x] = qRgba(straight(qRed(row[x])), straight(qGreen(row[x])), straight(qBlue(row[x])), alpha);
        }
    }
}

}  // namespace

bool showsTheSame(const PictureRequest& a, const PictureRequest& b) {
    return a.document == b.document && a.groom == b.groom && a.pose == b.pose &&
           sameCamera(a.camera, b.camera) && a.width == b.width && a.height == b.height &&
           a.showHair == b.showHair && a.showHead == b.showHead && a.lightTurn == b.lightTurn &&
           a.exposure == b.exposure && a.toDisplay == b.toDisplay && a.lightScale == b.lightScale &&
           a.environment == b.environment && a.background == b.background && a.seeThrough == b.seeThrough &&
           a.quality == b.quality && a.other == b.other && a.otherQuality == b.otherQuality;
}

RenderWork::RenderWork(gpu::Device& device, PlayedHair* played)
    : device_(device), played_(played), software_(software::isSoftware(device)), renderer_(device) {}

Groom RenderWork::shownOf(const Groom& groom, bool draft) const {
    Groom shown = draft ? draftOf(groom) : groom;
    if (software_) leaveTubes(shown);
    return shown;
}

Status RenderWork::setWindow(const std::optional<gpu::NativeWindow>& window) {
    swapChain_.reset();
    target_.reset();
    width_ = height_ = 0;
    window_ = window;
    if (!window) return {};
    auto made = device_.createSwapChain({*window, 1, 1, true});
    if (!made) {
        window_.reset();
        return tl::unexpected(made.error());
    }
    swapChain_ = std::move(*made);
    return {};
}

void RenderWork::takeMoves(PictureRequest& request) {
    if (request.groom != handed_) {
        handed_ = request.groom;
        moved_.reset();
    }
    if (request.moves) {
        if (!moved_) moved_ = std::make_shared<Groom>(*handed_);
        // Parts from the array of whoever handed it over, once.
        hairloom::moveStrands(*moved_, request.moves->strands, request.moves->points_ws);
    }
    if (moved_) request.groom = moved_;
}

void RenderWork::takeKeys(PictureRequest& request) {
    if (!request.pose || !request.pose->lineTime || request.moves ||
        !keysMaterial(timeLineOf(*request.groom))) {
        unkeyed_.reset();
        keyed_.reset();
        return;
    }
    const float time = *request.pose->lineTime;
    if (request.groom != unkeyed_ || time != keyedTime_) {
        auto keyed = std::make_shared<Groom>(*request.groom);  // shares its arrays
        keyed->material = materialAt(timeLineOf(*keyed), time, keyed->material);
        unkeyed_ = request.groom;
        keyed_ = std::move(keyed);
        keyedTime_ = time;
    }
    request.groom = keyed_;
}

Status RenderWork::take(PictureRequest request) {
    takeMoves(request);
    takeKeys(request);
    // What the device makes itself is never too slow to move.
    const bool onDevice = request.pose && request.pose->onDevice;
    const bool draft =
        request.moving && needsDraft_ && !onDevice && request.groom->interpolation.followPerGuide > 0;
    if (auto taken = takeScene(request, draft); !taken) return taken;
    const bool seenFromThere = last_ && sameCamera(last_->camera, request.camera);
    if (!seenFromThere) {
        if (auto set = renderer_.setCamera(request.camera); !set) return set;
    }
    if (!seenFromThere || last_->lightTurn != request.lightTurn || last_->lightScale != request.lightScale) {
        if (auto set = renderer_.setLights(lightsOf(request)); !set) return set;
    }
    if (!last_ || last_->environment != request.environment) {
        renderer_.setEnvironment(environmentOf(request));
    }
    if (!last_ || last_->background != request.background) renderer_.setBackground(request.background);
    if (auto set = renderer_.setOverlay(request.marks); !set) return set;
    last_ = std::move(request);
    return {};
}

Status RenderWork::takeScene(const PictureRequest& request, bool draft) {
    const bool sameShown = last_ && request.showHair == hairShown_ && request.showHead == headShown_;
    if (!scene_ || !sameShown || draft != draft_) return replaceScene(request, draft);
    const Groom& now = *request.groom;
    const Groom& before = *last_->groom;
    const bool sameGroom = request.groom == last_->groom;
    const bool followed = !draft_ && now.interpolation.followPerGuide > 0;
    const bool wasHanded = last_->groom == handed_ || last_->groom == moved_;
    const bool onlyMoves = request.moves && wasHanded && !request.pose && !last_->pose;
    if (!sameGroom && !sameStrands(now, before)) return replaceScene(request, draft);
    // Follow hairs are bound to their guides at rest: as they were before a stroke until it ends.
    if (followed && !onlyMoves &&
        (request.moves || !samePoints(now, before) || (scene_->isBindingOld() && !request.moving)))
        return replaceScene(request, draft);
    if (!sameGroom || request.quality.scattering != last_->quality.scattering) {
        Groom looks = now;
        if (draft) widenMaterials(looks);
        if (software_) leaveTubes(looks);
        // The skin below has some of the hair's colour.
        const bool tints = scene_->rest().material.rootColour != looks.material.rootColour;
        if (!scene_->setMaterials(looks, viewOf(request))) return replaceScene(request, draft);
        if (auto set = showMaterials(renderer_, *scene_, request.showHair, request.showHead && tints); !set)
            return set;
    }
    const bool sameDye = now.pointAttributes.version(attribute::kPointDye) ==
                         before.pointAttributes.version(attribute::kPointDye);
    if (!sameDye) {
        if (!scene_->setDye(now)) return replaceScene(request, draft);
        if (auto set = showDye(request); !set) return set;
    }
    const bool sameWidths = now.pointAttributes.version(attribute::kWidthChange) ==
                            before.pointAttributes.version(attribute::kWidthChange);
    if (!sameWidths && !scene_->setWidths(now)) return replaceScene(request, draft);
    if (scene_->hasPaintedWidths() && (!sameWidths || !sameGroom)) {
        if (auto set = showWidths(request); !set) return set;
    }
    if (onlyMoves) return moveStrands(request, *request.moves);
    const bool moved = request.pose != last_->pose || (!sameGroom && !samePoints(now, before));
    return moved ? movePoints(request) : Status();
}

Status RenderWork::replaceScene(const PictureRequest& request, bool draft) {
    // How hair is clumped is of its authored thickness, at any frame and from any frame before.
    const bool isKeyed = keyed_ && request.groom == keyed_;
    auto made = GroomScene::make(shownOf(isKeyed ? *unkeyed_ : *request.groom, draft), viewOf(request), {});
    if (!made) return tl::unexpected(made.error());
    scene_ = std::move(*made);
    if (isKeyed) scene_->setMaterials(shownOf(*request.groom, draft), viewOf(request));
    draft_ = draft;
    hairShown_ = request.showHair;
    headShown_ = request.showHead;
    MovingHair* const played = playedIn(request);
    if (!played && request.pose && request.pose->positions_ws.size() == request.groom->pointCount()) {
        scene_->pose(request.pose->positions_ws, request.pose->velocities_ws, request.pose->head);
    }
    render::RenderScene shown = scene_->scene();
    if (!request.showHair) shown.strands.clear();
    if (!request.showHead) shown.meshes.clear();
    shown.camera = request.camera;
    shown.lights = lightsOf(request);
    shown.background = request.background;
    shown.environment = environmentOf(request);
    if (auto set = renderer_.setScene(shown); !set || !played) return set;
    return played->show(renderer_, *scene_, !shown.strands.empty(), !shown.meshes.empty());
}

MovingHair* RenderWork::playedIn(const PictureRequest& request) const {
    const bool isPlayed = request.pose && request.pose->onDevice && played_ && !draft_;
    return isPlayed ? played_->hairOf(*request.groom) : nullptr;
}

Status RenderWork::movePoints(const PictureRequest& request) {
    const render::RenderScene shown = scene_->scene();
    const bool hair = request.showHair && !shown.strands.empty();
    const bool head = request.showHead && !shown.meshes.empty();
    if (MovingHair* const played = playedIn(request)) return played->show(renderer_, *scene_, hair, head);
    const bool posed = request.pose && request.pose->positions_ws.size() == request.groom->pointCount();
    if (posed) {
        scene_->pose(request.pose->positions_ws, request.pose->velocities_ws, request.pose->head);
    } else {
        scene_->pose(request.groom->positions(), {}, {});
    }
    return showPosed(renderer_, *scene_, hair, head);
}

Status RenderWork::moveStrands(const PictureRequest& request, const StrandMoves& moves) {
    if (!scene_->moveStrands(moves.strands, moves.points_ws)) return replaceScene(request, draft_);
    const render::RenderScene shown = scene_->scene();
    if (!request.showHair || shown.strands.empty()) return {};
    // One copy of all is sooner on the device than thousands of small ones with a barrier between each.
    return renderer_.setStrandPositions(0, shown.strands.front().positions_ws);
}

Status RenderWork::showWidths(const PictureRequest& request) {
    const render::RenderScene shown = scene_->scene();
    if (!request.showHair || shown.strands.empty()) return {};
    return renderer_.setRadii(0, shown.strands.front().radii);
}

Status RenderWork::showDye(const PictureRequest& request) {
    const render::RenderScene shown = scene_->scene();
    if (!request.showHair || shown.strands.empty()) return {};
    return renderer_.setPointDyes(0, shown.strands.front().pointDyes);
}

render::RenderOptions RenderWork::options() const {
    render::RenderOptions options = stillOptions(last_->quality, last_->groom->shadows, device_.info());
    options.width = width_;
    options.height = height_;
    options.exposure = last_->exposure;
    options.toDisplay = last_->toDisplay;
    options.bakeBehind = true;
    options.transparentBackground = last_->seeThrough && !swapChain_;
    if (last_->moving) {
        simplifyWhileMoving(options);
        options.temporal = last_->quality.joinsFrames && !software_;
    }
    if (software_) takeWaysOfSoftware(options);
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
        auto made = device_.createTexture(desc);
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
    auto list = device_.createCommandList();
    if (!list) return tl::unexpected(list.error());
    const auto recorded =
        renderer_.record(**list, options(), swapChain_ ? swapChain_->backBuffer() : target_);
    if (!recorded) return tl::unexpected(recorded.error());
    const auto submitted = device_.submit(std::move(*list));
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
    report.document = last_->document;
    report.camera = last_->camera;
    report.milliseconds = static_cast<double>(clock.nsecsElapsed()) * 1e-6;
    report.hairs = renderer_.strands();
    report.frames = renderer_.accumulated();
    report.moving = last_->moving;
    report.displayError = renderer_.displayError();
    report.presented = swapChain_ != nullptr;
    if (last_->moving) adapt(report.milliseconds);
    return result;
}

Result<QImage> RenderWork::readBack() const {
    const bool seeThrough = last_->seeThrough;
    QImage image(static_cast<int>(width_), static_cast<int>(height_),
                 seeThrough ? QImage::Format_ARGB32 : QImage::Format_RGB32);
    // Rows of 32-bit pixels have no gaps.
    const std::span<uchar> bytes(image.bits(), static_cast<std::size_t>(image.sizeInBytes()));
    if (auto read = device_.readTexture(target_, std::as_writable_bytes(bytes)); !read) {
        return tl::unexpected(read.error());
    }
    if (seeThrough) straighten(image);
    return image;
}

Result<QImage> RenderWork::shownBy(const render::ColourTransform& toDisplay) const {
    render::LinearImage light{width_, height_, std::vector<float>(std::size_t{4} * width_ * height_)};
    const auto sum = std::as_writable_bytes(std::span(light.rgba));
    if (auto read = device_.readBuffer(renderer_.linearSum(), 0, sum); !read)
        return tl::unexpected(read.error());
    const float share = 1 / static_cast<float>(renderer_.accumulated());
    const bool seeThrough = last_->seeThrough;
    for (std::size_t i = 0; i < light.rgba.size(); i += 4) {
        // From light times coverage to both apart.
        const float coverage = seeThrough ? std::clamp(light.rgba[i + 3] * share, 0.0f, 1.0f) : 1;
        for (std::size_t c = 0; c < 3; ++c) light.rgba[i + c] *= coverage > 0 ? share / coverage : 0;
        light.rgba[i + 3] = coverage;
    }
    const render::Image shown = render::showBy(toDisplay, light, last_->exposure);
    const auto side = [](std::uint32_t pixels) { return static_cast<int>(pixels); };
    return QImage(shown.rgba.data(), side(width_), side(height_), QImage::Format_RGBA8888)
        .convertToFormat(seeThrough ? QImage::Format_ARGB32 : QImage::Format_RGB32);
}

bool RenderWork::isComplete() const {
    return !last_ || (renderer_.isSettled() && renderer_.accumulated() >= options().frames);
}

void RenderWork::adapt(double milliseconds) {
    const auto wish = static_cast<float>(std::sqrt(kMovingBudget / std::max(milliseconds, 1.0)));
    if (!swapChain_) scale_ = std::clamp(scale_ * std::clamp(wish, 0.6f, 1.2f), kSmallestScale, 1.0f);
    if (milliseconds > 3 * kMovingBudget && (swapChain_ || scale_ <= kSmallestScale)) needsDraft_ = true;
}

}  // namespace hairloom::editor
