// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A curve over [0, 1] that an artist draws: how a brush fades to its rim, or from root to tip.

#include <span>
#include <string_view>
#include <vector>

namespace hairloom::editing {

class BrushCurve {
  public:
    static constexpr std::size_t kMaxValues = 64;

    BrushCurve() = default;  ///< 1 everywhere
    /// Values in [0, 1] at even distances from 0 to 1, at most kMaxValues; straight between. None is 1
    /// everywhere.
    explicit BrushCurve(std::vector<float> values) : values_(std::move(values)) {}

    /// "constant", "linear", "smooth", "sharp", "round": from 1 at 0 (the middle) to 0 at 1 (the rim), but
    /// for constant. Anything else is constant.
    static BrushCurve falloff(std::string_view name);
    static std::span<const std::string_view> falloffNames();

    float at(float x) const {
        if (values_.empty()) return 1;
        const float scaled = x * static_cast<float>(values_.size() - 1);
        if (!(scaled > 0)) return values_.front();
        const auto below = static_cast<std::size_t>(scaled);
        if (below + 1 >= values_.size()) return values_.back();
        const float t = scaled - static_cast<float>(below);
        return values_[below] + t * (values_[below + 1] - values_[below]);
    }
    const std::vector<float>& values() const { return values_; }
    bool operator==(const BrushCurve&) const = default;

  private:
    std::vector<float> values_;
};

}  // namespace hairloom::editing
