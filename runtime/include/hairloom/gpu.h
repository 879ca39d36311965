/* SPDX-License-Identifier: MIT */
#ifndef HAIRLOOM_GPU_H
#define HAIRLOOM_GPU_H
/* Follow hairs and ribbons on the game's own GPU: C99. An instance steps the guides on the CPU; a frame then
 * uploads their points alone, and kernels make all hairs of them and draw them, without reading anything
 * back. Kernels lie in share/hairloom-runtime/shaders as HLSL (shader model 5) and SPIR-V (Vulkan 1.1), and
 * gpu.json beside them has the tables below, made from this header.
 *
 * Once: make the buffers of HL_GPU_BUFFERS as large as hl_gpu_buffer() says, and fill those of HL_GPU_ONCE
 * with hl_gpu_fill(). Each frame: hl_instance_step(), fill those of HL_GPU_FRAME with hl_gpu_fill_frame(),
 * and run what hl_gpu_pass() says in the order of HL_GPU_PASSES, with a barrier after each.
 *
 * Binding: in Direct3D register `number` of class B (constants), T (read) or U (written); in Vulkan set 0,
 * binding `number` + HL_GPU_VULKAN_B, _T or _U, uniform buffers for B and storage buffers for T and U. */

#include "hairloom/hairloom.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Name, file without its ending, stage, threads of a group (0: none) and what it does. Entry point: main. */
#define HL_GPU_PASSES(X)                                                \
    X(WISPS, "follow_wisps", COMPUTE, 32, "the wisp around each guide") \
    X(HAIRS, "follow_hairs", COMPUTE, 64, "each point of each hair")    \
    X(RIBBONS, "ribbons", DRAW, 0, "ribbons.vert and ribbons.frag, an instance for each hair")

/* Name, bytes of an element, elements, who fills it, and with what. GUIDE_SAMPLES is guides times points of a
 * hair, GUIDE_ROWS four times as many, GUIDE_TURNS two a guide. */
#define HL_GPU_BUFFERS(X)                                                                          \
    X(CONSTANTS, 32, ONE, FRAME, "numbers of both kernels of hairs")                               \
    X(POSITIONS, 16, GUIDE_POINTS, FRAME, "of guides, metres less hl_frame.origin, and 1")         \
    X(VELOCITIES, 16, GUIDE_POINTS, FRAME, "of guides, m/s, and 0, since wisps widen with speed")  \
    X(TURNS, 16, GUIDE_TURNS, FRAME, "of each guide its root, and 1, and its turn since rest")     \
    X(PLANES, 48, GUIDES, ONCE, "the scalp at each root at rest")                                  \
    X(SAMPLES, 8, GUIDE_SAMPLES, ONCE, "where points of hairs lie along their guides")             \
    X(RADII, 4, HAIR_SAMPLES, ONCE, "of a wisp, from root to tip, metres")                         \
    X(BINDINGS, 80, HAIRS, ONCE, "how much of which guides each hair takes")                       \
    X(LOOKS, 32, HAIRS, ONCE, "linear colour, random number, radii at root and tip, metres, 0, 0") \
    X(ROWS, 16, GUIDE_ROWS, DEVICE, "what WISPS hands to HAIRS")                                   \
    X(POINTS, 16, HAIR_POINTS, DEVICE, "of all hairs, metres less hl_frame.origin, and 1")         \
    X(VIEW, 144, ONE, HOST, "hl_gpu_view")

/* Pass, class of the register, its number, and the buffer. */
#define HL_GPU_BINDINGS(X)     \
    X(WISPS, B, 0, CONSTANTS)  \
    X(WISPS, T, 0, POSITIONS)  \
    X(WISPS, T, 1, VELOCITIES) \
    X(WISPS, T, 2, PLANES)     \
    X(WISPS, T, 3, SAMPLES)    \
    X(WISPS, T, 4, RADII)      \
    X(WISPS, T, 5, TURNS)      \
    X(WISPS, U, 0, ROWS)       \
    X(HAIRS, B, 0, CONSTANTS)  \
    X(HAIRS, T, 0, ROWS)       \
    X(HAIRS, T, 1, PLANES)     \
    X(HAIRS, T, 2, BINDINGS)   \
    X(HAIRS, T, 3, TURNS)      \
    X(HAIRS, U, 0, POINTS)     \
    X(RIBBONS, B, 0, VIEW)     \
    X(RIBBONS, T, 0, POINTS)   \
    X(RIBBONS, T, 1, LOOKS)

