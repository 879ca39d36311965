// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces carry hair, and placing hair on them.
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include "core/editing/document.h"
#include "core/editing/place.h"
#include "core/editing/selection_commands.h"
#include "core/editing/surface_disc.h"
#include "core/geometry/selection.h"
#include "editor/fields/field_form.h"
#include "editor/panels/list.h"
#include "editor/panels/panel.h"
#include "editor/session.h"

namespace hairloom::editor {
namespace {

class ScalpPanel : public QWidget {
  public:
    explicit ScalpPanel(Session& session)
        : session_(session), groups_(new QComboBox), expression_(new QLineEdit), area_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        area_->setProperty("role", "dim");
        area_->setWordWrap(true);
        groups_->setObjectName("scalpGroup");
        groups_->setToolTip(tr("Takes all faces of a group or material of the head's file"));
        connect(groups_, &QComboBox::activated, this, [this](int index) {
            if (index > 0) select(groups_->itemData(index).toString());
            groups_->setCurrentIndex(0);
        });
        expression_->setObjectName("scalpExpression");
        expression_->setPlaceholderText(tr("cap:70, above:0.5 …"));
        expression_->setToolTip(
            tr("Chooses faces in words, then Enter: all, group:NAME, material:NAME, cap:DEGREES "
               "(leaning at most so far from up), above:SHARE of the height, grow:N, shrink:N, invert, "
               "connected. A "
               "comma means and."));
        connect(expression_, &QLineEdit::returnPressed, this, [this] { select(expression_->text()); });
        layout->addWidget(groups_);
        layout->addWidget(expression_);
        layout->addLayout(makeButtons());
        layout->addWidget(area_);
        connect(&session_.document, &Document::changed, this, [this](Changes changes) {
            if (changes & Change::Scalp) refresh();
        });
        refresh();
    }

  private:
    QGridLayout* makeButtons() {
        auto* grid = new QGridLayout;
        grid->setSpacing(6);
        const auto add = [&](const char* name, const QString& text, const QString& tip,
                             std::function<FaceSet()> faces) {
            auto* button = new QPushButton(text);
            button->setObjectName(name);
            button->setToolTip(tip);
            connect(button, &QPushButton::clicked, this, [this, faces = std::move(faces)] {
                if (groom().scalp) perform(faces());
            });
            grid->addWidget(button, grid->count() / 3, grid->count() % 3);
        };
        add("scalpGrow", tr("Grow"), tr("Adds the faces next to the scalp"),
            [this] { return growSelection(mesh(), groom().scalpSelection, 1); });
        add("scalpShrink", tr("Shrink"), tr("Takes the faces at the scalp's border away"),
            [this] { return shrinkSelection(mesh(), groom().scalpSelection, 1); });
        add("scalpInvert", tr("Invert"), tr("Takes all other faces instead"),
            [this] { return invertSelection(mesh(), groom().scalpSelection); });
        add("scalpSymmetric", tr("Mirror"), tr("Adds the faces on the other side of the head"), [this] {
            return editing::symmetricFaces(mesh(), *session_.document.editing().surface(),
                                           groom().scalpSelection);
        });
        add("scalpConnected", tr("Largest"), tr("Keeps the largest connected piece only"), [this] {
            const auto pieces = connectedPieces(mesh(), groom().scalpSelection);
            return pieces.empty() ? FaceSet() : pieces.front();
        });
        add("scalpClear", tr("Clear"), tr("Takes all faces away"), [] { return FaceSet(); });
        return grid;
    }

    const Groom& groom() const { return session_.document.groom(); }
    const ScalpMesh& mesh() const { return *groom().scalp; }

    void select(const QString& expression) {
        if (!groom().scalp || expression.isEmpty()) return;
        auto faces = selectFaces(mesh(), expression.toStdString());
        if (!faces) {
            session_.messages.warn(QString::fromStdString(faces.error().message()));
            return;
        }
        perform(*faces, expression);
    }

    void perform(const FaceSet& faces, const QString& expression = {}) {
        const auto& model = session_.document.editing().model();
        session_.document.perform(
            editing::selectScalp(model, faces, editing::Choice::Replace, expression.toStdString()));
    }

