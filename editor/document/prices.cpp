// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/document/prices.h"

#include <algorithm>

namespace hairloom::editor {

void Prices::set(Of kind, const QHash<QString, SettingPrices>& prices) {
    all(kind) = prices;
    for (SettingPrices& one : all(kind)) {
        if (!one.measured.isValid()) one.measured = QDateTime::currentDateTime();
    }
    Q_EMIT changed();
}

void Prices::outdate(Of kind) {
    for (SettingPrices& prices : all(kind)) prices.outdated = true;
    Q_EMIT changed();
}

void Prices::clear() {
    motion_.clear();
    picture_.clear();
    Q_EMIT changed();
}

const SettingPrices* Prices::find(const QString& setting) const {
    for (const auto* prices : {&motion_, &picture_}) {
        if (const auto found = prices->find(setting); found != prices->end()) return &*found;
    }
    return nullptr;
}

Price Prices::greatest(const QString& unit) const {
    Price all;
    for (const auto* settings : {&motion_, &picture_}) {
        for (const SettingPrices& one : *settings) {
            if (one.unit != unit) continue;
            for (const Price& price : one.values) {
                all.milliseconds = std::max(all.milliseconds, price.milliseconds);
                all.error = std::max(all.error, price.error);
            }
        }
    }
    return all;
}

}  // namespace hairloom::editor
