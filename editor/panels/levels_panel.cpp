// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/levels_panel.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QHeaderView>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/output_file.h"
#include "core/levels/level_report.h"
#include "editor/document/words.h"
#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

enum Column { kName, kTriangles, kFrom, kFlip, kColumns };

constexpr int kFails = Qt::UserRole;  ///< of a row: labels of the measures that it fails

/// All that a level is made from.
constexpr editing::Part kShown = editing::kHairParts | editing::kScalpParts | editing::Part::Spheres |
                                 editing::Part::Material | editing::Part::Interpolation | editing::Part::Dye |
                                 editing::Part::Widths | editing::Part::Operators | editing::Part::Cards;

/// The height of a head in pixels that is seen from so far, of those that levels can have.
std::uint32_t headPxAt(double metres) {
    const double px = cards::distanceOf(512) / metres * 512;
    return static_cast<std::uint32_t>(std::clamp(std::exp2(std::round(std::log2(px))), 16.0, 512.0));
}

/// A texture over a chequered ground, which shows through where no hair is.
QPixmap onChequers(const QImage& texture, int width) {
    const QImage shown = texture.scaledToWidth(std::max(32, width), Qt::SmoothTransformation);
    QPixmap pixmap(shown.size());
    QPainter painter(&pixmap);
    painter.fillRect(shown.rect(), QColor(72, 74, 80));
    painter.fillRect(shown.rect(), QBrush(QColor(96, 98, 104), Qt::Dense4Pattern));
    painter.drawImage(0, 0, shown);
    return pixmap;
}

/// "rim, holes"
QString failedMeasures(const cards::Level& level) {
    QStringList labels;
    for (const cards::Measure& measure : cards::allMeasures())
        if (level.failsBy(measure))
            labels.append(
                QString::fromUtf8(measure.label.data(), static_cast<qsizetype>(measure.label.size())));
    return labels.join(", ");
}

}  // namespace

LevelsPanel::LevelsPanel(const PanelParts& parts)
    : document_(parts.document),
      preferences_(parts.preferences),
      tasks_(parts.tasks),
      messages_(parts.messages),
      viewport_(parts.viewport),
      words_(new QLabel),
      table_(new QTreeWidget),
      detail_(new QLabel),
      plot_(new AccuracyPlot) {
    setObjectName("levels");
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    words_->setObjectName("levelsWords");
    words_->setWordWrap(true);
    layout->addWidget(words_);
    layout->addWidget(makeBudget());
    table_->setObjectName("levelsTable");
    table_->setRootIsDecorated(false);
    table_->setHeaderLabels({"Level", "Tri.", "From", "FLIP"});
    table_->setToolTip(
        "Triangles of each level, the distance in metres at which it starts, and FLIP, the visible "
        "difference "
        "from all strands at that distance, where 0 is none. A level in red fails a measure: point at it. "
        "Click a level to see it, and more about it below");
    table_->header()->setStretchLastSection(false);
    table_->header()->setMinimumSectionSize(24);
    table_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
    table_->header()->setSectionResizeMode(kName, QHeaderView::Stretch);
    table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    layout->addWidget(table_);
    detail_->setObjectName("levelsDetail");
    detail_->setWordWrap(true);
    detail_->setToolTip(
        "Coverage and light: as a share of those of all strands. Step: the largest change in light when the "
        "level replaces the one before it or on the way to the next. Fails: measures from 24 directions and "
        "while the head nods");
    layout->addWidget(detail_);
    plot_->setObjectName("levelsPlot");
    plot_->setAccessibleName("FLIP of each level by distance");
    plot_->setAxes("distance", "m", "FLIP vs. all strands");
    plot_->setLines(true);
    layout->addWidget(plot_);
    layout->addWidget(makeLook(parts));
    connect(table_, &QTreeWidget::currentItemChanged, this, &LevelsPanel::showChosen);
    connect(plot_, &AccuracyPlot::clicked, this,
            [this](std::size_t point) { table_->setCurrentItem(table_->topLevelItem(plotted_[point])); });
    connect(&preferences_, &Preferences::changed, this, &LevelsPanel::colourTable);
    connect(&document_, &QtDocument::changed, this, &LevelsPanel::noteChange);
    connect(&document_, &QtDocument::replaced, this, [this] {
        card_->setLevel(nullptr, nullptr);
        made_.reset();
        ++documents_;
        fillTable();
        refresh();
    });
    viewport_.addMarks([this](Marks& marks) {
        if (over_->isChecked() && !viewport_.pose()) marks_.draw(marks, card_->picked());
    });
    refresh();
}

NumberBox* LevelsPanel::addBudget(QFormLayout& form, const char* name, const QString& label,
                                  const QString& tip, double min, double max, double value) {
    auto* box = new NumberBox(min, max, true);
    box->setObjectName(name);
    box->setToolTip(tip);
    box->setValue(value);
    form.addRow(label, box);
    return box;
}

