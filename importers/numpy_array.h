// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An array of a .npy file, as NumPy writes it (format 1 to 3).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

struct NumpyArray {
    std::string name;
    std::vector<std::uint64_t> shape;  ///< without sides of length 1 before the last
    char kind = 'f';                   ///< f, i, u or b
    std::size_t bytesEach = 4;
    bool isBigEndian = false, isFortran = false;
    std::span<const std::byte> data;

    std::uint64_t count() const;  ///< of all numbers
    /// Last axis fastest, whatever the file's order. The caller has seen that there are so many bytes.
    std::vector<float> numbers() const;
    std::vector<std::int64_t> whole() const;
    bool isWhole() const { return kind != 'f'; }
    /// "points (10, 100, 3)"
    std::string words() const;
};

bool looksLikeNumpy(std::span<const std::byte> bytes);

/// `bytes` must outlive the array. Errors: no array, objects or records, fewer bytes than the shape takes.
Result<NumpyArray> readNumpy(const std::string& file, const std::string& name,
                             std::span<const std::byte> bytes);

}  // namespace hairloom
