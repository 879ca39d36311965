// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/json_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;
using Differences = std::vector<JsonDifference>;

/// Which element of `after` each one of `before` has become; nothing for those that are gone.
using Partners = std::vector<std::optional<std::size_t>>;

bool isListOfObjects(const Json& json) {
    return json.is_array() && std::ranges::all_of(json, [](const Json& item) { return item.is_object(); });
}

std::string textAt(const Json& object, const char* member) {
    const auto found = object.find(member);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Indices by name; nothing where one has no name, or one that another has.
std::optional<std::map<std::string, std::size_t>> byName(const Json& list) {
    std::map<std::string, std::size_t> names;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string name = textAt(list[i], "name");
        if (name.empty() || !names.emplace(name, i).second) return std::nullopt;
    }
    return names;
}

/// What is alone at one place of both lists is the same under another name.
Partners partnersByName(const Json& before, const Json& after,
                        const std::map<std::string, std::size_t>& names) {
    Partners partners(before.size());
    std::vector<bool> isTaken(after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const auto found = names.find(textAt(before[i], "name"));
        if (found == names.end()) continue;
        partners[i] = found->second;
        isTaken[found->second] = true;
    }
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
        if (!partners[i] && !isTaken[i]) partners[i] = i;
    return partners;
}

/// Pairs of a stretch where the lists differ.
void pairByKind(const Json& before, const Json& after, std::size_t firstBefore, std::size_t lastBefore,
                std::size_t firstAfter, std::size_t lastAfter, Partners& partners) {
    std::size_t next = firstAfter;
    for (std::size_t i = firstBefore; i < lastBefore; ++i) {
        for (std::size_t j = next; j < lastAfter; ++j) {
            if (textAt(before[i], "op") != textAt(after[j], "op")) continue;
            partners[i] = j;
            next = j + 1;
            break;
        }
    }
}

/// The longest common sequence of equal elements, and pairs of a kind between these.
Partners partnersByContent(const Json& before, const Json& after) {
    constexpr std::size_t kMostCells = 4'000'000;
    std::size_t first = 0, last = 0;
    const std::size_t shorter = std::min(before.size(), after.size());
    while (first < shorter && before[first] == after[first]) ++first;
    while (last < shorter - first && before[before.size() - 1 - last] == after[after.size() - 1 - last])
        ++last;
    Partners partners(before.size());
    for (std::size_t i = 0; i < first; ++i) partners[i] = i;
    for (std::size_t i = 1; i <= last; ++i) partners[before.size() - i] = after.size() - i;
    const std::size_t rows = before.size() - first - last, columns = after.size() - first - last;
    if (rows == 0 || columns == 0) return partners;
    if (rows * columns > kMostCells) {
        pairByKind(before, after, first, first + rows, first, first + columns, partners);
        return partners;
    }
    const auto textsOf = [&](const Json& list, std::size_t count) {
        std::vector<std::string> texts;
        for (std::size_t i = 0; i < count; ++i)
            texts.push_back(list[first + i].dump(-1, ' ', false, Json::error_handler_t::replace));
        return texts;
    };
    const std::vector<std::string> a = textsOf(before, rows), b = textsOf(after, columns);
    // Length of the longest sequence of what begins at row and column.
    std::vector<std::uint32_t> length((rows + 1) * (columns + 1));
    const auto at = [&](std::size_t row, std::size_t column) -> std::uint32_t& {
        return length[row * (columns + 1) + column];
    };
    for (std::size_t i = rows; i-- > 0;)
        for (std::size_t j = columns; j-- > 0;)
            at(i, j) = a[i] == b[j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
    std::size_t i = 0, j = 0, openBefore = 0, openAfter = 0;
    const auto close = [&] {
        pairByKind(before, after, first + openBefore, first + i, first + openAfter, first + j, partners);
    };
    while (i < rows && j < columns) {
        if (a[i] == b[j]) {
            close();
            partners[first + i++] = first + j++;
            openBefore = i;
            openAfter = j;
        } else if (at(i + 1, j) >= at(i, j + 1)) {
            ++i;
        } else {
            ++j;
        }
    }
    i = rows;
    j = columns;
    close();
    return partners;
}

/// "layers[Fringe]", "operators[2 clump]", "card_edits[7]"
std::string placeOf(const std::string& where, const Json& element, std::size_t index, bool named) {
    if (named) return fmt::format("{}[{}]", where, textAt(element, "name"));
    const std::string op = textAt(element, "op");
    return fmt::format("{}[{}{}{}]", where, index, op.empty() ? "" : " ", op);
}

void add(const std::string& where, const Json& before, const Json& after, Differences& all);

void addObjects(const std::string& where, const Json& before, const Json& after, Differences& all) {
    const auto within = [&](const std::string& name) { return where.empty() ? name : where + "." + name; };
    for (const auto& [name, value] : before.items()) {
        if (const auto now = after.find(name); now != after.end())
            add(within(name), value, *now, all);
        else
            all.push_back({within(name), "removed", value, {}});
    }
    for (const auto& [name, value] : after.items())
        if (!before.contains(name)) all.push_back({within(name), "added", {}, value});
}

void addLists(const std::string& where, const Json& before, const Json& after, Differences& all) {
    const auto named = byName(after);
    const bool isNamed = named && byName(before);
    const Partners partners =
        isNamed ? partnersByName(before, after, *named) : partnersByContent(before, after);
    std::vector<bool> isOld(after.size());
    std::optional<std::size_t> last;
    bool isReordered = false;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (!partners[i]) {
            all.push_back({placeOf(where, before[i], i, isNamed), "removed", before[i], {}});
            continue;
        }
        const std::size_t now = *partners[i];
        isOld[now] = true;
        isReordered = isReordered || (last && now < *last);
        last = now;
        add(placeOf(where, after[now], now, isNamed), before[i], after[now], all);
    }
    for (std::size_t i = 0; i < after.size(); ++i)
        if (!isOld[i]) all.push_back({placeOf(where, after[i], i, isNamed), "added", {}, after[i]});
    if (!isReordered) return;
    const auto names = [](const Json& list) {
        Json order = Json::array();
        for (const Json& item : list) order.push_back(textAt(item, "name"));
        return order;
    };
    all.push_back({where, "reordered", names(before), names(after)});
}

void add(const std::string& where, const Json& before, const Json& after, Differences& all) {
    if (before == after) return;
    if (before.is_object() && after.is_object())
        addObjects(where, before, after, all);
    else if (isListOfObjects(before) && isListOfObjects(after))
        addLists(where, before, after, all);
    else
        all.push_back({where, "changed", before, after});
}

}  // namespace

std::vector<JsonDifference> differences(const Json& before, const Json& after) {
    Differences all;
    add({}, before, after, all);
    return all;
}

}  // namespace hairloom
