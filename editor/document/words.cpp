// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/words.h"

#include <QStringList>

namespace hairloom::editor {
namespace {

/// "Operators › 3 › root radius" from "/operators/2/rootRadius": people count from 1.
QString inWords(const QString& pointer) {
    QStringList parts;
    for (QString part : pointer.split('/', Qt::SkipEmptyParts)) {
        bool isNumber = false;
        const int number = part.toInt(&isNumber);
        part.replace("~1", "/").replace("~0", "~").replace('_', ' ');
        parts << (isNumber ? QString::number(number + 1) : labelOf(part));
        if (parts.size() > 1) parts.back() = parts.back().toLower();
    }
    return parts.join(QStringLiteral(" › "));
}

}  // namespace

QString labelOf(const QString& name) {
    QString label;
    for (const QChar letter : name) {
        if (letter.isUpper() && !label.isEmpty()) label += ' ';
        label += label.isEmpty() ? letter.toUpper() : letter.toLower();
    }
    // The unit stands beside the value.
    for (const QLatin1String unit : {QLatin1String(" degrees"), QLatin1String(" per cm2")}) {
        if (label.endsWith(unit)) label.chop(unit.size());
    }
    // "spacing2" is one of several, "3x3" is not.
    if (label.size() > 1 && !label.at(0).isDigit() && label.back().isDigit() &&
        label.at(label.size() - 2).isLetter())
        label.insert(label.size() - 1, ' ');
    return label;
}

QString asSentence(QString text) {
    if (!text.isEmpty()) text[0] = text[0].toUpper();
    return text;
}

QString errorText(const Error& error) {
    Error told = error;
    const std::size_t end = told.problem.find(' ');
    if (told.problem.starts_with('/') && end > 1) {
        const QString words = inWords(QString::fromStdString(told.problem.substr(0, end)));
        told.problem.replace(0, end, words.toStdString());
    }
    return QString::fromStdString(told.message());
}

}  // namespace hairloom::editor
