// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <set>

#include "core/groom/findings.h"
#include "core/groom/mask_names.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"

namespace hairloom {
namespace {

struct KnownAttribute {
    std::string_view name;
    std::string_view type;
};
constexpr std::array<KnownAttribute, 7> kPointTypes = {{{attribute::kPosition, "float3"},
                                                        {attribute::kBasePosition, "float3"},
                                                        {attribute::kRadius, "float"},
                                                        {attribute::kPointDye, "float"},
                                                        {attribute::kWidthChange, "float"},
                                                        {attribute::kPointColour, "float3"},
                                                        {attribute::kTransparency, "float"}}};
constexpr std::array<KnownAttribute, 14> kStrandTypes = {{{attribute::kRootTriangle, "uint32"},
                                                          {attribute::kRootBarycentric, "float3"},
                                                          {attribute::kRootUv, "float2"},
                                                          {attribute::kGroup, "uint32"},
                                                          {attribute::kGuide, "uint8"},
                                                          {attribute::kFrozen, "uint8"},
                                                          {attribute::kSelected, "uint8"},
                                                          {attribute::kHidden, "uint8"},
                                                          {attribute::kLayer, "uint32"},
                                                          {attribute::kStrandColour, "float3"},
                                                          {attribute::kDye, "float"},
                                                          {attribute::kMelanin, "float"},
                                                          {attribute::kStiffness, "float"},
                                                          {attribute::kStrandId, "uint32"}}};

bool findOffsets(const Groom& groom, std::vector<Finding>& findings) {
    const auto offsets = groom.offsets.view();
    const auto wrong = [&](std::string what, std::string where) {
        findings.push_back({Severity::Error, std::move(what), std::move(where),
                            "rebuild the offsets: strands + 1 numbers that begin with 0 and ascend to the "
                            "number of points"});
        return false;
    };
    if (offsets.empty()) return wrong("there are no offsets", "offsets");
    if (offsets[0] != 0) return wrong(fmt::format("offsets begin with {}", offsets[0]), "offset 0");
    for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
        if (offsets[s + 1] < offsets[s]) return wrong("offsets descend", fmt::format("strand {}", s));
    }
    return true;
}

bool findArrays(const AttributeSet& attributes, std::span<const KnownAttribute> known,
                std::string_view domain, std::size_t count, std::vector<Finding>& findings) {
    Places lengths;
    Places types;
    for (const auto& [name, data] : attributes.all()) {
        const std::string where = fmt::format("{} attribute '{}'", domain, name);
        if (sizeOf(data) != count) lengths.named(fmt::format("{} ({} values)", where, sizeOf(data)));
        const auto entry = std::find_if(known.begin(), known.end(), [&attributeName = name](const auto& k) {
            return k.name == attributeName;
        });
        if (entry != known.end() && entry->type != typeName(data)) {
            types.named(fmt::format("{} is {}, expected {}", where, typeName(data), entry->type));
        }
    }
    const std::size_t before = findings.size();
    lengths.report(findings, Severity::Error,
                   fmt::format("an attribute does not have one value for each of the {} {}s", count, domain),
                   "remove the attribute or give it as many values");
    types.report(findings, Severity::Error, "an attribute with a reserved name has the wrong type",
                 "remove the attribute or store it with the expected type");
    return findings.size() == before;
}

void findShortStrands(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        if (groom.offsets[s + 1] - groom.offsets[s] < 2) places.strand(s);
    }
    places.report(findings, Severity::Error, "a strand has fewer than 2 points", "delete the strand");
}

void findIndices(const Groom& groom, std::string_view name, std::size_t limit, std::string_view into,
                 std::vector<Finding>& findings) {
    const auto indices = groom.strandAttributes.view<std::uint32_t>(name);
    Places places;
    for (std::size_t s = 0; s < indices.size(); ++s) {
        if (indices[s] >= limit) places.strand(s);
    }
    places.report(findings, Severity::Error,
                  fmt::format("{} is not an index into the {} {}", name, limit, into),
                  fmt::format("assign the strands to one that exists"));
}

