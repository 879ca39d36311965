// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/panel.h"

#include <algorithm>

namespace hairloom::editor {

const std::vector<PanelInfo>& panels() {
    static const std::vector<PanelInfo> sorted = [] {
        std::vector<PanelInfo> list = panelFiles();
        std::ranges::stable_sort(list, {}, &PanelInfo::order);
        return list;
    }();
    return sorted;
}

}  // namespace hairloom::editor
