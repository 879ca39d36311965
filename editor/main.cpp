// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QCommandLineParser>
#include <QTimer>

#include "core/base/output_file.h"
#include "editor/document/end_signals.h"
#include "editor/shell/main_window.h"
#include "editor/style/theme.h"

int main(int argc, char** argv) {
    using namespace hairloom::editor;
    hairloom::removeTemporariesWhenEnded();
    QApplication application(argc, argv);
    QCoreApplication::setApplicationName("Hairloom");
    QCoreApplication::setOrganizationName("Hairloom");
    QCoreApplication::setApplicationVersion(HAIRLOOM_VERSION);
    QCommandLineParser parser;
    parser.setApplicationDescription(QObject::tr("Hairstyles for games: groom, simulate, export."));
    parser.addHelpOption();
    parser.addVersionOption();
    const QCommandLineOption quit("quit-when-shown",
                                  QObject::tr("Exit when the window is shown, to measure startup time."));
    parser.addOption(quit);
    parser.addPositionalArgument("file", QObject::tr("Project, head or hair file to open"), "[file]");
    parser.process(application);
    applyTheme(application, Preferences().theme());
    EndSignals signals;
    const int exitCode = [&] {
        MainWindow window;
        QObject::connect(&signals, &EndSignals::received, &window, [&window] {
            window.autosave().keep();
            QCoreApplication::exit();
        });
        window.show();
        if (const QStringList files = parser.positionalArguments(); !files.isEmpty())
            window.open(files.first());
        if (parser.isSet(quit)) {
            QTimer::singleShot(0, &window, [&window] {
                window.repaint();
                QCoreApplication::quit();
            });
        }
        return QApplication::exec();
    }();
    signals.endProcess();
    return exitCode;
}
