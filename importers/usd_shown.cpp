// SPDX-License-Identifier: GPL-3.0-or-later
// Which curves and meshes a stage shows: what usd-core's traversal and the imaging of USD make of it.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "importers/usd_values.h"

namespace hairloom {
namespace {

constexpr std::size_t kMaxShown = 1'000'000;  ///< prims and copies of these
constexpr int kMaxInstancers = 8;             ///< in each other's prototypes

bool isOf(const UsdPrim& prim, UsdShape shape) {
    if (shape == UsdShape::Meshes) return prim.type == "Mesh";
    return prim.type == "BasisCurves" || prim.type == "NurbsCurves" || prim.type == "HermiteCurves";
}

/// Whether anything of the shape lies below a prim, shown or not.
bool isAnyBelow(const UsdPrim& prim, UsdShape shape) {
    return isOf(prim, shape) ||
           std::ranges::any_of(prim.children, [&](const UsdPrim& child) { return isAnyBelow(child, shape); });
}

std::string tokenOf(const UsdPrim& prim, std::string_view name, double time) {
    const UsdAttribute* const attribute = prim.find(name);
    if (attribute == nullptr) return {};
    const UsdValue value = valueAt(*attribute, time);
    return value.texts.empty() ? std::string() : value.texts.front();
}

class Walk {
  public:
    Walk(UsdPrim& root, UsdShape shape, double time) : root_(root), shape_(shape), time_(time) {}

    Result<UsdShown> run() {
        visit(root_, "", {}, "default", 0);
        if (shown_.prims.size() > kMaxShown)
            return fail(shape_ == UsdShape::Curves ? "instances make more curves than are read"
                                                   : "instances make more meshes than are read",
                        fmt::format("expected at most {}", kMaxShown));
        std::map<const UsdPrim*, std::size_t> last;
        for (std::size_t i = 0; i < shown_.prims.size(); ++i) last[shown_.prims[i].prim] = i;
        for (std::size_t i = 0; i < shown_.prims.size(); ++i)
            shown_.prims[i].isLast = last[shown_.prims[i].prim] == i;
        return std::move(shown_);
    }

  private:
    using Levels = std::vector<UsdLevel>;

    /// Only where something of the shape would be is worth a word.
    void leaveOut(const UsdPrim& prim, const std::string& path, const char* why) {
        constexpr std::size_t kMost = 64;
        if (isAnyBelow(prim, shape_) && shown_.leftOut.size() < kMost)
            shown_.leftOut.push_back(fmt::format("{} {}", path, why));
    }

    void visit(UsdPrim& prim, const std::string& path, const Levels& above, const std::string& purposeAbove,
               int instancers) {
        if (shown_.prims.size() > kMaxShown) return;
        const bool isRoot = &prim == &root_;
        if (!isRoot) {
            if (prim.active && !*prim.active) return leaveOut(prim, path, "is not active");
            if (prim.specifier == UsdPrim::Specifier::Class)
                return leaveOut(prim, path, "is a class, which is shown where it is inherited alone");
            if (prim.specifier == UsdPrim::Specifier::Over)
                return leaveOut(prim, path, "is an \"over\" of a prim that is defined nowhere");
            if (tokenOf(prim, "visibility", time_) == "invisible")
                return leaveOut(prim, path, "is not visible");
        }
        const std::string own = tokenOf(prim, "purpose", time_);
        const std::string purpose = own.empty() ? purposeAbove : own;
        Levels levels = above;
        levels.push_back({&prim, false, 0});
        if (isOf(prim, shape_)) {
            if (purpose == "proxy")
                leaveOut(prim, path, "is a proxy of what images show");
            else
                shown_.prims.push_back({&prim, path, levels, purpose == "guide", true});
        }
        if (prim.type == "PointInstancer") return copies(prim, path, levels, purpose, instancers);
        for (UsdPrim& child : prim.children)
            visit(child, path + "/" + child.name, levels, purpose, instancers);
    }

    UsdPrim* at(std::string_view path) {
        UsdPrim* prim = &root_;
        path.remove_prefix(std::min<std::size_t>(1, path.size()));
        while (!path.empty()) {
            const std::size_t end = std::min(path.find('/'), path.size());
            const auto found = std::ranges::find(prim->children, path.substr(0, end), &UsdPrim::name);
            if (found == prim->children.end()) return nullptr;
            prim = &*found;
            path.remove_prefix(std::min(end + 1, path.size()));
        }
        return prim == &root_ ? nullptr : prim;
    }

    /// What is not seen of the instances, by id or by place where there are no ids.
    std::vector<std::int64_t> wholes(const UsdPrim& prim, std::string_view name) const {
        std::vector<std::int64_t> found;
        const UsdAttribute* const attribute = prim.find(name);
        if (attribute == nullptr) return found;
        const UsdValue value = valueAt(*attribute, time_);
        for (std::size_t i = 0; i < value.numbers.size(); ++i) found.push_back(value.numbers.whole(i));
        return found;
    }

    /// Prototypes are shown once for each instance, and where they stand not at all.
    void copies(UsdPrim& instancer, const std::string& path, const Levels& levels, const std::string& purpose,
                int instancers) {
        const std::vector<std::int64_t> indices = wholes(instancer, "protoIndices"),
                                        ids = wholes(instancer, "ids");
        std::vector<std::int64_t> hidden = wholes(instancer, "invisibleIds");
        const std::vector<std::int64_t> inactive = instancer.inactiveIds.all();
        hidden.insert(hidden.end(), inactive.begin(), inactive.end());
        std::ranges::sort(hidden);
        const UsdAttribute* const prototypes = instancer.find("prototypes");
        if (indices.empty() || prototypes == nullptr) return leaveOut(instancer, path, "has no instances");
        if (instancers >= kMaxInstancers)
            return leaveOut(instancer, path, "lies too deep in other instancers");
        std::vector<UsdPrim*> found;
        for (const std::string& target : prototypes->value.texts) {
            UsdPrim* const prototype = at(target);
            const bool isUsed =
                prototype != nullptr && prototype != &instancer && isAnyBelow(*prototype, shape_);
            found.push_back(isUsed ? prototype : nullptr);
        }
        for (std::size_t i = 0; i < indices.size() && shown_.prims.size() <= kMaxShown; ++i) {
            const std::int64_t id = ids.size() == indices.size() ? ids[i] : static_cast<std::int64_t>(i);
            if (std::ranges::binary_search(hidden, id)) continue;
            if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= found.size()) continue;
            const auto index = static_cast<std::size_t>(indices[i]);
            if (found[index] == nullptr) continue;
            Levels copy = levels;
            copy.push_back({&instancer, true, i});
            visit(*found[index], prototypes->value.texts[index], copy, purpose, instancers + 1);
        }
    }

    UsdPrim& root_;
    UsdShape shape_;
    double time_;
    UsdShown shown_;
};

}  // namespace

Result<UsdShown> shownPrims(UsdPrim& root, UsdShape shape, double time) {
    return Walk(root, shape, time).run();
}

}  // namespace hairloom
