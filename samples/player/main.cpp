// SPDX-License-Identifier: MIT
// Plays a runtime asset without a window, by the installed package alone: a nodding head in wind, a crowd.
//   player ASSET [--frames N] [--crowd N] [--budget MS] [--resting] [--wind M/S] [--hairs]

#include <hairloom/hairloom.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

struct Options {
    const char* file = nullptr;
    int frames = 120, crowd = 0;
    bool resting = false, hairs = false;
    float wind = 3, budget = 0;
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
    const float y = pivot[1] - c * pivot[1] + s * pivot[2], z = pivot[2] - s * pivot[1] - c * pivot[2];
    const float rows[12] = {1, 0, 0, 0, 0, c, -s, y, 0, s, c, z};
    std::copy(std::begin(rows), std::end(rows), head);
}

/// One character for `frames` frames; false where the library refuses something.
bool play(hairloom::game::Instance& hair, const hl_asset_info& asset, const Options& options,
          hl_error& error) {
    std::vector<float> points;
    const float pivot[3] = {0, asset.bounds_max[1], 0}, wind[3] = {options.wind, 0, 0};
    double step = 0, read = 0, sum = 0;
    for (int f = 1; f <= options.frames; ++f) {
        float head[12];
        hairloom::game::Frame frame;
        frame.time = f / 60.0;
        frame.head = head;
        frame.wind = wind;
        nod(frame.time, pivot, head);
        auto begin = Clock::now();
        if (!hair.step(frame, &error)) return false;
        step += millisecondsSince(begin);
        begin = Clock::now();
        if (!(options.hairs ? hair.readHairs(points, &error) : hair.readGuides(points, &error))) return false;
        read += millisecondsSince(begin);
    }
    for (const float value : points) sum += static_cast<double>(value);
    std::printf("state %016llx, mean coordinate %.6f m\nstep %.3f ms, read-out %.3f ms per frame\n",
                static_cast<unsigned long long>(hair.hash()), sum / static_cast<double>(points.size()),
                step / options.frames, read / options.frames);
    return std::isfinite(sum);
}

std::uint64_t nanoseconds(void*) {
    return static_cast<std::uint64_t>(Clock::now().time_since_epoch().count());
}