    void refresh() {
        setEnabled(groom().scalp != nullptr);
        if (!groom().scalp) {
            area_->setText(tr("Open a head first."));
            return;
        }
        const FaceSet& faces = groom().scalpSelection;
        area_->setText(faces.empty() ? tr("No faces yet: paint them (P), or choose a group.")
                                     : tr("%L1 faces, %2 cm²")
                                           .arg(faces.size())
                                           .arg(selectionArea(mesh(), faces) * 1e4, 0, 'f', 0));
        if (shownHead_ == groom().scalp) return;
        shownHead_ = groom().scalp;
        groups_->clear();
        groups_->addItem(tr("Group or material…"));
        for (const std::string& name : mesh().groupNames()) {
            groups_->addItem(QString::fromStdString(name), "group:" + QString::fromStdString(name));
        }
        for (const std::string& name : mesh().materialNames()) {
            groups_->addItem(tr("%1 (material)").arg(QString::fromStdString(name)),
                             "material:" + QString::fromStdString(name));
        }
    }

    Session& session_;
    QComboBox* groups_;
    QLineEdit* expression_;
    QLabel* area_;
    std::shared_ptr<const ScalpMesh> shownHead_;
};

/// What placing needs, held while it runs.
using Roots = std::vector<SurfacePoint>;

class PlacePanel : public QWidget {
  public:
    explicit PlacePanel(Session& session) : session_(session), note_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(new FieldForm(session.document, session.preferences, placementFields()));
        auto* preview = new QPushButton(tr("Preview roots"));
        preview->setObjectName("placePreview");
        preview->setCheckable(true);
        preview->setToolTip(tr("Shows where roots would go, and follows the settings"));
        auto* place = new QPushButton(tr("Place hair"));
        place->setObjectName("place");
        place->setToolTip(tr("Grows strands on the whole scalp, in place of those that are there"));
        auto* row = new QHBoxLayout;
        row->addWidget(preview);
        row->addWidget(place);
        layout->addLayout(row);
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        layout->addWidget(note_);
        connect(place, &QPushButton::clicked, this, [this, preview] {
            preview->setChecked(false);
            this->place();
        });
        connect(preview, &QPushButton::toggled, this, [this](bool on) {
            previewing_ = on;
            refresh();
        });
        connect(&session_.document, &Document::changed, this, [this](Changes changes) {
            if (changes & (Changes(Change::Placement) | Change::Scalp)) refresh();
        });
        session_.viewport->addMarks([this](Marks& marks) {
            const Groom& groom = session_.document.groom();
            if (!groom.scalp) return;
            for (const SurfacePoint& root : roots_) {
                marks.point(groom.scalp->pointAt(root.triangle, root.barycentric), QColor(90, 230, 140), 4);
            }
        });
    }

  private:
    void refresh() {
        roots_.clear();
        note_->clear();
        session_.viewport->redraw();
        if (!previewing_ || !session_.document.groom().scalp) return;
        session_.tasks.run<Roots>(
            tr("Placing roots"),
            [groom = session_.document.groom()](TaskControl&) { return editing::placeRoots(groom, {}); },
            [this](Roots roots) {
                roots_ = std::move(roots);
                note_->setText(tr("%L1 roots").arg(roots_.size()));
                session_.viewport->redraw();
            });
    }

    void place() {
        using Command = std::shared_ptr<std::unique_ptr<editing::Command>>;
        session_.tasks.run<Command>(
            tr("Placing hair"),
            [groom = session_.document.groom()](TaskControl&) -> Result<Command> {
                auto command = editing::place(groom, {}, {});
                if (!command) return tl::unexpected(command.error());
                return std::make_shared<std::unique_ptr<editing::Command>>(std::move(*command));
            },
            [this, strandsBefore = session_.document.groom().offsets.version(),
             selection = session_.document.groom().scalpSelection](const Command& command) {
                const Groom& groom = session_.document.groom();
                if (groom.offsets.version() != strandsBefore || groom.scalpSelection != selection) {
                    session_.messages.warn(tr("The hair has changed meanwhile; place it again"));
                    return;
                }
                session_.document.perform(std::move(*command));
                session_.messages.say(tr("%L1 strands placed").arg(session_.document.groom().strandCount()));
            });
    }

    Session& session_;
    QLabel* note_;
    Roots roots_;
    bool previewing_ = false;
};

}  // namespace

QWidget* makeScalpPanel(Session& session) {
    return scrolled(column({heading(QObject::tr("Where hair grows")), new ScalpPanel(session),
                            heading(QObject::tr("Place hair")), new PlacePanel(session)}));
}

}  // namespace hairloom::editor
