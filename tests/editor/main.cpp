// SPDX-License-Identifier: GPL-3.0-or-later
// The tests drive the real window, so there has to be an application before any of them. Settings and
// recovery files go to a folder of this run.
#include <gtest/gtest.h>

#include <QApplication>
#include <QDir>
#include <QSettings>
#include <QStandardPaths>
#include <QTemporaryDir>

#include "editor/style/theme.h"

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    if (testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
    const QTemporaryDir home;
    qunsetenv("OCIO");  // a studio's colours are not these tests'
    // A software device compiles shaders for minutes. Mesa keeps them where other programs find them, too.
    if (qEnvironmentVariableIsEmpty("MESA_SHADER_CACHE_DIR")) {
        const QString cache = QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation);
        if (QDir().mkpath(cache)) qputenv("MESA_SHADER_CACHE_DIR", cache.toUtf8());
    }
    qputenv("XDG_CONFIG_HOME", home.path().toUtf8());
    qputenv("XDG_DATA_HOME", home.path().toUtf8());
    qputenv("XDG_CACHE_HOME", home.path().toUtf8());
    // Processes that a test begins and a signal ends take nothing away: it goes with the folder of this one.
    qputenv("TMPDIR", home.path().toUtf8());
#ifdef _WIN32
    qputenv("APPDATA", home.path().toUtf8());
    // Windows asks no environment variable for the other folders.
    QStandardPaths::setTestModeEnabled(true);
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, home.path());
#else
    if (qEnvironmentVariableIsEmpty("DISPLAY") && qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) {
        qputenv("QT_QPA_PLATFORM", "offscreen");
    }
#endif
    QApplication application(argc, argv);
    QCoreApplication::setApplicationName("Hairloom");
    QCoreApplication::setOrganizationName("Hairloom");
    hairloom::editor::applyTheme(application, hairloom::editor::Theme::Dark);
    return RUN_ALL_TESTS();
}
