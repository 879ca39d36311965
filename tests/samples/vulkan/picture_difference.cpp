// SPDX-License-Identifier: GPL-3.0-or-later
// picture_difference OURS.exr GAMES.ppm BLOCK: how far a game's picture (sRGB) is from ours (linear light),
// both made smaller by so many pixels: FLIP, and the light of the hair by ours. Pixels without hair are black
// in both.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "core/render/exr.h"
#include "core/render/flip.h"

namespace {

using hairloom::render::Image;
using hairloom::render::LinearImage;

float toLinear(float srgb) {
    return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}
float toSrgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

LinearImage readPpm(const char* name) {
    std::ifstream file(name, std::ios::binary);
    std::string magic;
    int most = 0;
    LinearImage image;
    file >> magic >> image.width >> image.height >> most;
    file.get();
    std::vector<unsigned char> rgb(std::size_t{3} * image.width * image.height);
    file.read(reinterpret_cast<char*>(rgb.data()), static_cast<std::streamsize>(rgb.size()));
    if (magic != "P6" || most != 255 || !file) {
        std::fprintf(stderr, "%s: no PPM\n", name);
        std::exit(2);
    }
    for (std::size_t i = 0; i < rgb.size(); ++i) {
        image.rgba.push_back(toLinear(static_cast<float>(rgb[i]) / 255));
        if (i % 3 == 2) image.rgba.push_back(1);
    }
    return image;
}

/// Means of blocks of pixels.
LinearImage smaller(const LinearImage& image, std::uint32_t block) {
    LinearImage result{image.width / block, image.height / block, {}};
    for (std::uint32_t y = 0; y < result.height; ++y) {
        for (std::uint32_t x = 0; x < result.width; ++x) {
            for (std::uint32_t c = 0; c < 4; ++c) {
                float sum = 0;
                for (std::uint32_t v = 0; v < block; ++v) {
                    for (std::uint32_t u = 0; u < block; ++u)
                        sum += image.rgba[4 * (std::size_t{y * block + v} * image.width + x * block + u) + c];
                }
                result.rgba.push_back(sum / static_cast<float>(block * block));
            }
        }
    }
    return result;
}

Image shown(const LinearImage& linear) {
    Image image{linear.width, linear.height, {}};
    for (const float value : linear.rgba) {
        const float bounded = std::fmin(std::fmax(value, 0.0f), 1.0f);
        image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * toSrgb(bounded))));
    }
    return image;
}

double lightOf(const LinearImage& image) {
    double sum = 0;
    for (std::size_t p = 0; p < image.rgba.size(); p += 4) {
        for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(image.rgba[p + c]);
    }
    return sum;
}

}  // namespace

int main(int count, char** words) {
    if (count != 4) return 2;
    const auto ours = hairloom::render::readExr(words[1]);
    if (!ours) {
        std::fprintf(stderr, "%s\n", ours.error().message().c_str());
        return 2;
    }
    const LinearImage games = readPpm(words[2]);
    if (ours->width != games.width || ours->height != games.height) {
        std::fprintf(stderr, "pictures of other sizes\n");
        return 2;
    }
    const auto block = static_cast<std::uint32_t>(std::atoi(words[3]));
    const LinearImage a = smaller(*ours, block), b = smaller(games, block);
    const auto difference = hairloom::render::flipDifference(shown(a), shown(b));
    if (!difference) return 2;
    std::printf("FLIP %.4f, light %.4f of ours\n", difference->mean, lightOf(b) / lightOf(a));
    return 0;
}
