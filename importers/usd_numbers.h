// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace hairloom {

/// Numbers, one after another, as wide as the file has them: points weigh, and ids of 64 bits are no doubles.
class UsdNumbers {
  public:
    enum class Kind : std::uint8_t { Double, Single, Whole };

    /// From now on, of numbers that are none yet.
    void keep(Kind kind) { kind_ = kind; }
    Kind kind() const { return kind_; }

    std::size_t size() const {
        return kind_ == Kind::Single  ? singles_.size()
               : kind_ == Kind::Whole ? wholes_.size()
                                      : doubles_.size();
    }
    bool empty() const { return size() == 0; }
    double operator[](std::size_t index) const {
        return kind_ == Kind::Single  ? double{singles_[index]}
               : kind_ == Kind::Whole ? static_cast<double>(wholes_[index])
                                      : doubles_[index];
    }
    double front() const { return (*this)[0]; }
    /// Fractions are cut; what no whole number is becomes 0.
    std::int64_t whole(std::size_t index) const {
        if (kind_ == Kind::Whole) return wholes_[index];
        const double number = (*this)[index];
        return number > -9.2e18 && number < 9.2e18 ? static_cast<std::int64_t>(number) : 0;
    }
    void set(std::size_t index, double number) {
        if (kind_ == Kind::Single)
            singles_[index] = static_cast<float>(number);
        else if (kind_ == Kind::Whole)
            wholes_[index] = static_cast<std::int64_t>(number);
        else
            doubles_[index] = number;
    }
    void push_back(double number) {
        if (kind_ == Kind::Single)
            singles_.push_back(static_cast<float>(number));
        else if (kind_ == Kind::Whole)
            wholes_.push_back(number > -9.2e18 && number < 9.2e18 ? static_cast<std::int64_t>(number) : 0);
        else
            doubles_.push_back(number);
    }
    void pushWhole(std::int64_t number) {
        if (kind_ == Kind::Whole)
            wholes_.push_back(number);
        else
            push_back(static_cast<double>(number));
    }
    /// Room for so many in all.
    void reserve(std::size_t count) {
        if (kind_ == Kind::Single)
            singles_.reserve(count);
        else if (kind_ == Kind::Whole)
            wholes_.reserve(count);
        else
            doubles_.reserve(count);
    }
    std::vector<double> doubles() const {
        if (kind_ == Kind::Double) return doubles_;
        std::vector<double> numbers(size());
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = (*this)[i];
        return numbers;
    }
    /// Takes them.
    std::vector<float> floats() && {
        if (kind_ == Kind::Single) return std::move(singles_);
        std::vector<float> numbers(size());
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>((*this)[i]);
        return numbers;
    }

  private:
    Kind kind_ = Kind::Double;
    std::vector<float> singles_;
    std::vector<double> doubles_;
    std::vector<std::int64_t> wholes_;
};

}  // namespace hairloom
