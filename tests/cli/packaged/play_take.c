/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plays the clip of a take by the installed library, and compares its guides with what the take holds: a
 * record of frames (docs/formats/frames.md), of which a second one has the head at rest. The head is placed
 * by its matrix, which three of its vertices give. Roots stay on the skin, and the take has them rounded.
 *   play_take ASSET FRAMES REST */
#include <hairloom/hairloom.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Metres: what is lost where a head is placed by vertices in 32 bits, 2 m from the origin. */
static const double kFloatError = 2e-6;

typedef struct Record {
    char* bytes;
    uint64_t frames, points, vertices, stride;
    size_t first; /* byte of the first frame */
    float rate;
} Record;

static void end(const char* what, const char* words) {
    fprintf(stderr, "%s: %s\n", what, words);
    exit(1);
}

/* At a multiple of 16 bytes, as assets want it. */
static char* readFile(const char* name, size_t* size) {
    FILE* file = fopen(name, "rb");
    char* block;
    if (!file) end(name, "cannot be read");
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    block = malloc(*size + 16);
    if (!block) end(name, "is too large");
    block += (16 - (size_t)block % 16) % 16;
    if (fread(block, 1, *size, file) != *size) end(name, "cannot be read");
    fclose(file);
    return block;
}

static Record readRecord(const char* name) {
    Record record;
    size_t size;
    uint32_t version;
    uint64_t counts[5] = {0, 0, 0, 0, 0}; /* frames, points, vertices, spheres, bones */
    record.bytes = readFile(name, &size);
    if (size < 56 || memcmp(record.bytes, "HLFRAMES", 8) != 0) end(name, "is no record of frames");
    memcpy(&version, record.bytes + 8, 4);
    memcpy(&record.rate, record.bytes + 12, 4);
    record.first = version == 2 ? 56 : 48;
    memcpy(counts, record.bytes + 16, record.first - 16);
    record.frames = counts[0], record.points = counts[1], record.vertices = counts[2];
    record.stride = 8 + 12 * (counts[1] + counts[2] + counts[3] + 4 * counts[4]);
    if (record.frames == 0 || record.vertices < 3 || record.first + record.frames * record.stride != size)
        end(name, "has no frames of a head, or is damaged");
    return record;
}

/* A vector of a frame: its points, then its vertices. */
static void vectorOf(const Record* record, uint64_t frame, uint64_t number, double out[3]) {
    float values[3];
    memcpy(values, record->bytes + record->first + frame * record->stride + 8 + 12 * number, sizeof values);
    out[0] = values[0], out[1] = values[1], out[2] = values[2];
}

static double distance(const double a[3], const double b[3]) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static double lengthOfCross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
    return sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
}

/* Columns of a right-handed frame on three vertices, and their first as its origin. */
static void frameOn(const Record* record, uint64_t number, const uint64_t on[3], double axes[3][3],
                    double origin[3]) {
    double b[3], c[3], length;
    int i;
    vectorOf(record, number, record->points + on[0], origin);
    vectorOf(record, number, record->points + on[1], b);
    vectorOf(record, number, record->points + on[2], c);
    length = distance(origin, b);
    for (i = 0; i < 3; ++i) {
        axes[0][i] = (b[i] - origin[i]) / length;
        c[i] -= origin[i];
    }
    length = lengthOfCross(axes[0], c, axes[2]);
    for (i = 0; i < 3; ++i) axes[2][i] /= length;
    lengthOfCross(axes[2], axes[0], axes[1]);
}

/* Three vertices far from one another, for a frame that their rounding turns little. */
static void chooseVertices(const Record* rest, uint64_t on[3]) {
    double a[3], b[3], at[3], cross[3], best = 0;
    uint64_t v;
    int i;
    on[0] = on[1] = on[2] = 0;
    vectorOf(rest, 0, rest->points, a);
    for (v = 1; v < rest->vertices; ++v) {
        vectorOf(rest, 0, rest->points + v, at);
        if (distance(a, at) > best) best = distance(a, at), on[1] = v;
    }
    vectorOf(rest, 0, rest->points + on[1], b);
    for (i = 0; i < 3; ++i) b[i] -= a[i];
    best = 0;
    for (v = 1; v < rest->vertices; ++v) {
        vectorOf(rest, 0, rest->points + v, at);
        for (i = 0; i < 3; ++i) at[i] -= a[i];
        if (lengthOfCross(b, at, cross) > best) best = lengthOfCross(b, at, cross), on[2] = v;
    }
    if (on[1] == 0 || on[2] == 0) end("head", "its vertices lie on a line");
}

/* Three rows of four: from the head at rest to that of a frame. */
static void headOf(const Record* take, const Record* rest, uint64_t number, const uint64_t on[3],
                   double head[12]) {
    double now[3][3], then[3][3], to[3], from[3];
    int row, column, k;
    frameOn(take, number, on, now, to);
    frameOn(rest, 0, on, then, from);
    for (row = 0; row < 3; ++row) {
        head[4 * row + 3] = to[row];
        for (column = 0; column < 3; ++column) {
            head[4 * row + column] = 0;
            for (k = 0; k < 3; ++k) head[4 * row + column] += now[k][row] * then[k][column];
            head[4 * row + 3] -= head[4 * row + column] * from[column];
        }
    }
}

