// SPDX-License-Identifier: GPL-3.0-or-later
// Follows light through the hair in the cells of a grid, from fibre to fibre and skin to skin: a thread for each photon. Fibres
// turn light around themselves as their first two moments tell (what goes nearly straight on counts as not stopped, as in
// lightInLayer()), and along themselves as Marschner's M. Cells sum up what has been turned at least once; light that has not is
// known exactly from the shadow maps. Sums are of whole numbers, so that they do not depend on the order of threads.
#include "runtime/shaders/layer_light.hlsli"
#include "hash.hlsli"
#include "shaders/render/light_cells_read.hlsli"
#include "shaders/render/lights.hlsli"
#include "shaders/render/opacity.hlsli"

cbuffer Constants : register(b0) { ShadeConstants gShade; };
Texture2D<float> gHeadDepth : register(t8);
RWStructuredBuffer<uint> gSums : register(u0);

static const uint kMostSteps = 2000u;
static const float kEmptyCosine = 0.785;  // mean, where no hair says which way it lies
static const float kMostLight = 64.0;  // of its share
static const float kLeast = 0.1;  // of its light, below which a photon goes on by chance

// Numbers of chance of one photon, one after the other (O'Neill 2014).
float next(inout uint state) {
    state = state * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22u) ^ word) >> 8u) * (1.0 / 16777216.0);
}

float3 onSphere(float u, float v) {
    const float z = 1.0 - 2.0 * u;
    const float r = sqrt(max(1.0 - z * z, 0.0));
    return float3(r * cos(6.2831853 * v), r * sin(6.2831853 * v), z);
}

// By the cosine around a normal.
float3 aroundNormal(float3 n, float u, float v) {
    const float3 d = onSphere(u, v) + n;
    return d * rsqrt(max(dot(d, d), 1e-12));
}

struct Photon {
    float3 at;     // cells
    float3 way;    // unit
    float3 light;  // RGB, of a photon's power
    int lamp;      // -1: the sky
    bool turned;   // once at least
};

// Radical inverse of base 2: with the number itself, places that spread evenly.
float evenly(uint i) {
    i = (i << 16u) | (i >> 16u);
    i = ((i & 0x00ff00ffu) << 8u) | ((i & 0xff00ff00u) >> 8u);
    i = ((i & 0x0f0f0f0fu) << 4u) | ((i & 0xf0f0f0f0u) >> 4u);
    i = ((i & 0x33333333u) << 2u) | ((i & 0xccccccccu) >> 2u);
    i = ((i & 0x55555555u) << 1u) | ((i & 0xaaaaaaaau) >> 1u);
    return float(i >> 8u) * (1.0 / 16777216.0);
}

float3 gridSize() { return float3(gridCells()); }
uint beforeLight(uint i) { return gGrid.before[i >> 2u][i & 3u]; }

// On a side of the grid's box; `share`: its place within the side.
float3 onSide(int axis, bool high, float2 share) {
    const float3 size = gridSize();
    const float3 end = high ? size : 0.0;
    if (axis == 0) return float3(end.x, share.x * size.y, share.y * size.z);
    if (axis == 1) return float3(share.y * size.x, end.y, share.x * size.z);
    return float3(share.x * size.x, share.y * size.y, end.z);
}

// Microsoft's compiler writes to no component by its number.
float3 alongAxis(int axis, float amount) {
    return float3(axis == 0 ? amount : 0.0, axis == 1 ? amount : 0.0, axis == 2 ? amount : 0.0);
}

float sideArea(int axis) {
    const float3 size = gridSize();
    return axis == 0 ? size.y * size.z : axis == 1 ? size.z * size.x : size.x * size.y;
}

// Light of a lamp within the box, evenly to all sides.
Photon fromWithin(int lamp, float3 lampAt, float2 share) {
    const LightConstants light = gShade.lights[lamp];
    Photon p;
    p.lamp = lamp;
    p.turned = false;
    p.at = lampAt;
    p.way = onSphere(share.x, share.y);
    p.light = irradianceOf(light, light.toLight_ws.xyz + p.way) * 12.5663706;  // at a metre, which way it goes
    return p;
}

