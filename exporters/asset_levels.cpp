// SPDX-License-Identifier: GPL-3.0-or-later
// How far levels of detail of an asset are off: the library says it of paths, and what is seen far off is
// measured here.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "core/base/parallel.h"
#include "exporters/asset_extras.h"
#include "exporters/seen_motion.h"
#include "hairloom/hairloom.h"

namespace hairloom {
namespace {

/// Measuring them takes 60 µs a point on one core.
constexpr std::size_t kMostMeasuredPoints = 500'000;

// The hair comes into motion, and is looked at; at rest little happens.
constexpr int kFramesBefore = 24, kFramesSeen = 120, kFramesStill = 12;
constexpr float kStep = 1 / 60.0f;
constexpr float kWind = 3;  ///< m/s

/// Errors are said to be so much larger than those measured: other heads and winds have others.
constexpr float kReserve = 1.5f;

using Hair = std::unique_ptr<hl_instance, void (*)(hl_instance*)>;

void runPieces(void*, std::size_t count, std::size_t grain, void (*body)(void*, std::size_t, std::size_t),
               void* context) {
    parallelFor(count, grain, [&](std::size_t begin, std::size_t end) { body(context, begin, end); });
}

/// What hair is looked at in: at rest, on a nodding head, in wind.
enum class Scene { still, head, wind };

/// Hair of one level in a scene.
class LevelRun {
  public:
    LevelRun(const hl_asset& asset, const hl_asset_info& info, const hl_instance* rest)
        : rest_(rest),
          pivot_(0.5f * (info.bounds_min[1] + info.bounds_max[1])),
          points_(info.guide_points),
          offsets_(info.guides + 1),
          layers_(info.guides) {
        std::uint32_t layers = 0;
        known_ = hl_instance_offsets(rest, offsets_.data(), offsets_.size(), nullptr) == HL_OK &&
                 hl_asset_layers(&asset, &layers, layers_.data(), layers_.size(), nullptr) == HL_OK &&
                 read(rest_, points_);
        atRest_ = points_;
    }
    bool known() const { return known_; }
    /// m/s, of the roots: the greatest of all frames, root mean square.
    float rootSpeed() const { return rootSpeed_; }

    std::optional<SeenMotion> play(std::uint32_t level, Scene scene) {
        hl_instance* copy = nullptr;
        if (hl_instance_copy(rest_, &copy, nullptr) != HL_OK) return std::nullopt;
        const Hair hair(copy, hl_instance_free);
        if (hl_instance_set_level(copy, level, 1, nullptr) != HL_OK) return std::nullopt;
        SeenMotion seen(offsets_, atRest_, layers_);
        std::array<float, 3> wind{scene == Scene::wind ? kWind : 0, 0, 0};
        points_ = atRest_;
        rootSpeed_ = 0;
        const int frames = scene == Scene::still ? kFramesStill : kFramesSeen;
        for (int f = 1; f <= kFramesBefore + frames; ++f) {
            const float angle =
                scene == Scene::head ? 0.25f * std::sin(7.85f * kStep * static_cast<float>(f)) : 0;
            const float c = std::cos(angle), s = std::sin(angle);
            const std::array<float, 12> head{1, 0, 0, 0, 0, c, -s, pivot_ - c * pivot_, 0, s, c, -s * pivot_};
            hl_frame frame;
            hl_frame_init(&frame);
            frame.dt = kStep;
            frame.time = static_cast<double>(kStep * static_cast<float>(f));
            frame.head = head.data();
            frame.wind = wind.data();
            before_.swap(points_);
            points_.resize(atRest_.size());
            if (hl_instance_step(copy, &frame, nullptr) != HL_OK || !read(copy, points_)) return std::nullopt;
            holdSpeed();
            if (f > kFramesBefore) seen.add(points_);
        }
        return seen;
    }

  private:
    static bool read(const hl_instance* hair, std::vector<Vec3f>& points) {
        const hl_out positions{points.data(), points.size() * sizeof(Vec3f), sizeof(Vec3f)},
            none{nullptr, 0, 0};
        return hl_instance_read_guides(const_cast<hl_instance*>(hair), positions, none, none, nullptr) ==
               HL_OK;
    }
    void holdSpeed() {
        float squares = 0;
        for (std::size_t g = 0; g + 1 < offsets_.size(); ++g)
            squares += (points_[offsets_[g]] - before_[offsets_[g]]).squaredNorm();
        rootSpeed_ =
            std::max(rootSpeed_, std::sqrt(squares / static_cast<float>(offsets_.size() - 1)) / kStep);
    }

    const hl_instance* rest_;
    float pivot_;
    std::vector<Vec3f> points_, before_, atRest_;
    std::vector<std::uint32_t> offsets_, layers_;
    bool known_ = false;
    float rootSpeed_ = 0;
};

std::vector<asset::MeasuredLevel> measureSeen(const hl_asset& asset, const hl_asset_info& info,
                                              const hl_instance* rest) {
    LevelRun run(asset, info, rest);
    if (!run.known()) return {};
    std::vector<asset::MeasuredLevel> levels(HL_LEVEL_COUNT);
    for (const Scene scene : {Scene::still, Scene::head, Scene::wind}) {
        const auto finest = run.play(HL_LEVEL_FINEST, scene);
        for (std::uint32_t number = 1; number < HL_LEVEL_COUNT; ++number) {
            const auto coarser = run.play(number, scene);
            if (!finest || !coarser) return {};
            const float apart = kReserve * SeenMotion::between(*finest, *coarser).largest();
            const float speed = scene == Scene::head ? run.rootSpeed() : kWind;
            const float error = scene == Scene::still ? apart
                                : speed > 0           ? std::max(0.0f, apart - levels[number].still) / speed
                                                      : 0;
            float asset::MeasuredLevel::*const part = scene == Scene::still  ? &asset::MeasuredLevel::still
                                                      : scene == Scene::head ? &asset::MeasuredLevel::head
                                                                             : &asset::MeasuredLevel::wind;
            levels[number].*part = std::max(error, levels[number - 1].*part);
        }
    }
    return levels;
}

}  // namespace

MeasuredLevels measureLevels(std::span<const std::byte> file) {
    hl_asset opened;
    hl_asset_info info;
    hl_instance* made = nullptr;
    const hl_jobs jobs{nullptr, runPieces};
    if (hl_asset_open(&opened, file.data(), file.size(), nullptr) != HL_OK ||
        hl_asset_describe(&opened, &info, nullptr) != HL_OK || info.guide_points > kMostMeasuredPoints ||
        hl_instance_make(&opened, HL_LEVELS, &jobs, &made, nullptr) != HL_OK)
        return {};
    const Hair hair(made, hl_instance_free);
    MeasuredLevels levels;
    for (std::uint32_t number = 0; number < HL_LEVEL_COUNT; ++number) {
        hl_level level;
        if (hl_instance_level(hair.get(), number, &level, nullptr) != HL_OK) return {};
        levels.paths.push_back({level.error_still, level.error_head, level.error_wind, 0});
    }
    levels.seen = measureSeen(opened, info, hair.get());
    return levels;
}

}  // namespace hairloom
