// SPDX-License-Identifier: MIT
// Marschner's fibre and dual scattering by the tables of hair_types.h. Who includes it has `gTables` as a buffer of floats.
#ifndef HAIRLOOM_HAIR_FIBRE_HLSLI
#define HAIRLOOM_HAIR_FIBRE_HLSLI
#include "dual_scattering.hlsli"
#include "fibre_layers.hlsli"
#include "hair_types.h"

// A place between two entries of a table.
struct TablePlace {
    uint low;
    float part;
};

TablePlace tablePlace(float share, uint count) {
    const float at = saturate(share) * float(count - 1u);
    TablePlace place;
    place.low = min(uint(at), count - 2u);
    place.part = at - float(place.low);
    return place;
}

float tableAt(uint first, TablePlace x) { return lerp(gTables[first + x.low], gTables[first + x.low + 1u], x.part); }
float tableAt2(uint first, TablePlace x, TablePlace y, uint width) {
    return lerp(tableAt(first + y.low * width, x), tableAt(first + (y.low + 1u) * width, x), y.part);
}

// M of R, TT and TRT with cos theta_i / cos^2 theta_d.
float3 longitudinalOf(HairMaterial hair, uint table, FibreFrame f, FibreCosines c) {
    const float thetaIn = asin(clamp(f.sinIn, -1.0, 1.0)), thetaOut = asin(clamp(f.sinOut, -1.0, 1.0));
    const TablePlace ofIn = tablePlace(thetaIn / 3.14159265 + 0.5, HAIR_ALONG);
    const TablePlace ofOut = tablePlace(thetaOut / 3.14159265 + 0.5, HAIR_ALONG);
    const float3 x = (0.5 * (thetaIn + thetaOut) - hair.tilts.xyz) / hair.widths.xyz;
    const float3 gauss = exp(-0.5 * x * x) / (hair.widths.xyz * 2.5066283);
    const float3 factors = float3(tableAt(table, ofIn) * tableAt(table + 3u * HAIR_ALONG, ofOut),
                                  tableAt(table + HAIR_ALONG, ofIn) * tableAt(table + 4u * HAIR_ALONG, ofOut),
                                  tableAt(table + 2u * HAIR_ALONG, ofIn) * tableAt(table + 5u * HAIR_ALONG, ofOut));
    return hair.scales.xyz * factors * gauss * (c.cosIn / c.dSquared);
}

// N of TT and TRT of a layer.
float2 aroundOf(uint table, uint layer, TablePlace phi, TablePlace thetaD) {
    const uint row = table + HAIR_TABLE_AROUND + (layer * HAIR_INCLINATIONS + thetaD.low) * (HAIR_AROUND * 2u) + 2u * phi.low;
    const uint next = row + HAIR_AROUND * 2u;
    const float4 below = float4(gTables[row], gTables[row + 1u], gTables[row + 2u], gTables[row + 3u]);
    const float4 above = float4(gTables[next], gTables[next + 1u], gTables[next + 2u], gTables[next + 3u]);
    const float4 n = lerp(below, above, thetaD.part);
    return lerp(n.xy, n.zw, phi.part);
}

// N of TT, TRT and R of each channel.
struct FibreAround {
    float3 tt, trt;
    float r;
};

FibreAround fibreAround(uint table, float cosPhi, float thetaD, float3 absorption) {
    const TablePlace phi = tablePlace(acos(clamp(cosPhi, -1.0, 1.0)) / 3.14159265, HAIR_AROUND);
    const TablePlace inclination = tablePlace(thetaD, HAIR_INCLINATIONS);
    FibreAround n;
    n.r = tableAt2(table + HAIR_TABLE_REFLECTED, phi, inclination, HAIR_AROUND);
    [unroll] for (uint c = 0u; c < 3u; ++c) {
        const LayerPlace place = layerPlace(absorption[c]);
        const uint low = uint(place.low);
        const float2 below = aroundOf(table, low, phi, inclination), above = aroundOf(table, low + 1u, phi, inclination);
        const float2 one = betweenLayers(float4(below, 1.0, 1.0), float4(above, 1.0, 1.0), place.part).xy;
        n.tt[c] = one.x;
        n.trt[c] = one.y;
    }
    return n;
}

