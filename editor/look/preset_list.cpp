// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCryptographicHash>
#include <QDir>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QListWidget>
#include <QPainter>
#include <QPushButton>
#include <QStandardPaths>
#include <QVBoxLayout>

#include "core/documents/look_presets.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/groom/file/settings_json.h"
#include "editor/document/words.h"
#include "editor/fields/colour.h"
#include "editor/look/parts.h"
#include "editor/look/tress.h"

namespace hairloom::editor {
namespace {

constexpr int kSide = 60;  // of a thumbnail, in pixels of the interface
constexpr int kPicture = 2 * kSide;
constexpr int kSoonMs = 700;
constexpr const char* kPrefix = "look:";

QString words(const std::string& text) {
    return QString::fromStdString(text);
}

std::filesystem::path folderOfLooks() {
    return (QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/looks").toStdString();
}

/// Colours are what it is for: those of a selected one are not tinted.
QIcon shownAlways(const QPixmap& picture) {
    QIcon icon(picture);
    icon.addPixmap(picture, QIcon::Selected);
    return icon;
}

/// While the device has not drawn it yet, and where there is none: tip over root.
QPixmap swatch(const HairMaterial& material) {
    QPixmap pixmap(kPicture, kPicture);
    QPainter painter(&pixmap);
    QLinearGradient gradient(0, 0, 0, kPicture);
    gradient.setColorAt(0, fromLinear(material.rootColour));
    gradient.setColorAt(1, fromLinear(material.tipColour));
    painter.fillRect(pixmap.rect(), gradient);
    return pixmap;
}

class PresetList : public QWidget {
  public:
    PresetList(QtDocument& document, Messages& messages, Viewport& viewport)
        : document_(document), messages_(messages), viewport_(viewport), list_(new QListWidget) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(6);
        list_->setObjectName("looks");
        list_->setViewMode(QListView::IconMode);
        list_->setResizeMode(QListView::Adjust);
        list_->setMovement(QListView::Static);
        list_->setIconSize({kSide, kSide});
        list_->setGridSize({kSide + 18, kSide + 28});
        list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        list_->setFixedHeight(2 * (kSide + 28) + 16);
        list_->setToolTip("Click a look to apply it to the hair");
        layout->addWidget(list_);
        auto* row = new QHBoxLayout;
        auto* save = new QPushButton("Save preset…");
        save->setObjectName("saveLook");
        save->setToolTip("Saves all material settings of this panel as a preset for any document");
        row->addWidget(save);
        row->addStretch(1);
        layout->addLayout(row);
        connect(list_, &QListWidget::itemClicked, this, &PresetList::apply);
        connect(list_, &QListWidget::itemActivated, this, &PresetList::apply);
        connect(save, &QPushButton::clicked, this, &PresetList::save);
        connect(&viewport_, &Viewport::sidePictureReady, this, &PresetList::takePicture);
        soon_.setSingleShot(true);
        soon_.setInterval(kSoonMs);
        connect(&soon_, &QTimer::timeout, this, &PresetList::askForPictures);
        // Not while the program starts or a document opens.
        connect(&viewport_, &Viewport::drawn, this, [this] {
            if (!shownWith_ && isVisible()) soon_.start();
        });
        const auto askAnew = [this] {
            if (!shownWith_ || *shownWith_ == drawnWith()) return;
            shownWith_.reset();
            for (std::size_t i = 0; i < looks_.size(); ++i) showSwatch(i);
            soon_.start();
        };
        connect(&document_, &QtDocument::changed, this, [askAnew](editing::Part parts) {
            if (contains(parts, editing::Part::Material)) askAnew();
        });
        fill();
    }

  private:
    struct Look {
        QString name;
        HairMaterial material;
        const LookPreset* preset = nullptr;  ///< of those that come along
    };

    void fill() {
        looks_.clear();
        list_->clear();
        for (const LookPreset& preset : lookPresets()) {
            HairMaterial material;
            applyLook(preset, material);
            add({words(preset.name), material, &preset}, words(preset.description));
        }
        for (const std::string& name : savedLooks(folderOfLooks())) {
            if (auto material = loadLook(folderOfLooks(), name)) {
                add({words(name), *material, nullptr}, "A preset that you saved");
            } else {
                messages_.warn(errorText(material.error()));
            }
        }
        shownWith_.reset();
    }

    void add(Look look, const QString& tip) {
        QString label = look.name;
        label[0] = label[0].toUpper();
        auto* item = new QListWidgetItem(shownAlways(swatch(look.material)), label);
        item->setToolTip(tip);
        list_->addItem(item);
        looks_.push_back(std::move(look));
    }

    void apply(QListWidgetItem* item) {
        const Look& look = looks_[static_cast<std::size_t>(list_->row(item))];
        Groom groom = document_.groom();
        if (look.preset) {
            applyLook(*look.preset, groom);
        } else {
            groom.material = look.material;
        }
        const editing::Model& model = document_.editing().model();
        const std::string name = QString("Look %1").arg(item->text()).toStdString();
        // A look of another thickness also takes the radii that points carry.
        const bool sameRadii = groom.pointAttributes.has(attribute::kRadius) ==
                               model.groom.pointAttributes.has(attribute::kRadius);
        document_.perform(sameRadii ? editing::setMaterial(model, groom.material, name)
                                    : editing::replaceGroom(model, std::move(groom), name));
    }

    void save() {
        bool taken = false;
        const QString name =
            QInputDialog::getText(this, "Save preset", "Name", QLineEdit::Normal, {}, &taken);
        if (!taken || name.trimmed().isEmpty()) return;
        const auto& material = document_.groom().material;
        if (auto saved = saveLook(folderOfLooks(), name.trimmed().toStdString(), material); !saved) {
            messages_.warn(errorText(saved.error()));
            return;
        }
        fill();
        askForPictures();
    }

    /// Draws the thumbnails of looks that have no model of their own.
    ShadingModel drawnWith() const { return document_.groom().material.shadingModel; }
    /// As it would look on the hair.
    HairMaterial materialOf(const Look& look) const {
        HairMaterial material = look.material;
        if (look.preset) material.shadingModel = drawnWith();
        return material;
    }

    /// Drawn once for a material, then kept on disk.
    QString cacheFile(const Look& look) const {
        QByteArray what = QByteArray::fromStdString(toJson(materialOf(look)).dump());
        what += QByteArray::number(kTressVersion);
        const QByteArray hash = QCryptographicHash::hash(what, QCryptographicHash::Sha1).toHex();
        return QStandardPaths::writableLocation(QStandardPaths::CacheLocation) + "/looks/" +
               QString::fromLatin1(hash) + ".png";
    }

    void askForPictures() {
        shownWith_ = drawnWith();
        for (std::size_t i = 0; i < looks_.size(); ++i) {
            const QString file = cacheFile(looks_[i]);
            const QPixmap kept(file);
            if (!kept.isNull()) {
                show(i, kept);
            } else {
                viewport_.requestSidePicture(kPrefix + file, tressPicture(materialOf(looks_[i]), kPicture));
            }
        }
    }

    /// One that was asked for before the model changed is of no look any more.
    void takePicture(const QString& name, const QImage& picture) {
        for (std::size_t i = 0; i < looks_.size(); ++i) {
            const QString file = cacheFile(looks_[i]);
            if (name != kPrefix + file) continue;
            QDir().mkpath(QFileInfo(file).path());
            // Only a cache: where it cannot be written, it is drawn again.
            static_cast<void>(picture.save(file));
            show(i, QPixmap::fromImage(picture));
        }
    }

    void showSwatch(std::size_t look) {
        QListWidgetItem* const item = list_->item(static_cast<int>(look));
        item->setIcon(shownAlways(swatch(looks_[look].material)));
        item->setData(Qt::UserRole, false);
    }

    void show(std::size_t look, const QPixmap& picture) {
        QListWidgetItem* const item = list_->item(static_cast<int>(look));
        item->setIcon(shownAlways(picture));
        item->setData(Qt::UserRole, true);  // drawn
    }

    QtDocument& document_;
    Messages& messages_;
    Viewport& viewport_;
    QListWidget* list_;
    std::vector<Look> looks_;
    QTimer soon_;
    std::optional<ShadingModel> shownWith_;  ///< nothing: pictures are to be asked for
};

}  // namespace

QWidget* makePresetList(QtDocument& document, Messages& messages, Viewport& viewport) {
    return new PresetList(document, messages, viewport);
}

}  // namespace hairloom::editor
