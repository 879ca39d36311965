// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/autosave.h"

#include <QCoreApplication>
#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>
#include <QUuid>

#include "core/groom/file/project_file.h"
#include "editor/document/words.h"

namespace hairloom::editor {
namespace {

QString folder() {
    const QString path = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/recovery";
    QDir().mkpath(path);
    return path;
}

QString lockOf(const QString& file) {
    return file + ".lock";
}
QString descriptionOf(const QString& file) {
    return file + ".ini";
}

void removeAll(const QString& file) {
    QFile::remove(file);
    QFile::remove(descriptionOf(file));
}

}  // namespace

Autosave::Autosave(QtDocument& document, const Preferences& preferences, QObject* parent)
    : QObject(parent),
      document_(document),
      preferences_(preferences),
      file_(folder() + "/" + QUuid::createUuid().toString(QUuid::WithoutBraces) + ".hairloom"),
      lock_(std::make_unique<QLockFile>(lockOf(file_))) {
    lock_->setStaleLockTime(0);  // the lock says that this program runs, however long it does
    lock_->lock();
    connect(&timer_, &QTimer::timeout, this, &Autosave::saveNow);
    connect(&document_, &QtDocument::changed, this, [this] { dirty_ = true; });
    connect(&document_, &QtDocument::replaced, this, [this] {
        finish();
        removeAll(file_);
    });
    connect(&preferences_, &Preferences::changed, this, &Autosave::restart);
    restart();
}

Autosave::~Autosave() {
    finish();
    removeAll(file_);
}

void Autosave::restart() {
    const int interval = preferences_.autosaveMinutes() * 60'000;
    if (interval == timer_.interval() && timer_.isActive()) return;
    timer_.stop();
    if (interval > 0) timer_.start(interval);
}

void Autosave::saveNow() {
    if (!dirty_ || !document_.isModified()) return;
    finish();
    dirty_ = false;
    QSettings description(descriptionOf(file_), QSettings::IniFormat);
    description.setValue("document", document_.path());
    description.setValue("name", document_.title());
    writer_ = std::thread([this, groom = document_.groom(), file = file_] {
        if (const auto saved = saveProject(groom, file.toStdString()); !saved) {
            QMetaObject::invokeMethod(this,
                                      [this, words = errorText(saved.error())] { Q_EMIT failed(words); });
        }
    });
}

void Autosave::finish() {
    if (writer_.joinable()) writer_.join();
}

QList<Recovery> Autosave::recoveries() {
    QList<Recovery> found;
    const QDir recovery(folder());
    for (const QFileInfo& file : recovery.entryInfoList({"*.hairloom"}, QDir::Files, QDir::Time)) {
        QLockFile lock(lockOf(file.filePath()));
        lock.setStaleLockTime(0);
        if (!lock.tryLock(0)) continue;
        const QSettings description(descriptionOf(file.filePath()), QSettings::IniFormat);
        found.append({file.filePath(), description.value("document").toString(),
                      description.value("name").toString(), file.lastModified()});
    }
    return found;
}

void Autosave::discard(const Recovery& recovery) {
    removeAll(recovery.file);
    QFile::remove(lockOf(recovery.file));
}

}  // namespace hairloom::editor