#define HL_GPU_VULKAN_B 0
#define HL_GPU_VULKAN_T 16
#define HL_GPU_VULKAN_U 64

#define HL_GPU_AS_PASS(name, file, stage, threads, words) HL_GPU_PASS_##name,
#define HL_GPU_AS_BUFFER(name, bytes, count, fill, words) HL_GPU_BUFFER_##name,
/* HL_GPU_PASS_WISPS … and HL_GPU_BUFFER_CONSTANTS …: numbers of passes and buffers. */
enum { HL_GPU_PASSES(HL_GPU_AS_PASS) HL_GPU_PASS_COUNT };
enum { HL_GPU_BUFFERS(HL_GPU_AS_BUFFER) HL_GPU_BUFFER_COUNT };
#undef HL_GPU_AS_PASS
#undef HL_GPU_AS_BUFFER

enum {
    HL_GPU_ONCE = 0,   /* hl_gpu_fill() */
    HL_GPU_FRAME = 1,  /* hl_gpu_fill_frame() after each step */
    HL_GPU_DEVICE = 2, /* passes alone */
    HL_GPU_HOST = 3    /* the game */
};
typedef struct hl_gpu_buffer_info {
    size_t size; /* sizeof(hl_gpu_buffer_info), set by the caller */
    const char* name;
    size_t bytes;     /* of all of it */
    uint32_t element; /* bytes: the stride of a structured buffer */
    uint32_t fill;    /* HL_GPU_ONCE … */
} hl_gpu_buffer_info;
/* Of an asset with follow hairs; HL_BAD_VALUE where it has none. */
HL_API hl_code hl_gpu_buffer(const hl_asset* asset, uint32_t buffer, hl_gpu_buffer_info* out,
                             hl_error* error);
/* `bytes` as hl_gpu_buffer() says. HL_BAD_VALUE of a buffer that is not HL_GPU_ONCE. */
HL_API hl_code hl_gpu_fill(const hl_asset* asset, uint32_t buffer, void* data, size_t bytes, hl_error* error);
/* Of an instance of that asset, at any level, made with or without HL_HAIRS; takes memory at the first call.
 * All hairs are made, whatever the level's hair_share is. */
HL_API hl_code hl_gpu_fill_frame(hl_instance* instance, uint32_t buffer, void* data, size_t bytes,
                                 hl_error* error);

enum { HL_GPU_COMPUTE = 0, HL_GPU_DRAW = 1 };
typedef struct hl_gpu_pass_info {
    size_t size; /* sizeof(hl_gpu_pass_info), set by the caller */
    const char* file;
    uint32_t kind;                /* HL_GPU_COMPUTE or HL_GPU_DRAW */
    uint32_t groups[3];           /* to dispatch */
    uint32_t vertices, instances; /* to draw as triangle strips without vertex buffers, of both faces */
} hl_gpu_pass_info;
HL_API hl_code hl_gpu_pass(const hl_asset* asset, uint32_t pass, hl_gpu_pass_info* out, hl_error* error);

/* The constant block of RIBBONS: Kajiya and Kay's hair in the light of a lamp. Space of what is read: metres,
 * less hl_frame.origin. */
typedef struct hl_gpu_view {
    float clip_from_world[16]; /* column after column; takes (x, y, z, 1) */
    float eye[4];
    float to_light[4]; /* of unit length; the exponent of the highlight, 40 */
    float light[4];    /* linear; share of it that comes from everywhere, 0.15 */
    float specular[4]; /* of the highlight, linear, 0.25 each; 0 */
    float pixel_size;  /* metres that a pixel covers at a metre's distance: 2 tan(fov_y / 2) / height */
    float min_pixels;  /* narrower hairs are as wide, and a share of their pixels is left out; 1 */
    uint32_t points, hairs;
} hl_gpu_view;
/* All but clip_from_world, eye and pixel_size, which become 0. */
HL_API hl_code hl_gpu_view_init(const hl_asset* asset, hl_gpu_view* view, hl_error* error);

#ifdef __cplusplus
}
#endif
#endif
