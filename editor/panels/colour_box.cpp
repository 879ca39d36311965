// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/colour_box.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QLabel>
#include <QStyle>

namespace hairloom::editor {
namespace {

constexpr const char* kChooseFile = "?";

class ColourBox : public QWidget {
  public:
    explicit ColourBox(const PanelParts& parts)
        : preferences_(parts.preferences), viewport_(parts.viewport), messages_(parts.messages) {
        auto* rows = new QFormLayout(this);
        rows->setContentsMargins(0, 0, 0, 0);
        rows->setVerticalSpacing(6);
        config_ = add(*rows, "colourConfig", "Config",
                      "OpenColorIO config for the viewport and for images. Standard uses Hairloom's own tone "
                      "curve and sRGB");
        display_ = add(*rows, "colourDisplay", "Display", "Display of the config that you look at");
        view_ = add(*rows, "colourView", "View", "View of the config. Exposure is applied before it");
        display_->setPlaceholderText("sRGB");
        view_->setPlaceholderText("Tone curve");
        state_ = new QLabel;
        state_->setObjectName("colourState");
        state_->setWordWrap(true);
        state_->setTextFormat(Qt::PlainText);
        state_->setVisible(false);
        rows->addRow(state_);
        connect(config_, &QComboBox::activated, this, [this] { takeConfig(); });
        connect(display_, &QComboBox::activated, this, [this] {
            preferences_.setColours({preferences_.colours().config, textOf(display_), {}});
        });
        connect(view_, &QComboBox::activated, this, [this] {
            preferences_.setColours({preferences_.colours().config, textOf(display_), textOf(view_)});
        });
        connect(&preferences_, &Preferences::changed, this, [this] {
            if (preferences_.colours() != shown_) show();
        });
        connect(&viewport_, &Viewport::drawn, this, [this](const PictureReport& report) {
            if (report.displayError == displayError_) return;
            displayError_ = report.displayError;
            say();
        });
        show();
    }

  private:
    QComboBox* add(QFormLayout& rows, const char* name, const QString& label, const QString& tip) {
        auto* box = new QComboBox;
        box->setObjectName(name);
        box->setToolTip(tip);
        box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        rows.addRow(label, box);
        return box;
    }
    static std::string textOf(const QComboBox* box) { return box->currentText().toStdString(); }

    void takeConfig() {
        QString chosen = config_->currentData().toString();
        if (chosen == kChooseFile) {
            chosen = QFileDialog::getOpenFileName(this, "Colour config", {}, "OpenColorIO configs (*.ocio)");
            if (chosen.isEmpty()) return fillConfigs();
        }
        // The same one again: its files may have changed.
        if (chosen.toStdString() == shown_.config) return show();
        preferences_.setColours({chosen.toStdString(), {}, {}});
    }

    void fillConfigs() {
        const QString file = QString::fromStdString(shown_.config);
        config_->clear();
        config_->addItem("Standard", colour::kNoConfig);
        const QString named = QString::fromStdString(colour::configFile({}).string());
        if (!named.isEmpty()) {
            config_->addItem("$OCIO", "");
            config_->setItemData(config_->count() - 1, named, Qt::ToolTipRole);
        }
        if (!file.isEmpty() && file != colour::kNoConfig) {
            config_->addItem(QFileInfo(file).fileName(), file);
            config_->setItemData(config_->count() - 1, file, Qt::ToolTipRole);
        }
        if (colour::hasOpenColorIO()) config_->addItem("Choose…", kChooseFile);
        config_->setCurrentIndex(std::max(0, config_->findData(file)));
    }

    void show() {
        shown_ = preferences_.colours();
        problem_.clear();
        note_.clear();
        displayError_ = 0;
        display_->clear();
        view_->clear();
        fillConfigs();
        std::shared_ptr<const render::ColourTransform> toDisplay;
        if (!colour::configFile(shown_).empty()) toDisplay = choose();
        display_->setEnabled(display_->count() > 0);
        view_->setEnabled(view_->count() > 0);
        viewport_.setColours(std::move(toDisplay));
        say();
        if (!problem_.isEmpty()) messages_.warn(problem_);
    }

    /// Null, and what is wrong, where the standard colours remain.
    std::shared_ptr<const render::ColourTransform> choose() {
        const auto wrong = [this](const Error& error) {
            problem_ = QString("Standard colours are shown. %1").arg(QString::fromStdString(error.message()));
            return nullptr;
        };
        const auto config = colour::readConfig(shown_);
        if (!config) return wrong(config.error());
        for (const colour::Display& display : config->displays())
            display_->addItem(QString::fromStdString(display.name));
        const std::string display =
            shown_.display.empty() ? display_->itemText(0).toStdString() : shown_.display;
        display_->setCurrentIndex(display_->findText(QString::fromStdString(display)));
        for (const colour::Display& known : config->displays()) {
            if (known.name != display) continue;
            for (const std::string& view : known.views) view_->addItem(QString::fromStdString(view));
        }
        view_->setCurrentIndex(shown_.view.empty() ? 0
                                                   : view_->findText(QString::fromStdString(shown_.view)));
        const auto colours = colour::chooseView(*config, shown_.display, shown_.view);
        if (!colours) return wrong(colours.error());
        note_ = QString::fromStdString(config->working().note);
        return colours->toDisplay;
    }

    void say() {
        QString text = problem_;
        if (problem_.isEmpty() && viewport_.colours() != nullptr) {
            text = note_;
            if (displayError_ > 1) {
                if (!text.isEmpty()) text += "\n";
                text += QString(
                            "The viewport differs from this view by up to %1 of 255. Images of the command "
                            "line are exact")
                            .arg(displayError_);
            }
        }
        state_->setProperty("role", problem_.isEmpty() ? "dim" : "problem");
        state_->style()->polish(state_);
        state_->setText(text);
        state_->setVisible(!text.isEmpty());
    }

    Preferences& preferences_;
    Viewport& viewport_;
    Messages& messages_;
    QComboBox *config_, *display_, *view_;
    QLabel* state_;
    colour::ColourChoice shown_;
    QString problem_, note_;
    int displayError_ = 0;
};

}  // namespace

QWidget* makeColours(const PanelParts& parts) {
    return new ColourBox(parts);
}

}  // namespace hairloom::editor
