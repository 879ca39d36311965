// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_stage.h"

#include <algorithm>

namespace hairloom {
namespace {

template <class T>
void erase(std::vector<T>& from, const std::vector<T>& items) {
    std::erase_if(from, [&](const T& item) {
        return std::ranges::any_of(items, [&](const T& other) { return isSame(item, other); });
    });
}

}  // namespace

template <class T>
std::vector<T> UsdListEdits<T>::all() const {
    std::vector<T> found = items;
    found.insert(found.end(), appended.begin(), appended.end());
    return found;
}

template <class T>
void UsdListEdits<T>::over(const UsdListEdits& weaker) {
    if (isExplicit) return;
    std::vector<T> front = weaker.items, back = weaker.appended;
    for (std::vector<T>* const list : {&front, &back}) {
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

template struct UsdListEdits<UsdArc>;
template struct UsdListEdits<std::int64_t>;
template struct UsdListEdits<std::string>;

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