QWidget* LevelsPanel::makeBudget() {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    auto* form = new QFormLayout;
    form->setVerticalSpacing(6);
    layout->addLayout(form);
    const LevelBudget standard;
    cards_ = addBudget(*form, "levelCards", "Cards",
                       "Maximum number of cards in the nearest level. The next levels have a half "
                       "and a quarter of them",
                       1, 1000, standard.cards);
    textures_ =
        addBudget(*form, "levelTextures", "Textures",
                  "Maximum number of textures in a level. Cards that look alike share one. 0 makes as "
                  "many as fit the atlas that 32 need",
                  0, 256, standard.chain.textures);
    segments_ = addBudget(*form, "levelSegments", "Segments",
                          "Maximum number of segments per card. A card has fewer if they would not change "
                          "its outline by a third of a pixel",
                          1, 24, standard.chain.segments);
    distance_ = new NumberBox(cards::distanceOf(512), cards::distanceOf(16), false);
    distance_->setObjectName("levelDistance");
    distance_->setShown(1, "m", 2);
    distance_->setValue(cards::distanceOf(standard.headPx));
    distance_->setToolTip(
        "Distance in metres at which the nearest cards start, in an image of 1080 lines and 40° field of "
        "view. Each further level starts at twice that distance. The choices are distances where a head "
        "is 512, 256 … 16 pixels high");
    form->addRow("From", distance_);
    connect(distance_, &NumberBox::edited, this,
            [this](double metres) { distance_->setValue(cards::distanceOf(headPxAt(metres))); });
    auto* row = new QHBoxLayout;
    make_ = pushButton("levelsMake", "Create",
                       "Creates the levels and compares each with all strands. Takes one or two minutes "
                       "for a full head of hair. You can cancel it in the status line",
                       [this] { make(); });
    export_ = pushButton("levelsExport", "Export glTF…",
                         "Export the cards and the shell as shown, with textures, joints and springs",
                         [this] { choosePath(); });
    row->addWidget(make_);
    row->addWidget(export_);
    layout->addLayout(row);
    return widget;
}

QWidget* LevelsPanel::makeLook(const PanelParts& parts) {
    look_ = new QWidget;
    auto* layout = new QVBoxLayout(look_);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    over_ = new QCheckBox("Cards over strands");
    over_->setObjectName("levelOver");
    over_->setToolTip(
        "Draws the cards of this level in the viewport, each in its own colour, while the hair is at rest");
    connect(over_, &QCheckBox::toggled, this, [this] { viewport_.redraw(); });
    layout->addWidget(over_);
    card_ = new CardBox(document_, messages_, parts.tools);
    connect(card_, &CardBox::changed, this, [this] {
        if (card_->picked()) over_->setChecked(true);
        showCards();
    });
    connect(&parts.tools, &ToolBox::activeChanged, this, [this](Tool* tool) {
        if (dynamic_cast<CardTool*>(tool) != nullptr) over_->setChecked(true);
    });
    layout->addWidget(card_);
    layout->addWidget(heading("At its distance"));
    viewWords_ = new QLabel;
    viewWords_->setObjectName("levelViewWords");
    viewWords_->setWordWrap(true);
    viewWords_->setProperty("role", "dim");
    layout->addWidget(viewWords_);
    view_ = new LevelView;
    view_->setObjectName("levelView");
    view_->setToolTip("All strands on the left, the level on the right. Drag the line to move the split");
    layout->addWidget(view_);
    auto* form = new QFormLayout;
    form->setVerticalSpacing(6);
    direction_ = new NumberBox(1, 4, true);
    direction_->setObjectName("levelDirection");
    direction_->setValue(1);
    direction_->setToolTip("View from the front, left, back or right");
    connect(direction_, &NumberBox::edited, this, &LevelsPanel::showChosen);
    form->addRow("Side", direction_);
    layout->addLayout(form);
    layout->addWidget(heading("Textures"));
    map_ = new QComboBox;
    map_->setObjectName("levelMap");
    map_->setToolTip(
        "Colour: albedo and coverage. Shape: flow, depth, ambient occlusion. Normal. Strand: root to tip, "
        "strand number");
    connect(map_, &QComboBox::currentIndexChanged, this, &LevelsPanel::showTexture);
    layout->addWidget(map_);
    texture_ = new QLabel;
    texture_->setObjectName("levelTexture");
    texture_->setToolTip("The texture atlas of the level. Cards that look alike share a region");
    layout->addWidget(texture_);
    return look_;
}

LevelBudget LevelsPanel::budget() const {
    LevelBudget budget;
    budget.cards = static_cast<std::uint32_t>(cards_->value());
    budget.chain.textures = static_cast<std::uint32_t>(textures_->value());
    budget.chain.segments = static_cast<std::uint32_t>(segments_->value());
    budget.headPx = headPxAt(distance_->value());
    return budget;
}

