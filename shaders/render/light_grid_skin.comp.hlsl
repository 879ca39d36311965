// SPDX-License-Identifier: GPL-3.0-or-later
// Adds skin to the cells of the grid that light is followed in: a thread for each triangle.
#include "shaders/render/light_cells.hlsli"

StructuredBuffer<float> gPositions : register(t0);  // three a vertex
StructuredBuffer<float> gNormals : register(t1);
StructuredBuffer<uint> gIndices : register(t2);
RWStructuredBuffer<uint> gCells : register(u0);

static const uint kMostRows = 96u;
static const float kPlaces = 5.0;  // along a side of a cell: corners that are missed let light into the head

float3 vertexAt(StructuredBuffer<float> values, uint vertex) {
    return float3(values[3u * vertex], values[3u * vertex + 1u], values[3u * vertex + 2u]);
}
float3 inCells(float3 position_ws) { return (position_ws - gGrid.origin_ws.xyz) / gGrid.origin_ws.w; }
void addAt(uint word, float amount) { InterlockedAdd(gCells[word], uint(int(round(amount)))); }

void addSkin(float3 at, float3 normal, float area) {
    const float3 cell = floor(at);
    if (!inGrid(int3(cell))) return;
    const uint first = HAIRLOOM_GRID_SKIN + HAIRLOOM_GRID_CELL_WORDS * cellNumber(int3(cell));
    addAt(first, area);
    addAt(first + 1u, area * normal.x);
    addAt(first + 2u, area * normal.y);
    addAt(first + 3u, area * normal.z);
    addAt(first + 4u, area * dot(normal, at - cell - 0.5));
}

// Of a triangle that reaches far: where it meets the columns of cells along the axis that it faces most, four places each.
void addByColumns(float3 a, float3 b, float3 c, float3 plane, float3 normal, float unit) {
    const float3 turned = abs(plane);
    const bool x = turned.x >= turned.y && turned.x >= turned.z;
    const bool y = !x && turned.y >= turned.z;
    // The axis comes last.
    const float3 p = x ? a.yzx : y ? a.zxy : a;
    const float3 q = x ? b.yzx : y ? b.zxy : b;
    const float3 r = x ? c.yzx : y ? c.zxy : c;
    const float3 n = x ? plane.yzx : y ? plane.zxy : plane;
    const float3 cells = float3(gridCells());
    const float3 size = x ? cells.yzx : y ? cells.zxy : cells;
    const float2 low = clamp(min(p.xy, min(q.xy, r.xy)), 0.0, size.xy);
    const float2 high = clamp(max(p.xy, max(q.xy, r.xy)), 0.0, size.xy);
    const float facing = n.z < 0.0 ? -1.0 : 1.0;
    for (float v = floor(low.y) + 0.25; v < high.y; v += 0.5) {
        for (float u = floor(low.x) + 0.25; u < high.x; u += 0.5) {
            const float2 at = float2(u, v);
            const float2 toP = at - p.xy;
            const float2 toQ = at - q.xy;
            const float2 toR = at - r.xy;
            const float2 pq = q.xy - p.xy;
            const float2 qr = r.xy - q.xy;
            const float2 rp = p.xy - r.xy;
            if (facing * (pq.x * toP.y - pq.y * toP.x) < 0.0 || facing * (qr.x * toQ.y - qr.y * toQ.x) < 0.0 ||
                facing * (rp.x * toR.y - rp.y * toR.x) < 0.0)
                continue;
            const float3 on = float3(u, v, p.z - dot(n.xy, toP) / n.z);
            addSkin(x ? on.zxy : y ? on.yzx : on, normal, 0.25 * unit / abs(n.z));
        }
    }
}

[numthreads(HAIRLOOM_LIST_GROUP, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    const uint face = id.x + id.y * gGrid.rowThreads;
    if (id.x >= gGrid.rowThreads || face >= gGrid.count) return;
    const uint i = gIndices[3u * face];
    const uint j = gIndices[3u * face + 1u];
    const uint k = gIndices[3u * face + 2u];
    const float3 a = inCells(vertexAt(gPositions, i));
    const float3 b = inCells(vertexAt(gPositions, j));
    const float3 c = inCells(vertexAt(gPositions, k));
    if (any(max(a, max(b, c)) < 0.0) || any(min(a, min(b, c)) > float3(gridCells()))) return;
    const float3 across = cross(b - a, c - a);
    const float twice = length(across);
    if (!(twice > 0.0)) return;
    const float3 shown = vertexAt(gNormals, i) + vertexAt(gNormals, j) + vertexAt(gNormals, k);
    const float3 normal = across * ((dot(across, shown) < 0.0 ? -1.0 : 1.0) / twice);
    const float squareMetres = gGrid.origin_ws.w * gGrid.origin_ws.w;
    const float longest = max(length(b - a), max(length(c - a), length(c - b)));
    const uint rows = min(uint(kPlaces * longest) + 1u, kMostRows);
    if (kPlaces * longest > float(kMostRows)) {
        addByColumns(a, b, c, across / twice, normal, squareMetres * gGrid.skinUnit);
        return;
    }
    const float each = 0.5 * twice * squareMetres * gGrid.skinUnit / float(rows * rows);
    // As many triangles as that, alike, by their middles.
    for (uint y = 0u; y < rows; ++y) {
        for (uint x = 0u; x < 2u * (rows - y) - 1u; ++x) {
            const float third = (x & 1u) != 0u ? 2.0 / 3.0 : 1.0 / 3.0;
            const float u = (float(x >> 1u) + third) / float(rows);
            const float v = (float(y) + third) / float(rows);
            const float3 at = a + (b - a) * u + (c - a) * v;
            addSkin(at, normal, each);
        }
    }
}
