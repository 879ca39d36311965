// SPDX-License-Identifier: MIT
// Visits the segments of all hairs, a thread each, in pieces shorter than a column of the lamp's grid is wide: who includes it
// says what is done with a piece, by `void visitPiece(Columns columns, float depth, float covered)`. `covered`: columns that the
// piece covers across the light.
#ifndef HAIRLOOM_LAMP_HAIRS_HLSLI
#define HAIRLOOM_LAMP_HAIRS_HLSLI

void visitPieces(uint at) {
    if (at >= gView.hairs * gView.points) return;
    const uint p = at % gView.points, last = gView.points - 1u;
    if (p == last) return;
    const float3 from = gHairs[at].xyz;
    const float3 way = gHairs[at + 1u].xyz - from;
    const RibbonLook look = gLooks[at / gView.points];
    const float wider = gView.specular.w > 0.0 ? gView.specular.w : 1.0;
    const float radius = wider * lerp(look.radii.x, look.radii.y, (float(p) + 0.5) / float(last));
    const float along = dot(way, gLamp.toLight.xyz);
    const float across = sqrt(max(dot(way, way) - along * along, 0.0));
    const float pieces = clamp(ceil(2.0 * sqrt(dot(way, way) / gLamp.ground.w)), 1.0, 64.0);
    for (float i = 0.5; i < pieces; i += 1.0) {
        const float3 place = gridPlace(gLamp, from + way * (i / pieces));
        if (!(all(place >= 0.0) && all(place < 1.0))) continue;  // or no number
        visitPiece(columnsAround(place.xy), place.z, 2.0 * radius * across / (gLamp.ground.w * pieces));
    }
}
#endif