void findSelection(const Groom& groom, std::vector<Finding>& findings) {
    const std::size_t triangles = groom.scalp ? groom.scalp->triangleCount() : 0;
    Places places;
    for (std::size_t i = 0; i < groom.scalpSelection.size(); ++i) {
        const bool ascends = i == 0 || groom.scalpSelection[i - 1] < groom.scalpSelection[i];
        if (!ascends || groom.scalpSelection[i] >= triangles) places.other("selected triangle", i);
    }
    places.report(findings, Severity::Error,
                  fmt::format("the scalp selection does not ascend over the scalp's {} triangles", triangles),
                  "select the scalp again");
}

void findDensity(const Groom& groom, std::vector<Finding>& findings) {
    const std::size_t vertices = groom.scalp ? groom.scalp->vertexCount() : 0;
    if (groom.scalpDensity.empty() || groom.scalpDensity.size() == vertices) return;
    findings.push_back(
        {Severity::Error,
         fmt::format("the density map has {} values for {} vertices", groom.scalpDensity.size(), vertices),
         "density", "paint the density again"});
}

void findMaskNames(const Groom& groom, std::vector<Finding>& findings) {
    const auto status = checkMaskNames(groom.maskNames);
    if (!status) findings.push_back({Severity::Error, status.error().problem, "masks", "rename the mask"});
}

void findTriangulation(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    const std::size_t strands = groom.strandCount();
    const auto& triangles = groom.triangulation.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto [a, b, c] = triangles[t];
        if (a >= strands || b >= strands || c >= strands) places.other("root triangle", t);
    }
    const auto& coincident = groom.triangulation.coincident;
    for (std::size_t i = 0; i < coincident.size(); ++i) {
        if (coincident[i].root >= strands || coincident[i].sameAs >= strands)
            places.other("coincident root", i);
    }
    for (std::size_t i = 0; i < groom.triangulation.alone.size(); ++i) {
        if (groom.triangulation.alone[i] >= strands) places.other("root alone", i);
    }
    places.report(findings, Severity::Error,
                  "the triangulation of the roots refers to strands that do not exist",
                  "triangulate the roots again");
}

void findOperators(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    const auto hasArray = [&](std::string_view name) {
        const auto found = groom.pointAttributes.all().find(name);
        return found != groom.pointAttributes.all().end() && typeName(found->second) == "float3";
    };
    if (!groom.operators.empty() && !hasArray(attribute::kBasePosition))
        places.named("point attribute 'base_position'");
    std::set<std::uint32_t> numbers;
    for (std::size_t i = 0; i < groom.operators.size(); ++i) {
        const Operator& one = groom.operators[i];
        if (one.op == kSculpt &&
            (!numbers.insert(one.number).second || !hasArray(sculptAttribute(one.number))))
            places.other("operator", i);
    }
    places.report(findings, Severity::Error,
                  "the stack of operators lacks its base shape or the strokes of a sculpt",
                  "remove the operators, or save the project again with the program that created it");
}

}  // namespace

bool findStructure(const Groom& groom, std::vector<Finding>& findings) {
    if (!findOffsets(groom, findings)) return false;
    if (groom.pointCount() > 0 && !groom.pointAttributes.has(attribute::kPosition)) {
        findings.push_back({Severity::Error, "points have no positions", "point attribute 'position'",
                            "import or grow the strands again"});
        return false;
    }
    const bool points = findArrays(groom.pointAttributes, kPointTypes, "point", groom.pointCount(), findings);
    const bool strands =
        findArrays(groom.strandAttributes, kStrandTypes, "strand", groom.strandCount(), findings);
    if (!points || !strands) return false;
    const std::size_t before = findings.size();
    findShortStrands(groom, findings);
    findOperators(groom, findings);
    findIndices(groom, attribute::kGroup, groom.groupNames.size(), "groups", findings);
    findIndices(groom, attribute::kLayer, groom.layers.size(), "layers", findings);
    if (groom.scalp) {
        findIndices(groom, attribute::kRootTriangle, groom.scalp->triangleCount(), "triangles of the scalp",
                    findings);
    }
    findSelection(groom, findings);
    findDensity(groom, findings);
    findMaskNames(groom, findings);
    findTriangulation(groom, findings);
    return findings.size() == before;
}

}  // namespace hairloom
