// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a person has set for all documents; kept in QSettings.

#include <QObject>
#include <QStringList>

#include "core/colour/colour_choice.h"

namespace hairloom::editor {

inline constexpr int kLeastUndoMegabytes = 64, kMostUndoMegabytes = 65536;

enum class OrbitStyle { Maya, Blender };
enum class Theme { Dark, Light };
enum class SimulateOn { Automatic, Gpu, Cpu };
enum class DisplayUnit { Metre, Centimetre, Millimetre, Inch };

class Preferences : public QObject {
    Q_OBJECT

  public:
    explicit Preferences(QObject* parent = nullptr);

    Theme theme() const { return theme_; }
    void setTheme(Theme theme);
    /// How lengths are shown; documents are in metres.
    DisplayUnit unit() const { return unit_; }
    void setUnit(DisplayUnit unit);
    /// Maya: Alt and a button; Blender: the middle button.
    OrbitStyle orbitStyle() const { return orbitStyle_; }
    void setOrbitStyle(OrbitStyle style);
    /// Exponent that takes the pressure of a pen to that of a brush, 0.25 … 4; above 1 is harder to press.
    double tabletCurve() const { return tabletCurve_; }
    void setTabletCurve(double exponent);
    /// Where hair is simulated while it plays; Automatic: where it was measured to be faster.
    SimulateOn simulateOn() const { return simulateOn_; }
    void setSimulateOn(SimulateOn where);
    /// Minutes of work that a crash may cost at most, 0 … 60; 0 keeps no copies.
    int autosaveMinutes() const { return autosaveMinutes_; }
    void setAutosaveMinutes(int minutes);

    /// Megabytes that undo steps of a document may hold, 64 … 65,536.
    int undoMegabytes() const { return undoMegabytes_; }
    void setUndoMegabytes(int megabytes);

    /// What images are shown through.
    const colour::ColourChoice& colours() const { return colours_; }
    void setColours(const colour::ColourChoice& choice);

    /// The most recent first; those that are gone are left out.
    QStringList recentFiles() const;
    void addRecentFile(const QString& path);

  Q_SIGNALS:
    void changed();
    void recentFilesChanged();

  private:
    template <class T>
    void store(const char* key, T& member, T value);

    Theme theme_;
    DisplayUnit unit_;
    OrbitStyle orbitStyle_;
    double tabletCurve_;
    SimulateOn simulateOn_;
    int autosaveMinutes_;
    int undoMegabytes_;
    colour::ColourChoice colours_;
};

}  // namespace hairloom::editor
