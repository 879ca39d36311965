// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Arrays of NumPy and of whatever else speaks DLPack or the buffer protocol. In: checked and looked at, never
// converted. Out: NumPy arrays that own what they show.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "python/src/errors.h"

namespace hairloom::python {

/// A value of an array: its scalar and how many there are of it. 1 stands for an array of one dimension.
template <class T>
struct Element {
    using Scalar = T;
    static constexpr std::size_t kCount = 1;
};
template <int N>
struct Element<Eigen::Matrix<float, N, 1>> {
    using Scalar = float;
    static constexpr std::size_t kCount = N;
};

template <std::size_t N>
struct Element<std::array<std::uint32_t, N>> {
    using Scalar = std::uint32_t;
    static constexpr std::size_t kCount = N;
};

/// The array as it lies in memory, and what keeps it there.
struct InputArray {
    nb::ndarray<nb::ro, nb::device::cpu> array;
    const void* data = nullptr;
    std::size_t size = 0;  ///< elements
};

/// Throws hairloom.ArgumentError for what is no array on the CPU, of another type or shape, not contiguous in
/// C's order, or not finite. The message says `name`, what was found and what was expected.
InputArray inputArray(const char* name, nb::handle object, nb::dlpack::dtype type, std::size_t components);

/// The same with a span of its elements.
template <class T>
struct Input {
    Input(const char* name, nb::handle object)
        : held(inputArray(name, object, nb::dtype<typename Element<T>::Scalar>(), Element<T>::kCount)) {}

    std::span<const T> values() const { return {static_cast<const T*>(held.data), held.size}; }
    std::vector<T> copy() const { return {values().begin(), values().end()}; }

    InputArray held;
};

/// A read-only array of `values`, without a copy, that keeps `owner` alive.
template <class T>
nb::object viewOf(std::span<const T> values, std::shared_ptr<const void> owner) {
    using Scalar = typename Element<T>::Scalar;
    constexpr std::size_t kCount = Element<T>::kCount;
    auto* kept = new std::shared_ptr<const void>(std::move(owner));
    const nb::capsule capsule(
        kept, [](void* held) noexcept { delete static_cast<std::shared_ptr<const void>*>(held); });
    const std::size_t shape[2] = {values.size(), kCount};
    static const Scalar kNothing{};
    const void* const data = values.empty() ? static_cast<const void*>(&kNothing) : values.data();
    return nb::ndarray<nb::numpy, const Scalar>(data, kCount == 1 ? 1 : 2, shape, capsule).cast();
}

/// An array that owns `values` and may be written.
template <class T>
nb::object arrayOf(std::vector<T> values, std::initializer_list<std::size_t> shape = {}) {
    using Scalar = typename Element<T>::Scalar;
    constexpr std::size_t kCount = Element<T>::kCount;
    auto* kept = new std::vector<T>(std::move(values));
    const nb::capsule capsule(kept, [](void* held) noexcept { delete static_cast<std::vector<T>*>(held); });
    std::vector<std::size_t> sizes(shape);
    if (sizes.empty()) sizes = {kept->size()};
    if (shape.size() == 0 && kCount > 1) sizes.push_back(kCount);
    return nb::ndarray<nb::numpy, Scalar>(kept->data(), sizes.size(), sizes.data(), capsule).cast();
}

}  // namespace hairloom::python
