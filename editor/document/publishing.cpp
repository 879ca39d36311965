// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/publishing.h"

#include <QCoreApplication>

#include "core/base/versioned_name.h"
#include "core/base/write_rules.h"

namespace hairloom::editor {

QString withNextVersion(const QString& path) {
    const std::filesystem::path name = path.toStdString();
    if (!hasVersionToken(name)) return path;
    const unsigned version = nextVersion(name);
    // Who takes the same version meanwhile keeps it.
    keepNew(versionBeginning(name, version));
    return QString::fromStdString(withVersion(name, version).string());
}

ManifestSource manifestSource(const QtDocument& document, const QString& command) {
    ManifestSource source{QString("hairloom %1").arg(QCoreApplication::applicationVersion()).toStdString(),
                          command.toStdString(),
                          {},
                          nullptr,
                          "save the project under another name, or open it again"};
    if (!document.path().isEmpty()) source.inputs.emplace_back(document.path().toStdString());
    return source;
}

QString nextVersionOf(const QString& path) {
    return withNextVersion(QString::fromStdString(withVersionToken(path.toStdString()).string()));
}

}  // namespace hairloom::editor
