// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/json_words.h"

#include <algorithm>
#include <cmath>

namespace hairloom {

nlohmann::ordered_json withFewDigits(const nlohmann::ordered_json& value) {
    constexpr double kDigits = 4;
    if (value.is_structured()) {
        nlohmann::ordered_json all = value;
        for (auto& part : all) part = withFewDigits(part);
        return all;
    }
    if (!value.is_number_float()) return value;
    const double number = value.get<double>();
    if (number == 0 || !std::isfinite(number)) return value;
    const double digits = std::max(0.0, kDigits - 1 - std::floor(std::log10(std::abs(number))));
    // Beyond what a power of ten can say it is left alone.
    if (digits > 300) return value;
    const double unit = std::pow(10.0, digits);
    return std::round(number * unit) / unit;
}

std::string shortText(const nlohmann::ordered_json& value, std::size_t longest) {
    std::string text = value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    if (text.size() <= longest) return text;
    // Not within a character.
    while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0u) == 0x80u) --longest;
    text.resize(longest);
    return text + "…";
}

}  // namespace hairloom
