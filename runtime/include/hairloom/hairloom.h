/* SPDX-License-Identifier: MIT */
#ifndef HAIRLOOM_HAIRLOOM_H
#define HAIRLOOM_HAIRLOOM_H
/* Plays runtime assets (.hairrt) in a game: C99. hairloom/hairloom.hpp is the same for C++17.
 *
 * An asset is a view of a file in memory. An instance is one character's hair: it is made from an asset,
 * stepped once a frame, and read. Metres, seconds, Y up, right-handed; matrices are three rows of four, row
 * by row, and take columns (x, y, z, 1).
 *
 * Structs may get more members at their end. Those that begin with `size` want it set to the size that the
 * caller knows; of others each call tells it (hl_asset_describe_sized() and the like, which the plain names
 * stand for). Older and newer callers are both served: members that the library does not know have to be 0
 * where they ask for something, and are set to 0 where they are given back. Other sizes are refused.
 *
 * No call throws, keeps state of its own but hl_set_allocator(), or reads beyond the sizes that it is given.
 * Calls on different instances may run at the same time; calls on one may not. Every call that can fail
 * returns a code and, where `error` is not null, says in words what was wrong. A call that fails changes
 * nothing. Of a thread's stack a call takes at most 64 KB. */

#include <stddef.h>
#include <stdint.h>

/* Of these headers. docs/versions.md of the project says what may change from one to the next. */
#define HL_VERSION_MAJOR 0
#define HL_VERSION_MINOR 3
#define HL_VERSION_PATCH 0
#define HL_VERSION (HL_VERSION_MAJOR * 1000000 + HL_VERSION_MINOR * 1000 + HL_VERSION_PATCH)

/* Say HL_SHARED where the library is shared; its CMake package does. */
#if !defined(HL_SHARED)
#define HL_API
#elif defined(_WIN32) && defined(HL_BUILDS_RUNTIME)
#define HL_API __declspec(dllexport)
#elif defined(_WIN32)
#define HL_API __declspec(dllimport)
#else
#define HL_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hl_code {
    HL_OK = 0,
    HL_DAMAGED = 1,    /* the asset is damaged, or none */
    HL_NEWER = 2,      /* the asset is of a version that this library does not know */
    HL_WRONG_SIZE = 3, /* an array or a struct has another size than is needed */
    HL_BAD_VALUE = 4,  /* a number out of range or not finite, a null pointer, an unknown name */
    HL_NO_MEMORY = 5
} hl_code;

#define HL_NO_PLACE UINT64_MAX
typedef struct hl_error {
    hl_code code;
    uint64_t byte;   /* of the asset, near which it is damaged; HL_NO_PLACE where that is not what is wrong */
    char words[232]; /* ends in 0 */
} hl_error;

/* --- Version --- */

/* HL_VERSION of the library that runs. */
HL_API uint32_t hl_version(void);
typedef struct hl_build {
    size_t size; /* sizeof(hl_build) */
    uint32_t version;
    uint32_t lanes; /* strands that one instruction works on; 1: no vectors, several times slower */
    const char* instruction_set; /* "AVX3": what runs on this machine */
    const char* compiler;
    uint32_t fused; /* 1: multiplies and adds in one; the bits of hair are then those of all such machines */
    uint32_t single_header; /* 1: for one instruction set; 0: takes the best of the machine at run time */
} hl_build;
HL_API hl_code hl_build_info(hl_build* build, hl_error* error);

/* --- Memory --- */

/* Where all memory comes from that instances hold and that calls work in; without it, C++'s operator new. Two
 * things do not come from here: words of errors and of hl_effect.why, which calls put together by operator
 * new and give back before they return, and what a C++ exception takes inside of a call that fails. Called
 * from the threads that call and from those of hl_jobs. Frames ask as seldom as hl_instance_reserve says.
 * There is no function that enlarges a piece: nothing here grows in place. */
typedef struct hl_allocator {
    size_t size; /* sizeof(hl_allocator), set by hl_allocator_init() */
    void* user;
    /* `bytes` at a multiple of `alignment`, a power of two up to 128. Null: there is no more, and the call
     * comes back with HL_NO_MEMORY. Neither it nor `release` may throw. */
    void* (*allocate)(void* user, size_t bytes, size_t alignment);
    /* With the numbers that it was asked with; `data` is never null. */
    void (*release)(void* user, void* data, size_t bytes, size_t alignment);
} hl_allocator;
HL_API void hl_allocator_init(hl_allocator* allocator);
/* For all of the process, from the next call on; null: operator new. While no other call runs. HL_BAD_VALUE
 * while there are instances, whose memory goes back where it came from, or where one function is null. */
