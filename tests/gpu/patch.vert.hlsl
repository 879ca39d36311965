// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gpu/patch.hlsli"

Corner main(float3 position : POSITION) {
    Corner corner;
    corner.position = position;
    return corner;
}
