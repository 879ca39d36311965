// SPDX-License-Identifier: GPL-3.0-or-later
// The brushes of core/editing as tools: name, icon, key. A new brush is a line here.
#include "editor/tools/brush_tool.h"
#include "editor/tools/registry.h"

namespace hairloom::editor {
namespace {

struct Entry {
    const char *brush, *name, *icon, *tip, *key;
};

constexpr Entry kHeadBrushes[] = {
    {"scalp_paint", QT_TR_NOOP("Paint scalp"), "paint-scalp",
     QT_TR_NOOP("Drag over the head to say where hair grows"), "P"},
    {"density_paint", QT_TR_NOOP("Paint density"), "density",
     QT_TR_NOOP("Drag over the scalp to set how dense hair grows"), "Shift+P"},
};
constexpr Entry kHairBrushes[] = {
    {"comb", QT_TR_NOOP("Comb"), "comb", QT_TR_NOOP("Drag to comb hair along; lengths stay"), "C"},
    {"brush", QT_TR_NOOP("Brush"), "brush", QT_TR_NOOP("Drag to turn hair into the direction of the stroke"),
     "B"},
    {"grab", QT_TR_NOOP("Grab"), "grab", QT_TR_NOOP("Drag to take hair along and let it go elsewhere"), "G"},
    {"smooth", QT_TR_NOOP("Smooth"), "smooth", QT_TR_NOOP("Drag to take bends out of hair"), "S"},
    {"puff", QT_TR_NOOP("Puff"), "puff", QT_TR_NOOP("Drag to lift hair away from the skin"), "U"},
    {"pinch", QT_TR_NOOP("Pinch"), "clump", QT_TR_NOOP("Drag to draw hair together"), "I"},
    {"length", QT_TR_NOOP("Length"), "length", QT_TR_NOOP("Drag to make hair longer"), "L"},
    {"cut", QT_TR_NOOP("Cut"), "cut", QT_TR_NOOP("Drag to cut hair where it meets the brush"), "X"},
    {"cut_line", QT_TR_NOOP("Cut along line"), "cut-line",
     QT_TR_NOOP("Draw a line; hair is cut where it crosses it"), "Shift+X"},
    {"add", QT_TR_NOOP("Add"), "add",
     QT_TR_NOOP("Drag over the scalp to grow hair between the hair that is there"), "A"},
    {"delete", QT_TR_NOOP("Delete"), "delete", QT_TR_NOOP("Drag to remove hair"), "D"},
    {"dye_paint", QT_TR_NOOP("Paint dye"), "dye", QT_TR_NOOP("Drag to bring the material's dye onto hair"),
     "Y"},
    {"freeze", QT_TR_NOOP("Freeze"), "freeze", QT_TR_NOOP("Drag to keep brushes from touching hair"), "Z"},
};

std::vector<ToolMaker> makersOf(std::span<const Entry> entries) {
    std::vector<ToolMaker> makers;
    for (const Entry& entry : entries) {
        makers.emplace_back([&entry](Session& session) -> std::unique_ptr<Tool> {
            return std::make_unique<BrushTool>(session, entry.brush,
                                               ToolInfo{entry.brush, QObject::tr(entry.name), entry.icon,
                                                        QObject::tr(entry.tip), QKeySequence(entry.key)});
        });
    }
    return makers;
}

}  // namespace

std::vector<ToolMaker> headBrushes() {
    return makersOf(kHeadBrushes);
}
std::vector<ToolMaker> hairBrushes() {
    return makersOf(kHairBrushes);
}

}  // namespace hairloom::editor
