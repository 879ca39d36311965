// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/files.h"

#include <QCoreApplication>
#include <QFileInfo>

#include "core/base/file.h"
#include "core/groom/file/project_file.h"
#include "core/scene/motions.h"
#include "core/scene/open.h"
#include "core/scene/sample.h"
#include "importers/mesh_format.h"

namespace hairloom::editor {
namespace {

/// A groom, and the character that its head came from where that can be read.
struct OpenedFile {
    Groom groom;
    std::shared_ptr<const Actor> actor;
    QString note;  ///< for the status line
};

std::shared_ptr<const Actor> actorOf(const Groom& groom) {
    if (groom.characterFile.empty() || !QFileInfo::exists(QString::fromStdString(groom.characterFile)))
        return {};
    auto actor = loadActor({}, groom);
    return actor ? std::move(*actor) : nullptr;
}

Result<OpenedFile> openHead(const std::string& path) {
    auto scene = importSceneLoud(path, {});
    if (!scene) return tl::unexpected(scene.error());
    OpenedFile opened;
    opened.groom.scalp = std::make_shared<const ScalpMesh>(std::move(scene->mesh));
    opened.groom.characterFile = path;
    if (!scene->warnings.empty()) opened.note = QString::fromStdString(scene->warnings.front());
    auto actor = Actor::make(opened.groom.scalp, std::move(scene->skeleton), std::move(scene->clips),
                             std::move(scene->skin));
    if (actor) opened.actor = std::make_shared<const Actor>(std::move(*actor));
    return opened;
}

Result<OpenedFile> openProject(const std::string& path) {
    auto groom = loadProject(path);
    if (!groom) return tl::unexpected(groom.error());
    OpenedFile opened;
    opened.actor = actorOf(*groom);
    opened.groom = std::move(*groom);
    return opened;
}

Result<OpenedFile> openStrands(const std::string& path, const StrandImportOptions& options) {
    auto imported = importStrands(path, options);
    if (!imported) return tl::unexpected(imported.error());
    OpenedFile opened;
    opened.groom = std::move(imported->groom);
    if (!imported->dropped.empty()) {
        opened.note =
            QObject::tr("%n strands could not be used", nullptr, static_cast<int>(imported->dropped.size()));
    } else if (!imported->warnings.empty()) {
        opened.note = QString::fromStdString(imported->warnings.front().what);
    }
    return opened;
}

void show(Session& session, OpenedFile opened, const QString& path, const QString& name) {
    session.document.open(std::move(opened.groom), path, name);
    session.player.setActor(std::move(opened.actor));
    const Groom& groom = session.document.groom();
    const QString what = groom.strandCount() > 0 ? QObject::tr("%L1 strands").arg(groom.strandCount())
                                                 : QObject::tr("a head; paint its scalp next");
    session.messages.say(opened.note.isEmpty() ? QObject::tr("%1: %2").arg(name, what)
                                               : QObject::tr("%1: %2. %3").arg(name, what, opened.note));
}

/// "*.hair *.tfx"
QString patternsOf(const std::vector<FileFormat>& formats) {
    QStringList patterns;
    for (const FileFormat& format : formats) {
        for (const std::string& suffix : format.suffixes) patterns += "*." + QString::fromStdString(suffix);
    }
    return patterns.join(' ');
}

}  // namespace

FileKind kindOf(const QString& path) {
    const std::string file = path.toStdString();
    if (looksLikeProject(file)) return FileKind::Project;
    if (looksLikeStrandFile(readBeginning(file, 256))) return FileKind::Strands;
    if (!path.endsWith(".obj", Qt::CaseInsensitive)) return FileKind::Head;
    return importStrands(file) ? FileKind::Strands : FileKind::Head;
}

QString openFilter() {
    const QString project = "*.hairloom", heads = patternsOf(meshFormats()),
                  hair = patternsOf(strandFormats());
    return QObject::
        tr("Everything that opens (%1 %2 %3);;Hairloom projects (%1);;Heads (%2);;Hair (%3);;All files (*)")
            .arg(project, heads, hair);
}

QString strandFilter() {
    return QObject::tr("Hair (%1);;All files (*)").arg(patternsOf(strandFormats()));
}

std::filesystem::path samplesFolder() {
    return findSamples(QCoreApplication::applicationDirPath().toStdString());
}

void openFile(Session& session, const QString& path, std::function<void()> done) {
    const QString name = QFileInfo(path).fileName();
    session.tasks.run<std::pair<OpenedFile, FileKind>>(
        QObject::tr("Opening %1").arg(name),
        [path](TaskControl&) -> Result<std::pair<OpenedFile, FileKind>> {
            const FileKind kind = kindOf(path);
            const std::string file = path.toStdString();
            auto opened = kind == FileKind::Project   ? openProject(file)
                          : kind == FileKind::Strands ? openStrands(file, {})
                                                      : openHead(file);
            if (!opened) return tl::unexpected(opened.error());
            return std::pair(std::move(*opened), kind);
        },
        [&session, path, name, done = std::move(done)](std::pair<OpenedFile, FileKind> opened) {
            show(session, std::move(opened.first), opened.second == FileKind::Project ? path : QString(),
                 name);
            session.preferences.addRecentFile(path);
            if (done) done();
        });
}

void openSample(Session& session, const QString& name) {
    const auto samples = samplesFolder();
    if (name.isEmpty()) {
        openFile(session, QString::fromStdString((samples / "bust/bust.glb").string()));
        return;
    }
    session.tasks.run<OpenedFile>(
        QObject::tr("Making the sample “%1”").arg(name),
        [samples, name](TaskControl&) -> Result<OpenedFile> {
            auto groom = makeSample(samples, name.toStdString());
            if (!groom) return tl::unexpected(groom.error());
            OpenedFile opened;
            opened.actor = actorOf(*groom);
            opened.groom = std::move(*groom);
            return opened;
        },
        [&session, name](OpenedFile opened) { show(session, std::move(opened), {}, name); });
}

void importStrandsInto(Session& session, const QString& path, const StrandImportOptions& options) {
    const QString name = QFileInfo(path).fileName();
    session.tasks.run<OpenedFile>(
        QObject::tr("Importing %1").arg(name),
        [path, options, head = session.document.groom().scalp,
         selection = session.document.groom().scalpSelection](TaskControl&) -> Result<OpenedFile> {
            StrandImportOptions bound = options;
            bound.scalp = head.get();
            auto opened = openStrands(path.toStdString(), bound);
            if (opened && head) bindToScalp(opened->groom, head, selection);
            return opened;
        },
        [&session, path, name](OpenedFile opened) {
            Groom groom = session.document.groom();
            if (!groom.scalp) {
                show(session, std::move(opened), {}, name);
            } else {
                groom.offsets = opened.groom.offsets;
                groom.strandAttributes = opened.groom.strandAttributes;
                groom.pointAttributes = opened.groom.pointAttributes;
                groom.groupNames = opened.groom.groupNames;
                groom.triangulation = {};
                groom.scalpSelection = opened.groom.scalpSelection;
                session.document.change(QObject::tr("Import %1").arg(name),
                                        Changes(Change::Strands) | Change::Scalp, std::move(groom));
                session.messages.say(QObject::tr("%1: %L2 strands on the head")
                                         .arg(name)
                                         .arg(session.document.groom().strandCount()));
            }
            session.preferences.addRecentFile(path);
        });
}

void openRecovered(Session& session, const QString& file, const QString& documentPath, const QString& name) {
    session.tasks.run<OpenedFile>(
        QObject::tr("Recovering %1").arg(name),
        [file](TaskControl&) { return openProject(file.toStdString()); },
        [&session, documentPath, name](OpenedFile opened) {
            session.document.restore(std::move(opened.groom), documentPath, name);
            session.player.setActor(std::move(opened.actor));
            session.messages.say(QObject::tr("%1 is back as it was; save it to keep it").arg(name));
        });
}

}  // namespace hairloom::editor
