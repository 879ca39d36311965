// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/src/arrays.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace hairloom::python {
namespace {

std::string nameOf(nb::dlpack::dtype type) {
    const char* kind = "values";
    if (type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Int)) kind = "int";
    if (type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::UInt)) kind = "uint";
    if (type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float)) kind = "float";
    if (type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Bool)) return "bool";
    if (type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Complex)) kind = "complex";
    return fmt::format("{}{}", kind, type.bits);
}

std::string shapeOf(const nb::ndarray<nb::ro, nb::device::cpu>& array) {
    std::string text;
    for (std::size_t i = 0; i < array.ndim(); ++i) text += fmt::format("{}{}", i ? ", " : "", array.shape(i));
    return fmt::format("({}{})", text, array.ndim() == 1 ? "," : "");
}

}  // namespace

InputArray inputArray(const char* name, nb::handle object, nb::dlpack::dtype type, std::size_t components) {
    const std::string expected =
        components == 1 ? fmt::format("a contiguous {} array of shape (n,)", nameOf(type))
                        : fmt::format("a contiguous {} array of shape (n, {})", nameOf(type), components);
    InputArray in;
    if (!nb::ndarray_check(object) || !nb::try_cast(object, in.array, false))
        raiseArgument(name, fmt::format("is {}", nb::type_name(object.type()).c_str()), expected);
    if (in.array.dtype() != type) raiseArgument(name, "is " + nameOf(in.array.dtype()), expected);
    const std::size_t dimensions = components == 1 ? 1 : 2;
    if (in.array.ndim() != dimensions || (dimensions == 2 && in.array.shape(1) != components))
        raiseArgument(name, "has the shape " + shapeOf(in.array), expected);
    std::int64_t stride = 1;
    // The strides of an array without elements mean nothing, and NumPy's are 0.
    for (std::size_t i = in.array.size() > 0 ? dimensions : 0; i-- > 0;
         stride *= static_cast<std::int64_t>(in.array.shape(i))) {
        if (in.array.shape(i) > 1 && in.array.stride(i) != stride)
            raiseArgument(name, "is not contiguous", expected + ", as numpy.ascontiguousarray() makes it");
    }
    in.data = in.array.data();
    in.size = in.array.shape(0);
    if (type == nb::dtype<float>()) {
        const auto* values = static_cast<const float*>(in.data);
        for (std::size_t i = 0; i < in.size * components; ++i) {
            if (!std::isfinite(values[i]))
                raiseArgument(name, fmt::format("has {} in row {}", values[i], i / components),
                              "finite numbers");
        }
    }
    return in;
}

}  // namespace hairloom::python
