// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures of levels and of all strands, from several directions at once.

#include <map>
#include <memory>
#include <mutex>

#include "core/cards/levels.h"

namespace hairloom::cards {

/// Plates that were drawn on. They are large, and a system takes its time to hand out memory.
class Plates {
  public:
    /// Calls draw(plate) with one that nobody else draws on.
    template <class Draw>
    void draw(const View& view, std::uint32_t samplesPerHead, const Draw& drawOn) {
        std::unique_ptr<Plate> plate;
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) plate = std::move(idle_.back()), idle_.pop_back();
        }
        if (!plate) plate = std::make_unique<Plate>();
        plate->start(view, samplesPerHead);
        drawOn(*plate);
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(plate));
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Plate>> idle_;
};

/// What pictures are made of and with.
struct Stage {
    const Hair& hair;
    const HairLight& light;
    Plates& plates;
    Cancel cancel;
};

/// Samples along the height of a head where strands are measured and not compared pixel by pixel.
inline constexpr std::uint32_t kSamplesBetween = 768;

struct Shooting {
    std::vector<Shot> shots;
    double drawMs = 0;  ///< mean of a direction
};
enum class Shown { all, coverage };
/// Pictures of a level's content, with a head of `px` pixels, of hair by that many samples a head. Where
/// coverage alone is asked for, those of strands have no light. Some are empty where it was stopped.
Shooting shoot(const Stage& stage, const LevelContent& content, std::span<const View> views, std::uint32_t px,
               std::uint32_t samplesOfHair, Shown shown = Shown::all);

/// Pictures of all strands by pixels of a head, and the mean time of drawing a direction, ms.
struct StrandShots {
    std::map<std::uint32_t, std::vector<Shot>> shots;
    double drawMs = 0;
};
/// Errors: stopped.
Result<StrandShots> shootStrands(const Stage& stage, const StrandLight& light, std::span<const View> views,
                                 std::span<const std::uint32_t> heightsPx);
/// What measures need of such pictures, by kSamplesBetween.
Result<std::map<std::uint32_t, std::vector<Print>>> printStrands(const Stage& stage, const StrandLight& light,
                                                                 std::span<const View> views,
                                                                 std::span<const std::uint32_t> heightsPx);

}  // namespace hairloom::cards
