// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the faces that carry hair by a box or a lasso.
#include "core/editing/document.h"
#include "core/editing/surface_disc.h"
#include "editor/session.h"
#include "editor/tools/option_form.h"
#include "editor/tools/outline_tool.h"
#include "editor/tools/registry.h"
#include "editor/tools/surface_pick.h"

namespace hairloom::editor {
namespace {

class ScalpOutlineTool : public OutlineTool {
  public:
    using OutlineTool::OutlineTool;

    QString hint() const override { return tr("%1. Shift adds, Ctrl takes away").arg(info().tip); }

    QWidget* makeOptions() override {
        auto* form = new OptionForm(session().preferences);
        form->addGroundTruth(
            "scalpThrough", tr("Through the head"), tr("Faces on the far side count too"),
            [this] { return through_; }, [this](bool on) { through_ = on; });
        form->addGroundTruth(
            "scalpSymmetric", tr("Symmetric"), tr("Faces on the other side of the head as well"),
            [this] { return symmetric_; }, [this](bool on) { symmetric_ = on; });
        return form;
    }

  protected:
    void choose(const editing::ScreenRegion& region, editing::Choice choice) override {
        editing::Document& document = session().document.editing();
        if (!document.surface()) return;
        const ScalpMesh& mesh = *document.groom().scalp;
        FaceSet faces = editing::facesIn(region, mesh, *document.surface(), viewOf(session()), through_);
        if (symmetric_) faces = editing::symmetricFaces(mesh, *document.surface(), faces);
        document.perform(editing::selectScalp(document.model(), faces, choice));
    }

  private:
    bool through_ = false;
    bool symmetric_ = false;
};

ToolMaker maker(OutlineTool::Shape shape, const ToolInfo& info) {
    return [shape, info](Session& session) -> std::unique_ptr<Tool> {
        return std::make_unique<ScalpOutlineTool>(session, shape, info);
    };
}

}  // namespace

ToolMaker scalpBoxTool() {
    return maker(OutlineTool::Shape::Box,
                 {"scalp_box", QObject::tr("Box scalp"), "box-select",
                  QObject::tr("Drag a box over the faces that carry hair"), QKeySequence("M")});
}

ToolMaker scalpLassoTool() {
    return maker(OutlineTool::Shape::Lasso,
                 {"scalp_lasso", QObject::tr("Lasso scalp"), "lasso",
                  QObject::tr("Draw around the faces that carry hair"), QKeySequence("Shift+M")});
}

}  // namespace hairloom::editor
