// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/price_tag.h"

#include <QLocale>
#include <QPainter>
#include <algorithm>

#include "editor/style/theme.h"

namespace hairloom::editor {
namespace {

constexpr double kColumn_px = 7, kGap_px = 3;
constexpr float kFaded = 0.4f;

QString amount(double value, const QString& unit) {
    return QString::number(value, 'g', 2) + ' ' + unit;
}

std::vector<Price>::const_iterator nowOf(const SettingPrices& prices) {
    return std::ranges::find_if(prices.values, &Price::now);
}

}  // namespace

PriceTag::PriceTag(const Prices& prices, const Preferences& preferences, const QString& setting,
                   QWidget* parent)
    : QWidget(parent), prices_(prices), preferences_(preferences), setting_(setting) {
    setObjectName(setting + "Cost");
    connect(&prices_, &Prices::changed, this, &PriceTag::refresh);
    refresh();
}

QString PriceTag::words() const {
    const SettingPrices* prices = prices_.find(setting_);
    if (!prices) return {};
    const auto now = nowOf(*prices);
    if (now == prices->values.end()) return {};
    QString text = QString("%1, %2.").arg(amount(now->milliseconds, "ms"), amount(now->error, prices->unit));
    // The cheapest that is nearer to the truth.
    const Price* next = nullptr;
    for (const Price& other : prices->values) {
        if (other.error < now->error && (!next || other.milliseconds < next->milliseconds)) next = &other;
    }
    if (!next) return text;
    const double more = next->milliseconds - now->milliseconds;
    const QString less = amount(now->error - next->error, prices->unit);
    return text + ' ' +
           (more > 0 ? QString("%1 adds %2 and saves %3.").arg(next->value, amount(more, "ms"), less)
                     : QString("%1 saves %2 and %3.").arg(next->value, amount(-more, "ms"), less));
}

void PriceTag::refresh() {
    const SettingPrices* prices = prices_.find(setting_);
    setVisible(prices != nullptr);
    if (!prices) return;
    QString rows;
    for (const Price& price : prices->values) {
        const QString row = QStringLiteral(
                                "<tr><td>%1&nbsp;</td><td align=right>%2&nbsp;</td>"
                                "<td align=right>%3</td></tr>")
                                .arg(price.value.toHtmlEscaped(), amount(price.milliseconds, "ms"),
                                     amount(price.error, prices->unit));
        rows += price.now ? "<b>" + row + "</b>" : row;
    }
    const QString age =
        prices->outdated
            ? QString("before the last change")
            : QString("at %1").arg(QLocale().toString(prices->measured.time(), QLocale::ShortFormat));
    setToolTip(
        QString("<p>Frame time, and error against the reference</p><table>%1</table><p>%2 Measured %3.</p>")
            .arg(rows, words().toHtmlEscaped(), age));
    setAccessibleDescription(words());
    update();
}

void PriceTag::paintEvent(QPaintEvent*) {
    const SettingPrices* prices = prices_.find(setting_);
    if (!prices) return;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    if (prices->outdated) painter.setOpacity(static_cast<double>(kFaded));
    const ThemeColours colours = themeColours(preferences_.theme());
    const Price greatest = prices_.greatest(prices->unit);
    const double middle = height() / 2.0, room = middle - 1;
    const auto share = [room](double value, double most) {
        return most > 0 ? std::max(1.0, room * value / most) : 1.0;
    };
    double x = 0;
    painter.setPen(Qt::NoPen);
    for (const Price& price : prices->values) {
        QColor time = colours.accent, error = colours.caution;
        if (!price.now) {
            time.setAlphaF(kFaded);
            error.setAlphaF(kFaded);
        }
        const double up = share(price.milliseconds, greatest.milliseconds),
                     down = share(price.error, greatest.error);
        painter.fillRect(QRectF(x, middle - up, kColumn_px, up), time);
        painter.fillRect(QRectF(x, middle, kColumn_px, down), error);
        x += kColumn_px + kGap_px;
    }
    const auto now = nowOf(*prices);
    if (now == prices->values.end()) return;
    painter.setPen(colours.dimText);
    QFont font = painter.font();
    font.setPointSizeF(font.pointSizeF() * 0.85);
    painter.setFont(font);
    painter.drawText(
        QRectF(x + kGap_px, 0, width() - x - kGap_px, height()), Qt::AlignVCenter | Qt::AlignLeft,
        amount(now->milliseconds, "ms") + QStringLiteral(" · ") + amount(now->error, prices->unit));
}

}  // namespace hairloom::editor
