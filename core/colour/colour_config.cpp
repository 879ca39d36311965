// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/colour/colour_config.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/base/file.h"
#include "core/colour/interchange.h"
#include "core/colour/used_transforms.h"

namespace hairloom::colour {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr std::uint64_t kMaxConfigBytes = std::uint64_t{64} << 20u;

class Processed final : public render::ColourTransform {
  public:
    explicit Processed(const ocio::ConstProcessorRcPtr& processor)
        : processor_(processor->getOptimizedCPUProcessor(ocio::BIT_DEPTH_F32, ocio::BIT_DEPTH_F32,
                                                         ocio::OPTIMIZATION_DEFAULT)) {}

    void apply(std::span<float> rgba) const override {
        if (rgba.empty()) return;
        ocio::PackedImageDesc pixels(rgba.data(), static_cast<long>(rgba.size() / 4), 1, 4);
        processor_->apply(pixels);
    }

  private:
    ocio::ConstCPUProcessorRcPtr processor_;
};

/// The library's words in one line, with the line of the file that they name.
Error told(const std::filesystem::path& path, const std::string& what, std::string why) {
    std::ranges::replace(why, '\n', ' ');
    Error error{path.string(), {}, what + ": " + why, {}};
    constexpr std::string_view kLine = "at line ";
    if (const auto at = why.find(kLine); at != std::string::npos) {
        std::uint64_t line = 0;
        const char* const number = why.data() + at + kLine.size();
        if (std::from_chars(number, why.data() + why.size(), line).ec == std::errc())
            error.place = Line{line};
    }
    return error;
}

std::string joined(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<Display> displaysOf(const ocio::Config& config) {
    std::vector<Display> displays;
    for (int d = 0; d < config.getNumDisplays(); ++d) {
        Display display{config.getDisplay(d), {}};
        const char* const name = display.name.c_str();
        for (int v = 0; v < config.getNumViews(name); ++v)
            display.views.emplace_back(config.getView(name, v));
        const auto first = std::ranges::find(display.views, config.getDefaultView(name));
        if (first != display.views.end()) std::rotate(display.views.begin(), first, first + 1);
        if (!display.views.empty()) displays.push_back(std::move(display));
    }
    const auto first = std::ranges::find(displays, config.getDefaultDisplay(), &Display::name);
    if (first != displays.end()) std::rotate(displays.begin(), first, first + 1);
    return displays;
}

}  // namespace

struct ColourConfig::Library {
    ocio::ConstConfigRcPtr config;
    Entry entry;
};

bool hasOpenColorIO() {
    return true;
}

Result<ColourConfig> ColourConfig::read(const std::filesystem::path& path) {
    const std::string file = path.string();
    if (file.rfind("ocio://", 0) == 0)
        return failIn(file, {}, fmt::format("OpenColorIO {} has no built-in configs", ocio::GetVersion()),
                      "expected the file of a config");
    if (const auto text = readTextFile(path, kMaxConfigBytes); !text) return tl::unexpected(text.error());
    // What it warns of is in the errors below. Its own variable, OCIO_LOGGING_LEVEL, outweighs this.
    ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
    ColourConfig read;
    read.path_ = path;
    try {
        // Files that have changed since they were read are read again.
        ocio::ClearAllCaches();
        auto library = std::make_shared<Library>();
        library->config = ocio::Config::CreateFromFile(file.c_str());
        const ocio::Config& config = *library->config;
        read.displays_ = displaysOf(config);
        if (read.displays_.empty())
            return failIn(file, {}, "this config has no display with a view", "expected at least one");
        auto space = config.getColorSpace(ocio::ROLE_SCENE_LINEAR);
        if (!space) space = config.getColorSpace(ocio::ROLE_RENDERING);
        if (!space)
            return failIn(file, {}, "this config says nowhere which space its renders are in",
                          "expected a role scene_linear or rendering that names a colour space");
        read.working_.name = space->getName();
        library->entry = entryOf(config, read.working_.name);
        const auto steps = fromRec709(library->entry, read.working_.name);
        if (auto status = checkUsed(config, steps); !status)
            return tl::unexpected(inFile(status.error(), file));
        // Probed the other way, by what may be the inverse of another transform.
        if (auto status = checkUsed(config, toEntry(library->entry, read.working_.name)); !status)
            return tl::unexpected(inFile(status.error(), file));
        const auto linear = linearSpaceOf(config, library->entry, read.working_.name);
        if (!linear) return tl::unexpected(inFile(linear.error(), file));
        read.working_.linear = *linear;
        if (library->entry.isAssumed)
            read.working_.note = fmt::format(
                "{}: the config has neither the role aces_interchange nor linear Rec. 709 under a "
                "known name, so '{}' is taken for it",
                file, read.working_.name);
        read.working_.fromRec709 = std::make_shared<Processed>(config.getProcessor(steps));
        read.library_ = std::move(library);
    } catch (const std::exception& thrown) {
        return tl::unexpected(told(path, "this config cannot be used", thrown.what()));
    }
    return read;
}

Result<std::shared_ptr<const render::ColourTransform>> ColourConfig::view(const std::string& display,
                                                                          const std::string& view) const {
    const auto found = std::ranges::find(displays_, display, &Display::name);
    if (found == displays_.end()) {
        std::vector<std::string> names;
        for (const Display& known : displays_) names.push_back(known.name);
        return failIn(path_.string(), {}, fmt::format("this config has no display '{}'", display),
                      "expected one of " + joined(names));
    }
    if (std::ranges::find(found->views, view) == found->views.end())
        return failIn(path_.string(), {}, fmt::format("display '{}' has no view '{}'", display, view),
                      "expected one of " + joined(found->views));
    try {
        auto steps = fromRec709(library_->entry, working_.name);
        auto last = ocio::DisplayViewTransform::Create();
        last->setSrc(working_.name.c_str());
        last->setDisplay(display.c_str());
        last->setView(view.c_str());
        steps->appendTransform(last);
        if (auto status = checkUsed(*library_->config, steps); !status)
            return tl::unexpected(inFile(status.error(), path_.string()));
        return std::make_shared<Processed>(library_->config->getProcessor(steps));
    } catch (const std::exception& thrown) {
        return tl::unexpected(told(
            path_, fmt::format("view '{}' of display '{}' cannot be used", view, display), thrown.what()));
    }
}

}  // namespace hairloom::colour
