// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/preferences.h"

#include <QFileInfo>
#include <QSettings>
#include <algorithm>

namespace hairloom::editor {
namespace {

constexpr int kMaxRecentFiles = 10;
constexpr const char* kRecent = "recentFiles";

template <class Enum>
Enum readChoice(const char* key, Enum defaultValue, int count) {
    const int value = QSettings().value(key, static_cast<int>(defaultValue)).toInt();
    return value >= 0 && value < count ? static_cast<Enum>(value) : defaultValue;
}

std::string readText(const char* key) {
    return QSettings().value(key).toString().toStdString();
}

}  // namespace

Preferences::Preferences(QObject* parent)
    : QObject(parent),
      theme_(readChoice("theme", Theme::Dark, 2)),
      unit_(readChoice("unit", DisplayUnit::Centimetre, 4)),
      orbitStyle_(readChoice("orbitStyle", OrbitStyle::Maya, 2)),
      tabletCurve_(std::clamp(QSettings().value("tabletCurve", 1.0).toDouble(), 0.25, 4.0)),
      simulateOn_(readChoice("simulateOn", SimulateOn::Automatic, 3)),
      autosaveMinutes_(std::clamp(QSettings().value("autosaveMinutes", 1).toInt(), 0, 60)),
      undoMegabytes_(std::clamp(QSettings().value("undoMegabytes", 512).toInt(), kLeastUndoMegabytes,
                                kMostUndoMegabytes)),
      colours_{readText("colour/config"), readText("colour/display"), readText("colour/view")} {}

template <class T>
void Preferences::store(const char* key, T& member, T value) {
    if (member == value) return;
    member = value;
    if constexpr (std::is_enum_v<T>) {
        QSettings().setValue(key, static_cast<int>(value));
    } else {
        QSettings().setValue(key, value);
    }
    Q_EMIT changed();
}

void Preferences::setTheme(Theme theme) {
    store("theme", theme_, theme);
}
void Preferences::setUnit(DisplayUnit unit) {
    store("unit", unit_, unit);
}
void Preferences::setOrbitStyle(OrbitStyle style) {
    store("orbitStyle", orbitStyle_, style);
}
void Preferences::setTabletCurve(double exponent) {
    store("tabletCurve", tabletCurve_, std::clamp(exponent, 0.25, 4.0));
}
void Preferences::setSimulateOn(SimulateOn where) {
    store("simulateOn", simulateOn_, where);
}
void Preferences::setAutosaveMinutes(int minutes) {
    store("autosaveMinutes", autosaveMinutes_, std::clamp(minutes, 0, 60));
}

void Preferences::setUndoMegabytes(int megabytes) {
    store("undoMegabytes", undoMegabytes_, std::clamp(megabytes, kLeastUndoMegabytes, kMostUndoMegabytes));
}

void Preferences::setColours(const colour::ColourChoice& choice) {
    if (colours_ == choice) return;
    colours_ = choice;
    QSettings settings;
    settings.setValue("colour/config", QString::fromStdString(choice.config));
    settings.setValue("colour/display", QString::fromStdString(choice.display));
    settings.setValue("colour/view", QString::fromStdString(choice.view));
    Q_EMIT changed();
}

QStringList Preferences::recentFiles() const {
    QStringList files;
    for (const QString& path : QSettings().value(kRecent).toStringList()) {
        if (QFileInfo::exists(path)) files.append(path);
    }
    return files;
}

void Preferences::addRecentFile(const QString& path) {
    const QString absolute = QFileInfo(path).absoluteFilePath();
    QStringList files = QSettings().value(kRecent).toStringList();
    files.removeAll(absolute);
    files.prepend(absolute);
    while (files.size() > kMaxRecentFiles) files.removeLast();
    QSettings().setValue(kRecent, files);
    Q_EMIT recentFilesChanged();
}

}  // namespace hairloom::editor
