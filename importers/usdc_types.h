// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace hairloom::usdc {

/// Types of values by their numbers in the file.
enum Type : std::uint8_t {
    Bool = 1,
    UChar,
    Int,
    UInt,
    Int64,
    UInt64,
    Half,
    Float,
    Double,
    String,
    Token,
    AssetPath,
    Matrix2d,
    Matrix3d,
    Matrix4d,
    Quatd,
    Quatf,
    Quath,
    Vec2d,
    Vec2f,
    Vec2h,
    Vec2i,
    Vec3d,
    Vec3f,
    Vec3h,
    Vec3i,
    Vec4d,
    Vec4f,
    Vec4h,
    Vec4i,
    Dictionary = 31,
    StringListOp = 33,
    PathListOp = 34,
    ReferenceListOp = 35,
    Int64ListOp = 37,
    TokenVector = 41,
    VariantSelectionMap = 45,
    TimeSamples = 46,
    Payload = 47,
    DoubleVector = 48,
    LayerOffsetVector = 49,
    StringVector = 50,
    ValueBlock = 51,
    PayloadListOp = 55,
    TimeCode = 56
};

}  // namespace hairloom::usdc
