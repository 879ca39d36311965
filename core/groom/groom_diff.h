// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What changed between two versions of a groom.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom {

struct GroomDifference {
    std::string where;  ///< "strands", "points.radius", "layers[Fringe].density"
    std::string what;   ///< for people: "12 of 300 strands moved, by up to 4.1 mm", "changed"
    nlohmann::ordered_json before,
        after;                      ///< values of settings, counts of elements; null where there is none
    std::size_t count = 0;          ///< of arrays: elements that differ; 0 for settings
    std::size_t of = 0;             ///< of arrays: elements that are in both
    std::optional<double> largest;  ///< of numbers in arrays: greatest difference, in mm where `isLength`
    bool isLength = false;
    std::string unit;  ///< of settings; empty for pure numbers
};

/// "2 → 4", "12 strands added (300 → 312)". Numbers have four digits, and more where two would look alike.
std::string changeInWords(const GroomDifference& difference);
/// "simulation.substeps: 2 → 4"
std::string inWords(const GroomDifference& difference);

/// How strands of two grooms were found to be the same.
enum class StrandMatch : std::uint8_t {
    ids,    ///< by attribute::kStrandId, which is unique in both
    order,  ///< without ids, and as many strands in both
    roots,  ///< without ids, by equal positions of roots
};
std::string_view strandMatchName(StrandMatch match);

struct GroomComparison {
    std::vector<GroomDifference> differences;  ///< none for grooms of the same content
    StrandMatch match = StrandMatch::ids;
};

enum class ComparedParts : std::uint8_t {
    all,   ///< everything that a project holds
    hair,  ///< strands, points and their attributes, for files that have no more
};

/// A groom and the file that it came from; their heads are the same file where projects name them alike.
struct GroomVersion {
    const Groom& groom;
    std::filesystem::path file;
};

/// Strands first, then attributes of strands and points, settings, lists and arrays of the head. Arrays are
/// compared bit by bit. Strands without unique ids are matched by order where both grooms have as many, else
/// by roots where all are in different places, else by order. Both grooms have a sound structure
/// (checkStructure()). Takes time in proportion to the sizes.
GroomComparison compare(const GroomVersion& before, const GroomVersion& after,
                        ComparedParts parts = ComparedParts::all);

}  // namespace hairloom
