// SPDX-License-Identifier: GPL-3.0-or-later
// Selects strands by click, box or lasso, by any part, by their roots or by their tips.
#include "core/editing/document.h"
#include "editor/fields/option_form.h"
#include "editor/tools/outline_tool.h"
#include "editor/tools/surface_pick.h"
#include "editor/tools/tool_maker.h"

namespace hairloom::editor {
namespace {

class StrandSelectTool : public OutlineTool {
  public:
    explicit StrandSelectTool(const ToolParts& parts)
        : OutlineTool(
              parts, Shape::Lasso,
              {"select", QString("Select strands"), "select",
               QString("Click a strand or draw around several. Brushes then affect only the selection"),
               QKeySequence("E"), 70}) {}

    QString hint() const override { return QString("%1. Shift adds, Ctrl subtracts").arg(info().tip); }

    QWidget* makeOptions() override {
        auto* form = new OptionForm(preferences());
        form->addChoice(
            "selectShape", "Shape", "Shape of the selection", {QString("Box"), QString("Lasso")},
            [this] { return static_cast<int>(shape()); },
            [this](int index) { setShape(static_cast<Shape>(index)); });
        form->addChoice(
            "selectPart", "Part", "Part of the strand that must be inside",
            {QString("Any"), QString("Root"), QString("Tip")},
            [this] { return static_cast<int>(options_.part); },
            [this](int index) { options_.part = static_cast<editing::StrandPart>(index); });
        form->addBool(
            "selectThrough", "Through head", "Include strands behind the head",
            [this] { return options_.throughHead; }, [this](bool on) { options_.throughHead = on; });
        return form;
    }

    void draw(Marks& marks) const override {
        OutlineTool::draw(marks);
        const Groom& groom = document().groom();
        const auto selected = groom.strandAttributes.view<std::uint8_t>(attribute::kSelected);
        const QColor colour(255, 170, 60, 230);
        for (std::size_t s = 0; s < selected.size() && s < groom.strandCount(); ++s) {
            if (selected[s] == 0) continue;
            const auto strand = groom.strand(s);
            for (std::size_t p = 1; p < strand.size(); ++p)
                marks.line(strand[p - 1], strand[p], colour, 1.5f);
        }
    }

  protected:
    void choose(const editing::ScreenRegion& region, editing::Choice choice) override {
        editing::Document& document = OutlineTool::document().editing();
        take(editing::strandsIn(region, document.groom(), document.surface(), viewOf(viewport()), options_),
             choice);
    }

    void click(const QPointF& at_px, editing::Choice choice) override {
        editing::Document& document = OutlineTool::document().editing();
        editing::PickOptions options;
        options.part = options_.part;
        options.throughHead = options_.throughHead;
        const auto picked = editing::pickStrand(document.groom(), document.bounds(), document.surface(),
                                                viewOf(viewport()), toPixels(at_px), options);
        take(picked ? std::vector<std::uint32_t>{picked->strand} : std::vector<std::uint32_t>(), choice);
    }

  private:
    void take(const std::vector<std::uint32_t>& strands, editing::Choice choice) {
        editing::Document& document = OutlineTool::document().editing();
        document.perform(editing::selectStrands(document.model(), strands, choice));
        Q_EMIT updated();
    }

    editing::RegionOptions options_;
};

}  // namespace

ToolMaker strandSelectTool() {
    return [](const ToolParts& parts) { return oneTool<StrandSelectTool>(parts); };
}

}  // namespace hairloom::editor