HL_API hl_code hl_set_allocator(const hl_allocator* allocator, hl_error* error);

/* --- Assets --- */

/* The caller's; holds no memory of its own. Do not look inside. */
typedef struct hl_asset {
    uint64_t inside[40];
} hl_asset;

typedef struct hl_asset_info {
    uint32_t major, minor;
    uint32_t guides, guide_points;   /* strands that are simulated, and points of all of them */
    uint32_t hairs, points_per_hair; /* follow hairs; 0 where there are none */
    uint32_t bones, spheres;
    uint32_t scalp_vertices;            /* of the head, that roots need; 0 where roots move rigidly */
    float bounds_min[3], bounds_max[3]; /* of all guides at rest */
    float greatest_error;               /* metres, of a point at rest */
    /* Bytes that an instance holds at most: on one thread, ... */
    size_t guides_memory;
    size_t hairs_memory;  /* ... what HL_HAIRS adds, ... */
    size_t thread_memory; /* ... and each further thread of the machine where there are hl_jobs */
    /* Since 0.2: */
    size_t levels_memory; /* what HL_LEVELS adds */
    uint32_t layers, settings, attributes;
    uint32_t measured_levels; /* 1: errors of levels are in the asset, so that HL_LEVELS takes little time */
    /* Since 0.3: */
    uint32_t poses;
    uint32_t unused; /* 0 */
} hl_asset_info;

/* Looks at header and table of the file alone. `bytes` begin at a multiple of 16 and outlive the asset. */
HL_API hl_code hl_asset_open(hl_asset* asset, const void* bytes, size_t size, hl_error* error);
/* Compares all checksums and looks at every record. hl_instance_make does the second by itself. */
HL_API hl_code hl_asset_check(const hl_asset* asset, hl_error* error);
/* Of an asset whose content is sound; looks at every record. */
HL_API hl_code hl_asset_describe(const hl_asset* asset, hl_asset_info* info, hl_error* error);

typedef struct hl_bone {
    const char* name; /* UTF-8, does not end in 0 */
    size_t name_bytes;
    uint32_t index;         /* in the skeleton of the file that the head came from */
    float inverse_bind[12]; /* from the head at rest to the bone */
} hl_bone;
/* Bones by whose numbers hl_frame takes matrices, `bone` from 0. */
HL_API hl_code hl_asset_bone(const hl_asset* asset, uint32_t bone, hl_bone* out, hl_error* error);
/* The vertex of the head's file of each scalp vertex. */
HL_API hl_code hl_asset_scalp_sources(const hl_asset* asset, uint32_t* vertices, size_t count,
                                      hl_error* error);
typedef struct hl_layer {
    const char* name; /* UTF-8, does not end in 0; empty where the hairstyle names no layers */
    size_t name_bytes;
    float density;         /* that the number of follow hairs of its guides was multiplied with */
    uint32_t own_material; /* 1: its settings are "layerN.rootColour" and so on, N = layer + 1; 0: the
                              hairstyle's, "material.rootColour" */
} hl_layer;
/* `layer` from 0. */
HL_API hl_code hl_asset_layer(const hl_asset* asset, uint32_t layer, hl_layer* out, hl_error* error);
/* How many layers there are, one at least, and of each guide its layer. `of_guides` may be null, with a count
 * of 0. Follow hairs are on the layer of their guide. */
HL_API hl_code hl_asset_layers(const hl_asset* asset, uint32_t* layers, uint32_t* of_guides, size_t count,
                               hl_error* error);