// Where light of a lamp comes into the box: through one of the sides that face it, as much of it as they catch.
Photon fromBeside(int lamp, float3 lampAt, float2 share, inout uint state) {
    const LightConstants light = gShade.lights[lamp];
    const float3 size = gridSize();
    const float metres = gGrid.origin_ws.w;
    const bool place = light.toLight_ws.w > 0.0;
    float3 caught = 0;
    const float3 middle = place ? lampAt - 0.5 * size : light.toLight_ws.xyz;
    const float3 towards = middle * rsqrt(max(dot(middle, middle), 1e-12));
    [unroll] for (int axis = 0; axis < 3; ++axis) {
        const bool faces = !place || lampAt[axis] > size[axis] || lampAt[axis] < 0.0;
        caught[axis] = faces ? sideArea(axis) * max(abs(towards[axis]), 0.02) : 0.0;
    }
    const float sides = caught.x + caught.y + caught.z;
    const float pick = next(state) * sides;
    const int side = pick < caught.x ? 0 : pick < caught.x + caught.y ? 1 : 2;
    const bool high = place ? lampAt[side] > 0.5 * size[side] : light.toLight_ws[side] > 0.0;
    Photon p;
    p.lamp = lamp;
    p.turned = false;
    p.at = onSide(side, high, share);
    const float3 at_ws = gGrid.origin_ws.xyz + metres * p.at;
    p.way = -directionToLight(light, at_ws);
    const float area = sideArea(side) * metres * metres;
    p.light = irradianceOf(light, at_ws) * (abs(p.way[side]) * area * sides / max(caught[side], 1e-12));
    return p;
}

Photon fromSky(float2 share, inout uint state) {
    const float x = sideArea(0);
    const float y = sideArea(1);
    const float sides = x + y + sideArea(2);
    const float metres = gGrid.origin_ws.w;
    const float pick = next(state) * sides;
    const int side = pick < x ? 0 : pick < x + y ? 1 : 2;
    const bool high = next(state) < 0.5;
    Photon p;
    p.lamp = -1;
    p.turned = false;
    p.at = onSide(side, high, share);
    const float3 normal = alongAxis(side, high ? -1.0 : 1.0);
    const float u = next(state);
    p.way = aroundNormal(normal, u, next(state));
    p.light = environmentFrom(gShade, -p.way) * (2.0 * sides * metres * metres * 3.14159265);
    return p;
}

// The head between the lamp and a place, by its depth map.
bool headHides(int lamp, float3 position_ws) {
    const LightConstants light = gShade.lights[lamp];
    if (!(light.headCasts > 0.0)) return false;
    const float4 clip = mul(light.clipFromWorld, float4(position_ws, 1));
    if (!(clip.w > 0.0)) return false;
    const float2 uv = float2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    if (any(uv < 0.0) || any(uv >= 1.0)) return false;
    const int2 at = int2(uv * light.tileSize);
    const float head = gHeadDepth.Load(int3(at.x + int(light.tileLeft), at.y, 0));
    return metresBehindNear(light.depthRange, light.nearPlane, clip.z / clip.w) >
           metresBehindNear(light.depthRange, light.nearPlane, head) + 0.004;
}

// What a cell holds.
struct Cell {
    uint first;       // of its words
    float3 tangent;   // mean: shorter where hairs lie different ways
    float hair;       // fibres across a cell's side
    float3 straight;  // share of light that they send nearly straight on
    float least;      // of its channels
    float3 normal;
    float skin;       // area, in sides of a cell squared
    float distance;   // of the skin from the middle, along the normal
    bool folded;
};

Cell cellAt(int3 at) {
    Cell cell;
    cell.first = HAIRLOOM_GRID_CELL_WORDS * cellNumber(at);
    const float side = gGrid.origin_ws.w;
    const float hair = float(gCells[cell.first]);
    cell.hair = hair / (gGrid.hairUnit * side * side) * gGrid.clumping;
    cell.tangent = hair > 0.0 ? threeAt(cell.first + HAIRLOOM_GRID_TANGENT) / hair : 0.0;
    cell.straight = clamp(threeAt(cell.first + HAIRLOOM_GRID_SECOND) / max(hair, 1.0), 0.0, 0.99);
    cell.least = min(cell.straight.x, min(cell.straight.y, cell.straight.z));
    const float skin = float(gCells[cell.first + HAIRLOOM_GRID_SKIN]);
    cell.skin = skin / (gGrid.skinUnit * side * side);
    cell.normal = 0;
    cell.distance = 0;
    cell.folded = false;
    if (skin > 0.0) {
        const float3 sum = threeAt(cell.first + HAIRLOOM_GRID_SKIN + 1u);
        if (isFolded(sum, skin)) {
            cell.folded = cell.skin > 0.5;
            cell.skin = 0;
        } else {
            cell.normal = sum / length(sum);
            cell.distance = wordAt(cell.first + HAIRLOOM_GRID_SKIN + 4u) / skin;
        }
    }
    return cell;
}

// Mean square of the cosine of the angle between a way and the hairs of a cell.
float alongHair(Cell cell, float3 way) {
    const float along = dot(cell.tangent, way);
    return min(along * along + (1.0 - min(dot(cell.tangent, cell.tangent), 1.0)) / 3.0, 0.98);
}

