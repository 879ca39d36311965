// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usda_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace hairloom {
namespace {

bool isWordCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ':' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace

bool UsdaScanner::wrong(std::string what, std::string expected) {
    if (problem_.empty()) {
        problem_ = std::move(what);
        expected_ = std::move(expected);
        failedLine_ = line_;
    }
    return false;
}

tl::unexpected<Error> UsdaScanner::error(const std::string& file) const {
    return failIn(file, Line{failedLine_}, problem_, expected_);
}

void UsdaScanner::skip() {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (c == '\n') ++line_;
        if (c == '#') {
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ';') {
            ++at_;
        } else {
            return;
        }
    }
}

bool UsdaScanner::atEnd() {
    skip();
    return at_ >= text_.size();
}

char UsdaScanner::peek() {
    skip();
    return at_ < text_.size() ? text_[at_] : '\0';
}

bool UsdaScanner::take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
}

bool UsdaScanner::need(char c) {
    return take(c) || wrong(fmt::format("found {}", shown()), fmt::format("expected '{}'", c));
}

bool UsdaScanner::startsWith(std::string_view word) {
    skip();
    return text_.substr(at_).starts_with(word);
}

std::string UsdaScanner::shown() {
    if (atEnd()) return "the end";
    return fmt::format("'{}'", std::string(text_.substr(at_, std::min<std::size_t>(12, text_.size() - at_))));
}

std::string_view UsdaScanner::word() {
    skip();
    const std::size_t start = at_;
    while (at_ < text_.size() && isWordCharacter(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
}

std::string_view UsdaScanner::nextWord() {
    const std::size_t at = at_, line = line_;
    const std::string_view found = word();
    at_ = at;
    line_ = line;
    return found;
}

bool UsdaScanner::takeString(std::string& into) {
    const char quote = peek();
    if (quote != '"' && quote != '\'') return wrong(fmt::format("found {}", shown()), "expected a text");
    const std::string triple(3, quote);
    const bool isLong = text_.substr(at_).starts_with(triple);
    const std::string_view end = isLong ? std::string_view(triple) : std::string_view(triple).substr(0, 1);
    at_ += end.size();
    while (at_ < text_.size() && !text_.substr(at_).starts_with(end)) {
        if (text_[at_] == '\n') {
            if (!isLong) return wrong("a text is not closed", "expected its quotation mark");
            ++line_;
        }
        if (text_[at_] == '\\' && at_ + 1 < text_.size())
            takeEscape(into);
        else
            into += text_[at_++];
    }
    if (at_ >= text_.size()) return wrong("a text is not closed", "expected its quotation mark");
    at_ += end.size();
    return true;
}

/// As OpenUSD's TfEscapeString() has them: \n and the like, numbers of one byte in hexadecimals and octals;
/// others are the character itself.
void UsdaScanner::takeEscape(std::string& into) {
    constexpr std::string_view kNames = "abfnrtv", kBytes = "\a\b\f\n\r\t\v";
    const char c = text_[++at_];
    const auto takeNumber = [&](int base, std::size_t digits) {
        const std::string_view rest = text_.substr(at_, digits);
        std::uint8_t byte = 0;
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), byte, base);
        if (error != std::errc()) return false;
        into += static_cast<char>(byte);
        at_ += static_cast<std::size_t>(end - rest.data());
        return true;
    };
    if (c >= '0' && c <= '7' && takeNumber(8, 3)) return;
    ++at_;
    if (c == 'x' && takeNumber(16, 2)) return;
    if (c == '\n') ++line_;
    const std::size_t name = kNames.find(c);
    into += name == std::string_view::npos ? c : kBytes[name];
}

bool UsdaScanner::takeUntil(std::string_view close, std::string& into) {
    const std::size_t end = text_.find(close, at_);
    if (end == std::string_view::npos)
        return wrong("a path is not closed", fmt::format("expected '{}'", close));
    into = text_.substr(at_, end - at_);
    line_ += static_cast<std::uint64_t>(std::ranges::count(into, '\n'));
    at_ = end + close.size();
    return true;
}

bool UsdaScanner::takePath(std::string& into) {
    return need('<') && takeUntil(">", into);
}

bool UsdaScanner::takeAsset(std::string& into) {
    skip();
    const std::string_view mark = text_.substr(at_).starts_with("@@@") ? "@@@" : "@";
    if (!text_.substr(at_).starts_with(mark)) return need('@');
    at_ += mark.size();
    return takeUntil(mark, into);
}