/* A setting, by its number below hl_asset_info.settings. What is given back lies in the asset's bytes. */
enum { HL_NUMBERS = 0, HL_CHOICE = 1, HL_SEED = 2, HL_CURVE = 3 };
typedef struct hl_setting {
    size_t size;      /* sizeof(hl_setting) */
    const char* name; /* "simulation.windSpeed", UTF-8, does not end in 0 */
    size_t name_bytes;
    uint32_t kind;
    uint32_t count;       /* of values */
    const double* values; /* numbers; of a seed its lower and upper 32 bits; of a curve place (0 root … 1 tip)
                             and value of each key; null of a choice */
    const char* choice;   /* the name of what is chosen; null of others */
    size_t choice_bytes;
} hl_setting;
HL_API hl_code hl_asset_setting(const hl_asset* asset, uint32_t setting, hl_setting* out, hl_error* error);
/* HL_BAD_VALUE where there is none of that name. */
HL_API hl_code hl_asset_find_setting(const hl_asset* asset, const char* name, uint32_t* setting,
                                     hl_error* error);

/* What the hairstyle says of each guide, by its number below hl_asset_info.attributes: "root_uv", "group",
 * "colour", or a name that an artist gave. */
enum { HL_UINT8 = 0, HL_UINT32 = 1, HL_INT32 = 2, HL_FLOAT = 3 };
typedef struct hl_attribute {
    size_t size; /* sizeof(hl_attribute) */
    const char* name;
    size_t name_bytes;
    uint32_t type, components; /* 1 to 4 */
    const void* values;        /* guide after guide, without gaps, in the asset's bytes */
    size_t bytes;
} hl_attribute;
HL_API hl_code hl_asset_attribute(const hl_asset* asset, uint32_t attribute, hl_attribute* out,
                                  hl_error* error);
HL_API hl_code hl_asset_find_attribute(const hl_asset* asset, const char* name, uint32_t* attribute,
                                       hl_error* error);

/* Another shape of the hair, for rods to follow by an amount that a game sets (hl_instance_set_pose); by its
 * number below hl_asset_info.poses. What is given back lies in the asset's bytes. */
typedef struct hl_hair_pose {
    size_t size;      /* sizeof(hl_hair_pose) */
    const char* name; /* UTF-8, does not end in 0 */
    size_t name_bytes;
    float amount;     /* that an instance begins with, 0 to 1 */
    uint32_t partial; /* 1: points take less than the amount, as it was painted; 0: all take all of it */
} hl_hair_pose;
HL_API hl_code hl_asset_pose(const hl_asset* asset, uint32_t pose, hl_hair_pose* out, hl_error* error);
HL_API hl_code hl_asset_find_pose(const hl_asset* asset, const char* name, uint32_t* pose, hl_error* error);

/* What a follow hair is, whatever share of them is read: for vertex buffers and shaders, once. */
typedef struct hl_hair {
    uint32_t guide; /* its own */
    uint32_t layer;
    uint32_t guides[3]; /* that it goes with, and how much of each; the first is its own */
    float shares[3];
    float random;                  /* its own for good: evenly spread over 0 to 1, by seed, guide and hair */
    float root_uv[2];              /* in the head's texture; 0 0 where the asset has none */
    float colour[3];               /* linear: the guides' where strands have colours, else the material's */
    float root_radius, tip_radius; /* metres */
} hl_hair;
/* All follow hairs, in the order in which hl_instance_read_hairs has them where it reads all. `bytes` are
 * from one to the next: sizeof(hl_hair). */
HL_API hl_code hl_asset_hairs(const hl_asset* asset, hl_hair* hairs, size_t bytes, size_t count,
                              hl_error* error);
/* Numbers of a setting: "simulation.windSpeed", "material.rootColour". `written` says how many there are,
 * also where `count` is too small. Choices have none. */
HL_API hl_code hl_asset_numbers(const hl_asset* asset, const char* name, double* values, size_t count,
                                size_t* written, hl_error* error);

/* Recorded motion that an asset may hold: of guides, relative to the head, so that the game's own head moves
 * it. hl_instance_play() plays it. */
typedef struct hl_clip {
    size_t size;      /* sizeof(hl_clip) */
    const char* name; /* UTF-8, does not end in 0; null where there is no clip */
    size_t name_bytes;
    uint32_t frames; /* 0: the asset has no clip */
    float frames_per_second;
    uint32_t loops;      /* 1: behind the last frame comes the first */
    float largest_error; /* metres, of a point behind its root, from where it was recorded */
    uint64_t bytes;      /* of the asset that it takes */
    size_t memory;       /* bytes that playing it adds to an instance, at most */
} hl_clip;
HL_API hl_code hl_asset_clip(const hl_asset* asset, hl_clip* clip, hl_error* error);

/* --- Instances --- */

typedef struct hl_instance hl_instance;

