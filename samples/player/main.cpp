// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a runtime asset without a window: a nodding head in wind, then a crowd. Written against the installed
// package alone; what a game does is in play().
//   player ASSET [--frames N] [--crowd N] [--resting] [--wind METRES_PER_SECOND] [--hairs]

#include <hairloom/hairloom.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace {

struct Options {
    const char* file = nullptr;
    int frames = 120;
    int crowd = 0;
    bool resting = false;
    bool hairs = false;
    float wind = 3;
};

using Clock = std::chrono::steady_clock;
double millisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// At a multiple of 16 bytes, as assets want it.
struct alignas(16) Piece {
    unsigned char bytes[16];
};
std::vector<Piece> readFile(const char* name, std::size_t& size) {
    std::ifstream file(name, std::ios::binary | std::ios::ate);
    size = file ? static_cast<std::size_t>(file.tellg()) : 0;
    std::vector<Piece> pieces(size / sizeof(Piece) + 1);
    file.seekg(0);
    file.read(reinterpret_cast<char*>(pieces.data()), static_cast<std::streamsize>(size));
    return pieces;
}

/// Three rows of four: nods by 20 degrees about an axis through the ears, at `pivot`; begins at rest.
void nod(double time, const float pivot[3], float head[12]) {
    const double rise = std::min(time * 2.5, 1.0), degree = std::acos(-1.0) / 180;
    const double angle = 20 * degree * rise * rise * (3 - 2 * rise) * std::sin(2.5 * 180 * degree * time);
    const float c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    const float rows[12] = {1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0};
    std::memcpy(head, rows, sizeof rows);
    head[7] = pivot[1] - c * pivot[1] + s * pivot[2];
    head[11] = pivot[2] - s * pivot[1] - c * pivot[2];
}

struct Times {
    double step = 0, read = 0;
};

/// One character for `frames` frames; false where the library refuses something.
bool play(hairloom::game::Instance& hair, const hl_asset_info& asset, const Options& options, Times& times,
          hl_error& error) {
    std::vector<float> points;
    const float pivot[3] = {0, asset.bounds_max[1], 0};
    const float wind[3] = {options.wind, 0, 0};
    for (int f = 1; f <= options.frames; ++f) {
        float head[12];
        hairloom::game::Frame frame;
        frame.time = f / 60.0;
        frame.head = head;
        frame.wind = wind;
        nod(frame.time, pivot, head);
        auto begin = Clock::now();
        if (!hair.step(frame, &error)) return false;
        times.step += millisecondsSince(begin);
        begin = Clock::now();
        if (!(options.hairs ? hair.readHairs(points, &error) : hair.readGuides(points, &error))) return false;
        times.read += millisecondsSince(begin);
    }
    double sum = 0;
    for (const float value : points) sum += static_cast<double>(value);
    std::printf("state %016llx, mean coordinate %.6f m\n", static_cast<unsigned long long>(hair.hash()),
                sum / static_cast<double>(points.size()));
    return std::isfinite(sum);
}

/// Characters side by side, each at its own time of the nod, or all at rest until their hair sleeps.
bool playCrowd(const hairloom::game::Asset& asset, const hl_asset_info& info, const Options& options,
               hl_error& error) {
    std::vector<hairloom::game::Instance> crowd(static_cast<std::size_t>(options.crowd));
    std::size_t bytes = 0;
    for (hairloom::game::Instance& hair : crowd) {
        if (!(&hair == &crowd[0] ? hair.make(asset, HL_GUIDES, nullptr, &error)
                                 : hair.copy(crowd[0], &error)))
            return false;
        bytes += hair.describe().bytes;
        if (options.resting && !hair.set("windSpeed", 0, &error)) return false;
    }
    const float pivot[3] = {0, info.bounds_max[1], 0};
    const int before = options.resting ? 300 : 0;
    double measured = 0;
    for (int f = 1; f <= before + options.frames; ++f) {
        const auto begin = Clock::now();
        for (std::size_t i = 0; i < crowd.size(); ++i) {
            float head[12];
            hairloom::game::Frame frame;
            frame.time = f / 60.0;
            frame.head = head;
            frame.origin[0] = 2 * static_cast<double>(i);  // numbers stay small wherever a character stands
            nod(options.resting ? 0 : frame.time + 0.1 * static_cast<double>(i), pivot, head);
            if (!crowd[i].step(frame, &error)) return false;
        }
        if (f > before) measured += millisecondsSince(begin);
    }
    std::size_t asleep = 0, guides = 0;
    for (const hairloom::game::Instance& hair : crowd) {
        asleep += hair.describe().asleep;
        guides += hair.describe().guides;
    }
    std::printf("crowd of %d %s: %.4f ms a frame, %.1f KB a character, %zu of %zu guides asleep\n",
                options.crowd, options.resting ? "at rest" : "nodding", measured / options.frames,
                static_cast<double>(bytes) / 1e3 / static_cast<double>(options.crowd), asleep, guides);
    return true;
}

bool parse(int count, char** words, Options& options) {
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const bool more = i + 1 < count;
        if (word == "--resting")
            options.resting = true;
        else if (word == "--hairs")
            options.hairs = true;
        else if (word == "--frames" && more)
            options.frames = std::atoi(words[++i]);
        else if (word == "--crowd" && more)
            options.crowd = std::atoi(words[++i]);
        else if (word == "--wind" && more)
            options.wind = static_cast<float>(std::atof(words[++i]));
        else if (!options.file && word.rfind("--", 0) != 0)
            options.file = words[i];
        else
            return false;
    }
    return options.file && options.frames > 0 && options.frames <= 100000 && options.crowd >= 0 &&
           options.crowd <= 10000;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    if (!parse(count, words, options)) {
        std::fprintf(
            stderr,
            "player ASSET [--frames N] [--crowd N] [--resting] [--wind METRES_PER_SECOND] [--hairs]\n");
        return 2;
    }
    std::size_t size = 0;
    const std::vector<Piece> file = readFile(options.file, size);
    hairloom::game::Error error;
    hairloom::game::Asset asset;
    hairloom::game::Instance hair;
    auto begin = Clock::now();
    bool good = asset.open(file.data(), size, &error);
    const double opened = millisecondsSince(begin);
    begin = Clock::now();
    good = good && asset.check(&error);
    const double checked = millisecondsSince(begin);
    begin = Clock::now();
    good = good && hair.make(asset, options.hairs ? HL_HAIRS : HL_GUIDES, nullptr, &error);
    const double made = millisecondsSince(begin);
    Times times;
    if (good) {
        const hl_asset_info info = asset.describe();
        std::printf(
            "%u guides of %u points, %u follow hairs; opened in %.3f ms, checked in %.2f ms, made in %.1f "
            "ms\n",
            info.guides, info.guide_points, info.hairs, opened, checked, made);
        std::printf("memory %.1f KB, at most %.1f KB\n", static_cast<double>(hair.describe().bytes) / 1e3,
                    static_cast<double>(info.guides_memory + (options.hairs ? info.hairs_memory : 0)) / 1e3);
        good = play(hair, info, options, times, error);
        if (good)
            std::printf("step %.3f ms, read-out %.3f ms a frame\n", times.step / options.frames,
                        times.read / options.frames);
        if (good && options.crowd > 0) good = playCrowd(asset, info, options, error);
    }
    if (good) return 0;
    std::fprintf(stderr, "error: %s: %s\n", options.file, error.words);
    return 1;
}
