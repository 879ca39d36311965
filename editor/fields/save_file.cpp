// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/save_file.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QStringList>

#include "editor/document/publishing.h"

namespace hairloom::editor {
namespace {

bool endsIn(const QString& name, const SaveFormat& format) {
    const QString end = '.' + format.suffix;
    return QFileInfo(name).fileName().size() > end.size() && name.endsWith(end, Qt::CaseInsensitive);
}

QString fileTypeOf(const SaveFormat& format) {
    return QString("%1 (*.%2)").arg(format.label, format.suffix);
}

}  // namespace

SavePlace placeOf(const QString& name, const std::vector<SaveFormat>& formats, int chosen) {
    const SaveFormat& wanted = formats[static_cast<std::size_t>(chosen)];
    if (endsIn(name, wanted)) return {name, chosen};
    for (std::size_t i = 0; i < formats.size(); ++i)
        if (endsIn(name, formats[i])) return {name, static_cast<int>(i)};
    return {name + '.' + wanted.suffix, chosen};
}

std::optional<SavePlace> askWhereToSave(QWidget* parent, const QString& title, const QString& name,
                                        const std::vector<SaveFormat>& formats, int chosen) {
    QStringList types;
    std::vector<int> formatOfType;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        if (!formats[i].isOffered) continue;
        types += fileTypeOf(formats[i]);
        formatOfType.push_back(static_cast<int>(i));
    }
    QString type = fileTypeOf(formats[static_cast<std::size_t>(chosen)]);
    // The name that is asked about is known only once it has its suffix.
    const QString typed = QFileDialog::getSaveFileName(parent, title, name, types.join(";;"), &type,
                                                       QFileDialog::DontConfirmOverwrite);
    if (typed.isEmpty()) return std::nullopt;
    const auto index = types.indexOf(type);
    if (index >= 0) chosen = formatOfType[static_cast<std::size_t>(index)];
    SavePlace place = placeOf(typed, formats, chosen);
    place.path = withNextVersion(place.path);
    return place;
}

bool mayReplaceFile(QWidget* parent, const QString& path) {
    const QFileInfo file(path);
    return !file.exists() ||
           QMessageBox::question(parent, "Replace file",
                                 QString("%1 is there. Replace it?").arg(file.fileName())) ==
               QMessageBox::Yes;
}

}  // namespace hairloom::editor
