// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A USD layer as far as hair needs it: prims with attributes and their values in time.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// Numbers, one after another, or texts.
struct UsdValue {
    std::vector<double> numbers;
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