/* Lends threads. Calls body(context, begin, end) for pieces of [0, count) of about `grain` elements and
 * returns when all are done. */
typedef struct hl_jobs {
    void* user;
    void (*parallel_for)(void* user, size_t count, size_t grain,
                         void (*body)(void* context, size_t begin, size_t end), void* context);
} hl_jobs;

enum { HL_GUIDES = 0, HL_HAIRS = 1, HL_LEVELS = 2 };

/* A copy of what it needs: the asset may go afterwards. `what` is HL_GUIDES, or the sum of HL_HAIRS to read
 * follow hairs as well and HL_LEVELS to have levels of detail. `jobs` may be null: all on the calling thread.
 * All memory is asked for here and at the first frames of new effects or more spheres, none by other steps.
 * At rest on the head at rest until it is reset or stepped. */
HL_API hl_code hl_instance_make(const hl_asset* asset, uint32_t what, const hl_jobs* jobs, hl_instance** out,
                                hl_error* error);
/* What a game lends an instance. All may be null. */
typedef struct hl_host {
    size_t size; /* sizeof(hl_host), set by hl_host_init() */
    const hl_jobs* jobs;
    void* user;                          /* for the two below */
    uint64_t (*nanoseconds)(void* user); /* as hl_instance_time */
    /* Is told in words what a developer wants to know: of hair that was put back to rest, say. From the
     * thread that steps. */
    void (*log)(void* user, const char* words, size_t bytes);
} hl_host;
HL_API void hl_host_init(hl_host* host);
HL_API hl_code hl_instance_make_hosted(const hl_asset* asset, uint32_t what, const hl_host* host,
                                       hl_instance** out, hl_error* error);
/* Another character of the same hair, in the same state: running on gives the same bits, so a copy is a
 * snapshot, too. It takes less time than hl_instance_make, and shares with the instance what never changes.
 */
HL_API hl_code hl_instance_copy(const hl_instance* instance, hl_instance** out, hl_error* error);
HL_API void hl_instance_free(hl_instance* instance); /* null is allowed */

/* Where things are at a time within a frame, as hl_frame has them at its end, and as many: a pose has those
 * that its frame has, and no others. Begin with hl_pose_init(). */
typedef struct hl_pose {
    size_t size; /* sizeof(hl_pose), set by hl_pose_init(); the same in all poses of a frame */
    const float* head;
    const float* bones;
    const float* scalp;
    const float* roots;
    const float* spheres;
} hl_pose;
HL_API void hl_pose_init(hl_pose* pose);

/* Where the head is at the end of a frame. Begin with hl_frame_init(); what stays 0 or null is not there.
 * Roots follow, the first of these that is there: `roots`, `scalp`, `bones`, `head`. Spheres follow
 * `spheres`, else `bones`, else `head`. A matrix or root that is not finite leaves its strands where they
 * were. */
typedef struct hl_frame {
    size_t size;       /* sizeof(hl_frame), set by hl_frame_init() */
    float dt;          /* seconds, 1e-6 or more, which may change from frame to frame; or 0, a game that is
                          paused: nothing moves */
    double time;       /* seconds at the end of the frame; drives gusts alone */
    const float* head; /* 12: from the head at rest to the world, rigid; null: the head at rest */
    const float*
        bones; /* 12 of each of the asset's bones: from the head at rest to the world (skinning matrices) */
    size_t bone_count;
    const float* scalp; /* 3 of each scalp vertex: where they are, world */
    size_t scalp_count;
    const float*
        roots; /* 7 of each guide: position and unit quaternion x, y, z, w of its turn since rest, world */
    size_t root_count;
    const float* spheres; /* 4 of each: centre and radius, world. The asset's own where it is null */
    size_t sphere_count;
    const float* wind; /* 3: the mean wind, m/s, in place of the authored one; null: as authored */
    double origin[3];  /* that roots, bones' results, spheres and what is read are measured from, world */
    const uint32_t* capsules; /* 2 of each: numbers of two of the frame's spheres, whose hull is a tapered
                                 capsule. Without `spheres` the asset's own capsules count instead */
    size_t capsule_count;     /* up to 256 */
    /* Poses on the way there, one after another, at equal shares of dt: three are those at the quarters of
     * the frame. Substeps see the motion through them; without, all goes straight to the end. Matrices of
     * poses are finite. An instance takes 28 bytes more for each guide and pose, asked for at the first such
     * frame. hl_gpu_step leaves them out, and says so once in the log. */
    const hl_pose* inner;
    size_t inner_count; /* up to 15 */
    /* 1: the frame does not continue from the one before. Roots, spheres and skin jump to its first pose, or
     * to that at the first substep's end if it is later, and take the hair along, as roots do that jump
     * farther than `teleportDistance`. hl_instance_reset puts hair at rest instead */
    uint32_t cut;
    uint32_t unused; /* 0 */
} hl_frame;
HL_API void hl_frame_init(hl_frame* frame);

