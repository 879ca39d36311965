// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the golden pictures, shows each beside the accepted one, and accepts new ones.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/base/file.h"
#include "core/render/png.h"
#include "tests/golden/golden_pictures.h"
#include "tests/gpu/test_backend.h"

namespace hairloom::golden {
namespace {

struct Options {
    std::string output = "out/golden";
    std::vector<std::string> accept;
    std::vector<std::string> only;
};

struct Verdict {
    std::string name;
    bool isNew = false;
    bool accepted = false;
    double flip = 0;
    double largest = 0;

    bool passes() const { return accepted || (!isNew && flip < kTolerance); }
    std::string words() const {
        const std::string difference =
            isNew ? "no accepted picture" : fmt::format("FLIP {:.4f}, largest {:.3f}", flip, largest);
        const char* const result = accepted ? "accepted" : isNew ? "NEW" : passes() ? "same" : "CHANGED";
        return fmt::format("{}: {}", difference, result);
    }
};

bool named(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::any_of(names, [&](const std::string& n) { return n == "all" || n == name; });
}

render::Image sideBySide(const std::vector<render::Image>& images) {
    render::Image row{0, images.front().height, {}};
    for (const render::Image& image : images) row.width += image.width;
    for (std::uint32_t y = 0; y < row.height; ++y) {
        for (const render::Image& image : images) {
            const auto from = image.rgba.begin() + std::ptrdiff_t{4} * image.width * y;
            row.rgba.insert(row.rgba.end(), from, from + std::ptrdiff_t{4} * image.width);
        }
    }
    return row;
}

Result<Verdict> review(const Options& options, const Case& which, Painter& painter) {
    const auto drawn = painter.draw(which);
    if (!drawn) return tl::unexpected(drawn.error());
    Verdict verdict;
    verdict.name = which.name;
    std::vector<render::Image> shown{*drawn};
    if (const auto before = acceptedPicture(which)) {
        const auto difference = render::flipDifference(*before, *drawn);
        if (!difference) return tl::unexpected(difference.error());
        verdict.flip = difference->mean;
        verdict.largest = difference->largest;
        shown = {*before, *drawn, difference->map};
    } else {
        verdict.isNew = true;
    }
    const auto sheet = std::filesystem::path(options.output) / (which.name + ".png");
    if (auto status = render::writePng(sheet, sideBySide(shown)); !status)
        return tl::unexpected(status.error());
    if (named(options.accept, which.name)) {
        if (auto status = render::writePng(pathOf(which), *drawn); !status)
            return tl::unexpected(status.error());
        verdict.accepted = true;
    }
    return verdict;
}

/// Those that have changed come first.
std::string pageOf(std::vector<Verdict> verdicts) {
    std::stable_partition(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return !v.passes(); });
    std::string rows;
    for (const Verdict& v : verdicts) {
        rows += fmt::format("<p{}>{}, {}<br><img src=\"{}.png\">\n", v.passes() ? "" : " class=other", v.name,
                            v.words(), v.name);
    }
    return "<!doctype html><meta charset=utf-8><title>Golden pictures</title>"
           "<style>body{font:14px sans-serif;background:#222;color:#ddd}.other{background:#522}"
           "img{image-rendering:pixelated;zoom:2}</style><p>Accepted, now, difference (FLIP)\n" +
           rows;
}

Result<bool> reviewAll(const Options& options) {
    std::error_code code;
    std::filesystem::create_directories(options.output, code);
    const auto device = gpu::createDevice(gpu::testDevice());
    if (!device) return tl::unexpected(device.error());
    Painter painter(**device);
    std::vector<Verdict> verdicts;
    for (const Case& which : cases()) {
        const bool asked = options.only.empty() ? options.accept.empty() || named(options.accept, which.name)
                                                : named(options.only, which.name);
        if (!asked) continue;
        auto verdict = review(options, which, painter);
        if (!verdict) return tl::unexpected(verdict.error());
        fmt::print("{:<28} {}\n", verdict->name, verdict->words());
        verdicts.push_back(std::move(*verdict));
    }
    if (verdicts.empty()) return fail("no golden picture has that name");
    const auto page = std::filesystem::path(options.output) / "index.html";
    if (auto status = writeFileAtomically(page, std::string_view(pageOf(verdicts))); !status)
        return tl::unexpected(status.error());
    fmt::print("{} shows them side by side\n", page.string());
    return std::ranges::all_of(verdicts, &Verdict::passes);
}

}  // namespace
}  // namespace hairloom::golden

int main(int argc, char** argv) {
    CLI::App app(
        "Draws the golden pictures of tests/golden, compares them with the accepted ones, and accepts new "
        "ones. HAIRLOOM_TEST_BACKEND chooses the graphics API: vulkan or d3d11");
    hairloom::golden::Options options;
    app.add_option("-o,--output", options.output, "Folder for the sheets and index.html");
    app.add_option("--accept", options.accept, "Pictures to put in place of the accepted ones; all for all");
    app.add_option("names", options.only, "Pictures to draw; all where none is named");
    CLI11_PARSE(app, argc, argv);
    const auto result = hairloom::golden::reviewAll(options);
    if (!result) {
        fmt::print(stderr, "error: {}\n", result.error().message());
        return 1;
    }
    return *result ? 0 : 1;
}
