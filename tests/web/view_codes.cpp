// SPDX-License-Identifier: GPL-3.0-or-later
// Light as a view of a colour config shows it, by OpenColorIO alone.
//   view_codes CONFIG DISPLAY VIEW LIGHT CODES
// LIGHT: floats, linear Rec. 709, three a pixel. CODES: bytes, three a pixel.
#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

int main(int count, char** arguments) {
    namespace ocio = OCIO_NAMESPACE;
    if (count != 6) return std::fputs("view_codes CONFIG DISPLAY VIEW LIGHT CODES\n", stderr), 2;
    std::ifstream in(arguments[4], std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
    std::vector<float> light(bytes.size() / sizeof(float));
    std::copy_n(bytes.data(), light.size() * sizeof(float), reinterpret_cast<char*>(light.data()));
    try {
        const auto config = ocio::Config::CreateFromFile(arguments[1]);
        const auto view =
            config->getProcessor("lin_rec709", arguments[2], arguments[3], ocio::TRANSFORM_DIR_FORWARD)
                ->getDefaultCPUProcessor();
        std::ofstream out(arguments[5], std::ios::binary);
        for (std::size_t i = 0; i + 2 < light.size(); i += 3) {
            view->applyRGB(&light[i]);
            for (std::size_t c = 0; c < 3; ++c)
                out.put(static_cast<char>(std::lround(255 * std::clamp(light[i + c], 0.0f, 1.0f))));
        }
        return out.flush() ? 0 : 1;
    } catch (const std::exception& problem) {
        return std::fprintf(stderr, "%s\n", problem.what()), 1;
    }
}