/* At rest on the frame's roots, without speed. dt is not looked at. */
HL_API hl_code hl_instance_reset(hl_instance* instance, const hl_frame* frame, hl_error* error);
HL_API hl_code hl_instance_step(hl_instance* instance, const hl_frame* frame, hl_error* error);

/* How a clip is played. */
enum { HL_LOOP_AS_AUTHORED = 0, HL_LOOP_NEVER = 1, HL_LOOP_ALWAYS = 2 };
typedef struct hl_play {
    size_t size; /* sizeof(hl_play), set by hl_play_init() */
    double time; /* seconds from the clip's first frame, any finite number. A clip that does not loop stays at
                    its first and last frame beyond them */
    float speed; /* seconds of the clip in a second of the game, -1000 to 1000; 1. Speeds of points follow it;
                    `time` is the caller's to advance */
    uint32_t loop; /* HL_LOOP_AS_AUTHORED */
} hl_play;
HL_API void hl_play_init(hl_play* play);

/* In place of a step: guides are where the asset's clip has them at that time, linearly between its frames,
 * on the roots of the frame and turned as these have turned on the whole. Nothing is simulated. Follow hairs,
 * levels and reads are as after a step, and a step goes on from these points with their speeds. At a coarser
 * level the clip's motion is that of the level's guides, and none of the rigid one. The asset is of the
 * instance's hairstyle, another file of it with another clip is one, too. It is read while it plays, so its
 * bytes stay. HL_DAMAGED with a place where bits of the clip are none: all stays as it was. Asks for memory
 * where an asset is played that the last call did not play. */
HL_API hl_code hl_instance_play(hl_instance* instance, const hl_asset* asset, const hl_frame* frame,
                                const hl_play* play, hl_error* error);

/* Replaces a setting of the engine from the next step on: name without group, "windSpeed", one value or those
 * of a vector. Curves stay as authored. May ask for memory. */
HL_API hl_code hl_instance_set(hl_instance* instance, const char* name, const double* values, size_t count,
                               hl_error* error);
/* The same of a choice, by its name: "strandModel", "springs". HL_BAD_VALUE of a name that there is not:
 * words list those that there are. */
HL_API hl_code hl_instance_choose(hl_instance* instance, const char* name, const char* choice,
                                  hl_error* error);

/* How far hair follows one of the asset's poses from the next step on, in place of the authored amount: 0
 * simulates it alone, 1 holds it in the pose but for what it collides with, and what is between draws it
 * there. Poses add up: by 1 and 1 hair stands half way between two. The amount of a frame is the game's to
 * animate. Springs follow none, and hl_gpu_step refuses hair that follows one. Asks for memory at the first
 * amount above 0, and gives it back when all are 0, unless memory was reserved: at such a first amount poses
 * are laid, which docs/integrate.md has the time of. */
HL_API hl_code hl_instance_set_pose(hl_instance* instance, uint32_t pose, float amount, hl_error* error);
HL_API hl_code hl_instance_pose(const hl_instance* instance, uint32_t pose, float* amount, hl_error* error);

/* Memory ahead of time. hl_instance_make asks for what an instance holds, its first frames of new effects and
 * of more spheres for more. After this call no step, reset, change of level or read asks for any, whatever
 * head, bones and wind do, as long as frames have no more spheres, no more capsules than these, no more poses
 * inside, no setting is replaced, nothing is loaded, and no pose gets its first amount without `poses`. The
 * state stays. Takes as long as some frames at each level, and the memory of a copy meanwhile. Copies of the
 * instance have to be told again. */
