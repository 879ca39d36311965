// SPDX-License-Identifier: MIT
// Hair in the light that its points have.
#include "ribbons.hlsli"

float4 main(Ribbon hair) : SV_Target {
    if (isLeftOut(hair)) discard;
    return float4(hair.colour, 1);
}
