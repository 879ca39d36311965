/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The listings of docs/integrate.md as they stand there, each with what a game has around it: they compile, and
 * do what the page says. A GPU is stood in for by memory.
 *   listings ASSET ASSET_WITH_CLIP */
#include <hairloom/gpu.h>
#include <hairloom/hairloom.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static hl_error error;
static void check(int good, const char* what) {
    if (good) return;
    fprintf(stderr, "%s: %s\n", what, error.words);
    exit(1);
}

static hl_asset open_file(const char* name) {
    FILE* const file = fopen(name, "rb");
    hl_asset asset;
    char* block;
    size_t size;
    check(file != NULL, name);
    fseek(file, 0, SEEK_END);
    size = (size_t)ftell(file);
    rewind(file);
    block = malloc(size + 16); /* stays: clips and tables lie in it */
    block += (16 - (size_t)block % 16) % 16;
    check(fread(block, 1, size, file) == size, name);
    fclose(file);
    check(hl_asset_open(&asset, block, size, &error) == HL_OK, name);
    return asset;
}

typedef struct vertex {
    uint16_t at[3], before[3];
} vertex;
static int uploads;
static void upload(void) {
    ++uploads;
}

static void reads(hl_instance* hair, size_t points, const float box_min[3], const float box_max[3]) {
    const size_t bytes = points * sizeof(vertex);
    vertex* const vertices = calloc(points, sizeof(vertex));
    uint64_t seen = 0;
    int i;
    for (i = 0; i < 3; ++i) {
#include "listing_2.inc"
        check(read.outside == 0, "points are outside of their own bounds");
    }
    check(uploads == 1, "hair at rest was read more than once");
    check(memcmp(vertices[points - 1].at, vertices[points - 1].before, sizeof vertices->at) == 0, "it moves");
    free(vertices);
}

static void recorded(hl_instance* hair, hl_asset asset, hl_out positions) {
    const hl_out none = {NULL, 0, 0};
    const float* const at = positions.data;
    float first;
    hl_frame frame;
    hl_frame_init(&frame);
    frame.dt = 0.25f;
    check(hl_instance_read_hairs(hair, positions, none, none, &error) == HL_OK, "read");
    first = at[positions.bytes / sizeof(float) - 1];
    {
#include "listing_3.inc"
        check(error.code == HL_OK && clip.frames == 40, "the clip does not play");
    }
    check(at[positions.bytes / sizeof(float) - 1] != first, "the clip does not move");
}

static void* mapped[HL_GPU_BUFFER_COUNT];
static size_t made;
static void make_buffer(uint32_t buffer, size_t bytes, uint32_t element) {
    check(bytes % element == 0, "a buffer of no whole number of elements");
    mapped[buffer] = calloc(1, bytes);
    made += bytes;
}

static void on_gpu(hl_instance* hair, hl_asset asset) {
    hl_gpu_buffer_info info[HL_GPU_BUFFER_COUNT];
    hl_gpu_pass_info pass[HL_GPU_PASS_COUNT];
    const float to_light[3] = {1, 1, 0}, head_centre[3] = {0, 1.6f, 0};
    uint32_t b, p;
    hl_frame frame;
    hl_frame_init(&frame);
    frame.dt = 1.0f / 60;
    memset(info, 0, sizeof info);
    memset(pass, 0, sizeof pass);
#include "listing_4.inc"
    check(error.code == HL_OK, "the GPU is given a frame");
    check(view.hairs > 0 && memcmp(mapped[HL_GPU_BUFFER_VIEW], &view, sizeof view) == 0, "the view");
#include "listing_5.inc"
    check(error.code == HL_OK && ((float*)mapped[HL_GPU_BUFFER_LAMP])[16] == 3, "the lamp");
    check(pass[HL_GPU_PASS_HAIRS].groups[0] > 0 && ((float*)mapped[HL_GPU_BUFFER_ROOTS_TO])[3] <= 1, "passes");
    printf("%u buffers of %lu bytes\n", (unsigned)HL_GPU_BUFFER_COUNT, (unsigned long)made);
}

static int seen(size_t c) {
    return c != 0;
}
static float distance(size_t c) {
    return 2.0f * (float)c;
}

static void crowd(hl_instance* first) {
    enum { count = 3 };
    hl_instance* hair[count];
    hl_viewed characters[count];
    hl_crowd_report report;
    const float screen_height = 1080, fov_y = 0.8f;
    size_t c;
    for (c = 0; c < count; ++c) check(hl_instance_copy(first, &hair[c], &error) == HL_OK, "copy");
#include "listing_6.inc"
    check(error.code == HL_OK && report.within == 1, "the crowd is within its budget");
    check(characters[0].level == HL_LEVEL_RIGID, "who is not seen is rigid");
    for (c = 0; c < count; ++c) hl_instance_free(hair[c]);
}

int main(int count, char** words) {
    hl_asset asset, with_clip;
    hl_asset_info info;
    hl_instance *hair, *played;
    size_t points;
    hl_out positions;
    hl_read box;
    if (count != 3) return 2;
    asset = open_file(words[1]);
    with_clip = open_file(words[2]);
    check(hl_asset_describe(&asset, &info, &error) == HL_OK, "describe");
    check(hl_instance_make(&asset, HL_HAIRS | HL_LEVELS, NULL, &hair, &error) == HL_OK, "make");
    check(hl_instance_make(&with_clip, HL_HAIRS, NULL, &played, &error) == HL_OK, "make");
    points = (size_t)info.hairs * info.points_per_hair;
    positions.bytes = points * 3 * sizeof(float);
    positions.stride = 3 * sizeof(float);
    positions.data = malloc(positions.bytes);
    hl_read_init(&box);
    box.hairs = 1;
    check(hl_instance_read(hair, &box, &error) == HL_OK, "bounds");
    reads(hair, points, box.bounds_min, box.bounds_max);
    recorded(played, with_clip, positions);
    on_gpu(hair, asset);
    crowd(hair);
    hl_instance_free(hair);
    hl_instance_free(played);
    free(positions.data);
    printf("all listings run\n");
    return 0;
}
