// SPDX-License-Identifier: MIT
// Each point of each follow hair, a thread of its own: a weighted sum of rows.
#include "follow.hlsli"

StructuredBuffer<float4> gRows : register(t0);
StructuredBuffer<FollowPlane> gPlanes : register(t1);
StructuredBuffer<FollowBinding> gBindings : register(t2);
StructuredBuffer<float4> gFrames : register(t3);  // of guides: position; rotation since rest
RWStructuredBuffer<float4> gHairs : register(u0);  // hair after hair, world, w 1

[numthreads(64, 1, 1)]
void main(uint3 thread : SV_DispatchThreadID) {
    // Rows of groups: one dimension of a dispatch is too short for many hairs.
    const uint at = thread.y * (65535u * 64u) + thread.x;
    if (at >= gFollow.hairs * gFollow.points) return;
    const uint p = at % gFollow.points;
    const FollowBinding hair = gBindings[at / gFollow.points];
    const FollowPlane plane = gPlanes[hair.guides.x];
    const float3 along = rotate(gFrames[2 * hair.guides.x + 1], plane.x.xyz * hair.shift.x + plane.y.xyz * hair.shift.y +
                                                plane.normal.xyz * hair.shift.z);
    const float3 roots = gRows[rowOf(hair.guides.x, 0, 0)].xyz * hair.roots.x +
                         gRows[rowOf(hair.guides.y, 0, 0)].xyz * hair.roots.y +
                         gRows[rowOf(hair.guides.z, 0, 0)].xyz * hair.roots.z;
    const float3 wisp = gRows[rowOf(hair.guides.x, 1, p)].xyz * hair.weights.w +
                        gRows[rowOf(hair.guides.x, 2, p)].xyz * hair.wisp.x +
                        gRows[rowOf(hair.guides.x, 3, p)].xyz * hair.wisp.y;
    const float3 between = gRows[rowOf(hair.guides.x, 0, p)].xyz * hair.weights.x +
                           gRows[rowOf(hair.guides.y, 0, p)].xyz * hair.weights.y +
                           gRows[rowOf(hair.guides.z, 0, p)].xyz * hair.weights.z;
    gHairs[at] = float4(wisp + between + roots + along, 1);
}
