// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the faces that carry hair by a box or a lasso.
#include "core/editing/document.h"
#include "core/editing/surface_disc.h"
#include "editor/fields/option_form.h"
#include "editor/tools/outline_tool.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

class ScalpOutlineTool : public OutlineTool {
  public:
    using OutlineTool::OutlineTool;

    QString hint() const override { return QString("%1. Shift adds, Ctrl subtracts").arg(info().tip); }

    QWidget* makeOptions() override {
        auto* form = new OptionForm(preferences());
        form->addBool(
            "scalpThrough", "Through head", "Include faces on the far side", [this] { return through_; },
            [this](bool on) { through_ = on; });
        form->addBool(
            "scalpSymmetric", "Symmetric", "Include faces on the other side of the head",
            [this] { return symmetric_; }, [this](bool on) { symmetric_ = on; });
        return form;
    }

  protected:
    void choose(const editing::ScreenRegion& region, editing::Choice choice) override {
        editing::Document& document = OutlineTool::document().editing();
        if (!document.surface()) return;
        const ScalpMesh& mesh = *document.groom().scalp;
        FaceSet faces = editing::facesIn(region, mesh, *document.surface(), viewOf(viewport()), through_);
        if (symmetric_) faces = editing::symmetricFaces(mesh, *document.surface(), faces);
        document.perform(editing::selectScalp(document.model(), faces, choice));
    }

  private:
    bool through_ = false;
    bool symmetric_ = false;
};

}  // namespace

ToolMaker scalpOutlineTool() {
    return [](const ToolParts& parts) {
        Tools tools;
        tools.push_back(std::make_unique<ScalpOutlineTool>(
            parts, OutlineTool::Shape::Box,
            ToolInfo{"scalp_box", QString("Box scalp"), "box-select",
                     QString("Drag a box over the faces where hair grows"), QKeySequence("M"), 40}));
        tools.push_back(std::make_unique<ScalpOutlineTool>(
            parts, OutlineTool::Shape::Lasso,
            ToolInfo{"scalp_lasso", QString("Lasso scalp"), "lasso",
                     QString("Draw around the faces where hair grows"), QKeySequence("Shift+M"), 50}));
        return tools;
    };
}

}  // namespace hairloom::editor
