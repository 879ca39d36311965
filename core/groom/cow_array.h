// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Arrays that copies of a groom share until one of them writes.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hairloom {

/// A number that no other content has had in this run of the program. Equal versions mean equal content, so
/// caches and the GPU re-upload only when it changed.
using Version = std::uint64_t;

inline Version nextVersion() {
    static std::atomic<Version> last{0};
    return ++last;
}

/// Copying is cheap and shares; `edit()` separates and renews the version. Distinct CowArrays may be read and
/// edited on different threads at once, also while they share.
template <class T>
class CowArray {
  public:
    CowArray() = default;
    explicit CowArray(std::vector<T> values)
        : values_(std::make_shared<std::vector<T>>(std::move(values))), version_(nextVersion()) {}

    std::size_t size() const { return values_ ? values_->size() : 0; }
    bool empty() const { return size() == 0; }
    std::span<const T> view() const { return values_ ? std::span<const T>(*values_) : std::span<const T>(); }
    const T& operator[](std::size_t index) const { return (*values_)[index]; }

    /// 0 while empty and never written.
    Version version() const { return version_; }
    bool sharesWith(const CowArray& other) const { return values_ && values_ == other.values_; }

    /// The values for writing; valid until this array is copied, moved or destroyed.
    std::vector<T>& edit() {
        if (!values_) {
            values_ = std::make_shared<std::vector<T>>();
        } else if (values_.use_count() > 1) {
            values_ = std::make_shared<std::vector<T>>(*values_);
        }
        version_ = nextVersion();
        return *values_;
    }

  private:
    std::shared_ptr<std::vector<T>> values_;
    Version version_ = 0;
};

}  // namespace hairloom