void add(uint word, float amount, inout uint state) {
    InterlockedAdd(gSums[word], uint(int(floor(amount * gGrid.lightUnit + next(state)))));
}

// Light that goes so far through a cell.
void passThrough(Cell cell, uint index, Photon p, float far, inout uint state) {
    const uint sum = index * HAIRLOOM_GRID_LIGHT_WORDS;
    const bool hair = cell.hair > 0.0;
    const float along = hair ? alongHair(cell, p.way) : 0.0;
    const float cosine = hair ? sqrt(1.0 - along) : kEmptyCosine;
    const float3 got = p.light * (far * cosine);
    add(sum, got.x, state);
    add(sum + 1u, got.y, state);
    add(sum + 2u, got.z, state);
    if (!hair) return;
    const float mean = dot(p.light, 1.0 / 3.0) * far;
    const float3 axis = cell.tangent * rsqrt(max(dot(cell.tangent, cell.tangent), 1e-6));
    const float3 way = mean * (p.way - axis * (dot(axis, p.way) * (1.0 - cosine)));
    add(sum + 3u, way.x, state);
    add(sum + 4u, way.y, state);
    add(sum + 5u, way.z, state);
    add(sum + 6u, mean * cosine * along, state);
}

// A fibre is met: the photon goes straight on or is turned, and keeps what is not absorbed.
void meetFibre(inout Photon p, Cell cell, inout uint state) {
    const float hair = max(float(gCells[cell.first]), 1.0);
    const float3 albedo = threeAt(cell.first + HAIRLOOM_GRID_ALBEDO) / hair;
    const float stopped = 1.0 - cell.least;
    const float3 straight = (cell.straight - cell.least) / stopped;
    const float3 turned = max(albedo - cell.straight, 0.0) / stopped;
    const float all = max(p.light.x + p.light.y + p.light.z, 1e-20);
    const float goesOn = dot(p.light, straight) / all;
    const float turns = dot(p.light, turned) / all;
    if (next(state) * (goesOn + turns) < goesOn) {
        p.light *= straight * ((goesOn + turns) / goesOn);
        return;
    }
    p.light *= turned * ((goesOn + turns) / max(turns, 1e-20));
    p.turned = true;
    const float tilt = wordAt(cell.first + HAIRLOOM_GRID_TILT) / hair;
    const float variance = wordAt(cell.first + HAIRLOOM_GRID_VARIANCE) / hair;
    const float u0 = next(state);
    const float u1 = next(state);
    const float spread = sqrt(max(1.0 - dot(cell.tangent, cell.tangent), 0.0));
    float3 fibre = cell.tangent + spread * onSphere(u0, u1);
    fibre *= rsqrt(max(dot(fibre, fibre), 1e-9));
    // By Box and Muller.
    const float radius = sqrt(-2.0 * log(1.0 - next(state)));
    const float gauss = radius * cos(6.2831853 * next(state));
    const float along = clamp(dot(p.way, fibre), -1.0, 1.0);
    float theta = asin(along) + 2.0 * (tilt + gauss * sqrt(max(variance, 0.0)));
    // By the first moment of what is not straight on.
    const float3 first = threeAt(cell.first + HAIRLOOM_GRID_FIRST) / hair;
    const float3 asymmetric = clamp((first - cell.straight) / max(albedo - cell.straight, 1e-4), -0.5, 0.5);
    const float mean = dot(p.light, asymmetric) / max(p.light.x + p.light.y + p.light.z, 1e-20);
    float psi = 0;
    float cosPsi = 1;
    for (uint i = 0u; i < 16u; ++i) {
        psi = 6.2831853 * next(state);
        cosPsi = cos(psi);
        if (next(state) * (1.0 + 2.0 * abs(mean)) < 1.0 + 2.0 * mean * cosPsi) break;
    }
    p.light *= max(1.0 + 2.0 * asymmetric * cosPsi, 0.0) / max(1.0 + 2.0 * mean * cosPsi, 1e-3);
    // Over the pole it comes down on the other side.
    const float kHalf = 1.57079633;
    if (abs(theta) > kHalf) {
        theta = (theta < 0.0 ? -1.0 : 1.0) * (2.0 * kHalf - abs(theta));
        psi += 2.0 * kHalf;
    }
    theta = clamp(theta, -kHalf, kHalf);
    float3 onward = p.way - along * fibre;
    if (dot(onward, onward) < 1e-8) onward = abs(fibre.y) < 0.9 ? float3(0, 1, 0) - fibre.y * fibre : float3(1, 0, 0) - fibre.x * fibre;
    onward *= rsqrt(dot(onward, onward));
    const float3 aside = cross(fibre, onward);
    p.way = sin(theta) * fibre + cos(theta) * (cos(psi) * onward + sin(psi) * aside);
    p.way *= rsqrt(max(dot(p.way, p.way), 1e-12));
}