void LevelsPanel::make() {
    const auto groom = std::make_shared<const Groom>(document_.groom());
    tasks_.measure<MadeLevels>(
        "Creating levels",
        [groom, budget = budget()](TaskControl& control) { return makeShownLevels(*groom, budget, control); },
        [this, document = documents_, change = changes_](MadeLevels made) {
            if (document != documents_) return;
            card_->setLevel(nullptr, nullptr);
            made_ = std::move(made);
            madeAt_ = change;
            fillTable();
            refresh();
        });
}

void LevelsPanel::choosePath() {
    const QString name = QFileInfo(document_.title()).completeBaseName() + ".glb";
    const QString path = QFileDialog::getSaveFileName(this, "Export glTF", name, "*.glb");
    if (!path.isEmpty()) exportTo(path);
}

void LevelsPanel::exportTo(const QString& path) {
    if (!made_) return;
    const LevelFile& file = made_->file;
    if (auto written = writeFileAtomically(path.toStdString(), file.bytes); !written)
        return messages_.warn(errorText(written.error()));
    const QString size =
        locale().formattedDataSize(static_cast<qint64>(file.bytes.size()), 1, QLocale::DataSizeSIFormat);
    QString words = QString("Exported %1: %2 levels, %3")
                        .arg(QFileInfo(path).fileName())
                        .arg(file.report.levels.size())
                        .arg(size);
    if (madeAt_ != changes_) words += "; " + QString("as created before the last change");
    const auto warning = std::ranges::find(file.report.findings, Severity::Warning, &Finding::severity);
    if (warning == file.report.findings.end()) return messages_.say(words);
    messages_.warn(words + "; " + QString::fromStdString(warning->what));
}

void LevelsPanel::noteChange(editing::Part changed) {
    if (!contains(changed, kShown)) return;
    ++changes_;
    words_->setText(sentence());
    make_->setEnabled(document_.groom().strandCount() > 0);
}

QString LevelsPanel::sentence() const {
    if (document_.groom().strandCount() == 0) return QString("Place hair to create levels of detail.");
    if (!made_)
        return QString(
            "Replacements for this hair at a distance: fewer strands, cards and a shell. Each is compared "
            "with all strands at its distance.");
    QString text = QString("For %L1 hairs in %2 s.").arg(made_->strands).arg(made_->seconds, 0, 'f', 1);
    for (const Finding& finding : made_->file.report.findings)
        if (finding.where == kCardEditsPlace) text += ' ' + QString::fromStdString(finding.what) + '.';
    if (madeAt_ != changes_) text += ' ' + QString("The hair has changed: create the levels again.");
    return text;
}

MadeLevel* LevelsPanel::chosen() {
    const int row = table_->indexOfTopLevelItem(table_->currentItem());
    return made_ && row >= 0 ? &made_->levels[static_cast<std::size_t>(row)] : nullptr;
}

void LevelsPanel::fillTable() {
    const int before = table_->indexOfTopLevelItem(table_->currentItem());
    table_->clear();
    if (!made_) return;
    int firstCards = -1;
    for (const MadeLevel& made : made_->levels) {
        const cards::Level& level = made.level;
        auto* item = new QTreeWidgetItem(table_);
        item->setText(kName, QString::fromStdString(level.name));
        constexpr std::size_t kThousand = 1000, kMany = 10 * kThousand;
        const auto thousands = static_cast<double>(level.triangles) / kThousand;
        item->setText(kTriangles, level.triangles < kMany
                                      ? QStringLiteral("%L1").arg(level.triangles)
                                      : QStringLiteral("%L1 k").arg(thousands, 0, 'f', 0));
        item->setText(kFrom, QString::number(cards::distanceOf(level.spec.headPx), 'f', 2));
        item->setText(kFlip, QString::number(level.difference.flip, 'f', 3));
        for (int c = kTriangles; c < kColumns; ++c)
            item->setTextAlignment(c, Qt::AlignRight | Qt::AlignVCenter);
        if (const QString fails = failedMeasures(level); !fails.isEmpty()) {
            item->setData(kName, kFails, fails);
            for (int c = kName; c < kColumns; ++c)
                item->setToolTip(c, QString::fromStdString(failureWords(level)));
        }
        if (firstCards < 0 && level.cards() > 0) firstCards = table_->topLevelItemCount() - 1;
    }
    colourTable();
    const int rows = table_->topLevelItemCount();
    table_->setFixedHeight(table_->header()->sizeHint().height() + rows * table_->sizeHintForRow(0) + 4);
    table_->setCurrentItem(
        table_->topLevelItem(before >= 0 && before < rows ? before : std::max(0, firstCards)));
}

