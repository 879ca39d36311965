// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-window shows one of the sample hairstyles turning in the wind.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "core/documents/sample.h"
#include "samples/window/show.h"

namespace hairloom::window {
namespace {

struct Options {
    std::string style = "shoulder";
    std::string backend;
    std::string engine = "auto";
    Size size{720, 720};
    float wind = 4;
    bool guides = false;
    std::uint64_t pictures = 0;
    float hold = 0;
};

Result<Groom> sample(const std::string& style, const std::filesystem::path& programFolder) {
    const auto samples = findSamples(programFolder);
    if (samples.empty()) return fail("the samples folder was not found", "HAIRLOOM_SAMPLES");
    return makeSample(samples, style);
}

/// Says now and then how many pictures have been shown.
void say(std::uint64_t pictures, double seconds) {
    fmt::print("{} images, {:.1f} per second\n", pictures, static_cast<double>(pictures) / seconds);
    std::fflush(stdout);
}

Status show(const Options& options, const std::filesystem::path& programFolder) {
    static const std::map<std::string, gpu::Backend> kBackends{{"vulkan", gpu::Backend::Vulkan},
                                                               {"d3d11", gpu::Backend::Direct3D11}};
    auto groom = sample(options.style, programFolder);
    if (!groom) return tl::unexpected(groom.error());
    if (options.guides) groom->interpolation.followPerGuide = 0;
    gpu::DeviceOptions wanted;
    if (!options.backend.empty()) wanted.backend = kBackends.at(options.backend);
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    const gpu::DeviceInfo& info = (*device)->info();
    const std::string title = fmt::format("Hairloom: {}, {}", options.style, gpu::toString(info.backend));
    const auto window = Window::open(title, options.size);
    if (!window) return tl::unexpected(window.error());
    const auto wish = std::ranges::find(engineWishNames(), options.engine) - engineWishNames().begin();
    const auto made = Show::make(**device, **window, *groom, options.wind, static_cast<EngineWish>(wish));
    if (!made) return tl::unexpected(made.error());
    fmt::print("{} on {}\n", gpu::toString(info.backend), info.name);
    fmt::print("simulated on the {}: {}\n", (*made)->engine().kind == EngineKind::gpu ? "GPU" : "CPU",
               (*made)->engine().why);
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t shown = 1; (*window)->handleEvents(); ++shown) {
        if (auto status = (*made)->showNext(); !status) return status;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        if (shown % 10 == 0) say(shown, elapsed.count());
        if (shown == options.pictures) break;
    }
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(static_cast<int>(1000 * options.hold));
    while ((*window)->handleEvents() && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return {};
}

int run(int argc, char** argv) {
    Options options;
    CLI::App program("Shows a sample hairstyle turning in the wind.", "hairloom-window");
    program.allow_windows_style_options(false);
    program.add_option("style", options.style, "Name of a file in samples/hairstyles, without extension");
    program.add_option("--backend", options.backend, "Graphics API (default: that of the system)")
        ->check(CLI::IsMember({"vulkan", "d3d11"}));
    program
        .add_option("--engine", options.engine,
                    "Device that simulates: the CPU, the GPU, or the one that was measured to be faster")
        ->check(CLI::IsMember({"auto", "gpu", "cpu"}));
    program.add_option("--width", options.size.width, "Pixels")->check(CLI::Range(64, 8192));
    program.add_option("--height", options.size.height, "Pixels")->check(CLI::Range(64, 8192));
    program.add_option("--wind", options.wind, "Wind speed in metres per second")->check(CLI::Range(0, 50));
    program.add_flag("--guides", options.guides,
                     "Draw only the guides, which is faster on a software device");
    program.add_option("--pictures", options.pictures,
                       "Number of frames, or 0 to run until you close the window");
    program.add_option("--hold", options.hold, "Seconds to show the last image")->check(CLI::Range(0, 3600));
    CLI11_PARSE(program, argc, argv);
    const auto folder = std::filesystem::path(argv[0]).parent_path();
    if (const auto status = show(options, folder); !status) {
        fmt::print(stderr, "error: {}\n", status.error().message());
        return 1;
    }
    return 0;
}

}  // namespace
}  // namespace hairloom::window

int main(int argc, char** argv) {
    return hairloom::window::run(argc, argv);
}
