// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QFile>

namespace hairloom::editor {

/// MB of this program that are in memory; 0 where the system does not tell.
inline double residentMegabytes() {
    QFile file("/proc/self/statm");
    if (!file.open(QIODevice::ReadOnly)) return 0;
    const QList<QByteArray> words = file.readAll().split(' ');
    constexpr double kPage = 4096;
    return words.size() > 1 ? words[1].toDouble() * kPage * 1e-6 : 0;
}

}  // namespace hairloom::editor
