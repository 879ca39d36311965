// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_stage.h"

#include <algorithm>

namespace hairloom {
namespace {

void erase(std::vector<UsdArc>& from, const std::vector<UsdArc>& arcs) {
    std::erase_if(from, [&](const UsdArc& arc) {
        return std::ranges::any_of(arcs, [&](const UsdArc& other) { return arc.isSame(other); });
    });
}

}  // namespace

std::vector<UsdArc> UsdArcs::all() const {
    std::vector<UsdArc> arcs = items;
    arcs.insert(arcs.end(), appended.begin(), appended.end());
    return arcs;
}

void UsdArcs::over(const UsdArcs& weaker) {
    if (isExplicit) return;
    std::vector<UsdArc> front = weaker.items, back = weaker.appended;
    for (std::vector<UsdArc>* const list : {&front, &back}) {
        erase(*list, deleted);
        erase(*list, items);
        erase(*list, appended);
    }
    items.insert(items.end(), front.begin(), front.end());
    back.insert(back.end(), appended.begin(), appended.end());
    appended = std::move(back);
    isExplicit = weaker.isExplicit;
    if (!isExplicit) deleted.insert(deleted.end(), weaker.deleted.begin(), weaker.deleted.end());
}

const UsdAttribute* UsdPrim::find(std::string_view attribute) const {
    const auto found = std::ranges::find(attributes, attribute, &UsdAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}
UsdAttribute* UsdPrim::find(std::string_view attribute) {
    const auto found = std::ranges::find(attributes, attribute, &UsdAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}
const UsdPrim* UsdPrim::child(std::string_view childName) const {
    const auto found = std::ranges::find(children, childName, &UsdPrim::name);
    return found == children.end() ? nullptr : &*found;
}

bool UsdPrim::isComposed() const {
    return !inherits.empty() || !references.empty() || !payloads.empty() || !specializes.empty() ||
           !variantSets.empty();
}

double usdNumber(const UsdMetadata& metadata, std::string_view name, double otherwise) {
    const auto found = metadata.find(name);
    return found == metadata.end() || found->second.numbers.empty() ? otherwise
                                                                    : found->second.numbers.front();
}

}  // namespace hairloom
