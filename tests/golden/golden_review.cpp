// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the golden pictures, shows what has changed side by side, and accepts new ones.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/base/file.h"
#include "core/render/png.h"
#include "tests/golden/golden_pictures.h"

namespace hairloom::golden {
namespace {

struct Options {
    std::string output = "out/golden";
    std::string backend = "any";
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
};

bool named(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::any_of(names, [&](const std::string& n) { return n == "all" || n == name; });
}

Result<Verdict> review(const Options& options, const Case& which, Painter& painter) {
    const auto drawn = painter.draw(which);
    if (!drawn) return tl::unexpected(drawn.error());
    const std::filesystem::path folder = options.output;
    const auto put = [&](const std::string& suffix, const render::Image& image) {
        return render::writePng(folder / (which.name + suffix + ".png"), image);
    };
    Verdict verdict;
    verdict.name = which.name;
    if (auto status = put("", *drawn); !status) return tl::unexpected(status.error());
    if (const auto before = acceptedPicture(which)) {
        const auto difference = render::flipDifference(*before, *drawn);
        if (!difference) return tl::unexpected(difference.error());
        verdict.flip = difference->mean;
        verdict.largest = difference->largest;
        if (auto status = put("-accepted", *before); !status) return tl::unexpected(status.error());
        if (auto status = put("-difference", difference->map); !status) return tl::unexpected(status.error());
    } else {
        verdict.isNew = true;
    }
    if (named(options.accept, which.name)) {
        if (auto status = render::writePng(pathOf(which), *drawn); !status)
            return tl::unexpected(status.error());
        verdict.accepted = true;
    }
    return verdict;
}

std::string pageOf(const std::vector<Verdict>& verdicts) {
    std::string rows;
    for (const Verdict& v : verdicts) {
        const auto picture = [&](const std::string& suffix) {
            return v.isNew && !suffix.empty()
                       ? std::string("none")
                       : fmt::format("<img src=\"{}{}.png\" width=320>", v.name, suffix);
        };
        rows += fmt::format("<tr class={}><td>{}<br>FLIP {:.4f}<br>largest {:.3f}<td>{}<td>{}<td>{}\n",
                            v.passes() ? "same" : "other", v.name, v.flip, v.largest, picture("-accepted"),
                            picture(""), picture("-difference"));
    }
    return "<!doctype html><meta charset=utf-8><title>Golden pictures</title><style>body{font:14px "
           "sans-serif;background:#222;color:#ddd}.other td{background:#522}img{image-rendering:pixelated}"
           "td{padding:4px;vertical-align:top}</"
           "style><table><tr><th>picture<th>accepted<th>now<th>difference\n" +
           rows + "</table>\n";
}

Result<bool> reviewAll(const Options& options) {
    std::error_code code;
    std::filesystem::create_directories(options.output, code);
    gpu::DeviceOptions wanted;
    if (options.backend == "vulkan") wanted.backend = gpu::Backend::Vulkan;
    if (options.backend == "d3d11") wanted.backend = gpu::Backend::Direct3D11;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    Painter painter(**device);
    std::vector<Verdict> verdicts;
    for (const Case& which : cases()) {
        const bool asked = options.only.empty() ? options.accept.empty() || named(options.accept, which.name)
                                                : named(options.only, which.name);
        if (!asked) continue;
        const auto verdict = review(options, which, painter);
        if (!verdict) return tl::unexpected(verdict.error());
        fmt::print("{:<28} FLIP {:.4f}, largest {:.3f}: {}\n", verdict->name, verdict->flip, verdict->largest,
                   verdict->accepted   ? "accepted"
                   : verdict->isNew    ? "NEW"
                   : verdict->passes() ? "same"
                                       : "CHANGED");
        verdicts.push_back(*verdict);
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
        "ones");
    hairloom::golden::Options options;
    app.add_option("-o,--output", options.output,
                   "Folder for the pictures, their differences and index.html");
    app.add_option("--backend", options.backend, "Graphics API")
        ->check(CLI::IsMember({"any", "vulkan", "d3d11"}));
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
