// SPDX-License-Identifier: MIT
#pragma once
// What samples/vulkan and samples/direct3d share: a file, a turning head, a camera, and how far hairs of the
// GPU are from those of the CPU. Nothing of a graphics API.

#include <hairloom/gpu.h>
#include <hairloom/hairloom.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

constexpr std::uint32_t kWidth = 640, kHeight = 640;

[[noreturn]] inline void fail(const std::string& words) {
    std::fprintf(stderr, "%s\n", words.c_str());
    std::exit(1);
}
inline void check(hl_code code, const hl_error& error) {
    if (code != HL_OK) fail(error.words);
}
/// At a multiple of 16 bytes, as assets want it.
struct alignas(16) Piece {
    unsigned char bytes[16];
};
inline std::vector<Piece> readFile(const std::string& name, std::size_t& size) {
    std::ifstream file(name, std::ios::binary | std::ios::ate);
    if (!file) fail(name + ": cannot be read");
    size = static_cast<std::size_t>(file.tellg());
    std::vector<Piece> pieces(size / sizeof(Piece) + 1);
    file.seekg(0);
    file.read(reinterpret_cast<char*>(pieces.data()), static_cast<std::streamsize>(size));
    return pieces;
}

struct Options {
    std::string asset, shaders;
    const char* image = nullptr;
    int frames = 60;
    float share = 1;
    bool comparing = false, checking = false, onGpu = false, shading = false;
};
inline Options optionsOf(int count, char** words) {
    if (count < 3)
        fail(std::string(count > 0 ? words[0] : "gpu_hair") +
             " ASSET SHADERS [-o IMAGE] [--frames N] [--gpu] [--shade] [--share S] [--compare] [--check]");
    Options options;
    options.asset = words[1];
    options.shaders = words[2];
    for (int i = 3; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--compare")
            options.comparing = true;
        else if (word == "--check")
            options.comparing = options.checking = true;
        else if (word == "--gpu")
            options.onGpu = true;
        else if (word == "--shade")
            options.shading = true;
        else if (word == "-o" && i + 1 < count)
            options.image = words[++i];
        else if (word == "--share" && i + 1 < count)
            options.share = std::strtof(words[++i], nullptr);
        else if (word == "--frames" && i + 1 < count)
            options.frames = std::max(0, std::atoi(words[++i]));
        else
            fail(word + ": not known");
    }
    if (options.onGpu && options.frames == 0) fail("--frames 0 is for guides on the CPU");
    return options;
}

/// Whether a pass runs: guides on the GPU, and one of two ways to draw.
inline bool runs(std::uint32_t pass, const Options& options) {
    if (pass == HL_GPU_PASS_GUIDES) return options.onGpu;
    if (pass < HL_GPU_PASS_RIBBONS) return true;
    return (pass == HL_GPU_PASS_RIBBONS) != options.shading;
}

/// A head that turns to and fro in wind, one frame after the other.
struct Turning {
    float head[12], wind[3] = {2, 0, 1};
    hairloom::game::Frame frame;

    explicit Turning(int number) {
        const float turn = 0.3f * std::sin(0.1f * static_cast<float>(number)), c = std::cos(turn),
                    s = std::sin(turn);
        const float rows[12] = {c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0};
        std::copy(std::begin(rows), std::end(rows), head);
        frame.time = number / 60.0;
        frame.head = head;
        frame.wind = wind;
        if (number == 0) frame.dt = 0;
    }
    Turning(const Turning&) = delete;
    Turning& operator=(const Turning&) = delete;
};

/// Looks at the hair from the front; depth from 0. `up`: 1 where clip space has y upwards, as Direct3D's, -1
/// where downwards, as Vulkan's. A lamp shines from where that of `view` does.
inline void look(const hl_asset_info& asset, float up, hl_gpu_view& view, hl_gpu_lamp& lamp) {
    std::array<float, 3> centre{};
    float size = 0, squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        centre[c] = 0.5f * (asset.bounds_min[c] + asset.bounds_max[c]);
        const float side = asset.bounds_max[c] - asset.bounds_min[c];
        size = std::max(size, side);
        squares += side * side;
    }
    const float away = 2 * size, f = 2.2f, nearest = 0.05f, farthest = 2 * away + 1;
    const float z = farthest / (nearest - farthest), y = up * f;
    const std::array<float, 3> eye{centre[0], centre[1], centre[2] + away};
    const float matrix[16] = {
        f, 0, 0, 0, 0, y, 0, 0, 0, 0, z, -1, -f * eye[0], -y * eye[1], z * nearest - z * eye[2], eye[2]};
    std::copy_n(matrix, 16, view.clip_from_world);
    std::copy_n(eye.begin(), 3, view.eye);
    view.pixel_size = 2 / (f * kHeight);
    hl_error error{};
    check(hl_gpu_lamp_init(view.to_light, centre.data(), 0.55f * std::sqrt(squares), &lamp, &error), error);
    std::fill_n(lamp.light, 3, 2.0f);
    std::printf("seen from %.6f %.6f %.6f towards %.6f %.6f %.6f\n", eye[0], eye[1], eye[2], centre[0],
                centre[1], centre[2]);
}

