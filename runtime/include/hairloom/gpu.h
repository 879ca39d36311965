/* SPDX-License-Identifier: MIT */
#ifndef HAIRLOOM_GPU_H
#define HAIRLOOM_GPU_H
/* Hair on the game's own GPU: C99. Kernels make all hairs of guides and draw them, without reading anything
 * back. The guides are stepped by hl_instance_step() on the CPU, and a frame uploads their points. Or the
 * kernel GUIDES steps them, and a frame uploads their roots. Kernels lie in share/hairloom-runtime/shaders as
 * HLSL (shader model 5) and SPIR-V (Vulkan 1.1), and gpu.json beside them has the tables below, made from
 * this header.
 *
 * Once: make the buffers of HL_GPU_BUFFERS as large as hl_gpu_buffer() says, and fill those of HL_GPU_ONCE
 * with hl_gpu_fill(). Then, in each frame:
 *
 *   guides on the CPU   hl_instance_step(), hl_gpu_fill_frame() of HL_GPU_FRAME and HL_GPU_GUIDES, and all
 *                       passes but GUIDES
 *   guides on the GPU   hl_gpu_step(), hl_gpu_fill_frame() of HL_GPU_FRAME and HL_GPU_STEP, and all passes.
 *                       Before the first: hl_gpu_begin(), and hl_gpu_fill_frame() of HL_GPU_BEGIN and
 *                       HL_GPU_GUIDES
 *
 * Run what hl_gpu_pass() says in the order of HL_GPU_PASSES, with a barrier after each, and draw by one of
 * two:
 *
 *   RIBBONS     Kajiya and Kay's hair of one colour each, without shadows
 *   SHADED      hair as its material says: Kajiya and Kay's, or Marschner's with dual scattering, with
 *               streaks, dye and shadows of hair on hair. The four passes from LAMP_FIRST on come before it.
 *               For another lamp run these four again with another hl_gpu_lamp: it adds to what there is
 *
 * Buffers of HL_GPU_BEGIN, HL_GPU_STEP and SCRATCH are for the pass GUIDES alone, and those from LAMP on for
 * SHADED and the passes before it: HL_GPU_BINDINGS says which pass takes which. What none of yours takes need
 * not be made.
 *
 * Hairs are in the order in which a level leaves them out: those that a smaller hair_share reads come first.
 * NUMBERS says which of hl_asset_hairs() each is.
 *
 * Binding: in Direct3D register `number` of class B (constants), T (read) or U (written); in Vulkan set 0,
 * binding `number` + HL_GPU_VULKAN_B, _T or _U, uniform buffers for B and storage buffers for T and U.
 * Compile HLSL for Direct3D with the macro HAIRLOOM_DXBC and, of compute shaders, with strict IEEE
 * arithmetic. */

#include "hairloom/hairloom.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Name, file without its ending, stage, threads of a group (0: none) and what it does. Entry point: main. */
#define HL_GPU_PASSES(X)                                                                       \
    X(GUIDES, "guides", COMPUTE, 32, "a frame of each guide as a rod")                         \
    X(WISPS, "follow_wisps", COMPUTE, 32, "the wisp around each guide")                        \
    X(HAIRS, "follow_hairs", COMPUTE, 64, "each point of each hair")                           \
    X(RIBBONS, "ribbons", DRAW, 0, "ribbons.vert and ribbons.frag, an instance for each hair") \
    X(LAMP_FIRST, "lamp_first", COMPUTE, 64, "where hair begins as a lamp sees it")            \
    X(LAMP_COUNT, "lamp_count", COMPUTE, 64, "the hair in each cell of the lamp's grid")       \
    X(LAMP_SUM, "lamp_sum", COMPUTE, 64, "fibres between the lamp and each cell")              \
    X(SHADE, "shade_hairs", COMPUTE, 64, "the lamp's light at each point of each hair")        \
    X(SHADED, "shaded_ribbons", DRAW, 0, "shaded_ribbons.vert and .frag, an instance for each hair")

/* Name, bytes of an element, elements, who fills it, and with what. GUIDE_SAMPLES is guides times points of a
 * hair, GUIDE_ROWS four times as many, GUIDE_TURNS two a guide. GUIDES has them in slots, 32 a block:
 * SLOT_POINTS is slots times points of the longest guide. */
