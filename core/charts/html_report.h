// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A page that stands alone: tables and drawings in one HTML file, without scripts and without anything from
// elsewhere.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hairloom {

class HtmlReport {
  public:
    explicit HtmlReport(std::string title) : title_(std::move(title)) {}

    void heading(std::string_view text);
    void paragraph(std::string_view text);
    /// As from a command line.
    void command(std::string_view text);
    void list(const std::vector<std::string>& items);
    /// A name and what it is, row by row.
    void facts(const std::vector<std::pair<std::string, std::string>>& rows);
    enum class Strong { bold, red };
    /// The first row is the head. Cells that are numbers stand to the right. `strong` tells for each row of
    /// the body whether it stands out, and `how`; it may be empty.
    void table(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& strong = {},
               Strong how = Strong::bold);
    /// A drawing by svg().
    void drawing(std::string_view svg);

    std::string html() const;

  private:
    std::string title_;
    std::string body_;
};

}  // namespace hairloom
