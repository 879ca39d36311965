// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Asks where to save, in one of several formats. Name and format follow one another: what ends in ".mp4" is
// an MP4.

#include <QString>
#include <QWidget>
#include <optional>
#include <vector>

namespace hairloom::editor {

struct SaveFormat {
    QString label;          ///< "Animated WebP"
    QString suffix;         ///< "webp"
    bool isOffered = true;  ///< false: only a typed suffix chooses it
};

struct SavePlace {
    QString path;
    int format = 0;  ///< number in the list
};

/// What a typed name asks for: `chosen` where the name ends in its suffix, else the first format whose suffix
/// it ends in. Where there is none it is `chosen`, whose suffix comes behind the name.
SavePlace placeOf(const QString& name, const std::vector<SaveFormat>& formats, int chosen);

/// Opens the dialog of files; the list of file types in it has the formats. v### in the name takes the next
/// free version. Nothing where it is cancelled. Whether a file may be replaced is not asked:
/// mayReplaceFile().
std::optional<SavePlace> askWhereToSave(QWidget* parent, const QString& title, const QString& name,
                                        const std::vector<SaveFormat>& formats, int chosen);

/// Asks where there is a file of that name.
bool mayReplaceFile(QWidget* parent, const QString& path);

}  // namespace hairloom::editor
