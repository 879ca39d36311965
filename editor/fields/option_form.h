// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Controls for the settings of tools, which are no part of the document: a label, a control, a tooltip each.

#include <QFormLayout>
#include <QWidget>
#include <functional>

#include "editor/document/preferences.h"
#include "editor/document/prices.h"

namespace hairloom::editor {

class OptionForm : public QWidget {
    Q_OBJECT

  public:
    /// With `prices`, numbers and choices that have some show them.
    explicit OptionForm(const Preferences& preferences, const Prices* prices = nullptr,
                        QWidget* parent = nullptr);

    /// `unit` as in fields ("m", ""); the tooltip tells range and unit. `get` is asked again at refresh().
    void addNumber(const QString& name, const QString& label, const QString& tip, const QString& unit,
                   double min, double max, bool whole, std::function<double()> get,
                   std::function<void(double)> set);
    void addBool(const QString& name, const QString& label, const QString& tip, std::function<bool()> get,
                 std::function<void(bool)> set);
    void addChoice(const QString& name, const QString& label, const QString& tip, const QStringList& choices,
                   std::function<int()> get, std::function<void(int)> set);
    /// The same, of choices that are asked for again at refresh(). Their number stays.
    void addChoice(const QString& name, const QString& label, const QString& tip,
                   std::function<QStringList()> choices, std::function<int()> get,
                   std::function<void(int)> set);
    void addWidget(const QString& label, QWidget* widget);

    void refresh();

  private:
    void addPriced(const QString& name, const QString& label, QWidget* control);

    const Preferences& preferences_;
    const Prices* prices_;
    QFormLayout* layout_;
    std::vector<std::function<void()>> refreshers_;
};

}  // namespace hairloom::editor
