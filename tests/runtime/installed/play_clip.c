/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plays the clip of an asset, frame by frame, on the head of a record of frames (docs/formats/frames.md), and says how far
 * guides are from where the record has them. Fails where that is more than the asset says.
 *   play_clip ASSET FRAMES */
#include <hairloom/hairloom.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int refused(const char* what, const hl_error* error) {
    fprintf(stderr, "%s: %s\n", what, error->words);
    return 1;
}

/* All of a file, at a multiple of 16. */
static char* file_of(const char* name, size_t* size) {
    FILE* file = fopen(name, "rb");
    char *block, *bytes;
    if (!file) exit(2);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    block = malloc(*size + 16);
    bytes = block + (16 - (size_t)block % 16) % 16;
    if (fread(bytes, 1, *size, file) != *size) exit(2);
    fclose(file);
    return bytes;
}

static uint64_t number_at(const char* bytes, size_t at) {
    uint64_t value;
    memcpy(&value, bytes + at, sizeof value);
    return value;
}

static double apart(const float* a, const float* b) {
    const double x = (double)a[0] - b[0], y = (double)a[1] - b[1], z = (double)a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

int main(int count, char** words) {
    hl_error error;
    hl_asset asset;
    hl_asset_info info;
    hl_clip clip;
    hl_instance *hair, *shown;
    hl_frame frame;
    hl_play play;
    size_t size, recorded, header, frame_bytes, i, g, f;
    char *bytes, *record;
    uint32_t *sources, *offsets;
    float *values, *scalp, *before;
    hl_out out, none = {NULL, 0, 0};
    uint64_t points, vertices, spheres, bones = 0;
    double largest = 0, between = 0, moved = 0;
    if (count < 3) return 2;
    bytes = file_of(words[1], &size);
    record = file_of(words[2], &recorded);
    if (hl_asset_open(&asset, bytes, size, &error)) return refused("open", &error);
    if (hl_asset_check(&asset, &error)) return refused("check", &error);
    if (hl_asset_describe(&asset, &info, &error)) return refused("describe", &error);
    clip.size = sizeof clip;
    if (hl_asset_clip(&asset, &clip, &error)) return refused("clip", &error);
    if (hl_instance_make(&asset, HL_GUIDES, NULL, &hair, &error)) return refused("make", &error);
    header = (uint32_t)number_at(record, 8) == 2 ? 56 : 48;
    if (header == 56) bones = number_at(record, 48);
    points = number_at(record, 24);
    vertices = number_at(record, 32);
    spheres = number_at(record, 40);
    frame_bytes = (size_t)(8 + 12 * (points + vertices + spheres + 4 * bones));
    if (clip.frames == 0 || number_at(record, 16) != clip.frames || points != info.guide_points ||
        recorded != header + clip.frames * frame_bytes) {
        fprintf(stderr, "the record is of another clip\n");
        return 3;
    }
    sources = malloc(info.scalp_vertices * sizeof *sources);
    offsets = malloc((info.guides + 1) * sizeof *offsets);
    scalp = malloc(info.scalp_vertices * 3 * sizeof(float));
    values = malloc(points * 3 * sizeof(float));
    before = malloc(points * 3 * sizeof(float));
    out.data = values;
    out.bytes = points * 3 * sizeof(float);
    out.stride = 3 * sizeof(float);
    if (hl_asset_scalp_sources(&asset, sources, info.scalp_vertices, &error)) return refused("sources", &error);
    if (hl_instance_offsets(hair, offsets, info.guides + 1, &error)) return refused("offsets", &error);
    hl_play_init(&play);
    hl_frame_init(&frame);
    frame.scalp = scalp;
    frame.scalp_count = info.scalp_vertices;
    for (f = 0; f < clip.frames; ++f) {
        const float* now = (const float*)(record + header + f * frame_bytes + 8);
        for (i = 0; i < info.scalp_vertices; ++i)
            memcpy(scalp + 3 * i, now + 3 * (points + sources[i]), 3 * sizeof(float));
        play.time = (double)f / clip.frames_per_second;
        if (hl_instance_play(hair, &asset, &frame, &play, &error)) return refused("play", &error);
        if (hl_instance_read_guides(hair, out, none, none, &error)) return refused("read", &error);
        for (g = 0; g < info.guides; ++g) {
            for (i = offsets[g] + 1; i < offsets[g + 1]; ++i) {
                const double off = apart(values + 3 * i, now + 3 * i);
                if (!(off <= largest)) largest = off;
            }
        }
    }
    /* Halfway between the last two frames, on the last one's head, by another instance that jumps there. */
    if (hl_instance_make(&asset, HL_GUIDES, NULL, &shown, &error)) return refused("make", &error);
    memcpy(before, values, out.bytes);
    play.time = (clip.frames - 2.0) / clip.frames_per_second;
    if (hl_instance_play(shown, &asset, &frame, &play, &error)) return refused("play", &error);
    out.data = values;
    if (hl_instance_read_guides(shown, out, none, none, &error)) return refused("read", &error);
    for (i = 0; i < 3 * points; ++i) before[i] = 0.5f * (before[i] + values[i]);
    play.time = (clip.frames - 1.5) / clip.frames_per_second;
    if (hl_instance_play(shown, &asset, &frame, &play, &error)) return refused("play", &error);
    if (hl_instance_read_guides(shown, out, none, none, &error)) return refused("read", &error);
    for (i = 0; i < points; ++i) between = fmax(between, apart(values + 3 * i, before + 3 * i));
    /* The simulation goes on from there. */
    memcpy(before, values, out.bytes);
    if (hl_instance_step(shown, &frame, &error)) return refused("step", &error);
    if (hl_instance_read_guides(shown, out, none, none, &error)) return refused("read", &error);
    for (i = 0; i < points; ++i) moved = fmax(moved, apart(values + 3 * i, before + 3 * i));
    printf("clip %.*s of %u frames at %g a second, %s: error %.4f mm, stated %.4f mm, between frames %.4f mm, a step "
           "%.1f mm\n",
           (int)clip.name_bytes, clip.name, clip.frames, clip.frames_per_second, clip.loops ? "loops" : "ends",
           1e3 * largest, 1e3 * clip.largest_error, 1e3 * between, 1e3 * moved);
    hl_instance_free(hair);
    hl_instance_free(shown);
    return largest <= clip.largest_error && between < 1e-5 && moved < 0.1 ? 0 : 4;
}
