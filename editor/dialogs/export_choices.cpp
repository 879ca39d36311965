// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/export_choices.h"

#include <QObject>
#include <QRegularExpression>
#include <algorithm>

#include "core/documents/web_page.h"
#include "core/levels/level_chain.h"
#include "importers/child_process.h"

namespace hairloom::editor {
namespace {

const ExportTarget& pageTarget() {
    static const ExportTarget target{
        "browser",
        "Web page with moving hair",
        "A folder with index.html that opens without a network and plays the runtime asset",
        {}};
    return target;
}

/// What people look for: "Blender" of "Blender, USD", "Engines without strands" of those for cards.
QString programOf(const ExportTarget& target) {
    static const QRegularExpression kFormat("[,:]");
    return QString::fromStdString(target.name).section(kFormat, 0, 0).trimmed();
}

}  // namespace

const std::vector<ExportProgram>& programsToExportFor() {
    static const std::vector<ExportProgram> all = [] {
        std::vector<ExportProgram> list;
        const auto add = [&](const ExportChoice& choice) {
            const QString name = programOf(*choice.target);
            auto found = std::ranges::find(list, name, &ExportProgram::name);
            if (found == list.end()) found = list.insert(list.end(), {name, {}});
            found->choices.push_back(choice);
        };
        for (const HairWriter& writer : hairWriters()) {
            for (const ExportTarget& target : writer.targets) add({&writer, &target});
        }
        add({&strandWriter("runtime"), &pageTarget(), true});
        std::ranges::sort(list, [](const ExportProgram& a, const ExportProgram& b) {
            return a.name.compare(b.name, Qt::CaseInsensitive) < 0;
        });
        for (ExportProgram& program : list) {
            if (program.choices.size() == 1) continue;
            const std::string& name = program.choices.front().target->program;
            const HairWriter& best = preferredWriter(name, hairWriters());
            std::stable_partition(
                program.choices.begin(), program.choices.end(), [&](const ExportChoice& choice) {
                    return choice.writer->name == (best.holdsCards() ? kCardFormat : best.name);
                });
        }
        return list;
    }();
    return all;
}

const ExportChoice& exportChoice(int program, int format) {
    const std::vector<ExportChoice>& choices =
        programsToExportFor()[static_cast<std::size_t>(std::max(program, 0))].choices;
    return choices[static_cast<std::size_t>(std::clamp(format, 0, static_cast<int>(choices.size()) - 1))];
}

QString problemOf(const ExportChoice& choice) {
    if (choice.isPage && findWebPlayer(programFolder()).empty())
        return QString(
            "Not available: this program was built without the page's player. Build it with `./dev web`, or "
            "set HAIRLOOM_WEB to its folder.");
    return {};
}

}  // namespace hairloom::editor