float4 averagesRow(uint table, uint layer, uint row, TablePlace thetaD) {
    const uint at = table + HAIR_TABLE_AVERAGES + ((2u * layer + row) * HAIR_INCLINATIONS + thetaD.low) * 4u;
    return lerp(float4(gTables[at], gTables[at + 1u], gTables[at + 2u], gTables[at + 3u]),
                float4(gTables[at + 4u], gTables[at + 5u], gTables[at + 6u], gTables[at + 7u]), thetaD.part);
}

LayerAverages averagesOfLayer(uint table, float thetaD, float absorption) {
    const TablePlace inclination = tablePlace(thetaD, HAIR_INCLINATIONS);
    const LayerPlace place = layerPlace(absorption);
    const uint low = uint(place.low);
    return averagesBetween(averagesRow(table, low, 0u, inclination), averagesRow(table, low + 1u, 0u, inclination),
                           averagesRow(table, low, 1u, inclination), averagesRow(table, low + 1u, 1u, inclination), place.part);
}

float spreadOf(uint table, FibreFrame f, float tilt, float variance) {
    const float width = spreadWidth(variance, HAIR_MIN_SPREAD, HAIR_MAX_SPREAD);
    const TablePlace v = tablePlace((width - HAIR_MIN_SPREAD) / (HAIR_MAX_SPREAD - HAIR_MIN_SPREAD), HAIR_WIDTHS);
    const float factors =
        tableAt2(table + HAIR_TABLE_SPREAD, tablePlace(abs(f.sinIn), HAIR_SPREAD), v, HAIR_SPREAD) *
        tableAt2(table + HAIR_TABLE_SPREAD, tablePlace(abs(f.sinOut), HAIR_SPREAD), v, HAIR_SPREAD);
    return spreadLobe(f, factors, tilt, width);
}

// What leaves the fibre towards the view by the irradiance across the lamp's light: of light that has met no other fibre, and of
// light that others have scattered. `before` fibres up to the lamp, `all` from side to side; `ground`: albedo behind them.
float3 fibreLight(HairMaterial hair, FibreFrame f, float before, float all, float3 tint, float3 absorption, float3 ground) {
    const uint table = hair.table * HAIR_TABLE_FLOATS;
    const FibreCosines c = fibreCosines(f);
    const float3 m = longitudinalOf(hair, table, f, c);
    const FibreAround n = fibreAround(table, f.cosPhi, c.thetaD, absorption);
    float3 one;
    one.x = marschner(m, float3(n.tt.x, n.trt.x, n.r), tint.x);
    one.y = marschner(m, float3(n.tt.y, n.trt.y, n.r), tint.y);
    one.z = marschner(m, float3(n.tt.z, n.trt.z, n.r), tint.z);
    const FibreAverages averages =
        averagesOf(averagesOfLayer(table, c.thetaD, absorption.x), averagesOfLayer(table, c.thetaD, absorption.y),
                   averagesOfLayer(table, c.thetaD, absorption.z));
    const MultipleLight others = multipleLight(averages, f.cosPhi, before, all, tint, ground);
    const float3 profile = others.onward.share * (hair.scales.x * n.r + hair.scales.y * n.tt + hair.scales.z * n.trt);
    const float3 multiple = spreadOf(table, f, others.onward.tilt, others.onward.variance) * others.onward.light * profile +
                            spreadOf(table, f, others.diffuseTilt, others.diffuseVariance) * others.diffuse;
    return exp(-before) * one + multiple * (c.cosIn / c.dSquared);
}
#endif
