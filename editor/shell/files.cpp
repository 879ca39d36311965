// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/shell/files.h"

#include <QCoreApplication>
#include <QFileInfo>
#include <algorithm>

#include "core/base/file.h"
#include "core/base/write_rules.h"
#include "core/documents/hair_blend.h"
#include "core/documents/hair_import.h"
#include "core/documents/head_import.h"
#include "core/documents/head_transfer.h"
#include "core/documents/motions.h"
#include "core/documents/open.h"
#include "core/documents/sample.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"
#include "editor/document/task_watch.h"
#include "editor/fields/length_text.h"
#include "importers/mesh_format.h"

namespace hairloom::editor {
/// A groom, and the character that its head came from where that can be read.
struct DocumentFiles::Opened {
    Groom groom;
    std::shared_ptr<const Actor> actor;
    QString note;            ///< for the status line
    std::string record;      ///< of a transfer, for scripts
    float farthest = 0;      ///< metres between a root and the head that it was transferred to
    QString missing;         ///< file of the head that is not there
    FileVersion version;     ///< of a file that is opened: that which was read
    bool isUnclear = false;  ///< a head whose size, axis or groups look wrong
};

std::shared_ptr<const Actor> DocumentFiles::actorOf(const Groom& groom) {
    if (groom.characterFile.empty() || !QFileInfo::exists(QString::fromStdString(groom.characterFile)))
        return {};
    auto actor = loadActor({}, groom);
    return actor ? std::move(*actor) : nullptr;
}

Result<DocumentFiles::Opened> DocumentFiles::readHead(const std::string& path,
                                                      const HeadImportOptions& options) {
    auto head = importHead(path, options);
    if (!head) return tl::unexpected(head.error());
    ImportedScene& scene = head->scene;
    Opened opened;
    opened.isUnclear = !guessHead(scene).isClear();
    opened.groom.scalp = std::make_shared<const ScalpMesh>(std::move(scene.mesh));
    // Skeleton and clips fit no head that was turned.
    if (!options.isTurned()) opened.groom.characterFile = path;
    opened.groom.characterMetresPerUnit = options.metresPerUnit;
    opened.groom.spheres = std::move(head->colliders.spheres);
    QStringList notes;
    if (!opened.groom.spheres.empty()) {
        notes += QString("Spheres that hair will collide with: %1").arg(opened.groom.spheres.size());
    }
    if (!scene.warnings.empty()) notes += QString::fromStdString(scene.warnings.front());
    opened.note = notes.join("; ");
    auto actor = Actor::make(opened.groom.scalp, std::move(scene.skeleton), std::move(scene.clips),
                             std::move(scene.skin), std::move(scene.morphs));
    if (actor) opened.actor = std::make_shared<const Actor>(std::move(*actor));
    return opened;
}

Result<DocumentFiles::Opened> DocumentFiles::openProject(const std::string& path) {
    auto groom = hairloom::openProject(path);
    if (!groom) return tl::unexpected(groom.error());
    Opened opened;
    opened.actor = actorOf(*groom);
    const QString head = QString::fromStdString(groom->characterFile);
    if (!head.isEmpty() && !QFileInfo::exists(head)) {
        opened.missing = head;
        opened.note = QString("the head file %1 was not found, and its clips are missing").arg(head);
    }
    opened.groom = std::move(*groom);
    return opened;
}

Result<DocumentFiles::Opened> DocumentFiles::openedStrands(Result<ImportedStrands> imported) {
    if (!imported) return tl::unexpected(imported.error());
    Opened opened;
    opened.groom = std::move(imported->groom);
    if (!imported->dropped.empty()) {
        opened.note = QString("Strands that could not be used: %1").arg(imported->dropped.size());
    } else if (!imported->warnings.empty()) {
        opened.note = QString::fromStdString(imported->warnings.front().what);
    }
    return opened;
}

void DocumentFiles::show(Opened opened, const QString& path, const QString& name) {
    document_.open(std::move(opened.groom), path, name);
    player_.setActor(std::move(opened.actor));
    const Groom& groom = document_.groom();
    const QString what = groom.strandCount() > 0 ? QString("%L1 strands").arg(groom.strandCount())
                                                 : QString("a head. Next, paint its scalp");
    messages_.say(opened.note.isEmpty() ? QString("%1: %2").arg(name, what)
                                        : QString("%1: %2. %3").arg(name, what, asSentence(opened.note)));
    if (!opened.missing.isEmpty()) return;
    // A clip on the time line that the head no longer has.
    if (const auto motion = player_.makeMotion(player_.motion()); !motion)
        messages_.warn(errorText(motion.error()));
}

namespace {

/// "*.hair *.tfx"
QString patternsOf(const std::vector<FileFormat>& formats) {
    QStringList patterns;
    for (const FileFormat& format : formats) {
        for (const std::string& suffix : format.suffixes) patterns += "*." + QString::fromStdString(suffix);
    }
    return patterns.join(' ');
}

bool beginsLikeStrands(const QString& path) {
    return looksLikeStrandFile(readBeginning(path.toStdString(), 256));
}

/// Nothing where only the whole file tells.
std::optional<FileKind> kindByBeginning(const QString& path) {
    const std::string file = path.toStdString();
    if (looksLikeProject(file)) return FileKind::Project;
    const auto mesh = meshFormatOf(readBeginning(file, kMeshFormatHead),
                                   static_cast<std::uint64_t>(QFileInfo(path).size()));
    const bool isStrands = beginsLikeStrands(path);
    if (mesh && !isStrands && !mayBeHair(*mesh)) return FileKind::Head;
    if (!mesh && isStrands) return FileKind::Strands;
    return std::nullopt;
}

}  // namespace

FileKind kindOf(const QString& path) {
    if (const auto kind = kindByBeginning(path)) return *kind;
    const std::string file = path.toStdString();
    if (hairloom::importStrands(file)) return FileKind::Strands;
    // What is wrong with hair is told rather than that it is no head.
    return beginsLikeStrands(path) && !importScene(file) ? FileKind::Strands : FileKind::Head;
}

QString openFilter() {
    const QString project = "*.hairloom", heads = patternsOf(meshFormats()),
                  hair = patternsOf(strandFormats());
    return QString(
               "All supported files (%1 %2 %3);;Hairloom projects (%1);;Heads (%2);;Hair (%3);;All files (*)")
        .arg(project, heads, hair);
}

QString strandFilter() {
    return QString("Hair (%1);;All files (*)").arg(patternsOf(strandFormats()));
}

QString blendFilter() {
    return QString("Hairstyles and hair (*.hairloom %1);;All files (*)").arg(patternsOf(strandFormats()));
}

QString headFilter() {
    return QString("Heads (%1);;All files (*)").arg(patternsOf(meshFormats()));
}

std::filesystem::path samplesFolder() {
    return findSamples(QCoreApplication::applicationDirPath().toStdString());
}

void DocumentFiles::open(const QString& path, std::function<void()> done) {
    Opening opening = Opening::AsItself;
    if (mayOpen_ && looksLikeProject(path.toStdString())) opening = mayOpen_(path);
    if (opening != Opening::Not) openFile(path, opening, std::move(done));
}

void DocumentFiles::reload() {
    openFile(document_.path(), Opening::AsItself, {});
}

bool DocumentFiles::mayShow(quint64 before, const QString& name) {
    const bool changed = document_.isModified() && document_.editing().state() != before;
    if (!changed || !mayReplace_ || mayReplace_()) return true;
    messages_.say(QString("%1 was not opened").arg(name));
    return false;
}

void DocumentFiles::tellKind(const QString& path, std::function<void(FileKind)> done) {
    if (const auto kind = kindByBeginning(path)) return done(*kind);
    tasks_.run<FileKind>(
        QString("Reading %1").arg(QFileInfo(path).fileName()),
        [path](TaskControl&) -> Result<FileKind> { return kindOf(path); }, std::move(done));
}

void DocumentFiles::openFile(const QString& path, Opening opening, std::function<void()> done) {
    const QString name = QFileInfo(path).fileName();
    tasks_.run<std::pair<Opened, FileKind>>(
        QString("Opening %1").arg(name),
        [path](TaskControl&) -> Result<std::pair<Opened, FileKind>> {
            const FileKind kind = kindOf(path);
            const std::string file = path.toStdString();
            // What it was when it was opened before counts until it is shown anew.
            const FileVersion before = knownVersion(file);
            forgetInput(file);
            auto opened = kind == FileKind::Project   ? openProject(file)
                          : kind == FileKind::Strands ? openedStrands(hairloom::importStrands(file))
                                                      : readHead(file, {});
            const FileVersion read = knownVersion(file);
            forgetInput(file);
            if (before.exists) noteInput(file, before);
            if (!opened) return tl::unexpected(opened.error());
            opened->version = read;
            return std::pair(std::move(*opened), kind);
        },
        [this, path, name, opening, before = document_.editing().state(),
         done = std::move(done)](std::pair<Opened, FileKind> opened) {
            if (!mayShow(before, name)) return;
            // Nothing is opened before somebody has said what it is.
            if (opened.first.isUnclear && unclearHead_) return unclearHead_(path);
            const QString missing = opened.first.missing;
            if (opened.first.version.exists) noteInput(path.toStdString(), opened.first.version);
            const bool hasFile = opened.second == FileKind::Project && opening == Opening::AsItself;
            show(std::move(opened.first), hasFile ? path : QString(), name);
            preferences_.addRecentFile(path);
            if (done) done();
            if (!missing.isEmpty() && missingHead_) missingHead_(missing);
        });
}

void DocumentFiles::openHead(const QString& path, const HeadImportOptions& options) {
    const QString name = QFileInfo(path).fileName();
    tasks_.run<Opened>(
        QString("Opening %1").arg(name),
        [file = path.toStdString(), options](TaskControl&) { return readHead(file, options); },
        [this, path, name, before = document_.editing().state()](Opened opened) {
            if (!mayShow(before, name)) return;
            show(std::move(opened), {}, name);
            preferences_.addRecentFile(path);
        });
}

void DocumentFiles::findHead(const QString& path) {
    const QString name = QFileInfo(path).fileName();
    tasks_.run<Opened>(
        QString("Reading %1").arg(name),
        [file = path.toStdString(), groom = document_.groom()](TaskControl&) -> Result<Opened> {
            Opened opened;
            opened.groom = groom;
            opened.groom.characterFile = file;
            auto actor = loadActor({}, opened.groom);
            if (!actor) return tl::unexpected(actor.error());
            opened.actor = std::move(*actor);
            return opened;
        },
        [this, name](Opened opened) {
            Groom groom = document_.groom();
            groom.characterFile = opened.groom.characterFile;
            document_.perform(editing::replaceGroom(document_.editing().model(), std::move(groom),
                                                    QString("Find %1").arg(name).toStdString()));
            player_.setActor(std::move(opened.actor));
            messages_.say(QString("%1 is the head file again. Save to keep it").arg(name));
        });
}

void DocumentFiles::openSample(const QString& name) {
    const auto samples = samplesFolder();
    if (name.isEmpty()) {
        open(QString::fromStdString((samples / "bust/bust.glb").string()));
        return;
    }
    tasks_.run<Opened>(
        QString("Making the sample “%1”").arg(name),
        [samples, name](TaskControl&) -> Result<Opened> {
            auto groom = makeSample(samples, name.toStdString(), SampleColliders::skin);
            if (!groom) return tl::unexpected(groom.error());
            Opened opened;
            opened.actor = actorOf(*groom);
            opened.groom = std::move(*groom);
            return opened;
        },
        [this, name, before = document_.editing().state()](Opened opened) {
            if (mayShow(before, name)) show(std::move(opened), {}, name);
        });
}

void DocumentFiles::importStrands(const QString& path, const StrandImportOptions& options) {
    const QString name = QFileInfo(path).fileName();
    tasks_.run<Opened>(
        QString("Importing %1").arg(name),
        [path, options, groom = document_.groom()](TaskControl&) -> Result<Opened> {
            return openedStrands(importHairFor(groom, path.toStdString(), options));
        },
        [this, path, name, options, head = document_.groom().scalp,
         selection = document_.groom().scalpSelection](Opened opened) {
            Groom groom = document_.groom();
            if (!groom.scalp) {
                show(std::move(opened), {}, name);
            } else if (groom.scalp != head || groom.scalpSelection != selection) {
                messages_.warn("The scalp has changed in the meantime: import the hair again");
                return;
            } else {
                replaceHair(groom, opened.groom);
                document_.perform(editing::replaceGroom(document_.editing().model(), std::move(groom),
                                                        QString("Import %1").arg(name).toStdString(),
                                                        importRecord(path.toStdString(), options)));
                messages_.say(
                    QString("%1: %L2 strands on the head").arg(name).arg(document_.groom().strandCount()));
            }
            preferences_.addRecentFile(path);
        });
}

void DocumentFiles::transferTo(const QString& path) {
    const QString name = QFileInfo(path).fileName();
    const std::string file = path.toStdString();
    tasks_.run<Opened>(
        QString("Transferring to %1").arg(name),
        [file, groom = document_.groom()](TaskControl& control) -> Result<Opened> {
            Opened opened;
            opened.groom = groom;
            HeadImportOptions options;
            options.guessUnit = options.guessUp = options.guessTurn = true;
            const auto done = transferToFile(opened.groom, file, options, watchOf(control));
            if (!done) return tl::unexpected(done.error());
            opened.record = transferRecord(file, done->taken);
            opened.farthest = *std::ranges::max_element(done->transfer.distances);
            if (done->transfer.baked) opened.note = QString(". Operators were baked");
            for (const std::string& word : done->words) opened.note += "; " + QString::fromStdString(word);
            return opened;
        },
        [this, name, file, before = document_.groom()](Opened opened) {
            const Groom& now = document_.groom();
            if (now.scalp != before.scalp || now.pointAttributes.version(attribute::kPosition) !=
                                                 before.pointAttributes.version(attribute::kPosition))
                return messages_.warn("The hair has changed in the meantime: transfer it again");
            document_.perform(editing::replaceGroom(document_.editing().model(), std::move(opened.groom),
                                                    QString("Transfer to %1").arg(name).toStdString(),
                                                    opened.record));
            messages_.say(
                QString("On %1: the farthest root was %2 off the new head%3")
                    .arg(name, lengthText(static_cast<double>(opened.farthest), preferences_), opened.note));
            preferences_.addRecentFile(QString::fromStdString(file));
        });
}

void DocumentFiles::blendWith(const QString& path) {
    const QString name = QFileInfo(path).fileName();
    const BlendSettings settings;
    // The command is made for the hair as it is now.
    tasks_.run<std::shared_ptr<HairBlend>>(
        QString("Blending with %1").arg(name),
        [file = path.toStdString(), settings,
         groom = document_.groom()](TaskControl&) -> Result<std::shared_ptr<HairBlend>> {
            auto blend = blendWithFile(editing::Model{groom, {}}, file, settings);
            if (!blend) return tl::unexpected(blend.error());
            return std::make_shared<HairBlend>(std::move(*blend));
        },
        [this, path, name, settings,
         before = document_.editing().state()](const std::shared_ptr<HairBlend>& blend) {
            if (document_.editing().state() != before)
                return messages_.warn("The hair has changed in the meantime: blend it again");
            const std::size_t strands = document_.groom().strandCount();
            if (!blend->command)
                return messages_.say(QString("%1 has the same shape, so nothing changed").arg(name));
            document_.perform(std::move(blend->command));
            messages_.say(QString("Blended with %1 by %2: %L3 of %L4 strands. The sculpt on top of the "
                                  "operators has the weight and the mask")
                              .arg(name)
                              .arg(static_cast<double>(settings.weight))
                              .arg(blend->shape.matched)
                              .arg(strands));
            preferences_.addRecentFile(path);
        });
}

void DocumentFiles::compareWith(const QString& path,
                                std::function<void(const GroomComparison&, ComparedParts)> done) {
    const QString name = QFileInfo(path).fileName();
    using Compared = std::pair<GroomComparison, ComparedParts>;
    tasks_.run<Compared>(
        QString("Comparing with %1").arg(name),
        [file = path.toStdString(), own = document_.path().toStdString(),
         groom = document_.groom()](TaskControl&) -> Result<Compared> {
            const auto other = openAny(file, {});
            if (!other) return tl::unexpected(other.error());
            // Hair of other programs has no settings.
            const auto parts = looksLikeProject(file) ? ComparedParts::all : ComparedParts::hair;
            return Compared(compare({other->groom, file}, {groom, own.empty() ? file : own}, parts), parts);
        },
        [done = std::move(done)](const Compared& compared) { done(compared.first, compared.second); });
}

void DocumentFiles::openRecovered(const RecoveryCopy& copy) {
    const QString name = QString::fromStdString(copy.of.name);
    tasks_.run<Opened>(
        QString("Recovering %1").arg(name),
        [file = copy.file](TaskControl&) { return openProject(file.string()); },
        [this, copy, name, before = document_.editing().state()](Opened opened) {
            if (!mayShow(before, name)) return;
            // Saving asks where the project is no longer what the copy began with.
            FileVersion base = copy.of.base;
            base.exists = true;
            if (!copy.of.project.empty()) noteInput(copy.of.project, base);
            document_.restore(std::move(opened.groom), QString::fromStdString(copy.of.project.string()),
                              name);
            player_.setActor(std::move(opened.actor));
            messages_.say(QString("%1 is recovered. Save it to keep it").arg(name));
            recovered_ = copy;
        });
}

void DocumentFiles::discardRecovered() {
    if (!recovered_) return;
    if (auto removed = removeRecoveryCopy(*recovered_); !removed) messages_.warn(errorText(removed.error()));
    recovered_.reset();
}

}  // namespace hairloom::editor