/// Rows of ten, each at its own time of the nod, or at rest; levels within two pixels and the budget.
bool playCrowd(const hairloom::game::Asset& asset, const hl_asset_info& info, const Options& options,
               hl_error& error) {
    std::vector<hairloom::game::Instance> hairs(static_cast<std::size_t>(options.crowd));
    hairloom::game::Crowd crowd;
    if (options.budget > 0) crowd.limits.milliseconds = options.budget;
    std::size_t bytes = 0;
    for (hairloom::game::Instance& hair : hairs) {
        if (!(&hair == &hairs[0] ? hair.make(asset, HL_GUIDES | HL_LEVELS, nullptr, &error)
                                 : hair.copy(hairs[0], &error)))
            return false;
        bytes += hair.describe().bytes;
        if (options.resting && !hair.set("windSpeed", 0, &error)) return false;
        crowd.add(hair);
    }
    const float pivot[3] = {0, info.bounds_max[1], 0};
    const int before = options.resting ? 600 : 0;  // until they sleep
    double measured = 0, planned = 0, predicted = 0;
    std::map<std::string, double> cost;
    int timedFrames = 0, levels[HL_LEVEL_COUNT] = {};
    for (int f = 1; f <= before + options.frames; ++f) {
        // A clock around every stage makes steps longer: it runs in every eighth frame, which does not count.
        const bool counts = f > before, timed = counts && f % 8 == 0;
        timedFrames += timed;
        for (std::size_t i = 0; i < hairs.size(); ++i) {
            hl_instance_time(hairs[i].get(), timed ? nanoseconds : nullptr, nullptr, nullptr);
            crowd.characters[i].pixels_per_metre =  // 1080 lines of 40 degrees, from 1 m on
                1480 / (1 + 1.5f * static_cast<float>(i / 10) + 0.002f * static_cast<float>(f));
        }
        auto begin = Clock::now();
        if (!crowd.plan(&error)) return false;
        planned += counts ? millisecondsSince(begin) : 0;
        predicted += counts ? static_cast<double>(crowd.report.milliseconds) : 0;
        begin = Clock::now();
        for (std::size_t i = 0; i < hairs.size(); ++i) {
            float head[12];
            hairloom::game::Frame frame;
            frame.time = f / 60.0;
            frame.head = head;
            frame.origin[0] = 2 * static_cast<double>(i);  // numbers stay small wherever a character stands
            nod(options.resting ? 0 : frame.time + 0.1 * static_cast<double>(i), pivot, head);
            if (!hairs[i].step(frame, &error)) return false;
        }
        if (counts && !timed) measured += millisecondsSince(begin);
        for (std::uint32_t e = 0; timed && hairs[0].describeEffect(e).name; ++e)
            for (const hairloom::game::Instance& hair : hairs)
                cost[hair.describeEffect(e).name] += static_cast<double>(hair.describeEffect(e).milliseconds);
    }
    unsigned long long asleep = 0, guides = 0, state = 0;
    for (const hairloom::game::Instance& hair : hairs) {
        asleep += hair.describe().asleep, guides += hair.describe().guides;
        state = state * 31 + hair.hash();
    }
    for (const hl_viewed& character : crowd.characters) ++levels[character.level];
    std::printf("crowd of %d %s: plan %.4f ms, steps %.4f ms per frame, %.3f predicted, %.1f KB each\n",
                options.crowd, options.resting ? "at rest" : "nodding", planned / options.frames,
                measured / std::max(options.frames - timedFrames, 1), predicted / options.frames,
                static_cast<double>(bytes) / 1e3 / options.crowd);
    std::printf(
        "%llu of %llu guides asleep, %d %d %d %d %d at levels 0 to 4, error %.2f pixels, state %016llx\n",
        asleep, guides, levels[0], levels[1], levels[2], levels[3], levels[4],
        static_cast<double>(crowd.report.error_pixels), state);
    for (const auto& [name, milliseconds] : cost)
        std::printf("  %-20s %.4f ms per frame\n", name.c_str(), milliseconds / std::max(timedFrames, 1));
    return true;
}

bool parse(int count, char** words, Options& options) {
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto number = [&](const char* name, auto& value) {
            if (word != name || i + 1 >= count) return false;
            value = static_cast<std::decay_t<decltype(value)>>(std::atof(words[++i]));
            return true;
        };
        if (word == "--resting" || word == "--hairs")
            (word == "--hairs" ? options.hairs : options.resting) = true;
        else if (!options.file && word.rfind("--", 0) != 0)
            options.file = words[i];
        else if (!number("--frames", options.frames) && !number("--crowd", options.crowd) &&
                 !number("--wind", options.wind) && !number("--budget", options.budget))
            return false;
    }
    return options.file && options.frames > 0 && options.frames <= 100000 && options.crowd >= 0 &&
           options.crowd <= 10000;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    if (!parse(count, words, options)) {
        std::fputs("player ASSET [--frames N] [--crowd N] [--budget MS] [--resting] [--wind M/S] [--hairs]\n",
                   stderr);
        return 2;
    }
    std::size_t size = 0;
    const std::vector<Piece> file = readFile(options.file, size);
    hairloom::game::Error error;
    hairloom::game::Asset asset;
    hairloom::game::Instance hair;
    const auto begin = Clock::now();
    bool good = asset.open(file.data(), size, &error) && asset.check(&error) &&
                hair.make(asset, options.hairs ? HL_HAIRS : HL_GUIDES, nullptr, &error);
    if (good) {
        const hl_asset_info info = asset.describe();
        std::printf("%u guides of %u points, %u follow hairs; opened and made in %.3f ms, %.1f KB\n",
                    info.guides, info.guide_points, info.hairs, millisecondsSince(begin),
                    static_cast<double>(hair.describe().bytes) / 1e3);
        good = play(hair, info, options, error) &&
               (options.crowd == 0 || playCrowd(asset, info, options, error));
    }
    if (good) return 0;
    std::fprintf(stderr, "error: %s: %s\n", options.file, error.words);
    return 1;
}