typedef struct hl_reserve {
    size_t size;      /* sizeof(hl_reserve), set by hl_reserve_init() */
    uint32_t spheres; /* that hl_frame.spheres will have at most, up to 4096; 0: the asset's own */
    uint32_t previous_guides,
        previous_hairs; /* 1 where reads of guides, of hairs will ask for hl_read.previous */
    uint32_t inner;     /* poses that hl_frame.inner will have at most, up to 15; 0: none */
    /* 1: amounts of the asset's poses will change, so that hl_instance_set_pose asks for no memory either */
    uint32_t poses;
    uint32_t unused; /* 0 */
} hl_reserve;
HL_API void hl_reserve_init(hl_reserve* reserve);
HL_API hl_code hl_instance_reserve(hl_instance* instance, const hl_reserve* reserve, hl_error* error);

typedef struct hl_instance_info {
    uint32_t guides, guide_points;
    uint32_t hairs,
        points_per_hair; /* that hl_instance_read_hairs reads, all unless a level leaves some out */
    uint32_t asleep;     /* guides */
    uint32_t restored;   /* guides that the last step put back to rest because they were no numbers */
    uint32_t left_roots, left_spheres; /* of the last step that were not finite */
    size_t bytes;                      /* that the instance holds */
} hl_instance_info;
HL_API hl_code hl_instance_describe(const hl_instance* instance, hl_instance_info* info, hl_error* error);
/* First point of each guide, and the number of all points: guides + 1. */
HL_API hl_code hl_instance_offsets(const hl_instance* instance, uint32_t* offsets, size_t count,
                                   hl_error* error);
/* Of all positions and speeds: equal for any number of threads. */
HL_API uint64_t hl_instance_hash(const hl_instance* instance);

/* All that steps change, as bytes: an instance of the same asset, made with the same `what`, with the same
 * settings, runs on from them with the same bits. `data` may be null, with `bytes` 0; `written` says how many
 * there are, also where there is too little room. */
HL_API hl_code hl_instance_save(const hl_instance* instance, void* data, size_t bytes, size_t* written,
                                hl_error* error);
/* HL_DAMAGED where the bytes are of another asset or damaged. May ask for memory. */
HL_API hl_code hl_instance_load(hl_instance* instance, const void* data, size_t bytes, hl_error* error);

/* A steady clock, for hl_effect.milliseconds, from the next step on; it costs a little. Null: none. It is
 * asked from whatever threads the jobs run on. Copies ask it, too. */
HL_API hl_code hl_instance_time(hl_instance* instance, uint64_t (*nanoseconds)(void* user), void* user,
                                hl_error* error);
typedef struct hl_effect {
    const char* name; /* "collision"; the last is "strands", what every strand takes */
    uint32_t on;      /* in the last step */
    float milliseconds;
    char why[120]; /* "collision: off, no sphere within reach of a strand"; ends in 0 */
} hl_effect;
/* Of the last step, `effect` from 0 on; HL_BAD_VALUE: there are no more. Rods solve all forces in one, which
 * counts as strands. */
HL_API hl_code hl_instance_effect(const hl_instance* instance, uint32_t effect, hl_effect* out,
                                  hl_error* error);

/* Where a value of each point goes: at data, data + stride, ... Size and stride in bytes. Without data it is
 * left out. */
typedef struct hl_out {
    void* data;
    size_t bytes, stride;
} hl_out;
/* Guide after guide, or hair after hair, from root to tip: float[3] position, float[3] tangent of unit
 * length, float radius. HL_WRONG_SIZE where one does not fit; nothing is written then. */
HL_API hl_code hl_instance_read_guides(hl_instance* instance, hl_out positions, hl_out tangents, hl_out radii,
                                       hl_error* error);
HL_API hl_code hl_instance_read_hairs(hl_instance* instance, hl_out positions, hl_out tangents, hl_out radii,
                                      hl_error* error);

/* Which of hl_asset_hairs() each hair is that is read now, in their order: hl_instance_info.hairs of them. */
HL_API hl_code hl_instance_hair_numbers(const hl_instance* instance, uint32_t* numbers, size_t count,
                                        hl_error* error);