void meetSkin(inout Photon p, Cell cell, uint index, inout uint state) {
    if (p.turned) {
        const uint sum = index * HAIRLOOM_GRID_LIGHT_WORDS;
        add(sum + 7u, p.light.x, state);
        add(sum + 8u, p.light.y, state);
        add(sum + 9u, p.light.z, state);
    }
    p.light *= gGrid.skin.rgb;
    p.turned = true;
    const float u = next(state);
    p.way = aroundNormal(cell.normal, u, next(state));
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint index = id.x + id.y * gGrid.rowThreads;
    if (id.x >= gGrid.rowThreads || index >= gGrid.photons) return;
    uint state = hashUint(index + 1u);
    int lamp = -1;
    uint first = 0u;
    uint end = 0u;
    for (uint i = 0u; i < gShade.lightCount; ++i) {
        if (index >= beforeLight(i) && index < beforeLight(i + 1u)) {
            lamp = int(i);
            first = beforeLight(i);
            end = beforeLight(i + 1u);
        }
    }
    if (lamp < 0) {
        first = beforeLight(gShade.lightCount);
        end = gGrid.photons;
    }
    const float2 share = float2((float(index - first) + 0.5) / float(end - first), evenly(index - first));
    Photon p;
    if (lamp < 0) {
        p = fromSky(share, state);
    } else {
        const float4 place = gShade.lights[lamp].toLight_ws;
        const float3 lampAt = (place.xyz - gGrid.origin_ws.xyz) / gGrid.origin_ws.w;
        if (place.w > 0.0 && all(lampAt > 0.0) && all(lampAt < gridSize())) p = fromWithin(lamp, lampAt, share);
        else p = fromBeside(lamp, lampAt, share, state);
    }
    // A lamp close to a side would send photons that outshine all others.
    p.light = min(p.light / (gGrid.power * float(end - first)), kMostLight);
    int3 cell = clamp(int3(floor(p.at)), int3(0, 0, 0), gridCells() - 1);
    float left = -log(1.0 - next(state));
    bool fresh = true;  // nothing was met
    for (uint steps = 0u; steps < kMostSteps; ++steps) {
        const Cell here = cellAt(cell);
        if (here.folded) return;  // nothing is known of where it would go
        const uint number = cellNumber(cell);
        // Where the way leaves the cell.
        float3 ends = 1e9;
        [unroll] for (int a = 0; a < 3; ++a) {
            const float side = float(cell[a]) + (p.way[a] > 0.0 ? 1.0 : 0.0);
            if (abs(p.way[a]) > 1e-7) ends[a] = max((side - p.at[a]) / p.way[a], 0.0);
        }
        const int axis = ends.x <= ends.y && ends.x <= ends.z ? 0 : ends.y <= ends.z ? 1 : 2;
        float far = ends[axis];
        bool onSkin = false;
        if (here.skin > 0.0) {
            const float above = dot(here.normal, p.at - float3(cell) - 0.5) - here.distance;
            const float rises = dot(here.normal, p.way);
            // From within the head: where light starts there, or where it came in by a corner that no plane closes.
            if (rises > 0.0 && above < (fresh ? 0.0 : -0.4)) return;
            if (rises < 0.0 && -above >= rises * far) {
                onSkin = true;
                far = max(-above / rises, 0.0);
            }
        }
        const float stops = here.hair > 0.0 ? here.hair * sqrt(1.0 - alongHair(here, p.way)) * (1.0 - here.least) : 0.0;
        const bool met = stops * far >= left;
        if (met) far = left / stops;
        if (p.turned) passThrough(here, number, p, far, state);
        p.at += far * p.way;
        if (met || onSkin) {
            if (fresh && lamp >= 0 && headHides(lamp, gGrid.origin_ws.xyz + gGrid.origin_ws.w * p.at)) return;
            fresh = false;
        }
        if (met) {
            meetFibre(p, here, state);
            left = -log(1.0 - next(state));
        } else {
            left -= stops * far;
            if (onSkin) {
                meetSkin(p, here, number, state);
            } else {
                cell = cell + int3(alongAxis(axis, p.way[axis] > 0.0 ? 1.0 : -1.0));
                if (!inGrid(cell)) return;
                continue;
            }
        }
        const float most = max(p.light.x, max(p.light.y, p.light.z));
        if (most < kLeast) {
            const float kept = 0.25;
            if (next(state) >= kept) return;
            p.light /= kept;
        }
    }
}
