// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Levels of detail: a budget, the chain that it gives with what each level loses, cards over the strands, and
// the file.

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <optional>

#include "editor/fields/number_box.h"
#include "editor/panels/accuracy_plot.h"
#include "editor/panels/card_box.h"
#include "editor/panels/card_marks.h"
#include "editor/panels/level_view.h"
#include "editor/panels/made_levels.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {

class LevelsPanel : public QWidget {
    Q_OBJECT

  public:
    explicit LevelsPanel(const PanelParts& parts);
    /// Writes the chain that is shown, in the background.
    void exportTo(const QString& path);

  private:
    NumberBox* addBudget(QFormLayout& form, const char* name, const QString& label, const QString& tip,
                         double min, double max, double value);
    QWidget* makeBudget();
    QWidget* makeLook(const PanelParts& parts);
    LevelBudget budget() const;
    void make();
    void choosePath();
    void noteChange(editing::Part changed);
    QString sentence() const;
    MadeLevel* chosen();
    void fillTable();
    void colourTable();
    void showPlot();
    void showDetail(const MadeLevel& made);
    void showChosen();
    void showTexture();
    void showCards();
    void refresh();

    QtDocument& document_;
    Preferences& preferences_;
    Tasks& tasks_;
    Messages& messages_;
    Viewport& viewport_;
    NumberBox *cards_ = nullptr, *textures_ = nullptr, *segments_ = nullptr, *distance_ = nullptr;
    QLabel* words_;
    QPushButton *make_ = nullptr, *export_ = nullptr;
    QTreeWidget* table_;
    QLabel* detail_;
    AccuracyPlot* plot_;
    QWidget* look_ = nullptr;
    LevelView* view_ = nullptr;
    QLabel* viewWords_ = nullptr;
    NumberBox* direction_ = nullptr;
    QCheckBox* over_ = nullptr;
    CardBox* card_ = nullptr;
    QComboBox* map_ = nullptr;
    QLabel* texture_ = nullptr;
    std::optional<MadeLevels> made_;
    std::vector<int> plotted_;  ///< of each point of the plot, its row
    CardMarks marks_;
    std::uint32_t documents_ = 0;  ///< replaced so far
    std::uint32_t changes_ = 0;    ///< of what levels are made from, so far
    std::uint32_t madeAt_ = 0;     ///< the number of them when `made_` was
};

}  // namespace hairloom::editor
