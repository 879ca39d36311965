// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/operator_kinds.h"

#include <QObject>
#include <QStringList>
#include <algorithm>
#include <map>

#include "editor/style/icons.h"

namespace hairloom::editor {

QString operatorKind(std::string_view name) {
    static const std::vector<std::pair<QString, std::vector<std::string_view>>> kinds{
        {QString("Direction"), {"flow", "part", "attract", "shrinkwrap", "drape", "mirror"}},
        {QString("Length"), {"set_length", "trim"}},
        {QString("Locks"), {"clump", "braid", "bun"}},
        {QString("Texture"), {"curl", "wave", "noise", "frizz", "flyaways"}},
        {QString("Shape"), {"smooth", "straighten", "bend", "collide", "sculpt"}}};
    for (const auto& [kind, names] : kinds) {
        if (std::ranges::find(names, name) != names.end()) return kind;
    }
    return QString("Others");
}

std::vector<StackOperator> operatorsByKind() {
    std::vector<StackOperator> sorted = stackOperators();
    const QStringList order{QString("Direction"), QString("Length"), QString("Locks"),
                            QString("Texture"),   QString("Shape"),  QString("Others")};
    std::ranges::stable_sort(sorted, {},
                             [&](const StackOperator& one) { return order.indexOf(operatorKind(one.name)); });
    return sorted;
}

QIcon operatorIcon(std::string_view name) {
    static const std::map<std::string_view, const char*> icons{
        {"flow", "comb"},         {"part", "part"},     {"attract", "curve"},
        {"shrinkwrap", "shrink"}, {"drape", "grab"},    {"mirror", "mirror"},
        {"set_length", "length"}, {"trim", "cut"},      {"clump", "clump"},
        {"braid", "twist"},       {"bun", "sphere"},    {"curl", "curl"},
        {"wave", "wind"},         {"noise", "noise"},   {"frizz", "noise"},
        {"flyaways", "puff"},     {"smooth", "smooth"}, {"straighten", "straighten"},
        {"bend", "pinch"},        {"collide", "frame"}, {"sculpt", "brush"}};
    const auto found = icons.find(name);
    return icon(found == icons.end() ? "brush" : found->second);
}

}  // namespace hairloom::editor
