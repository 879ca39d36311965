// SPDX-License-Identifier: GPL-3.0-or-later
// Plays an asset as a page does, by the C interface of the native engine:
//   native_positions ASSET MATRICES WIND_X WIND_Y WIND_Z OUT
// MATRICES has twelve floats a frame; OUT gets the guides' positions of the last, then those of its hairs.

#include <hairloom/hairloom.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

std::vector<char> readFile(const char* name) {
    std::ifstream file(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void append(std::ofstream& file, const std::vector<float>& values) {
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
}

struct alignas(16) Piece {
    unsigned char bytes[16];
};

}  // namespace

int main(int count, char** words) {
    if (count != 7) return 2;
    const std::vector<char> bytes = readFile(words[1]), matrices = readFile(words[2]);
    std::vector<Piece> aligned(bytes.size() / sizeof(Piece) + 1);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(aligned.data()));
    const float wind[3] = {std::strtof(words[3], nullptr), std::strtof(words[4], nullptr),
                           std::strtof(words[5], nullptr)};
    hairloom::game::Error error;
    hairloom::game::Asset asset;
    hairloom::game::Instance hair;
    bool good =
        asset.open(aligned.data(), bytes.size(), &error) && hair.make(asset, HL_HAIRS, nullptr, &error);
    const float* head = reinterpret_cast<const float*>(matrices.data());
    const std::size_t frames = matrices.size() / (12 * sizeof(float));
    for (std::size_t f = 0; good && f < frames; ++f) {
        hairloom::game::Frame frame;
        frame.dt = static_cast<float>(1.0 / 60);
        frame.time = static_cast<double>(f + 1) * (1.0 / 60);
        frame.head = head + 12 * f;
        frame.wind = wind;
        good = hair.step(frame, &error);
    }
    std::vector<float> guides, hairs;
    good = good && hair.readGuides(guides, &error) && hair.readHairs(hairs, &error);
    if (!good) {
        std::fprintf(stderr, "error: %s: %s\n", words[1], error.words);
        return 1;
    }
    std::ofstream out(words[6], std::ios::binary);
    append(out, guides);
    append(out, hairs);
    return out.good() ? 0 : 1;
}