/* All that can be read, in one pass. */
enum {
    HL_FLOAT32 = 0,
    HL_FLOAT16 = 1, /* IEEE half; positions less `from`, since at 1.5 m a half is a millimetre */
    HL_NORM16 = 2   /* positions: 0 at `from` to 65535 at `to`; what lies outside is put onto the border.
                       Tangents: signed, -32767 for -1 to 32767 for 1. Radii: 65535 for a millimetre */
};
typedef struct hl_read {
    size_t size;    /* sizeof(hl_read), set by hl_read_init(), which sets all to 0 */
    uint32_t hairs; /* 1: follow hairs; 0: guides */
    uint32_t position_format, tangent_format, radius_format;
    hl_out positions, tangents,
        radii; /* as of hl_instance_read_hairs; 2 bytes a component of formats of 16 */
    /* Where the last read had them that asked for these, measured from the origin of now, in the format of
     * the positions: for motion vectors. Where they are now in the first, after a reset, and where another
     * number of hairs was read. Takes memory for all points at the first. */
    hl_out previous;
    float from[3], to[3]; /* metres, world, less hl_frame.origin: a box of the formats of 16 bits */
    /* In: what the last read into the same memory gave back, or 0. Where nothing has changed since, nothing
     * is written, and it stays as it is. */
    uint64_t state;
    /* Given back, also where nothing is to be written: */
    float bounds_min[3], bounds_max[3]; /* of all points that are finite; 0 where nothing has changed */
    uint32_t changed;                   /* 1 where something was written, or would have been */
    uint32_t outside;                   /* components of positions that HL_NORM16 put onto the border */
} hl_read;
HL_API void hl_read_init(hl_read* read);
HL_API hl_code hl_instance_read(hl_instance* instance, hl_read* read, hl_error* error);

/* --- Levels of detail and crowds --- */

/* From HL_LEVEL_FINEST, which is the hair as authored, over fewer guides, points and substeps to
 * HL_LEVEL_RIGID, which simulates nothing: hair goes with the head. Reads give all guides and points at every
 * level; those that are not simulated follow their neighbours. */
enum { HL_LEVEL_FINEST = 0, HL_LEVEL_RIGID = 4, HL_LEVEL_COUNT = 5 };

/* Errors are metres, measured on a nodding head and in wind. `error_…` is strict: root mean square over the
 * points of all guides, from where the finest level has them at the same time. `seen_…` is what an eye far
 * off can tell, the largest of three: how far outlines are apart, where each part of each layer hangs on the
 * mean, and how strongly hair moves at each rate (a rate at which a level is 3 dB off counts as four times
 * the motion there). Which strand swings a little earlier is not in it. The error of a frame is error_still +
 * error_head for each m/s of its roots + error_wind for each m/s of its wind, of the fastest in the last half
 * second, and `seen_…` likewise. */
typedef struct hl_level {
    uint32_t guides, points, substeps; /* simulated; substeps in 1/60 s */
    float error_still, error_head, error_wind;
    float milliseconds; /* of stepping and reading a frame of 1/60 s, with all hairs where the instance has
                           hairs; by counts and the rates of a machine of docs/integrate.md */
    /* Since 0.3; of older assets they are the strict ones: */
    float seen_still, seen_head, seen_wind;
} hl_level;
/* Bytes that HL_LEVELS adds to an instance, at most. */
HL_API hl_code hl_asset_levels_memory(const hl_asset* asset, size_t* bytes, hl_error* error);
HL_API hl_code hl_instance_level(const hl_instance* instance, uint32_t level, hl_level* out, hl_error* error);
/* From the next step on; what is read next is where it was, and goes over within half a second. Of an
 * instance with HL_LEVELS. `hair_share`, above 0 to 1: that share of each guide's follow hairs is read, one
 * at least, and as much wider as they are fewer. */
HL_API hl_code hl_instance_set_level(hl_instance* instance, uint32_t level, float hair_share,
                                     hl_error* error);

/* How fast this machine is, for hl_crowd_limits.speed: plays copies of the instance at each of its levels for
 * some frames, and compares what they take with what is predicted. Takes some tenths of a second;
 * `nanoseconds` is a steady clock. Ask it on a quiet machine. */
HL_API hl_code hl_rate(const hl_instance* instance, uint64_t (*nanoseconds)(void* user), void* user,
                       float* speed, hl_error* error);