bool UsdaScanner::number(UsdValue& value) {
    if (peek() == '+') ++at_;
    const char* const begin = text_.data() + at_;
    const char* const end = text_.data() + text_.size();
    if (value.numbers.kind() == UsdNumbers::Kind::Whole) {
        std::uint64_t large = 0;
        std::int64_t whole = 0;
        auto parsed = std::from_chars(begin, end, whole);
        // Beyond the signed numbers there are as many more; each keeps its bits.
        if (parsed.ec == std::errc::result_out_of_range) {
            parsed = std::from_chars(begin, end, large);
            whole = static_cast<std::int64_t>(large);
        }
        const bool isFraction = parsed.ptr < end && (*parsed.ptr == '.' || (*parsed.ptr | 0x20) == 'e');
        if (parsed.ec == std::errc() && !isFraction) {
            at_ = static_cast<std::size_t>(parsed.ptr - text_.data());
            value.numbers.pushWhole(whole);
            return true;
        }
    }
    double parsed = 0;
    const auto [at, code] = std::from_chars(begin, end, parsed);
    if (code == std::errc::invalid_argument)
        return wrong(fmt::format("found {}", shown()), "expected a number");
    // Too large or too small for a double: what is not finite is found where it is used.
    if (code == std::errc::result_out_of_range) parsed = std::numeric_limits<double>::infinity();
    at_ = static_cast<std::size_t>(at - text_.data());
    value.numbers.push_back(parsed);
    return true;
}

bool UsdaScanner::namedScalar(UsdValue& value) {
    const std::string_view name = word();
    if (name == "true" || name == "True")
        value.numbers.push_back(1);
    else if (name == "false" || name == "False")
        value.numbers.push_back(0);
    else if (name == "inf")
        value.numbers.push_back(std::numeric_limits<double>::infinity());
    else if (name == "nan")
        value.numbers.push_back(std::numeric_limits<double>::quiet_NaN());
    else if (name == "None")
        value.isBlock = true;
    else
        value.texts.emplace_back(name);
    return true;
}

bool UsdaScanner::scalar(UsdValue& value) {
    const char c = peek();
    if (c == '"' || c == '\'') return takeString(value.texts.emplace_back());
    if (c == '<') return takePath(value.texts.emplace_back());
    if (c == '@') {
        if (!takeAsset(value.texts.emplace_back())) return false;
        std::string prim;
        return peek() != '<' || takePath(prim);
    }
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') return namedScalar(value);
    if (c == '-' && text_.substr(at_).starts_with("-inf")) {
        at_ += 4;
        value.numbers.push_back(-std::numeric_limits<double>::infinity());
        return true;
    }
    return number(value);
}

bool UsdaScanner::tuple(UsdValue& value, int depth) {
    if (depth > 4) return wrong("tuples lie in each other too deep", "expected a matrix at most");
    if (!need('(')) return false;
    while (!take(')')) {
        if (!(peek() == '(' ? tuple(value, depth + 1) : scalar(value))) return false;
        if (!take(',') && peek() != ')')
            return wrong(fmt::format("found {}", shown()), "expected ',' or ')'");
    }
    return true;
}

bool UsdaScanner::element(UsdValue& value) {
    const std::size_t before = value.numbers.size();
    if (peek() == '(') {
        if (!tuple(value, 0)) return false;
    } else if (!scalar(value)) {
        return false;
    }
    const auto size = static_cast<std::uint32_t>(value.numbers.size() - before);
    if (size == 0) return true;
    if (before == 0) value.components = size;
    return size == value.components ||
           wrong(fmt::format("an element of {} numbers", size), fmt::format("expected {}", value.components));
}

bool UsdaScanner::value(UsdValue& into) {
    if (peek() == '{') return skipBlock('{', '}');
    if (!take('[')) return element(into);
    while (!take(']')) {
        if (!element(into)) return false;
        // Lists of lists are in no attribute of curves.
        if (!take(',') && peek() != ']')
            return wrong(fmt::format("found {}", shown()), "expected ',' or ']'");
    }
    return true;
}

bool UsdaScanner::skipBlock(char open, char close) {
    if (!need(open)) return false;
    int depth = 1;
    while (depth > 0) {
        if (atEnd()) return wrong("the file ends inside a block", fmt::format("expected '{}'", close));
        const char c = text_[at_];
        std::string ignored;
        if (c == '"' || c == '\'') {
            if (!takeString(ignored)) return false;
        } else if (c == '@') {
            if (!takeAsset(ignored)) return false;
        } else {
            depth += c == open ? 1 : c == close ? -1 : 0;
            ++at_;
        }
    }
    return true;
}

}  // namespace hairloom
