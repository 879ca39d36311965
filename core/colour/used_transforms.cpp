// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/colour/used_transforms.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <utility>

namespace hairloom::colour {
namespace {

namespace ocio = OCIO_NAMESPACE;
using Transform = ocio::ConstTransformRcPtr;

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30u;

class Walk {
  public:
    explicit Walk(const ocio::Config& config) : config_(config) {}

    /// `backwards`: its inverse is what is used.
    Status visit(const Transform& transform, bool backwards) {
        if (!transform) return {};
        if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const ocio::GroupTransform>(transform)) {
            const bool turned = isBackwards(*group, backwards);
            for (int i = 0; i < group->getNumTransforms(); ++i) {
                if (auto status = visit(group->getTransform(i), turned); !status) return status;
            }
        } else if (const auto file = OCIO_DYNAMIC_POINTER_CAST<const ocio::FileTransform>(transform)) {
            return visitFile(file->getSrc());
        } else if (const auto space = OCIO_DYNAMIC_POINTER_CAST<const ocio::ColorSpaceTransform>(transform)) {
            return visitPair(space->getSrc(), space->getDst(), isBackwards(*space, backwards));
        } else if (const auto look = OCIO_DYNAMIC_POINTER_CAST<const ocio::LookTransform>(transform)) {
            if (auto status = visitLooks(look->getLooks()); !status) return status;
            return visitPair(look->getSrc(), look->getDst(), isBackwards(*look, backwards));
        } else if (const auto view = OCIO_DYNAMIC_POINTER_CAST<const ocio::DisplayViewTransform>(transform)) {
            return visitView(*view, isBackwards(*view, backwards));
        }
        return {};
    }

  private:
    static bool isBackwards(const ocio::Transform& transform, bool backwards) {
        return backwards != (transform.getDirection() == ocio::TRANSFORM_DIR_INVERSE);
    }

    Status visitPair(const std::string& from, const std::string& to, bool backwards) {
        if (auto status = visitSpace(backwards ? to : from, true); !status) return status;
        return visitSpace(backwards ? from : to, false);
    }

    /// On the way to the reference space, or from it.
    Status visitSpace(const std::string& name, bool toReference) {
        const auto space = config_.getColorSpace(name.c_str());
        if (!space) {
            const auto named = config_.getNamedTransform(name.c_str());
            if (!named) return {};
            return visitOnce({name, toReference}, named->getTransform(ocio::TRANSFORM_DIR_FORWARD),
                             named->getTransform(ocio::TRANSFORM_DIR_INVERSE));
        }
        const auto to = space->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE);
        const auto from = space->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE);
        return visitOnce({space->getName(), toReference}, toReference ? to : from, toReference ? from : to);
    }

    /// A way, or the other backwards where there is none.
    Status visitOnce(const std::pair<std::string, bool>& what, const Transform& way, const Transform& other) {
        if (done_.contains(what)) return {};
        if (!active_.insert(what).second)
            return fail(fmt::format("'{}' is defined by itself", what.first),
                        "expected transforms that lead to the reference space");
        auto status = way ? visit(way, false) : visit(other, true);
        active_.erase(what);
        done_.insert(what);
        return status;
    }

    Status visitView(const ocio::DisplayViewTransform& transform, bool backwards) {
        const char* const display = transform.getDisplay();
        const char* const view = transform.getView();
        if (auto status = visitSpace(transform.getSrc(), !backwards); !status) return status;
        if (auto status = visitLooks(config_.getDisplayViewLooks(display, view)); !status) return status;
        std::string space = config_.getDisplayViewColorSpaceName(display, view);
        if (space == ocio::OCIO_VIEW_USE_DISPLAY_NAME) space = display;
        if (const auto by = config_.getViewTransform(config_.getDisplayViewTransformName(display, view))) {
            auto status = visitOnce({std::string("view transform ") + by->getName(), false},
                                    by->getTransform(ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE),
                                    by->getTransform(ocio::VIEWTRANSFORM_DIR_TO_REFERENCE));
            if (!status) return status;
        }
        return visitSpace(space, backwards);
    }

    /// As "film, +warm | -cold": each of them, whichever way.
    Status visitLooks(std::string names) {
        for (std::size_t at = 0; at < names.size();) {
            const std::size_t end = std::min(names.find_first_of(",:|", at), names.size());
            std::string name = names.substr(at, end - at);
            at = end + 1;
            constexpr const char* kAround = " +-\t";
            const auto first = name.find_first_not_of(kAround), last = name.find_last_not_of(" \t");
            if (first == std::string::npos) continue;
            name = name.substr(first, last - first + 1);
            const auto look = config_.getLook(name.c_str());
            if (!look) continue;
            auto status = visitSpace(look->getProcessSpace(), true);
            if (status) status = visitSpace(look->getProcessSpace(), false);
            if (status)
                status = visitOnce({"look " + name, true}, look->getTransform(), look->getInverseTransform());
            if (status && look->getInverseTransform())
                status = visitOnce({"look " + name, false}, look->getInverseTransform(), nullptr);
            if (!status) return status;
        }
        return {};
    }

    Status visitFile(const std::string& name) const {
        std::filesystem::path found;
        try {
            found = config_.getCurrentContext()->resolveFileLocation(name.c_str());
        } catch (const ocio::Exception&) {
            return {};
        }
        std::error_code error;
        if (!std::filesystem::is_regular_file(found, error))
            return failIn(found.string(), {}, "a colour config uses this, which is no file",
                          "expected a file with a transform");
        if (std::filesystem::file_size(found, error) > kMaxFileBytes)
            return failIn(found.string(), {}, "a colour config uses this file of more than 1 GiB",
                          "expected a smaller one");
        return {};
    }

    const ocio::Config& config_;
    std::set<std::pair<std::string, bool>> active_, done_;
};

}  // namespace

Status checkUsed(const ocio::Config& config, const Transform& transform) {
    return Walk(config).visit(transform, false);
}

}  // namespace hairloom::colour
