// SPDX-License-Identifier: GPL-3.0-or-later
// The stack of operators: a list in the order in which they act, and the settings of the one that is chosen.
#include <QClipboard>
#include <QGridLayout>
#include <QGuiApplication>
#include <QInputDialog>
#include <QKeyEvent>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QStandardPaths>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidgetAction>
#include <algorithm>

#include "core/editing/document.h"
#include "core/editing/mask_commands.h"
#include "core/editing/stack_commands.h"
#include "core/operations/curl_class.h"
#include "core/operations/stack_file.h"
#include "editor/document/words.h"
#include "editor/fields/field_form.h"
#include "editor/fields/formula_edit.h"
#include "editor/fields/image_button.h"
#include "editor/fields/mask_name_edit.h"
#include "editor/fields/mask_ramp.h"
#include "editor/panels/operator_kinds.h"
#include "editor/panels/panel.h"
#include "editor/tools/curve_tool.h"
#include "editor/tools/handle_tool.h"
#include "editor/viewport/strand_preview.h"

namespace hairloom::editor {
namespace {

constexpr int kThumbnail_px = 64;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

class OperatorsPanel : public QWidget {
  public:
    explicit OperatorsPanel(const PanelParts& parts)
        : document_(parts.document),
          preferences_(parts.preferences),
          messages_(parts.messages),
          tools_(parts.tools),
          list_(new QListWidget) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        auto* first = new QHBoxLayout;
        first->addWidget(makeAddButton());
        first->addWidget(pushButton("operatorBake", "Bake",
                                    "Apply all operators permanently and clear the stack",
                                    [this] { perform(editing::bakeOperators(model()), kNone); }));
        layout->addLayout(first);
        list_->setObjectName("operators");
        list_->setMinimumHeight(150);
        list_->setToolTip(
            "Operators that build the hair from its base shape, in order from the top. Clear a checkbox "
            "to mute an operator. Brush strokes go into a Sculpt operator at the end.");
        list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        list_->installEventFilter(this);
        layout->addWidget(list_);
        layout->addLayout(makeButtons());
        settings_ = new QVBoxLayout;
        layout->addLayout(settings_);
        layout->addStretch(1);
        connect(list_, &QListWidget::currentRowChanged, this, [this] { showSettings(); });
        connect(list_, &QListWidget::itemChanged, this, [this](QListWidgetItem* item) {
            mute(static_cast<std::size_t>(list_->row(item)), item->checkState() != Qt::Checked);
        });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
            if (contains(changed, editing::Part::Operators)) refresh();
        });
        connect(&document_, &QtDocument::replaced, this, [this] { chosen_ = kNone; });
        refresh();
    }

  protected:
    bool eventFilter(QObject* object, QEvent* event) override {
        if (object != list_ || event->type() != QEvent::KeyPress || chosen() == kNone)
            return QWidget::eventFilter(object, event);
        const auto* key = static_cast<QKeyEvent*>(event);
        const bool alt = key->modifiers() & Qt::AltModifier;
        if (key->key() == Qt::Key_Delete) {
            perform(editing::removeOperator(model(), chosen()), chosen());
        } else if (alt && key->key() == Qt::Key_Up && chosen() > 0) {
            move(chosen() - 1);
        } else if (alt && key->key() == Qt::Key_Down && chosen() + 1 < operators().size()) {
            move(chosen() + 1);
        } else {
            return QWidget::eventFilter(object, event);
        }
        return true;
    }

  private:
    const editing::Model& model() const { return document_.editing().model(); }
    const std::vector<Operator>& operators() const { return document_.groom().operators; }
    static QString labelOf(const Operator& one) {
        return hairloom::editor::labelOf(QString::fromStdString(one.op).replace('_', ' '));
    }
    static QString sentence(std::string_view words) {
        return asSentence(QString::fromUtf8(words.data(), static_cast<qsizetype>(words.size())));
    }

    QWidget* makeAddButton() {
        auto* add = new QPushButton("Add");
        add->setObjectName("operatorAdd");
        add->setToolTip("Add an operator after the selected one");
        auto* menu = new QMenu(add);
        menu->setToolTipsVisible(true);
        QString last;
        for (const StackOperator& known : operatorsByKind()) {
            const std::string name(known.name);
            if (const QString kind = operatorKind(name); kind != last) addCaption(*menu, last = kind);
            QAction* action = menu->addAction(operatorIcon(name), labelOf(newOperator(name)));
            action->setToolTip(sentence(known.meaning));
            connect(action, &QAction::triggered, this, [this, name] {
                const std::size_t at = chosen() == kNone ? operators().size() : chosen() + 1;
                perform(editing::addOperator(model(), at, newOperator(name, headScale(document_.groom()))),
                        at);
            });
        }
        add->setMenu(menu);
        return add;
    }

    QLayout* makeButtons() {
        QWidget* const buttons[] = {
            pushButton("operatorUp", "Move up", "Move the operator up, to apply it earlier (Alt+Up)",
                       [this] {
                           if (chosen() != kNone && chosen() > 0) move(chosen() - 1);
                       }),
            pushButton("operatorDown", "Move down", "Move the operator down, to apply it later (Alt+Down)",
                       [this] {
                           if (chosen() != kNone && chosen() + 1 < operators().size()) move(chosen() + 1);
                       }),
            pushButton("operatorRemove", "Remove", "Remove the operator (Delete)",
                       [this] {
                           if (chosen() != kNone)
                               perform(editing::removeOperator(model(), chosen()), chosen());
                       }),
            pushButton("operatorSolo", "Solo", "Apply only this operator. Click again to apply all",
                       [this] {
                           if (chosen() != kNone) perform(editing::soloOperator(model(), chosen()), chosen());
                       }),
            pushButton("operatorCopy", "Duplicate", "Duplicate the operator",
                       [this] {
                           if (chosen() != kNone)
                               perform(editing::copyOperator(model(), chosen()), chosen() + 1);
                       }),
            makePresetsButton(),
            pushButton("operatorClip", "Copy", "Copy the operator to the clipboard, also for other projects",
                       [this] {
                           if (chosen() != kNone) copy();
                       }),
            pushButton("operatorPaste", "Paste", "Paste operators from the clipboard after the selected one",
                       [this] { paste(); })};
        auto* grid = new QGridLayout;
        constexpr int kColumns = 3;
        for (int i = 0; i < static_cast<int>(std::size(buttons)); ++i)
            grid->addWidget(buttons[i], i / kColumns, i % kColumns);
        return grid;
    }

    QWidget* makePresetsButton() {
        auto* presets = new QPushButton("Presets");
        presets->setObjectName("operatorPresets");
        presets->setToolTip("Operators for a class of curl, and those that you saved for any project");
        auto* menu = new QMenu(presets);
        connect(menu, &QMenu::aboutToShow, this, [this, menu] { fillPresets(*menu); });
        fillPresets(*menu);
        presets->setMenu(menu);
        return presets;
    }

    void copy() {
        const Operator one = operators()[chosen()];
        QGuiApplication::clipboard()->setText(QString::fromStdString(operatorsText({&one, 1})));
    }
    void paste() {
        const std::string text = QGuiApplication::clipboard()->text().toStdString();
        insert(parseOperators("clipboard", text), "Paste operators");
    }
    /// Behind the chosen one.
    void insert(Result<std::vector<Operator>> added, const QString& name) {
        if (!added) {
            messages_.warn(errorText(added.error()));
            return;
        }
        const std::size_t at = chosen() == kNone ? operators().size() : chosen() + 1;
        const std::size_t count = added->size();
        perform(editing::addOperators(model(), at, std::move(*added), name.toStdString()), at + count - 1);
    }

    static std::filesystem::path folderOfStacks() {
        return (QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/stacks").toStdString();
    }
    void fillPresets(QMenu& menu) {
        menu.clear();
        QMenu* const curls = menu.addMenu("Curl");
        for (const CurlClass& curl : curlClasses()) {
            QAction* const action = curls->addAction(editor::labelOf(QString(curl.name)));
            action->setToolTip(QString("Strands of this class: %1").arg(curl.description));
            connect(action, &QAction::triggered, this, [this, &curl] {
                auto stack = withCurl(operators(), curl);
                const std::size_t last = stack.empty() ? kNone : stack.size() - 1;
                perform(editing::setOperators(model(), std::move(stack), std::string("Curl ") + curl.name),
                        last);
            });
        }
        curls->setToolTipsVisible(true);
        for (const std::string& name : stackPresets(folderOfStacks())) {
            auto* action = new QWidgetAction(&menu);
            action->setText(QString::fromStdString(name));
            auto* shown = new QToolButton;
            shown->setText(action->text());
            shown->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
            shown->setIconSize({kThumbnail_px, kThumbnail_px});
            shown->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
            shown->setToolTip("Adds these operators after the selected one");
            if (const auto file = stackPresetFile(folderOfStacks(), name))
                shown->setIcon(QIcon(QString::fromStdString(pictureOf(*file).string())));
            action->setDefaultWidget(shown);
            menu.addAction(action);
            connect(shown, &QToolButton::clicked, action, [&menu, action] {
                menu.close();
                action->trigger();
            });
            connect(action, &QAction::triggered, this, [this, name] {
                const auto file = stackPresetFile(folderOfStacks(), name);
                insert(file ? loadOperators(*file) : tl::unexpected(file.error()),
                       QString("Preset %1").arg(QString::fromStdString(name)));
            });
        }
        menu.addSeparator();
        connect(menu.addAction("Save operator as preset…"), &QAction::triggered, this, [this] {
            if (chosen() != kNone) keep({operators()[chosen()]});
        });
        connect(menu.addAction("Save stack as preset…"), &QAction::triggered, this,
                [this] { keep(operators()); });
    }
    void keep(const std::vector<Operator>& kept) {
        bool taken = false;
        const QString name =
            QInputDialog::getText(this, "Save preset", "Name", QLineEdit::Normal, {}, &taken);
        if (!taken || name.trimmed().isEmpty()) return;
        const auto file = stackPresetFile(folderOfStacks(), name.trimmed().toStdString());
        std::error_code problem;
        std::filesystem::create_directories(folderOfStacks(), problem);
        const Status saved = file ? saveOperators(*file, kept) : tl::unexpected(file.error());
        if (!saved) return messages_.warn(errorText(saved.error()));
        // The hair as it is when they are kept; a preset without its picture is one all the same.
        StrandPreview preview;
        preview.resize(preview.minimumSize());
        preview.show(document_.groom(), document_.groom().scalp);
        preview.grab()
            .scaled(2 * kThumbnail_px, 2 * kThumbnail_px, Qt::KeepAspectRatio, Qt::SmoothTransformation)
            .save(QString::fromStdString(pictureOf(*file).string()));
    }
    /// Beside the file of a preset.
    static std::filesystem::path pictureOf(std::filesystem::path preset) {
        return preset.replace_extension(".png");
    }

    QWidget* curveRow(std::size_t index) {
        auto* row = new QWidget;
        auto* layout = new QHBoxLayout(row);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->addWidget(new QLabel("Curve"));
        layout->addWidget(pushButton(
            "curveDraw", "Draw", "Draw over the head with the pen, or click point by point", [this, index] {
                auto* tool = dynamic_cast<CurveTool*>(tools_.find("curve"));
                if (!tool) return;
                tool->setOperator(index);
                tools_.activate(tool);
            }));
        layout->addWidget(
            pushButton("curveClear", "Clear", "Delete the curve. Without a curve the operator has no effect",
                       [this, index] {
                           if (index >= operators().size()) return;
                           Operator changed = operators()[index];
                           setCurveOf(changed, {});
                           perform(editing::setOperator(model(), index, changed, "Clear curve"), index);
                       }));
        return row;
    }

    std::size_t chosen() const {
        const int row = list_->currentRow();
        return row < 0 || static_cast<std::size_t>(row) >= operators().size() ? kNone
                                                                              : static_cast<std::size_t>(row);
    }

    /// `then` is chosen when it is done.
    void perform(editing::StackCommand command, std::size_t then) {
        if (!command) {
            messages_.warn(errorText(command.error()));
            return;
        }
        document_.perform(std::move(*command));
        if (then != kNone) list_->setCurrentRow(std::min(static_cast<int>(then), list_->count() - 1));
    }
    void move(std::size_t to) { perform(editing::moveOperator(model(), chosen(), to), to); }
    void mute(std::size_t index, bool muted) {
        if (index >= operators().size() || operators()[index].enabled == !muted) return;
        Operator changed = operators()[index];
        changed.enabled = !muted;
        const QString name = (muted ? QString("Mute %1") : QString("Unmute %1")).arg(labelOf(changed));
        perform(editing::setOperator(model(), index, changed, name.toStdString()), index);
        refresh();  // where it failed, the check goes back
    }

    void refresh() {
        const int row = list_->currentRow();
        {
            const QSignalBlocker quiet(list_);
            while (list_->count() > static_cast<int>(operators().size()))
                delete list_->takeItem(list_->count() - 1);
            for (std::size_t i = 0; i < operators().size(); ++i) {
                if (static_cast<int>(i) >= list_->count()) list_->addItem(QString());
                QListWidgetItem& item = *list_->item(static_cast<int>(i));
                const Operator& one = operators()[i];
                item.setText(labelOf(one));
                item.setToolTip(sentence(findStackOperator(one.op)->meaning));
                item.setCheckState(one.enabled ? Qt::Checked : Qt::Unchecked);
            }
            if (list_->count() > 0) list_->setCurrentRow(std::clamp(row, 0, list_->count() - 1));
        }
        showSettings();
    }

    /// New controls only where another operator is chosen, so that a slider outlives its own drag.
    void showSettings() {
        const std::size_t index = chosen();
        const std::string op = index == kNone ? std::string() : operators()[index].op;
        if (index == chosen_ && op == shown_ && settings_->count() > 0) return;
        chosen_ = index;
        shown_ = op;
        if (auto* tool = dynamic_cast<HandleTool*>(tools_.find("handles")); tool && index != kNone)
            tool->setOperator(index);
        while (QLayoutItem* item = settings_->takeAt(0)) {
            if (QWidget* form = item->widget()) {
                form->setParent(nullptr);  // gone at once; one of its controls may be what is talking
                form->deleteLater();
            }
            delete item;
        }
        if (index == kNone) {
            auto* none = new QLabel(
                "No operators yet. Add one to shape all hair. You can change it at any time. "
                "Start with Flow, which lays hair along the head.");
            none->setObjectName("operatorsNone");
            none->setProperty("role", "dim");
            none->setWordWrap(true);
            settings_->addWidget(none);
            return;
        }
        const auto failed = [this](const QString& words) { messages_.warn(words); };
        settings_->addWidget(heading(labelOf(operators()[index])));
        if (findStackOperator(op)->hasCurve) settings_->addWidget(curveRow(index));
        settings_->addWidget(new FieldForm(
            document_, preferences_,
            withFormulas(pickable(operatorFields(document_.groom(), index, failed), index, SettingsPart::own),
                         index)));
        settings_->addWidget(
            collapsible("Mask", maskForm(index, failed), !maskOf(operators()[index]).isWhole()));
        if (!findStackOperator(op)->hasRegion) return;
        auto* region = new FieldForm(
            document_, preferences_,
            pickable(operatorRegionFields(document_.groom(), index, failed), index, SettingsPart::region));
        settings_->addWidget(collapsible("Region", region, false));
    }

    /// Places can be pointed at.
    std::vector<Field> pickable(std::vector<Field> fields, std::size_t index, SettingsPart part) {
        for (Field& field : fields) {
            if (field.kind != FieldKind::Vector || QLatin1String(field.unit) != QLatin1String("m")) continue;
            field.pick = [this, index, part, info = FieldInfo(field)] {
                auto* tool = dynamic_cast<HandleTool*>(tools_.find("handles"));
                if (!tool) return;
                tools_.activate(tool);
                tool->pickOnHead(index, info, part);
            };
        }
        return fields;
    }

    std::vector<Field> withFormulas(std::vector<Field> fields, std::size_t index) {
        const auto takers = findStackOperator(operators()[index].op)->formulaFields;
        for (Field& field : fields) {
            const std::string_view name = field.name;
            if (std::ranges::find(takers, name) == takers.end()) continue;
            field.formula = [this, index, named = QString::fromUtf8(field.name)] {
                return new FormulaEdit(document_, index, named);
            };
        }
        return fields;
    }

    QWidget* maskForm(std::size_t index, const SayError& failed) {
        auto* form = new QWidget;
        auto* rows = new QVBoxLayout(form);
        rows->setContentsMargins(0, 0, 0, 0);
        rows->addWidget(
            new FieldForm(document_, preferences_, operatorMaskFields(document_.groom(), index, failed)));
        rows->addWidget(new MaskNameEdit(document_, [this, index]() -> std::uint32_t {
            if (index >= operators().size()) return 0;
            const MaskMap map = maskOf(operators()[index]).map;
            if (map < MaskMap::mask1) return 0;
            return static_cast<std::uint32_t>(map) - static_cast<std::uint32_t>(MaskMap::mask1) + 1;
        }));
        rows->addWidget(imageButton(
            "maskImage", "Mask from image…",
            "Fills the painted mask of the operator with the values of a PNG at the root UVs. If the "
            "operator has no mask, it gets the first unused one",
            [this, index](const MaskImage& image) { return takeMask(index, image); }, failed));
        rows->addWidget(imageButton(
            "regionsImage", "Regions from image…",
            "Fills an unused painted mask for each colour of a PNG at the root UVs. Operators then "
            "choose "
            "a region by its mask",
            [this](const MaskImage& image) { return takeRegions(image); }, failed));
        rows->addWidget(new MaskRamp(document_, index, failed));
        rows->addWidget(new FormulaEdit(document_, index));
        return form;
    }

    Status takeMask(std::size_t index, const MaskImage& image) {
        const auto values = valuesAtRoots(image, document_.groom());
        if (!values) return tl::unexpected(values.error());
        auto step = editing::fillMaskOf(model(), index, *values);
        if (!step) return tl::unexpected(step.error());
        document_.perform(std::move(*step));
        return {};
    }

    Status takeRegions(const MaskImage& image) {
        const auto regions = regionsAtRoots(image, document_.groom());
        if (!regions) return tl::unexpected(regions.error());
        const auto numbers = editing::masksFor(document_.groom(), regions->size());
        if (!numbers) return tl::unexpected(numbers.error());
        std::vector<std::vector<float>> values;
        QStringList told;
        for (std::size_t i = 0; i < regions->size(); ++i) {
            const ColourRegion& region = (*regions)[i];
            values.push_back(region.shares);
            told += QString("mask %1: %2 (%L3 strands)")
                        .arg((*numbers)[i])
                        .arg(QString::fromStdString(region.name))
                        .arg(region.strands);
        }
        document_.perform(editing::fillMasks(model(), "Regions from image", *numbers, values,
                                             namesOfRegions(document_.groom(), *numbers, *regions)));
        messages_.say(QString("Regions from image: %1").arg(told.join(QStringLiteral(", "))));
        return {};
    }

    QtDocument& document_;
    const Preferences& preferences_;
    Messages& messages_;
    ToolBox& tools_;
    QListWidget* list_;
    QVBoxLayout* settings_ = nullptr;
    std::size_t chosen_ = kNone;
    std::string shown_;
};

}  // namespace

PanelInfo operatorsPanel() {
    return {
        "operators",
        QString("Operators"),
        "comb",
        Qt::LeftDockWidgetArea,
        25,
        true,
        [](const PanelParts& parts) -> QWidget* { return scrolled(column({new OperatorsPanel(parts)})); }};
}

}  // namespace hairloom::editor
