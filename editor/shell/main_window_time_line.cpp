// SPDX-License-Identifier: GPL-3.0-or-later
// The project's time line, from and to files.
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <memory>
#include <string_view>

#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/documents/keyed_motion.h"
#include "core/documents/motions.h"
#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/groom/file/time_line_json.h"
#include "core/groom/time_line.h"
#include "editor/document/words.h"
#include "editor/shell/main_window.h"

namespace hairloom::editor {
namespace {

constexpr const char* kFilter = "Time lines and keyframe files (*.json)";

/// A time line, or `now` with the keys of head and wind of a keyframe file.
Result<TimeLine> readLine(const std::string& file, TimeLine now) {
    const auto text = readTextFile(file, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    if (text->find("\"time_line\"") != std::string::npos) return parseTimeLine(file, *text);
    auto keys = parseMotion(file, *text);
    if (!keys) return keys;
    now.head = std::move(keys->head);
    now.wind = std::move(keys->wind);
    return now;
}

}  // namespace

bool MainWindow::openTimeLine(const QString& path) {
    auto line = readLine(path.toStdString(), timeLineOf(document_.groom()));
    // What cannot play, a clip that the head lacks, is not taken.
    if (line && !line->clips.empty() && document_.groom().characterFile.empty())
        line = failIn(path.toStdString(), {}, "has clips, but this head has no animation clips",
                      "expected keys alone");
    if (line) {
        Groom tried = document_.groom();
        tried.timeLine = std::make_shared<const TimeLine>(*line);
        if (auto motion = makeMotion(std::string(kTimeLineMotion), {}, tried); !motion)
            line = tl::unexpected(motion.error());
    }
    if (!line) {
        messages_.warn(errorText(line.error()));
        return false;
    }
    return setTimeLine(std::move(*line), "Open time line");
}

bool MainWindow::setTimeLine(TimeLine line, const char* name) {
    auto command = editing::setTimeLine(document_.editing().model(), std::move(line), name);
    if (!command) {
        messages_.warn(errorText(command.error()));
        return false;
    }
    document_.perform(std::move(*command));
    return true;
}

bool MainWindow::saveTimeLine(const QString& path) {
    const std::string text = timeLineText(timeLineOf(document_.groom()));
    if (auto written = writeFileAtomically(path.toStdString(), std::string_view(text)); !written) {
        messages_.warn(errorText(written.error()));
        return false;
    }
    messages_.say(QString("%1 saved").arg(QFileInfo(path).fileName()));
    return true;
}

bool MainWindow::saveMotion(const QString& path) {
    const TimeLine& line = timeLineOf(document_.groom());
    if (auto written = saveMotionKeys(path.toStdString(), line); !written) {
        messages_.warn(errorText(written.error()));
        return false;
    }
    const bool isAll = line.clips.empty() && line.settings.empty();
    messages_.say(
        QString(isAll ? "%1 saved" : "%1 saved, without clips and settings").arg(QFileInfo(path).fileName()));
    return true;
}

void MainWindow::addTimeLineActions(QMenu& menu) {
    const auto add = [&](const char* id, const QString& text, const QString& tip, std::function<void()> run) {
        menu.addAction(&actions_->add({id, text, "", tip, {}}, std::move(run)));
    };
    add("timeLine.open", "&Open time line…",
        "Clips, keys and range from a file, or keys of head and wind from a keyframe file. They play at once",
        [this] {
            const QString path = QFileDialog::getOpenFileName(this, "Open time line", {}, kFilter);
            if (!path.isEmpty()) openTimeLine(path);
        });
    add("timeLine.save", "Save time &line…", "The time line as a file, for other projects and hairloom-cli",
        [this] {
            const QString name = QFileInfo(document_.title()).completeBaseName() + "-timeline.json";
            const QString path = QFileDialog::getSaveFileName(this, "Save time line", name, kFilter);
            if (!path.isEmpty()) saveTimeLine(path);
        });
    add("timeLine.saveMotion", "Save &keyframe file…", "Keys of head and wind as a motion for hairloom-cli",
        [this] {
            const QString name = QFileInfo(document_.title()).completeBaseName() + "-motion.json";
            const QString path =
                QFileDialog::getSaveFileName(this, "Save keyframe file", name, "Keyframe files (*.json)");
            if (!path.isEmpty()) saveMotion(path);
        });
    add("timeLine.clear", "&Clear time line", "Remove all clips and keys from the time line",
        [this] { setTimeLine({}, "Clear time line"); });
}

}  // namespace hairloom::editor
