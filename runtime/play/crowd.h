// SPDX-License-Identifier: MIT
#pragma once
// How much detail each character of a crowd is worth: hl_crowd_plan.

#include <cstddef>

#include "play/instance.h"

namespace hairloom::runtime {

/// Characters whose structs may be larger than this library knows.
class Characters {
  public:
    class Place {
      public:
        Place(char* at, std::size_t stride) : at_(at), stride_(stride) {}
        hl_viewed& operator*() const { return *reinterpret_cast<hl_viewed*>(at_); }
        Place& operator++() {
            at_ += stride_;
            return *this;
        }
        bool operator!=(const Place& other) const { return at_ != other.at_; }

      private:
        char* at_;
        std::size_t stride_;
    };
    Characters(hl_viewed* first, std::size_t stride, std::size_t count)
        : first_(reinterpret_cast<char*>(first)), stride_(stride), count_(count) {}
    Place begin() const { return {first_, stride_}; }
    Place end() const { return {count_ > 0 ? first_ + count_ * stride_ : first_, stride_}; }

  private:
    char* first_;
    std::size_t stride_, count_;
};

/// Nothing is changed where it refuses.
Outcome planCrowd(const hl_crowd_limits& limits, Characters characters, hl_crowd_report& report);

}  // namespace hairloom::runtime