void LevelsPanel::colourTable() {
    const QColor red = themeColours(preferences_.theme()).bad;
    for (int row = 0; row < table_->topLevelItemCount(); ++row) {
        QTreeWidgetItem* const item = table_->topLevelItem(row);
        if (item->data(kName, kFails).isNull()) continue;
        for (int c = kName; c < kColumns; ++c) item->setForeground(c, red);
    }
}

void LevelsPanel::showPlot() {
    std::vector<AccuracyPoint> points;
    plotted_.clear();
    const int chosen = table_->indexOfTopLevelItem(table_->currentItem());
    std::optional<std::size_t> start;
    for (int row = 0; row < table_->topLevelItemCount(); ++row) {
        const cards::Level& level = made_->levels[static_cast<std::size_t>(row)].level;
        for (const cards::FlipAt& at : level.flips) {
            if (!(at.flip > 0)) continue;  // all strands themselves
            const double metres = cards::distanceOf(at.headPx);
            if (row == chosen && at.headPx == level.spec.headPx) start = points.size();
            plotted_.push_back(row);
            points.push_back({metres, metres, metres, at.flip, false, row == chosen,
                              QString::fromStdString(level.name), static_cast<std::size_t>(row)});
        }
    }
    plot_->setPoints(std::move(points), {});
    plot_->setMarked(start, {});
}

void LevelsPanel::showDetail(const MadeLevel& made) {
    const cards::Level& level = made.level;
    const cards::Difference& off = level.difference;
    QString text = QString::fromStdString(level.name) + ": ";
    if (level.cards() > 0) text += QString("%L1 cards, ").arg(level.cards());
    text += QString("%1 MB, coverage %2, light %3, step %4 %.")
                .arg(static_cast<double>(level.bytes) / 1e6, 0, 'f', 2)
                .arg(off.coverage, 0, 'f', 3)
                .arg(off.light, 0, 'f', 3)
                .arg(100 * made.lightStep, 0, 'f', 1);
    if (const std::string fails = failureWords(level); !fails.empty())
        text += ' ' + QString("Fails: %1.").arg(QString::fromStdString(fails));
    detail_->setText(text);
}

void LevelsPanel::showChosen() {
    MadeLevel* made = chosen();
    const bool hasCards = made != nullptr && made->level.spec.kind == cards::LevelKind::cards;
    card_->setLevel(hasCards ? made : nullptr, made_ ? &made_->roots_ws : nullptr);
    showCards();
    if (made == nullptr) return view_->show({}, {});
    showDetail(*made);
    showPlot();
    const std::size_t side = std::min(made->shots.size(), static_cast<std::size_t>(direction_->value())) - 1;
    view_->show(made->strands[side], made->shots[side]);
    viewWords_->setText(QString("Strands | %1, as seen from %2 m: a head of %3 pixels in 1080 lines")
                            .arg(QString::fromStdString(made->level.name))
                            .arg(cards::distanceOf(made->level.spec.headPx), 0, 'f', 2)
                            .arg(made->level.spec.headPx));
    const int map = std::max(0, map_->currentIndex());
    map_->clear();
    for (const MadeLevel::Texture& texture : made->textures) map_->addItem(texture.name);
    map_->setEnabled(!made->textures.empty());
    if (!made->textures.empty()) map_->setCurrentIndex(map);
    showTexture();
}

void LevelsPanel::showCards() {
    const MadeLevel* made = chosen();
    const auto* cards = made == nullptr ? nullptr : std::get_if<cards::Cards>(&made->level.content);
    marks_ = cards == nullptr ? CardMarks() : CardMarks(*cards);
    viewport_.redraw();
}

void LevelsPanel::showTexture() {
    const MadeLevel* made = chosen();
    const int map = map_->currentIndex();
    if (made == nullptr || map < 0 || static_cast<std::size_t>(map) >= made->textures.size())
        return texture_->setPixmap({});
    constexpr int kWidth = 220;  // the narrowest panel has it
    texture_->setPixmap(onChequers(made->textures[static_cast<std::size_t>(map)].image, kWidth));
}

void LevelsPanel::refresh() {
    words_->setText(sentence());
    make_->setEnabled(document_.groom().strandCount() > 0);
    const bool any = made_.has_value();
    export_->setEnabled(any);
    for (QWidget* part :
         {static_cast<QWidget*>(table_), static_cast<QWidget*>(detail_), static_cast<QWidget*>(plot_), look_})
        part->setVisible(any);
    showChosen();
}

PanelInfo levelsPanel() {
    return {"levels",
            QString("Levels"),
            "overlay",
            Qt::RightDockWidgetArea,
            97,
            true,
            [](const PanelParts& parts) -> QWidget* {
                return scrolled(column({heading("Levels of detail"), new LevelsPanel(parts)}));
            }};
}

}  // namespace hairloom::editor
