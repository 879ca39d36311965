// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of the tool that has the pointer.
#include <QLabel>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "editor/panels/panel.h"

namespace hairloom::editor {

namespace {

QWidget* makePages(ToolBox& tools) {
    auto* pages = new QStackedWidget;
    const auto page = [](const QString& title, const QString& tip, QWidget* options) {
        auto* text = new QLabel(tip);
        text->setProperty("role", "dim");
        text->setWordWrap(true);
        return options ? column({heading(title), text, options}) : column({heading(title), text});
    };
    pages->addWidget(page("Navigate",
                          "Drag to orbit, drag with the middle button to pan, scroll to zoom. "
                          "Choose a tool on the left to edit.",
                          nullptr));
    QHash<Tool*, QWidget*> pageOf;
    for (const auto& tool : tools.all()) {
        QWidget* const made = page(tool->info().name, tool->info().tip, tool->makeOptions());
        pages->addWidget(made);
        pageOf.insert(tool.get(), made);
    }
    QObject::connect(&tools, &ToolBox::activeChanged, pages, [pages, pageOf](Tool* tool) {
        pages->setCurrentWidget(tool ? pageOf.value(tool) : pages->widget(0));
    });
    return scrolled(pages);
}

}  // namespace

PanelInfo toolPanel() {
    return {"tool", QString("Tool"), "brush", Qt::LeftDockWidgetArea, 10, true, [](const PanelParts& parts) {
                return makePages(parts.tools);
            }};
}

}  // namespace hairloom::editor
