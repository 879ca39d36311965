// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is precompiled for the editor: Qt's headers that most files include. None of our own, so that a change
// of one builds only what includes it.

#include <QComboBox>
#include <QLabel>
#include <QObject>
#include <QPushButton>
#include <QSettings>
#include <QString>
#include <QTimer>
#include <QVBoxLayout>
#include <QWidget>
