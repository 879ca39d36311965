// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The body of a PLY file, row by row, whatever its encoding.

#include <string>
#include <string_view>
#include <vector>

#include "importers/ply_header.h"

namespace hairloom {

/// The properties of one row: single values and lists, each at their property's index.
struct PlyRow {
    std::vector<double> values;
    std::vector<std::vector<double>> lists;
};

class PlyRows {
  public:
    /// `bytes` is the whole file and must outlive the rows.
    PlyRows(std::string file, std::span<const std::byte> bytes, const PlyHeader& header)
        : file_(std::move(file)),
          text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
          position_(header.bodyOffset),
          line_(header.lines + 1),
          encoding_(header.encoding) {}

    /// An error where the file cannot hold as many rows as it promises.
    Status checkCount(const PlyElement& element) const;
    /// The next row. Errors, with line or byte: no number, the end of the file, a list longer than that.
    Status row(const PlyElement& element, PlyRow& row);
    tl::unexpected<Error> wrong(std::string problem, std::string expected = {}) const;
    /// Bytes that are left to read.
    std::uint64_t remaining() const { return text_.size() - position_; }

  private:
    Result<double> next(PlyType type) {
        return encoding_ == PlyEncoding::Text ? nextWord() : nextBinary(type);
    }
    Result<double> nextWord();
    Result<double> nextBinary(PlyType type);

    std::string file_;
    std::string_view text_;
    std::size_t position_;
    std::uint64_t line_;
    PlyEncoding encoding_;
};

}  // namespace hairloom
