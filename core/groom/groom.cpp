// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/groom.h"

#include <algorithm>
#include <cassert>

namespace hairloom {

std::size_t Groom::guideCount() const {
    const auto flags = strandAttributes.view<std::uint8_t>(attribute::kGuide);
    if (flags.empty()) return strandCount();
    return static_cast<std::size_t>(
        std::count_if(flags.begin(), flags.end(), [](std::uint8_t flag) { return flag != 0; }));
}

Box3f Groom::bounds() const {
    Box3f box;
    for (const Vec3f& position : positions()) box.extend(position);
    return box;
}

std::vector<SurfacePoint> Groom::rootBindings() const {
    const auto triangles = strandAttributes.view<std::uint32_t>(attribute::kRootTriangle);
    const auto barycentrics = strandAttributes.view<Vec3f>(attribute::kRootBarycentric);
    if (triangles.size() != strandCount() || barycentrics.size() != strandCount()) return {};
    std::vector<SurfacePoint> roots(strandCount());
    for (std::size_t s = 0; s < roots.size(); ++s) roots[s] = {triangles[s], barycentrics[s]};
    return roots;
}

void Groom::setRootBindings(std::span<const SurfacePoint> roots) {
    assert(roots.size() == strandCount());
    std::vector<std::uint32_t> triangles(roots.size());
    std::vector<Vec3f> barycentrics(roots.size());
    for (std::size_t s = 0; s < roots.size(); ++s) {
        triangles[s] = roots[s].triangle;
        barycentrics[s] = roots[s].barycentric;
    }
    strandAttributes.set(attribute::kRootTriangle, std::move(triangles));
    strandAttributes.set(attribute::kRootBarycentric, std::move(barycentrics));
}

Groom makeGroom(std::vector<std::uint32_t> offsets, std::vector<Vec3f> positions) {
    assert(!offsets.empty() && offsets.front() == 0 && offsets.back() == positions.size());
    Groom groom;
    groom.offsets = CowArray<std::uint32_t>(std::move(offsets));
    groom.pointAttributes.set(attribute::kPosition, std::move(positions));
    return groom;
}

bool isOperatorAttribute(std::string_view name) {
    return name == attribute::kBasePosition || name.starts_with(kSculptPrefix);
}

void dropOperators(Groom& groom) {
    groom.operators.clear();
    std::vector<std::string> gone;
    for (const auto& [name, data] : groom.pointAttributes.all()) {
        if (isOperatorAttribute(name)) gone.push_back(name);
    }
    for (const std::string& name : gone) groom.pointAttributes.erase(name);
}

}  // namespace hairloom
