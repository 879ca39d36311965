// SPDX-License-Identifier: GPL-3.0-or-later
// One frame joins those before it, each pixel where its surface was a frame ago. What was seen there counts where it is of the
// same hair, or about as far from the eye as this surface was then; else the pixel begins anew.
#include "shaders/shared/render_types.h"

cbuffer Constants : register(b0) { TemporalConstants gTemporal; };
StructuredBuffer<float4> gFrame : register(t0);
StructuredBuffer<SurfacePixel> gSurface : register(t1);
StructuredBuffer<float4> gPast : register(t2);
StructuredBuffer<TemporalPixel> gPastPixels : register(t3);
RWStructuredBuffer<float4> gShown : register(u0);
RWStructuredBuffer<TemporalPixel> gPixels : register(u1);

static const float kDepthReach = 0.02;  // of the depth: as far as strands of one wisp lie behind each other
static const float kDeviations = 0.3;
static const float kLeastWeight = 0.05;

bool isInside(int2 at) {
    return all(at >= int2(0, 0)) && at.x < int(gTemporal.width) && at.y < int(gTemporal.height);
}

uint pixelAt(int2 at) { return uint(at.y) * gTemporal.width + uint(at.x); }

bool isOf(TemporalPixel past, SurfacePixel now) {
    const bool sameHair = now.strand != HAIRLOOM_NO_STRAND && past.strand == now.strand;
    const bool nothing = past.albedo == 0.0 && now.albedo.w == 0.0;
    const bool near = abs(past.depth - now.pastDepth) < kDepthReach * now.pastDepth;
    return sameHair || nothing || (past.albedo > 0.0 && now.albedo.w > 0.0 && near);
}

// Catmull and Rom: what is between pixels is not blurred a little more with each frame.
float4 cubic(float t) {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return float4(-0.5 * t + t2 - 0.5 * t3, 1.0 - 2.5 * t2 + 1.5 * t3, 0.5 * t + 2.0 * t2 - 1.5 * t3,
                  -0.5 * t2 + 0.5 * t3);
}

// Of a pixel and those around it: an edge moves as what is in front, of which the pixel may show some that its middle does not.
SurfacePixel nearestAround(int2 pixel) {
    uint nearest = pixelAt(pixel);
    float depth = gSurface[nearest].depth;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            const int2 at = pixel + int2(x, y);
            if (!isInside(at)) continue;
            const float other = gSurface[pixelAt(at)].depth;
            if (other < depth) {
                depth = other;
                nearest = pixelAt(at);
            }
        }
    }
    return gSurface[nearest];
}

struct Around {
    float4 mean, deviation;
};

Around lightAround(int2 pixel) {
    float4 sum = 0;
    float4 squares = 0;
    float count = 0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            const int2 at = pixel + int2(x, y);
            if (!isInside(at)) continue;
            const float4 light = gFrame[pixelAt(at)];
            sum += light;
            squares += light * light;
            count += 1.0;
        }
    }
    Around around;
    around.mean = sum / count;
    around.deviation = sqrt(max(squares / count - around.mean * around.mean, 0.0));
    return around;
}

struct History {
    float4 light;
    float frames;
};

History historyAt(float2 place, SurfacePixel now) {
    History history;
    history.light = 0;
    history.frames = 0;
    const int2 base = int2(floor(place));
    const float2 f = place - float2(base);
    const float4 wx = cubic(f.x);
    const float4 wy = cubic(f.y);
    const float2 lx = float2(1.0 - f.x, f.x);
    const float2 ly = float2(1.0 - f.y, f.y);
    float4 sharp = 0;
    float4 soft = 0;
    float weight = 0;
    float sharpWeight = 0;
    float frames = 0;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            const int2 at = base + int2(x - 1, y - 1);
            if (!isInside(at)) continue;
            const uint pixel = pixelAt(at);
            const TemporalPixel past = gPastPixels[pixel];
            if (!isOf(past, now)) continue;
            const float4 light = gPast[pixel];
            const float w = wx[x] * wy[y];
            sharp += w * light;
            sharpWeight += w;
            if (x == 0 || x == 3 || y == 0 || y == 3) continue;
            const float near = lx[x - 1] * ly[y - 1];
            soft += near * light;
            frames += near * past.frames;
            weight += near;
        }
    }
    if (weight < kLeastWeight) return history;
    history.frames = frames;  // fewer where part of it is missing
    const bool whole = abs(sharpWeight - 1.0) < 1e-3;
    history.light = whole ? max(sharp, 0.0) : soft / weight;
    return history;
}

[numthreads(HAIRLOOM_TILE_GROUP, HAIRLOOM_TILE_GROUP, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    if (id.x >= gTemporal.width || id.y >= gTemporal.height) return;
    const uint pixel = id.x + id.y * gTemporal.width;
    const SurfacePixel now = nearestAround(int2(id.xy));
    History history;
    history.light = 0;
    history.frames = 0;
    if (gTemporal.hasPast != 0u) {
        history = historyAt(float2(id.xy) - float2(now.velocityX, now.velocityY), now);
    }
    const float frames = min(history.frames, gTemporal.most - 1.0);
    // A highlight that has gone elsewhere does not trail: what was shown has to be like what is around now.
    if (frames > 0.0 && gTemporal.moves != 0u) {
        const Around around = lightAround(int2(id.xy));
        const float4 reach = kDeviations * around.deviation;
        const float4 light = gFrame[pixel];
        history.light = clamp(history.light, min(around.mean - reach, light), max(around.mean + reach, light));
    }
    gShown[pixel] = (history.light * frames + gFrame[pixel]) / (frames + 1.0);
    TemporalPixel result;
    result.depth = now.depth;
    result.strand = now.strand;
    result.frames = frames + 1.0;
    result.albedo = now.albedo.w;
    gPixels[pixel] = result;
}
