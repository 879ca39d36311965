// SPDX-License-Identifier: MIT
#pragma once
// A body in few bytes, as runtime assets have it (docs/formats/body.md, "Packed").

#include <cstdint>
#include <vector>

#include "hairloom/body_field.h"

namespace hairloom::runtime {

/// The same field in about a third of the bytes, which bodyFieldFromBytes() reads to the bit.
std::vector<std::uint8_t> packBody(const BodyField& field);

}  // namespace hairloom::runtime
