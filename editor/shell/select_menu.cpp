// SPDX-License-Identifier: GPL-3.0-or-later
// The menu over strands that are chosen: select, hide and show, freeze, guides, delete.
#include <fmt/format.h>

#include <QInputDialog>
#include <QMenuBar>
#include <algorithm>
#include <iterator>

#include "core/editing/document.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/operations/guide_clusters.h"
#include "editor/document/words.h"
#include "editor/fields/length_text.h"
#include "editor/shell/main_window.h"

namespace hairloom::editor {
namespace {

std::vector<std::uint32_t> others(const Groom& groom, const std::vector<std::uint32_t>& strands) {
    std::vector<std::uint32_t> rest;
    std::ranges::set_difference(editing::allStrands(groom), strands, std::back_inserter(rest));
    return rest;
}

}  // namespace

void MainWindow::chooseGuidesByClustering() {
    const Groom& groom = document_.groom();
    const std::vector<std::uint32_t> strands = strandsToEdit(groom, {});
    if (strands.size() < 2) {
        messages_.say("There are no strands to choose from");
        return;
    }
    bool taken = false;
    GuidesSettings settings;
    settings.count = static_cast<std::uint32_t>(QInputDialog::getInt(
        this, "Cluster guides", QString("Number of guides for %1 strands").arg(strands.size()),
        std::min<int>(200, static_cast<int>(strands.size() / 2)), 1, static_cast<int>(strands.size()), 1,
        &taken));
    if (!taken) return;
    const GuideClusters clusters = clusterGuides(groom, strands, settings);
    Groom guided = groom;
    keepGuides(guided, strands, clusters, settings.alone);
    const std::string record = fmt::format(R"({{"op":"guides","count":{}}})", settings.count);
    document_.perform(
        editing::replaceGroom(document_.editing().model(), std::move(guided), "Cluster guides", record));
    messages_.say(QString("%1 guides represent %2 strands, with a mean distance of %3 and at most %4")
                      .arg(clusters.guides.size())
                      .arg(strands.size())
                      .arg(lengthText(1e-3 * clusters.meanMm, preferences_),
                           lengthText(1e-3 * clusters.maxMm, preferences_)));
}

void MainWindow::addSelectActions() {
    QMenu* menu = menuBar()->addMenu("&Select");
    menu->setToolTipsVisible(true);
    using Strands = std::vector<std::uint32_t>;
    using Make =
        std::function<std::unique_ptr<editing::Command>(const editing::Model&, const Strands& selected)>;
    const auto add = [&](const ActionInfo& info, Make make, bool needsSelection) {
        menu->addAction(&actions_->add(info, [this, make = std::move(make), needsSelection] {
            const editing::Model& model = document_.editing().model();
            const Strands selected = editing::strandsWithFlag(model.groom, attribute::kSelected);
            if (needsSelection && selected.empty()) {
                messages_.say("Select strands first (E)");
                return;
            }
            document_.perform(make(model, selected));
        }));
    };
    using editing::Choice;
    add(
        {"select.all", QString("&All strands"), "", QString("Select all strands"), QKeySequence("Ctrl+A")},
        [](const editing::Model& model, const Strands&) {
            return editing::selectStrands(model, editing::allStrands(model.groom), Choice::Replace);
        },
        false);
    add(
        {"select.none", QString("&None"), "",
         QString("Deselect all strands, so that brushes affect all of them"), QKeySequence("Ctrl+Shift+A")},
        [](const editing::Model& model, const Strands&) {
            return editing::selectStrands(model, {}, Choice::Replace);
        },
        false);
    add(
        {"select.invert", QString("&Invert"), "", QString("Invert the selection"),
         QKeySequence("Ctrl+Shift+I")},
        [](const editing::Model& model, const Strands& selected) {
            return editing::selectStrands(model, others(model.groom, selected), Choice::Replace);
        },
        false);
    groupMenu_ = menu->addMenu("By &group");
    groupMenu_->setToolTipsVisible(true);
    connect(groupMenu_, &QMenu::aboutToShow, this, &MainWindow::fillGroupMenu);
    menu->addSeparator();
    add(
        {"select.hide", QString("&Hide selected"), "",
         QString("Hide the selected strands and protect them from brushes"), QKeySequence("Ctrl+H")},
        [](const editing::Model& model, const Strands& selected) {
            return editing::hideStrands(model, selected);
        },
        true);
    add(
        {"select.hideOthers", QString("Hide &others"), "", QString("Hide all strands that are not selected"),
         QKeySequence("Ctrl+Shift+H")},
        [](const editing::Model& model, const Strands& selected) {
            return editing::hideStrands(model, others(model.groom, selected));
        },
        true);
    add(
        {"select.show", QString("&Show all"), "", QString("Show all hidden strands"),
         QKeySequence("Ctrl+Alt+H")},
        [](const editing::Model& model, const Strands&) { return editing::showStrands(model); }, false);
    menu->addSeparator();
    add(
        {"select.freeze",
         QString("&Freeze selected"),
         "freeze",
         QString("Protect the selected strands from brushes"),
         {}},
        [](const editing::Model& model, const Strands& selected) {
            return editing::freezeStrands(model, selected, true);
        },
        true);
    add(
        {"select.thaw", QString("&Thaw all"), "", QString("Let brushes affect all strands again"), {}},
        [](const editing::Model& model, const Strands&) {
            return editing::freezeStrands(model, editing::allStrands(model.groom), false);
        },
        false);
    menu->addAction(&actions_->add(
        {"select.guides",
         QString("&Cluster guides…"),
         "",
         QString("Reduces many strands to a few guides by clustering, and interpolates hairs from them"),
         {}},
        [this] { chooseGuidesByClustering(); }));
    add(
        {"select.delete", QString("&Delete selected"), "delete", QString("Delete the selected strands"),
         QKeySequence("Del")},
        [](const editing::Model& model, const Strands& selected) {
            return editing::deleteStrands(model, selected);
        },
        true);
}

void MainWindow::fillGroupMenu() {
    groupMenu_->clear();
    const Groom& groom = document_.groom();
    for (std::uint32_t g = 0; g < groom.groupNames.size(); ++g) {
        const std::vector<std::uint32_t> strands = editing::strandsOfGroup(groom, g);
        QAction* action = groupMenu_->addAction(
            QString("%1 (%L2 strands)").arg(QString::fromStdString(groom.groupNames[g])).arg(strands.size()));
        action->setToolTip("Select the strands of this group");
        connect(action, &QAction::triggered, this, [this, g] {
            const editing::Model& model = document_.editing().model();
            document_.perform(editing::selectStrands(model, editing::strandsOfGroup(model.groom, g),
                                                     editing::Choice::Replace));
        });
    }
    if (groom.groupNames.empty()) groupMenu_->addAction("The hair has no groups")->setEnabled(false);
}

}  // namespace hairloom::editor