#define HL_GPU_BUFFERS(X)                                                                               \
    X(CONSTANTS, 32, ONE, FRAME, "numbers of both kernels of hairs")                                    \
    X(POSITIONS, 16, GUIDE_POINTS, GUIDES, "of guides, metres less hl_frame.origin, and 1")             \
    X(VELOCITIES, 16, GUIDE_POINTS, GUIDES, "of guides, m/s, and 0, since wisps widen with speed")      \
    X(TURNS, 16, GUIDE_TURNS, FRAME, "of each guide its root, and 1, and its turn since rest")          \
    X(PLANES, 48, GUIDES, ONCE, "the scalp at each root at rest")                                       \
    X(SAMPLES, 8, GUIDE_SAMPLES, ONCE, "where points of hairs lie along their guides")                  \
    X(RADII, 4, HAIR_SAMPLES, ONCE, "of a wisp, from root to tip, metres")                              \
    X(BINDINGS, 80, HAIRS, ONCE, "how much of which guides each hair takes")                            \
    X(LOOKS, 32, HAIRS, ONCE, "linear colour, random number, radii at root and tip, metres, 0, 0")      \
    X(NUMBERS, 4, HAIRS, ONCE, "which of hl_asset_hairs each hair is, for tables of your own")          \
    X(ROWS, 16, GUIDE_ROWS, DEVICE, "what WISPS hands to HAIRS")                                        \
    X(POINTS, 16, HAIR_POINTS, DEVICE, "of all hairs, metres less hl_frame.origin, and 1")              \
    X(VIEW, 144, ONE, HOST, "hl_gpu_view")                                                              \
    X(STEP, 352, ONE, STEP, "numbers of the frame")                                                     \
    X(RODS, 160, ONE, STEP, "numbers of rods in it")                                                    \
    X(ROOTS_TO, 16, SLOT_TURNS, STEP, "where roots go: place, and 1 if it moves, and turn")             \
    X(SPHERES, 32, SPHERES, STEP, "centre and radius, and way in a substep")                            \
    X(WAKING, 16, SPHERE_ENDS, STEP, "reach of spheres that have moved")                                \
    X(REPORT, 4, WORDS, STEP, "of the kernel: bits of a speed, restored, asleep, guarded")              \
    X(REST, 16, SLOT_POINTS, BEGIN, "segments at rest")                                                 \
    X(SEGMENTS, 8, SLOT_POINTS, BEGIN, "their lengths, and inverse masses of points")                   \
    X(ROD_REST, 16, SLOT_RESTS, BEGIN, "rods at rest: tangents, stiffness, turns, sections")            \
    X(MASSES, 4, SLOT_POINTS, BEGIN, "of points")                                                       \
    X(BLOCKS, 8, BLOCKS, BEGIN, "points of a guide, and guides")                                        \
    X(FIRST_POINTS, 4, SLOTS, BEGIN, "of the slot's guide in POSITIONS")                                \
    X(CURVED, 4, BLOCKS, BEGIN, "1 where rods twist")                                                   \
    X(STATE, 4, SLOT_STATE, BEGIN, "where points are, and were")                                        \
    X(ROOTS, 4, SLOT_ROOTS, BEGIN, "where roots were")                                                  \
    X(RESTS, 4, BLOCK_RESTS, BEGIN, "of a block: how long it rests, whether it sleeps, where it stays") \
    X(ROD_STATE, 4, SLOT_RODS, BEGIN, "speeds, turns and strains of rods")                              \
    X(SCRATCH, 4, SLOT_SCRATCH, DEVICE, "what GUIDES works in")                                         \
    X(LAMP, 96, ONE, HOST, "hl_gpu_lamp")                                                               \
    X(MATERIALS, 288, MATERIALS, ONCE, "of the hairstyle and its layers: HairMaterial of hair_types.h") \
    X(TABLES, 4, TABLE_FLOATS, ONCE, "of Marschner's fibres and dual scattering: hair_types.h")         \
    X(SHADES, 32, HAIRS, ONCE, "material, number, streak, dye, pigment, length, own colour, 0")         \
    X(CROSSED, 4, LAMP_CELLS, ONCE, "zeros, and what LAMP_FIRST and LAMP_COUNT find")                   \
    X(FIBRES, 4, LAMP_CELLS, DEVICE, "from the lamp to the end of each cell, and where they begin")     \
    X(COLOURS, 16, HAIR_POINTS, DEVICE, "linear light that leaves points towards the eye, and 1")

