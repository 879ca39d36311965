// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What frames that play take, of the last half second: the whole and each effect.

#include <map>
#include <string>

#include "editor/simulation/player.h"

namespace hairloom::editor {

class LiveCosts {
  public:
    /// Frames come in their order; one from before begins anew. The same one again is none.
    void add(const PlayedFrame& frame);
    void restart() { *this = {}; }

    /// Milliseconds, of the thread or the device that simulates; 0 while it is not known.
    double frame() const { return frame_; }
    /// Its share of those: what threads spend together counts as part of the frame that they share.
    double millisecondsOf(const std::string& effect) const;

  private:
    /// Milliseconds of some frames.
    struct Sums {
        std::uint64_t frames = 0;
        double frame = 0;
        std::map<std::string, double> effects;
    };
    void show(const Sums& spent);

    Sums from_;               ///< all before the half second, of the CPU
    std::uint64_t last_ = 0;  ///< frame
    double frame_ = 0;
    std::map<std::string, double> shares_;  ///< of the frame, by effect
};

}  // namespace hairloom::editor
