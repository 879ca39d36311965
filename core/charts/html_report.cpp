// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/charts/html_report.h"

#include <fmt/format.h>

#include "core/charts/markup.h"

namespace hairloom {
namespace {

constexpr std::string_view kStyle = R"(
body { font: 15px/1.5 Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; color: #222; background: #fff;
  max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: .3rem; }
h2 { font-size: 1.15rem; margin-top: 2.2rem; border-bottom: 1px solid #ddd; padding-bottom: .2rem; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .8rem .2rem 0; text-align: left; vertical-align: top; }
thead th { border-bottom: 1px solid #999; }
tbody tr { border-bottom: 1px solid #eee; }
td.number, th.number { text-align: right; }
tr.strong td { font-weight: bold; }
tr.red td { color: #c00000; }
code { display: block; background: #f5f5f5; padding: .5rem .8rem; overflow-x: auto; font-size: 13px; }
svg { max-width: 100%; height: auto; margin: .5rem 0 1rem; display: block; }
div.wide { overflow-x: auto; }
)";

bool isNumber(std::string_view cell) {
    return !cell.empty() && cell.find_first_not_of("0123456789.,+-e ") == std::string_view::npos;
}

/// A column of numbers has its head to the right, too; cells without a value do not count.
bool isNumberColumn(const std::vector<std::vector<std::string>>& rows, std::size_t column) {
    bool any = false;
    for (std::size_t r = 1; r < rows.size(); ++r) {
        if (rows[r][column].empty()) continue;
        if (!isNumber(rows[r][column])) return false;
        any = true;
    }
    return any;
}

}  // namespace

void HtmlReport::heading(std::string_view text) {
    body_ += fmt::format("<h2>{}</h2>\n", escapeMarkup(text));
}

void HtmlReport::paragraph(std::string_view text) {
    body_ += fmt::format("<p>{}</p>\n", escapeMarkup(text));
}

void HtmlReport::command(std::string_view text) {
    body_ += fmt::format("<code>{}</code>\n", escapeMarkup(text));
}

void HtmlReport::list(const std::vector<std::string>& items) {
    body_ += "<ul>\n";
    for (const std::string& item : items) body_ += fmt::format("<li>{}</li>\n", escapeMarkup(item));
    body_ += "</ul>\n";
}

void HtmlReport::facts(const std::vector<std::pair<std::string, std::string>>& rows) {
    body_ += "<table><tbody>\n";
    for (const auto& [name, value] : rows) {
        body_ += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escapeMarkup(name), escapeMarkup(value));
    }
    body_ += "</tbody></table>\n";
}

void HtmlReport::table(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& strong,
                       Strong how) {
    if (rows.empty()) return;
    std::vector<const char*> classes;
    for (std::size_t c = 0; c < rows[0].size(); ++c) {
        classes.push_back(isNumberColumn(rows, c) ? " class=\"number\"" : "");
    }
    body_ += "<div class=\"wide\"><table>\n";
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const bool head = r == 0;
        const bool stands = !head && r - 1 < strong.size() && strong[r - 1];
        body_ += head                 ? "<thead><tr>"
                 : !stands            ? "<tr>"
                 : how == Strong::red ? "<tr class=\"red\">"
                                      : "<tr class=\"strong\">";
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            body_ +=
                fmt::format("<{0}{1}>{2}</{0}>", head ? "th" : "td", classes[c], escapeMarkup(rows[r][c]));
        }
        body_ += head ? "</tr></thead>\n<tbody>\n" : "</tr>\n";
    }
    body_ += "</tbody></table></div>\n";
}

void HtmlReport::drawing(std::string_view svg) {
    body_ += svg;
}

std::string HtmlReport::html() const {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
        "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
        escapeMarkup(title_), kStyle, body_);
}

}  // namespace hairloom