typedef struct hl_crowd_limits {
    size_t size;        /* sizeof(hl_crowd_limits), set by hl_crowd_limits_init() */
    float error_pixels; /* no character is given more while the budget allows; 2 */
    float hair_pixels;  /* hairs are left out while those that stay are narrower; 0 leaves out none; 0.7 */
    float milliseconds; /* of all characters together, predicted; infinite: no budget */
    float speed;        /* of this machine, where 1 is that of hl_level.milliseconds; 1 */
    /* Since 0.3: */
    uint32_t strict; /* 1: error_pixels is of hl_level.error_…; 0: of hl_level.seen_… */
    uint32_t unused; /* 0 */
} hl_crowd_limits;
HL_API void hl_crowd_limits_init(hl_crowd_limits* limits);

typedef struct hl_viewed {
    hl_instance* hair;      /* with HL_LEVELS; each stands once in a crowd */
    float pixels_per_metre; /* on the screen, where the character stands; 0: not seen */
    /* What it is given: */
    uint32_t level;
    float error_pixels, milliseconds; /* predicted; no milliseconds while it sleeps */
} hl_viewed;

typedef struct hl_crowd_report {
    float error_pixels; /* greatest of all characters */
    float milliseconds; /* of all together */
    uint32_t within;    /* 1 where both limits are kept; 0 where the budget asked for larger errors, or even
                           rigid hair takes more than the budget */
} hl_crowd_report;

/* Once a frame, before the steps: gives every character the cheapest level whose predicted error in pixels is
 * within one limit for all, which is error_pixels or, where these levels take more than the budget, the
 * smallest that does not. By what the instances were given so far, their levels and `limits` alone, without a
 * clock: the same frames come to the same levels. Takes no memory. A character goes to a coarser level only
 * where that has a quarter of the limit to spare, so that it does not go to and fro. Before its first step
 * nobody knows how it will move: all levels but the finest count as a metre off. */
HL_API hl_code hl_crowd_plan(const hl_crowd_limits* limits, hl_viewed* characters, size_t count,
                             hl_crowd_report* report, hl_error* error);

/* --- Sizes --- */

/* The plain names tell the sizes that the caller was compiled with. Programs that were compiled before there
 * were sizes call functions of the plain names. Other languages call these. */
HL_API hl_code hl_asset_describe_sized(const hl_asset* asset, hl_asset_info* info, size_t size,
                                       hl_error* error);
HL_API hl_code hl_asset_bone_sized(const hl_asset* asset, uint32_t bone, hl_bone* out, size_t size,
                                   hl_error* error);
HL_API hl_code hl_asset_layer_sized(const hl_asset* asset, uint32_t layer, hl_layer* out, size_t size,
                                    hl_error* error);
HL_API hl_code hl_instance_describe_sized(const hl_instance* instance, hl_instance_info* info, size_t size,
                                          hl_error* error);
HL_API hl_code hl_instance_effect_sized(const hl_instance* instance, uint32_t effect, hl_effect* out,
                                        size_t size, hl_error* error);
HL_API hl_code hl_instance_level_sized(const hl_instance* instance, uint32_t level, hl_level* out,
                                       size_t size, hl_error* error);
/* `viewed_size` is from one character to the next. */
HL_API hl_code hl_crowd_plan_sized(const hl_crowd_limits* limits, hl_viewed* characters, size_t viewed_size,
                                   size_t count, hl_crowd_report* report, size_t report_size,
                                   hl_error* error);
#define hl_asset_describe(asset, info, error) \
    hl_asset_describe_sized((asset), (info), sizeof(hl_asset_info), (error))
#define hl_asset_bone(asset, bone, out, error) \
    hl_asset_bone_sized((asset), (bone), (out), sizeof(hl_bone), (error))
#define hl_asset_layer(asset, layer, out, error) \
    hl_asset_layer_sized((asset), (layer), (out), sizeof(hl_layer), (error))
#define hl_instance_describe(instance, info, error) \
    hl_instance_describe_sized((instance), (info), sizeof(hl_instance_info), (error))
#define hl_instance_effect(instance, effect, out, error) \
    hl_instance_effect_sized((instance), (effect), (out), sizeof(hl_effect), (error))
#define hl_instance_level(instance, level, out, error) \
    hl_instance_level_sized((instance), (level), (out), sizeof(hl_level), (error))
#define hl_crowd_plan(limits, characters, count, report, error)                       \
    hl_crowd_plan_sized((limits), (characters), sizeof(hl_viewed), (count), (report), \
                        sizeof(hl_crowd_report), (error))

#ifdef __cplusplus
}
#endif
#endif