/* Pass, class of the register, its number, and the buffer. */
#define HL_GPU_BINDINGS(X)        \
    X(GUIDES, B, 0, STEP)         \
    X(GUIDES, B, 2, RODS)         \
    X(GUIDES, T, 0, REST)         \
    X(GUIDES, T, 1, SEGMENTS)     \
    X(GUIDES, T, 2, ROD_REST)     \
    X(GUIDES, T, 3, MASSES)       \
    X(GUIDES, T, 4, BLOCKS)       \
    X(GUIDES, T, 5, FIRST_POINTS) \
    X(GUIDES, T, 6, ROOTS_TO)     \
    X(GUIDES, T, 7, SPHERES)      \
    X(GUIDES, T, 8, WAKING)       \
    X(GUIDES, T, 9, CURVED)       \
    X(GUIDES, U, 0, STATE)        \
    X(GUIDES, U, 1, ROOTS)        \
    X(GUIDES, U, 2, RESTS)        \
    X(GUIDES, U, 3, REPORT)       \
    X(GUIDES, U, 4, POSITIONS)    \
    X(GUIDES, U, 5, ROD_STATE)    \
    X(GUIDES, U, 6, VELOCITIES)   \
    X(GUIDES, U, 7, SCRATCH)      \
    X(WISPS, B, 0, CONSTANTS)     \
    X(WISPS, T, 0, POSITIONS)     \
    X(WISPS, T, 1, VELOCITIES)    \
    X(WISPS, T, 2, PLANES)        \
    X(WISPS, T, 3, SAMPLES)       \
    X(WISPS, T, 4, RADII)         \
    X(WISPS, T, 5, TURNS)         \
    X(WISPS, U, 0, ROWS)          \
    X(HAIRS, B, 0, CONSTANTS)     \
    X(HAIRS, T, 0, ROWS)          \
    X(HAIRS, T, 1, PLANES)        \
    X(HAIRS, T, 2, BINDINGS)      \
    X(HAIRS, T, 3, TURNS)         \
    X(HAIRS, U, 0, POINTS)        \
    X(RIBBONS, B, 0, VIEW)        \
    X(RIBBONS, T, 0, POINTS)      \
    X(RIBBONS, T, 1, LOOKS)       \
    X(LAMP_FIRST, B, 0, VIEW)     \
    X(LAMP_FIRST, B, 1, LAMP)     \
    X(LAMP_FIRST, T, 0, POINTS)   \
    X(LAMP_FIRST, U, 0, CROSSED)  \
    X(LAMP_COUNT, B, 0, VIEW)     \
    X(LAMP_COUNT, B, 1, LAMP)     \
    X(LAMP_COUNT, T, 0, POINTS)   \
    X(LAMP_COUNT, T, 1, LOOKS)    \
    X(LAMP_COUNT, U, 0, CROSSED)  \
    X(LAMP_SUM, U, 0, CROSSED)    \
    X(LAMP_SUM, U, 1, FIBRES)     \
    X(SHADE, B, 0, VIEW)          \
    X(SHADE, B, 1, LAMP)          \
    X(SHADE, T, 0, POINTS)        \
    X(SHADE, T, 1, LOOKS)         \
    X(SHADE, T, 2, SHADES)        \
    X(SHADE, T, 3, MATERIALS)     \
    X(SHADE, T, 4, TABLES)        \
    X(SHADE, T, 5, FIBRES)        \
    X(SHADE, U, 0, COLOURS)       \
    X(SHADED, B, 0, VIEW)         \
    X(SHADED, T, 0, POINTS)       \
    X(SHADED, T, 1, LOOKS)        \
    X(SHADED, T, 2, COLOURS)

#define HL_GPU_VULKAN_B 0
#define HL_GPU_VULKAN_T 16
#define HL_GPU_VULKAN_U 64

/* Spheres of a frame that GUIDES meets at most, or those of the asset where it has more. */
#define HL_GPU_SPHERES 32

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
    HL_GPU_HOST = 3,   /* the game */
    HL_GPU_GUIDES = 4, /* HL_GPU_FRAME, or the pass GUIDES, from what it was at hl_gpu_begin() */
    HL_GPU_BEGIN = 5,  /* hl_gpu_fill_frame() after hl_gpu_begin() and before the first step */
    HL_GPU_STEP = 6    /* hl_gpu_fill_frame() after each hl_gpu_step() */
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
 */
HL_API hl_code hl_gpu_fill_frame(hl_instance* instance, uint32_t buffer, void* data, size_t bytes,
                                 hl_error* error);

/* From here on the pass GUIDES moves the hair, from where the CPU has it. hl_instance_reset(), _load(),
 * _step(), _play(), _set() and another level end it, and copies are on the CPU: begin again. What
 * hl_instance_read() gives stays as it was. The hair meets spheres, not the skin. HL_BAD_VALUE where
 * strandModel is springs, clampedPoints is not 2, or the level is not the finest. Takes memory: hl_gpu_step()
 * asks for none but for more spheres than there were, and hl_gpu_fill_frame() of its buffers for none. */
