// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Curves with their attributes as Alembic and USD have them, and how they become strands.

#include <cstdint>
#include <string>
#include <vector>

#include "importers/curve_evaluation.h"
#include "importers/raw_strands.h"

namespace hairloom {

struct CurveAttribute {
    enum class Scope : std::uint8_t { Unknown, Constant, Curve, Knot, Point };
    std::string name;
    Scope scope = Scope::Unknown;     ///< as the file says; the number of values has the last word
    std::uint32_t components = 1;     ///< numbers of one value, 1 … 4, or 3 whole ones
    std::vector<float> numbers;       ///< these or
    std::vector<std::int64_t> whole;  ///< those
    bool isFlag = false;              ///< of `whole`: bool or a byte

    std::size_t count() const { return (numbers.empty() ? whole.size() : numbers.size()) / components; }
};

/// One curves object of a file.
struct CurveSet {
    std::string path;  ///< in the file, for messages
    CurveBasis basis = CurveBasis::Linear;
    CurveWrap wrap = CurveWrap::Open;
    std::vector<std::uint32_t> counts;  ///< control points of each curve
    std::vector<float> points;          ///< three numbers each, in the object's space
    std::vector<std::uint32_t> orders;  ///< of NURBS, for each curve or one for all; empty: 4
    std::vector<double> knots;          ///< of NURBS, all curves after each other, or empty
    std::vector<float> weights;         ///< of NURBS, a point each, or empty
    Eigen::Affine3d toFile = Eigen::Affine3d::Identity();  ///< from the object's space
    std::vector<CurveAttribute> attributes;                ///< "width" is a diameter in the object's space
    std::vector<std::vector<float>> frames;                ///< `points` at each time, or empty
    std::vector<Eigen::Affine3d> frameToFile;              ///< as many, or empty where it stays
};

/// Whole numbers that 32 bits do not hold, such as hashes for ids, are numbered anew over all sets, alike
/// ones alike, with a warning.
void narrowWholeNumbers(std::vector<CurveSet>& sets, std::vector<Finding>& warnings);

/// Appends the curves to the strands, and `frames` positions of each point where that is not 0: those of the
/// set, the last one again where it has fewer. Curves of one point are left to the import to drop; those that
/// are none of their basis become lines through their control points, and too few or too many knots uniform
/// ones, with a warning. Errors: counts that do not add up.
Status appendCurves(const std::string& file, CurveSet curves, std::size_t frames, RawStrands& strands);

/// Names that other programs gave attributes become Hairloom's, once all curves of a file are appended:
/// widths, root UV, groups, guides and ids.
void adoptAttributes(RawStrands& strands);

}  // namespace hairloom
