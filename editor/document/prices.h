// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the values of a setting cost and how far each is from the truth, as panels have measured it for this
// document on this machine; rows of settings show it where they are set.

#include <QDateTime>
#include <QHash>
#include <QObject>
#include <QString>
#include <vector>

namespace hairloom::editor {

/// Of one value of a setting, all other settings as they are.
struct Price {
    QString value;
    double milliseconds = 0;  ///< a frame
    double error = 0;         ///< ≥ 0, in SettingPrices::unit
    bool now = false;         ///< what the document has
};

struct SettingPrices {
    std::vector<Price> values;  ///< in the order in which the setting lists them
    QString unit;               ///< of errors: "px", "FLIP"
    QDateTime measured;
    bool outdated = false;  ///< something that they hang on has changed since
};

class Prices : public QObject {
    Q_OBJECT

  public:
    enum class Of { Motion, Picture };

    using QObject::QObject;
    /// By the names of settings, in place of all of that kind. `measured` that is not valid is now.
    void set(Of kind, const QHash<QString, SettingPrices>& prices);
    /// All of that kind are from before a change.
    void outdate(Of kind);
    void clear();
    /// Null: not measured. Valid until the next change.
    const SettingPrices* find(const QString& setting) const;
    /// The longest time and the greatest error of all settings priced in that unit: their bars have one
    /// scale.
    Price greatest(const QString& unit) const;

  Q_SIGNALS:
    void changed();

  private:
    QHash<QString, SettingPrices>& all(Of kind) { return kind == Of::Motion ? motion_ : picture_; }
    QHash<QString, SettingPrices> motion_, picture_;
};

}  // namespace hairloom::editor
