// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/burn_in.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "cli/record_comparison.h"
#include "core/render/text.h"
#include "core/simulation/frame_record.h"
#include "core/simulation/settings_text.h"

namespace hairloom::cli {
namespace {

std::string nameOf(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

}  // namespace

std::string BurnIn::frameText(const Shot& shot, std::size_t index) const {
    const std::uint64_t number = options_.start ? options_.firstNumber() + index : shot.frame;
    std::string text = fmt::format("frame {}", number);
    if (!options_.frames.empty() && (shot.frame < options_.frames[0] || shot.frame > options_.frames[1]))
        text += " (handle)";
    if (options_.turntable > 0 || options_.turn != 0) text += fmt::format(", {:.4g}°", shot.turn);
    return text;
}

std::string BurnIn::takeText() const {
    const std::string take = !options_.record.empty()   ? nameOf(options_.record)
                             : !options_.motion.empty() ? nameOf(options_.motion)
                                                        : "at rest";
    return fmt::format("{}, {}", nameOf(options_.input), take);
}

Result<std::string> BurnIn::errorText(const Shot& shot) {
    const auto frame = readFrame(options_.record, groom_, shot.frame);
    if (!frame) return tl::unexpected(frame.error());
    RecordComparison comparison(options_.against);
    if (auto status = comparison.add(groom_, shot.frame, frame->positions_ws); !status)
        return tl::unexpected(status.error());
    Report row{{"frame", shot.frame}};
    comparison.report(row);
    errors_.push_back(std::move(row));
    return fmt::format("error {:.3g} mm, at most {:.3g} mm", comparison.meanMm(), comparison.maxMm());
}

Status BurnIn::draw(const Shot& shot, std::size_t index, render::Image& image) {
    std::string error;
    if (!options_.against.empty()) {
        auto text = errorText(shot);
        if (!text) return tl::unexpected(text.error());
        error = std::move(*text);
    }
    std::vector<std::string> lines;
    for (const std::string& what : options_.burnIn) {
        if (what == "frame") {
            lines.push_back(frameText(shot, index));
        } else if (what == "take") {
            lines.push_back(takeText());
        } else if (what == "settings") {
            lines.push_back(settingsText(groom_.simulation));
        } else if (what == "error") {
            lines.push_back(error);
        } else {
            lines.push_back(what);
        }
    }
    if (!lines.empty()) render::burnIn(image, lines);
    return {};
}

void BurnIn::report(Report& report) const {
    if (!errors_.empty()) report["errors"] = errors_;
}

}  // namespace hairloom::cli