/* Where the matrix puts a point, or back from there: it is rigid. */
static void place(const double head[12], const double in[3], double out[3]) {
    int row;
    for (row = 0; row < 3; ++row)
        out[row] =
            head[4 * row] * in[0] + head[4 * row + 1] * in[1] + head[4 * row + 2] * in[2] + head[4 * row + 3];
}
static void placeBack(const double head[12], const double in[3], double out[3]) {
    int row, k;
    for (row = 0; row < 3; ++row) {
        out[row] = 0;
        for (k = 0; k < 3; ++k) out[row] += head[4 * k + row] * (in[k] - head[4 * k + 3]);
    }
}

int main(int count, char** words) {
    hl_error error;
    hl_asset asset;
    hl_asset_info info;
    hl_instance* hair;
    hl_clip clip;
    Record take, rest;
    uint64_t on[3], i, p;
    size_t size;
    char* bytes;
    float* points;
    uint32_t* offsets;
    double headFirst[12], farthest = 0, rootsOff = 0, headMoves = 0, hairMoves = 0;
    if (count != 4) return 2;
    take = readRecord(words[2]);
    rest = readRecord(words[3]);
    if (rest.vertices != take.vertices || rest.points != take.points) end(words[3], "is of another head");
    bytes = readFile(words[1], &size);
    if (hl_asset_open(&asset, bytes, size, &error) || hl_asset_check(&asset, &error) ||
        hl_asset_describe(&asset, &info, &error) || hl_instance_make(&asset, HL_GUIDES, NULL, &hair, &error))
        end(words[1], error.words);
    clip.size = sizeof clip;
    if (hl_asset_clip(&asset, &clip, &error)) end(words[1], error.words);
    if (clip.frames != take.frames || clip.frames_per_second != take.rate || !clip.loops ||
        info.guide_points != take.points)
        end(words[1], "its clip is not the take");
    chooseVertices(&rest, on);
    headOf(&take, &rest, 0, on, headFirst);
    points = malloc(sizeof(float) * 3 * (size_t)take.points);
    offsets = malloc(sizeof(uint32_t) * ((size_t)info.guides + 1));
    if (!points || !offsets) end(words[2], "is too large");
    if (hl_instance_offsets(hair, offsets, (size_t)info.guides + 1, &error)) end(words[1], error.words);
    /* Each frame, between frames, and in an order that jumps; the second round is behind the clip's end. */
    for (i = 0; i < 2 * take.frames; ++i) {
        const uint64_t before = (i * 7) % take.frames, after = (before + 1) % take.frames;
        const double share = i % 3 == 2 ? 0.5 : 0;
        double head[12], next[12];
        float matrix[12];
        hl_out out;
        hl_out nothing = {NULL, 0, 0};
        hl_frame frame;
        hl_play play;
        uint64_t guide;
        int k;
        headOf(&take, &rest, before, on, head);
        headOf(&take, &rest, after, on, next);
        for (k = 0; k < 12; ++k) matrix[k] = (float)head[k];
        hl_frame_init(&frame);
        frame.head = matrix;
        hl_play_init(&play);
        play.time = ((double)before + share) / (double)take.rate;
        if (i >= take.frames) play.time += (double)take.frames / (double)take.rate;
        out.data = points, out.bytes = sizeof(float) * 3 * (size_t)take.points, out.stride = 12;
        if (hl_instance_play(hair, &asset, &frame, &play, &error) ||
            hl_instance_read_guides(hair, out, nothing, nothing, &error))
            end("play", error.words);
        for (p = 0, guide = 0; p < take.points; ++p) {
            double at[3], then[3], expected[3], first[3], is[3];
            if (p == offsets[guide]) {
                ++guide;
                vectorOf(&rest, 0, p, at);
                place(head, at, expected);
                for (k = 0; k < 3; ++k) is[k] = points[3 * p + (uint64_t)k];
                if (!(distance(is, expected) <= rootsOff)) rootsOff = distance(is, expected);
                continue;
            }
            vectorOf(&take, before, p, is);
            placeBack(head, is, at);
            vectorOf(&take, after, p, is);
            placeBack(next, is, then);
            for (k = 0; k < 3; ++k) then[k] = (1 - share) * at[k] + share * then[k];
            place(head, then, expected);
            for (k = 0; k < 3; ++k) is[k] = points[3 * p + (uint64_t)k];
            if (!(distance(is, expected) <= farthest)) farthest = distance(is, expected);
            /* How far the head takes this point, and how far the hair goes on the head. */
            if (distance(then, expected) > headMoves) headMoves = distance(then, expected);
            vectorOf(&take, 0, p, is);
            placeBack(headFirst, is, first);
            if (distance(first, at) > hairMoves) hairMoves = distance(first, at);
        }
    }
    printf("%u frames of %u guides: %.4f mm from the take, %.4f mm stated; roots %.5f mm from the skin\n",
           clip.frames, info.guides, 1e3 * farthest, 1e3 * (double)clip.largest_error, 1e3 * rootsOff);
    printf("the head moves %.1f mm, hair on it %.1f mm\n", 1e3 * headMoves, 1e3 * hairMoves);
    if (!(farthest <= (double)clip.largest_error + kFloatError)) end("play", "is not the take");
    if (!(rootsOff <= (double)info.greatest_error + kFloatError)) end("play", "roots have left the skin");
    if (!(headMoves > 0.01 && hairMoves > 0.001)) end(words[2], "does not move, so nothing was compared");
    hl_instance_free(hair);
    return 0;
}