HL_API hl_code hl_gpu_begin(hl_instance* instance, hl_error* error);
/* Takes a frame as hl_instance_step() does; HL_WRONG_SIZE where it has more spheres than HL_GPU_SPHERES and
 * than the asset, where each capsule has both of its ends to itself. With dt 0 nothing
 * moves: run no pass GUIDES. HL_BAD_VALUE without hl_gpu_begin(). */
HL_API hl_code hl_gpu_step(hl_instance* instance, const hl_frame* frame, hl_error* error);

enum { HL_GPU_COMPUTE = 0, HL_GPU_DRAW = 1 };
typedef struct hl_gpu_pass_info {
    size_t size; /* sizeof(hl_gpu_pass_info), set by the caller */
    const char* file;
    uint32_t kind;                /* HL_GPU_COMPUTE or HL_GPU_DRAW */
    uint32_t groups[3];           /* to dispatch */
    uint32_t vertices, instances; /* to draw as triangle strips without vertex buffers, of both faces */
} hl_gpu_pass_info;
/* Of all hairs. */
HL_API hl_code hl_gpu_pass(const hl_asset* asset, uint32_t pass, hl_gpu_pass_info* out, hl_error* error);
/* Of the hairs that the instance's hair_share leaves (hl_instance_set_level, of an instance with HL_LEVELS):
 * fewer groups of HAIRS and instances of RIBBONS. */
HL_API hl_code hl_gpu_frame_pass(const hl_instance* instance, uint32_t pass, hl_gpu_pass_info* out,
                                 hl_error* error);

/* The constant block of passes that draw and shade. RIBBONS takes its light, the others that of hl_gpu_lamp.
 * Space of what is read: metres, less hl_frame.origin. */
typedef struct hl_gpu_view {
    float clip_from_world[16]; /* column after column; takes (x, y, z, 1) */
    float eye[4];
    float to_light[4]; /* of unit length; the exponent of the highlight, 40 */
    float light[4];    /* linear; share of it that comes from everywhere, 0.15 */
    float specular[4]; /* of the highlight, linear, 0.25 each; how much wider hairs are, 0: as they are */
    float pixel_size;  /* metres that a pixel covers at a metre's distance: 2 tan(fov_y / 2) / height */
    float min_pixels;  /* narrower hairs are as wide, and a share of their pixels is left out; 1 */
    uint32_t points, hairs;
} hl_gpu_view;
/* All but clip_from_world, eye and pixel_size, which become 0. `size` is sizeof(hl_gpu_view), which the plain
 * name tells. */
HL_API hl_code hl_gpu_view_init_sized(const hl_asset* asset, hl_gpu_view* view, size_t size, hl_error* error);
#define hl_gpu_view_init(asset, view, error) \
    hl_gpu_view_init_sized((asset), (view), sizeof(hl_gpu_view), (error))
/* The constant block of a lamp far away: where its grid of fibres lies, and its light. Space as of
 * hl_gpu_view. */
typedef struct hl_gpu_lamp {
    float across[4], up[4], away[4]; /* rows: of a point (x, y, z, 1) its place in the grid, 0 to 1 */
    float to_light[4];               /* of unit length, and 0 */
    float light[4];  /* linear, across the light; 0 in the first lamp of a frame, 1 in others */
    float ground[4]; /* linear albedo of the skin behind the hair, 0 where there is none; square metres of a
                        column of the grid */
} hl_gpu_lamp;
/* A lamp of white light 1 in the direction `to_light` (three numbers, not 0), and a grid around the ball of
 * `radius` metres at `centre`. Hair outside casts no shadow: give the head's place and about the hair's
 * length and a half. HL_BAD_VALUE of what is no direction, place or radius. */
HL_API hl_code hl_gpu_lamp_init_sized(const float to_light[3], const float centre[3], float radius,
                                      hl_gpu_lamp* lamp, size_t size, hl_error* error);
#define hl_gpu_lamp_init(to_light, centre, radius, lamp, error) \
    hl_gpu_lamp_init_sized((to_light), (centre), (radius), (lamp), sizeof(hl_gpu_lamp), (error))
/* After another hair_share: sets `hairs` and specular[3], so that fewer hairs cover as much, and nothing
 * else. */
HL_API hl_code hl_gpu_frame_view_sized(const hl_instance* instance, hl_gpu_view* view, size_t size,
                                       hl_error* error);
#define hl_gpu_frame_view(instance, view, error) \
    hl_gpu_frame_view_sized((instance), (view), sizeof(hl_gpu_view), (error))

#ifdef __cplusplus
}
#endif
#endif
