/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plays an asset for 300 frames and says what it comes to, in one line: a head that nods, jumps and rests until hair
 * sleeps, wind, every level of detail, hairs read in each format. Built with other compilers and flags it has to
 * say the same.
 *   play ASSET */
#ifdef SINGLE_HEADER
#include "hairloom_single.h"
#else
#include <hairloom/gpu.h>
#include <hairloom/hairloom.h>
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int refused(const char* what, const hl_error* error) {
    fprintf(stderr, "%s: %s\n", what, error->words);
    return 1;
}

static uint64_t fold(uint64_t hash, const void* data, size_t bytes) {
    const unsigned char* at = data;
    size_t i;
    for (i = 0; i < bytes; ++i) hash = (hash ^ at[i]) * 1099511628211ull;
    return hash;
}

/* Sine and cosine of whole numbers of a small step, by products alone: libraries and compilers differ in sin(). */
static void turn(int steps, float* c, float* s) {
    const double c1 = 0.99875026039496628, s1 = 0.049979169270678331;
    double x = 1, y = 0;
    int i;
    for (i = 0; i < (steps < 0 ? -steps : steps); ++i) {
        volatile double xx = x * c1, ys = y * s1, xs = x * s1, yc = y * c1;
        x = xx - ys;
        y = xs + yc;
    }
    *c = (float)x;
    *s = (float)(steps < 0 ? -y : y);
}

static void place(int frame, float head[12]) {
    const int nod = frame < 60 ? frame % 20 - 10 : frame < 200 ? 0 : frame % 16 - 8;
    const int jumps = (frame >= 40) + (frame >= 90) + (frame >= 210) + (frame >= 260);
    float c, s, cy, sy;
    turn(nod, &c, &s);
    turn(9 * jumps, &cy, &sy);
    head[0] = cy, head[1] = 0, head[2] = sy, head[3] = 3.0f * (float)jumps;
    head[4] = 0, head[5] = c, head[6] = -s, head[7] = 0.25f * (float)jumps;
    head[8] = -sy, head[9] = 0, head[10] = cy, head[11] = 0;
    if (jumps == 0) {
        /* Nods on an untwisted neck; afterwards it is turned, and does not nod. */
        head[0] = 1, head[2] = 0, head[8] = 0, head[9] = s, head[10] = c;
    } else {
        head[5] = 1, head[6] = 0;
    }
}

int main(int count, char** words) {
    hl_error error;
    hl_asset asset;
    hl_asset_info info;
    hl_instance *hair, *second;
    hl_build build;
    FILE* file = count > 1 ? fopen(words[1], "rb") : NULL;
    size_t size, points, saved;
    char *block, *bytes;
    float *values, head[12], wind[3] = {3, 0, 1}, calm[3] = {0, 0, 0};
    uint64_t digest = 1469598103934665603ull, state = 0, slept = 0;
    double quick = 0.02, soon = 0.1;
    int f;
    if (!file) return 2;
    fseek(file, 0, SEEK_END);
    size = (size_t)ftell(file);
    rewind(file);
    block = malloc(size + 16);
    bytes = block + (16 - (size_t)block % 16) % 16;
    if (fread(bytes, 1, size, file) != size) return 2;
    fclose(file);
    build.size = sizeof build;
    if (hl_build_info(&build, &error)) return refused("build", &error);
    if (hl_version() != HL_VERSION || build.version != HL_VERSION) return 3;
    if (hl_asset_open(&asset, bytes, size, &error)) return refused("open", &error);
    if (hl_asset_check(&asset, &error)) return refused("check", &error);
    if (hl_asset_describe(&asset, &info, &error)) return refused("describe", &error);
    if (hl_instance_make(&asset, HL_HAIRS | HL_LEVELS, NULL, &hair, &error)) return refused("make", &error);
    points = info.hairs ? (size_t)info.hairs * info.points_per_hair : info.guide_points;
    if (hl_instance_set(hair, "sleepSpeed", &quick, 1, &error)) return refused("set", &error);
    if (hl_instance_set(hair, "sleepDelay", &soon, 1, &error)) return refused("set", &error);
    values = malloc(points * 7 * sizeof(float));
    for (f = 0; f < 300; ++f) {
        hl_frame frame;
        hl_read read;
        hl_instance_info now;
        hl_frame_init(&frame);
        place(f, head);
        frame.head = head;
        frame.time = f / 60.0;
        frame.wind = f < 100 || f >= 200 ? wind : calm;
        frame.origin[0] = f >= 150 ? 1000 : 0;
        if (f % 50 == 49 && hl_instance_set_level(hair, (uint32_t)(f / 50) % HL_LEVEL_COUNT, 1, &error))
            return refused("level", &error);
        if (hl_instance_step(hair, &frame, &error)) return refused("step", &error);
        if (hl_instance_describe(hair, &now, &error)) return refused("describe", &error);
        slept += now.asleep;
        hl_read_init(&read);
        read.hairs = now.hairs > 0;
        read.position_format = (uint32_t)f % 3;
        read.tangent_format = (uint32_t)f / 3 % 3;
        read.positions.data = values;
        read.positions.bytes = points * 12;
        read.positions.stride = read.position_format ? 6 : 12;
        read.tangents.data = values + points * 3;
        read.tangents.bytes = points * 12;
        read.tangents.stride = 12;
        read.radii.data = values + points * 6;
        read.radii.bytes = points * 4;
        read.radii.stride = 4;
        read.from[0] = -20, read.from[1] = -20, read.from[2] = -20;
        read.to[0] = 20, read.to[1] = 20, read.to[2] = 20;
        memset(values, 0, points * 7 * sizeof(float));
        if (hl_instance_read(hair, &read, &error)) return refused("read", &error);
        digest = fold(digest, values, points * 7 * sizeof(float));
        digest = fold(digest, read.bounds_min, 24);
        state = state * 31 + hl_instance_hash(hair);
    }
    /* A saved instance runs on with the same bits. */
    if (hl_instance_save(hair, NULL, 0, &saved, &error)) return refused("save", &error);
    free(block);
    block = malloc(saved);
    if (hl_instance_save(hair, block, saved, &saved, &error)) return refused("save", &error);
    if (hl_instance_copy(hair, &second, &error)) return refused("copy", &error);
    for (f = 300; f < 340; ++f) {
        hl_frame frame;
        hl_frame_init(&frame);
        place(f, head);
        frame.head = head;
        frame.time = f / 60.0;
        frame.wind = wind;
        if (f == 320 && hl_instance_load(second, block, saved, &error)) return refused("load", &error);
        if (f < 320 && hl_instance_step(hair, &frame, &error)) return refused("step", &error);
        place(f - (f >= 320 ? 20 : 0), head);
        frame.time = (f - (f >= 320 ? 20 : 0)) / 60.0;
        if (hl_instance_step(second, &frame, &error)) return refused("step", &error);
    }
    if (hl_instance_hash(hair) != hl_instance_hash(second)) {
        fprintf(stderr, "a saved instance comes to another state\n");
        return 4;
    }
    printf("fused %u state %016llx shown %016llx slept %llu\n", build.fused, (unsigned long long)state,
           (unsigned long long)digest, (unsigned long long)slept);
    fprintf(stderr, "%u.%u.%u %s, %u lanes, %s%s\n", build.version / 1000000, build.version / 1000 % 1000,
            build.version % 1000, build.instruction_set, build.lanes, build.compiler,
            build.single_header ? ", single header" : "");
    hl_instance_free(hair);
    hl_instance_free(second);
    free(values);
    free(block);
    return 0;
}
