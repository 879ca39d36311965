// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/strand_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace hairloom {
namespace {

using Elements = std::vector<std::string>;

constexpr std::string_view kUnnamed = "hair";  ///< the name of parts that have none

Elements elementsOf(std::string_view path) {
    Elements elements;
    while (!path.empty()) {
        const std::size_t end = std::min(path.find('/'), path.size());
        if (end > 0) elements.emplace_back(path.substr(0, end));
        path.remove_prefix(std::min(end + 1, path.size()));
    }
    return elements;
}

bool areDifferent(const std::vector<std::string>& names) {
    return std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

/// The element so many before the last of each path; empty where some path is shorter.
std::vector<std::string> fromBehind(const std::vector<Elements>& paths, std::size_t before) {
    std::vector<std::string> names;
    for (const Elements& path : paths) {
        if (path.size() <= before) return {};
        names.push_back(path[path.size() - 1 - before]);
    }
    return names;
}

/// Whether each path has a parent of its own.
bool haveOwnParents(const std::vector<Elements>& paths) {
    std::set<Elements> parents;
    for (const Elements& path : paths) {
        if (path.size() < 2 || !parents.emplace(path.begin(), path.end() - 1).second) return false;
    }
    return true;
}

std::string joined(const Elements& path, std::size_t first) {
    std::string text;
    for (std::size_t i = first; i < path.size(); ++i) text += (text.empty() ? "" : "/") + path[i];
    return text;
}

std::string parentOf(const std::string& path) {
    return path.substr(0, std::min(path.rfind('/'), path.size()));
}

/// Parts of a scene in thousands of objects, told by the objects above: each strand's layer, and their names.
void gather(RawStrands& strands) {
    std::vector<std::string> paths;
    for (const StrandPart& part : strands.parts) paths.push_back(part.path);
    const auto distinct = [&] { return std::set<std::string>(paths.begin(), paths.end()).size(); };
    while (distinct() > kMaxPartLayers) {
        for (std::string& path : paths) path = parentOf(path);
    }
    strands.warnings.push_back(
        fileNote(fmt::format("{} parts are more than {} layers", strands.parts.size(), kMaxPartLayers),
                 "layers", fmt::format("what lies under one object is one layer: {} in all", distinct())));
    for (std::size_t i = 0; i < paths.size(); ++i) strands.parts[i] = {paths[i], {}};
}

}  // namespace

void endPart(RawStrands& strands, const std::string& path, const std::string& name) {
    const std::size_t count = strands.offsets.size() - 1;
    if (strands.partOfStrand.size() >= count) return;
    const auto isIt = [&](const StrandPart& part) { return part.path == path && part.name == name; };
    // The last one, mostly: objects come one after another.
    auto found = std::find_if(strands.parts.rbegin(), strands.parts.rend(), isIt);
    if (found == strands.parts.rend()) {
        strands.parts.push_back({path, name});
        found = strands.parts.rbegin();
    }
    strands.partOfStrand.resize(count, static_cast<std::uint32_t>(strands.parts.rend() - found - 1));
}

std::vector<std::string> partNames(std::span<const std::string> paths) {
    std::vector<Elements> all;
    for (const std::string& path : paths) all.push_back(elementsOf(path));
    if (all.size() > 1 && haveOwnParents(all)) {
        std::vector<std::string> above = fromBehind(all, 1);
        if (areDifferent(above)) return above;
    }
    std::vector<std::string> last = fromBehind(all, 0);
    if (!last.empty() && areDifferent(last)) return last;
    std::size_t common = 0;
    const auto isCommon = [&](const Elements& path) {
        return path.size() > common + 1 && path[common] == all.front()[common];
    };
    while (!all.empty() && std::ranges::all_of(all, isCommon)) ++common;
    std::vector<std::string> names;
    for (const Elements& path : all) names.push_back(joined(path, common));
    return names;
}

void layersFromParts(RawStrands& strands) {
    const std::size_t count = strands.offsets.size() - 1;
    RawAttribute layer{std::string(attribute::kLayer), false, RawAttribute::Type::Index, 1, {}, {}};
    if (strands.parts.size() > 1 && strands.partOfStrand.size() == count) {
        if (strands.parts.size() > kMaxPartLayers) gather(strands);
        std::vector<std::string> paths;
        for (const StrandPart& part : strands.parts) paths.push_back(part.path);
        std::ranges::sort(paths);
        paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
        const std::vector<std::string> names = partNames(paths);
        std::vector<std::int32_t> layerOf;
        for (const StrandPart& part : strands.parts) {
            const auto path =
                static_cast<std::size_t>(std::ranges::lower_bound(paths, part.path) - paths.begin());
            std::string name = part.name.empty() ? names[path] : part.name;
            if (name.empty()) name = Layer{}.name;
            auto known = std::ranges::find(strands.layerNames, name);
            if (known == strands.layerNames.end()) known = strands.layerNames.insert(known, name);
            layerOf.push_back(static_cast<std::int32_t>(known - strands.layerNames.begin()));
        }
        for (const std::uint32_t part : strands.partOfStrand) layer.whole.push_back(layerOf[part]);
        if (strands.layerNames.size() == 1 && strands.layerNames.front() == kUnnamed)
            strands.layerNames.clear();
    } else if (strands.groupNames.size() > 1 && strands.groupNames.size() <= kMaxPartLayers) {
        const auto group = std::ranges::find_if(strands.attributes, [](const RawAttribute& one) {
            return one.name == attribute::kGroup && one.type == RawAttribute::Type::Index && !one.perPoint;
        });
        if (group == strands.attributes.end() || group->whole.size() != count) return;
        strands.layerNames = strands.groupNames;
        layer.whole = group->whole;
    } else if (strands.parts.size() == 1) {
        const StrandPart& part = strands.parts.front();
        const Elements path = elementsOf(part.path);
        strands.layerNames = {!part.name.empty() ? part.name : path.empty() ? std::string() : path.back()};
        if (strands.layerNames.front().empty() || strands.layerNames.front() == kUnnamed)
            strands.layerNames.clear();
        return;
    }
    if (strands.layerNames.size() > 1) strands.attributes.push_back(std::move(layer));
}

std::string NameGiver::give(std::string_view name) {
    std::string legal;
    for (const char c : name) {
        // One underscore for a character of several bytes.
        const bool continues = (static_cast<unsigned char>(c) & 0xc0u) == 0x80;
        if (isLegal_(c, false))
            legal += c;
        else if (!continues || legal.empty())
            legal += '_';
    }
    if (legal.empty() || !isLegal_(legal.front(), true)) legal.insert(legal.begin(), '_');
    std::string unique = legal;
    for (int number = 2; std::ranges::binary_search(taken_, unique); ++number)
        unique = fmt::format("{}_{}", legal, number);
    reserve(unique);
    return unique;
}

void NameGiver::reserve(std::string_view name) {
    const auto at = std::ranges::lower_bound(taken_, name);
    if (at == taken_.end() || *at != name) taken_.insert(at, std::string(name));
}

bool isGivenTo(std::string_view legal, std::string_view original, NameGiver::Legal isLegal) {
    const std::string plain = NameGiver(isLegal).give(original);
    if (!legal.starts_with(plain)) return false;
    legal.remove_prefix(plain.size());
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    return legal.empty() ||
           (legal.size() > 1 && legal.front() == '_' && std::ranges::all_of(legal.substr(1), isDigit));
}

bool isLegalInUsd(char c, bool isFirst) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    return letter || (!isFirst && c >= '0' && c <= '9');
}

bool isLegalInAlembic(char c, bool) {
    return c != '/' && c != '.' && static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
}

}  // namespace hairloom
