// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/style/theme.h"

#include <QFile>
#include <QPalette>
#include <QPixmapCache>
#include <QStyleFactory>
#include <map>

#include "editor/style/icons.h"

/// Icons and style sheet lie in a static library, whose resources nobody else asks for.
static void takeResources() {
    Q_INIT_RESOURCE(resources);
}

namespace hairloom::editor {
namespace {

struct Tones {
    const char *window, *panel, *field, *raised, *line, *text, *dim, *disabled, *accent, *onAccent;
};
// Text stands at 12:1 or more on panels, dim text at 5:1 or more (WCAG 2 contrast).
constexpr Tones kDark{"#1c1e22", "#25282d", "#17191c", "#33373e", "#3b4048",
                      "#e8eaed", "#a7adb7", "#6b717b", "#3d7fd6", "#ffffff"};
constexpr Tones kLight{"#dfe2e6", "#f2f3f5", "#ffffff", "#e3e6ea", "#c3c8cf",
                       "#17191c", "#535a64", "#959ca6", "#1f63b8", "#ffffff"};

constexpr const char *kBadOnDark = "#ef6b62", *kBadOnLight = "#b3261e";

const Tones& tones(Theme theme) {
    return theme == Theme::Dark ? kDark : kLight;
}

QPalette paletteOf(const Tones& t) {
    QPalette palette;
    palette.setColor(QPalette::Window, QColor(t.panel));
    palette.setColor(QPalette::WindowText, QColor(t.text));
    palette.setColor(QPalette::Base, QColor(t.field));
    palette.setColor(QPalette::AlternateBase, QColor(t.panel));
    palette.setColor(QPalette::Text, QColor(t.text));
    palette.setColor(QPalette::PlaceholderText, QColor(t.dim));
    palette.setColor(QPalette::Button, QColor(t.raised));
    palette.setColor(QPalette::ButtonText, QColor(t.text));
    palette.setColor(QPalette::BrightText, QColor(t.text));
    palette.setColor(QPalette::ToolTipBase, QColor(t.panel));
    palette.setColor(QPalette::ToolTipText, QColor(t.text));
    palette.setColor(QPalette::Highlight, QColor(t.accent));
    palette.setColor(QPalette::HighlightedText, QColor(t.onAccent));
    palette.setColor(QPalette::Link, QColor(t.accent));
    palette.setColor(QPalette::Light, QColor(t.raised));
    palette.setColor(QPalette::Mid, QColor(t.line));
    palette.setColor(QPalette::Dark, QColor(t.window));
    palette.setColor(QPalette::Shadow, QColor(t.window));
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
        palette.setColor(QPalette::Disabled, role, QColor(t.disabled));
    }
    palette.setColor(QPalette::Disabled, QPalette::Highlight, QColor(t.line));
    return palette;
}

QString styleSheetOf(const Tones& t) {
    QFile file(":/style.qss");
    if (!file.open(QIODevice::ReadOnly)) return {};
    QString sheet = QString::fromUtf8(file.readAll());
    const std::map<QString, const char*> names{
        {"@window", t.window}, {"@panel", t.panel},       {"@field", t.field}, {"@raised", t.raised},
        {"@line", t.line},     {"@text", t.text},         {"@dim", t.dim},     {"@disabled", t.disabled},
        {"@accent", t.accent}, {"@on-accent", t.onAccent}};
    for (const auto& [name, tone] : names) sheet.replace(name, tone);
    sheet.replace("@bad", &t == &kDark ? kBadOnDark : kBadOnLight);
    sheet.replace("@theme", &t == &kDark ? "dark" : "light");
    sheet.replace("@icon", iconEnding());
    return sheet;
}

}  // namespace

void applyTheme(QApplication& application, Theme theme) {
    takeResources();
    QPixmapCache::clear();
    QApplication::setStyle(QStyleFactory::create("Fusion"));
    QApplication::setPalette(paletteOf(tones(theme)));
    application.setStyleSheet(styleSheetOf(tones(theme)));
}

ThemeColours themeColours(Theme theme) {
    const Tones& t = tones(theme);
    const bool dark = theme == Theme::Dark;
    return {QColor(dark ? "#2a2d32" : "#b9bec6"),
            QColor(t.field),
            QColor(t.text),
            QColor(t.dim),
            QColor(t.accent),
            QColor(dark ? "#5fbf77" : "#1c7a37"),
            QColor(dark ? "#e0b04a" : "#8f6200"),
            QColor(dark ? kBadOnDark : kBadOnLight)};
}

}  // namespace hairloom::editor
