// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/key_this.h"

#include <QContextMenuEvent>
#include <QLineEdit>
#include <QMenu>
#include <memory>

#include "editor/fields/number_spin.h"

namespace hairloom::editor {
namespace {

class KeyMenu : public QObject {
  public:
    KeyMenu(Keying& keying, KeyTrack track, QObject* parent)
        : QObject(parent), keying_(keying), track_(std::move(track)) {}

    void watch(QWidget& place) {
        place.installEventFilter(this);
        for (QWidget* inside : place.findChildren<QWidget*>()) inside->installEventFilter(this);
    }

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (event->type() != QEvent::ContextMenu) return QObject::eventFilter(watched, event);
        const auto* at = static_cast<QContextMenuEvent*>(event);
        QMenu menu;
        menu.setObjectName("keyThis");
        menu.setToolTipsVisible(true);
        menu.addAction(QString("Key this at frame %1").arg(keying_.player().lineFrame()),
                       [this] { keying_.keySetting(track_.name); });
        QAction* remove = menu.addAction("Remove keys", [this] { keying_.removeSetting(track_.name); });
        remove->setEnabled(keying_.keyCount(track_) > 0);
        // What a right-click on a number or a text offers elsewhere.
        auto* edit = qobject_cast<QLineEdit*>(watched);
        if (!edit) edit = watched->findChild<QLineEdit*>();
        std::unique_ptr<QMenu> usual;
        if (edit) {
            usual.reset(edit->createStandardContextMenu());
            menu.addSeparator();
            menu.addActions(usual->actions());
        }
        menu.exec(at->globalPos());
        return true;
    }

  private:
    Keying& keying_;
    KeyTrack track_;
};

}  // namespace

KeyThis::KeyThis(Keying& keying, const char* section, QObject* parent)
    : KeyThis(
          keying, [prefix = std::string(section) + '.'](const char* setting) { return prefix + setting; },
          parent) {}

KeyThis::KeyThis(Keying& keying, std::function<std::string(const char*)> nameOf, QObject* parent)
    : FieldKeys(parent), keying_(keying), nameOf_(std::move(nameOf)) {
    connect(&keying_, &Keying::changed, this, &FieldKeys::changed);
}

KeyTrack KeyThis::trackOf(const char* setting) const {
    return {KeyTrack::Of::setting, nameOf_(setting)};
}

void KeyThis::offer(const char* setting, std::initializer_list<QWidget*> places) {
    if (findKeyable(trackOf(setting).name) == nullptr) return;
    for (QWidget* place : places) (new KeyMenu(keying_, trackOf(setting), place))->watch(*place);
}

QString KeyThis::mark(const char* setting) const {
    const KeyTrack track = trackOf(setting);
    if (keying_.keyCount(track) == 0) return {};
    return keying_.hasKeyHere(track) ? QStringLiteral("◆ ") : QStringLiteral("◇ ");
}

QString KeyThis::tip(const char* setting) const {
    const std::string name = trackOf(setting).name;
    for (const SettingTrack& track : keying_.line().settings) {
        const auto* const field = findKeyable(name);
        if (track.name != name || field == nullptr) continue;
        const Vec3d value = valueAt(track, keying_.player().lineTime());
        QStringList numbers;
        for (std::uint32_t c = 0; c < field->components(); ++c)
            numbers.append(numberLocale().toString(value[c], 'g', 4));
        return QString("<p>Keyed: %1 %2 at frame %3. The keys count in playback, not this value</p>")
            .arg(numbers.join(", "), QString::fromUtf8(field->unit).toHtmlEscaped())
            .arg(keying_.player().lineFrame());
    }
    return {};
}

}  // namespace hairloom::editor