/// The same hair on the CPU, to compare with, and for nothing else.
class Comparison {
  public:
    /// `numbers`: the buffer NUMBERS, `count` of them. `hairs`: that the device makes.
    Comparison(const hairloom::game::Asset& asset, float share, const std::uint32_t* numbers,
               std::size_t count, std::uint32_t hairs)
        : slots_(hairs) {
        hl_error error{};
        if (!onCpu_.make(asset, HL_HAIRS | HL_LEVELS, nullptr, &error) ||
            !onCpu_.setLevel(HL_LEVEL_FINEST, share, &error))
            fail(error.words);
        // Where the device has each of the hairs that the CPU reads: it makes those first that stay longest.
        std::vector<std::uint32_t> read(hairs), slotOf(count, ~0u);
        check(hl_instance_hair_numbers(onCpu_.get(), read.data(), read.size(), &error), error);
        for (std::uint32_t slot = 0; slot < hairs; ++slot) slotOf[numbers[slot]] = slot;
        for (std::uint32_t hair = 0; hair < hairs; ++hair) {
            slots_[hair] = slotOf[read[hair]];
            if (slots_[hair] == ~0u) fail("the device makes other hairs than the CPU reads");
        }
    }
    /// `made`: the buffer POINTS after the same frame.
    void step(const hl_frame& frame, const float* made) {
        hl_error error{};
        check(hl_instance_step(onCpu_.get(), &frame, &error), error);
        if (!onCpu_.readHairs(expected_, &error)) fail(error.words);
        double sum = 0;
        const std::size_t points = expected_.size() / 3, ofHair = points / slots_.size();
        for (std::size_t p = 0; p < points; ++p) {
            const std::size_t there = slots_[p / ofHair] * ofHair + p % ofHair;
            double squared = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double apart =
                    static_cast<double>(made[4 * there + c]) - static_cast<double>(expected_[3 * p + c]);
                squared += apart * apart;
            }
            farthest_ = std::max(farthest_, rootOf(squared));
            sum += squared;
        }
        squares_ = std::max(squares_, rootOf(sum / static_cast<double>(points)));
    }
    /// Says how far hairs were from those of the CPU, in metres. 1 where they were to be checked and that is
    /// more than docs/gpu-simulation.md lets them be: guides of the GPU leave contacts to other sides, one by
    /// one.
    int say(const Options& options) const {
        std::printf("apart from the CPU's: %.3g m at most, %.3g m root mean square\n", farthest_, squares_);
        if (!options.checking) return 0;
        const bool good = options.onGpu ? squares_ < 2e-4 : farthest_ < 1e-5;
        const char* const limit = options.onGpu ? "0.0002 m root mean square" : "0.00001 m";
        std::printf("%s %s\n", good ? "as expected, within" : "too far: expected at most", limit);
        return good ? 0 : 1;
    }

  private:
    /// What is no number is the farthest of all.
    static double rootOf(double squared) { return std::isfinite(squared) ? std::sqrt(squared) : HUGE_VAL; }

    hairloom::game::Instance onCpu_;
    std::vector<std::uint32_t> slots_;
    std::vector<float> expected_;
    double farthest_ = 0, squares_ = 0;
};

/// `pixels`: rows of four bytes a pixel, `pitch` bytes from row to row.
inline void writeImage(const char* name, const void* pixels, std::size_t pitch) {
    std::ofstream file(name, std::ios::binary);
    file << "P6\n" << kWidth << ' ' << kHeight << "\n255\n";
    const auto* const at = static_cast<const char*>(pixels);
    for (std::size_t y = 0; y < kHeight; ++y) {
        for (std::size_t x = 0; x < kWidth; ++x) file.write(at + y * pitch + 4 * x, 3);
    }
    if (!file.flush()) fail(std::string(name) + ": cannot be written");
}
