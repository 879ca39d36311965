// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A USD layer as far as hair needs it: prims with attributes and their values in time.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// Numbers, one after another: in single precision where the file has no more, since points weigh.
class UsdNumbers {
  public:
    /// From now on, of numbers that are none yet.
    void keepSingle() { isSingle_ = true; }

    std::size_t size() const { return isSingle_ ? singles_.size() : doubles_.size(); }
    bool empty() const { return size() == 0; }
    double operator[](std::size_t index) const {
        return isSingle_ ? double{singles_[index]} : doubles_[index];
    }
    double front() const { return (*this)[0]; }
    void set(std::size_t index, double number) {
        if (isSingle_)
            singles_[index] = static_cast<float>(number);
        else
            doubles_[index] = number;
    }
    void push_back(double number) {
        if (isSingle_)
            singles_.push_back(static_cast<float>(number));
        else
            doubles_.push_back(number);
    }
    /// Room for so many in all.
    void reserve(std::size_t count) {
        if (isSingle_)
            singles_.reserve(count);
        else
            doubles_.reserve(count);
    }
    std::vector<double> doubles() const {
        return isSingle_ ? std::vector<double>(singles_.begin(), singles_.end()) : doubles_;
    }
    /// Takes them.
    std::vector<float> floats() && {
        return isSingle_ ? std::move(singles_) : std::vector<float>(doubles_.begin(), doubles_.end());
    }

  private:
    bool isSingle_ = false;
    std::vector<float> singles_;
    std::vector<double> doubles_;
};

/// Numbers, or texts.
struct UsdValue {
    UsdNumbers numbers;
    std::uint32_t components = 1;  ///< numbers of one element
    std::vector<std::string> texts;

    bool empty() const { return numbers.empty() && texts.empty(); }
};

struct UsdAttribute {
    std::string type;  ///< "float3[]"
    std::string name;  ///< "primvars:groom_id"
    UsdValue value;    ///< without a time; may be empty
    std::map<double, UsdValue> samples;
    std::string interpolation;  ///< "vertex" …, or empty
    double elementSize = 1;
};

struct UsdPrim {
    std::string type, name;
    std::vector<UsdAttribute> attributes;
    std::vector<UsdPrim> children;
    bool isOver = false;

    const UsdAttribute* find(std::string_view attribute) const;
    UsdAttribute* find(std::string_view attribute);
};

struct UsdStage {
    UsdPrim root;
    std::map<std::string, UsdValue, std::less<>> metadata;  ///< upAxis, metersPerUnit, timeCodesPerSecond …
    std::vector<std::string> notFollowed;                   ///< other files that the layer is composed of
};

/// A layer of text. Errors with the line.
Result<UsdStage> readUsda(const std::string& file, std::string_view text);
/// A binary layer. Errors with the byte.
Result<UsdStage> readUsdc(const std::string& file, std::span<const std::byte> bytes);

}  // namespace hairloom
