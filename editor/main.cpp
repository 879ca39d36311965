// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QCommandLineParser>
#include <QTimer>
#include <cstdlib>

#include "core/base/output_file.h"
#include "editor/document/end_signals.h"
#include "editor/shell/main_window.h"
#include "editor/style/theme.h"

namespace {

/// A library that ends the process, as Qt does when the display is gone, calls exit(): what is unsaved is
/// kept then, too.
class Shown {
  public:
    explicit Shown(hairloom::editor::MainWindow& window) {
        shown = &window;
        std::atexit([] {
            if (shown != nullptr) shown->autosave().keepFromElsewhere();
        });
    }
    Shown(const Shown&) = delete;
    Shown& operator=(const Shown&) = delete;
    ~Shown() { shown = nullptr; }

  private:
    static inline hairloom::editor::MainWindow* shown = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
    using namespace hairloom::editor;
    hairloom::removeTemporariesWhenEnded();
    QApplication application(argc, argv);
    QCoreApplication::setApplicationName("Hairloom");
    QCoreApplication::setOrganizationName("Hairloom");
    QCoreApplication::setApplicationVersion(HAIRLOOM_VERSION);
    QCommandLineParser parser;
    parser.setApplicationDescription("Hairstyles for games: groom, simulate, export.");
    parser.addHelpOption();
    parser.addVersionOption();
    const QCommandLineOption quit("quit-when-shown",
                                  "Exit when the window is shown, to measure startup time.");
    parser.addOption(quit);
    parser.addPositionalArgument("file", "Project, head or hair file to open", "[file]");
    parser.process(application);
    applyTheme(application, Preferences().theme());
    MainWindow window;
    const Shown shown(window);
    // Until here there is no work, and a signal ends the process at once.
    EndSignals signals([&window] { window.autosave().keepFromElsewhere(); });
    QObject::connect(&signals, &EndSignals::received, &window, [&window, &signals] {
        window.keepUnsaved();
        window.autosave().leave();
        // Whatever event loop this is in, and whatever the window would wait for.
        signals.endProcess();
    });
    window.show();
    if (const QStringList files = parser.positionalArguments(); !files.isEmpty()) window.open(files.first());
    if (parser.isSet(quit)) {
        QTimer::singleShot(0, &window, [&window] {
            window.repaint();
            QCoreApplication::quit();
        });
    }
    return QApplication::exec();
}
