// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Expressions: a value as a formula of where a strand grows, how long it is, what is painted there, noise and
// chance. docs/formats/script.md describes the language for people.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

/// What a formula may name; kFormulaNames has their names in this order.
enum class FormulaName : std::uint8_t {
    u,
    v,       ///< UV of the root
    t,       ///< 0 root … 1 tip, by length
    length,  ///< of the strand, metres
    random,  ///< 0 … 1, another for each strand
    x,
    y,
    z,  ///< of the root, metres
    density,
    dye,
    mask1,
    mask2,
    mask3,
    mask4,  ///< 0 … 1
    pi
};
inline constexpr std::array<const char*, 15> kFormulaNames = {"u",     "v",     "t",     "length",  "random",
                                                              "x",     "y",     "z",     "density", "dye",
                                                              "mask1", "mask2", "mask3", "mask4",   "pi"};
using FormulaValues = std::array<float, kFormulaNames.size()>;

/// A formula that was read once and is evaluated at many points. It has no loops, calls nothing but what is
/// listed and ends after as many steps as it has operators.
class Formula {
  public:
    static constexpr std::size_t kMostCharacters = 500;
    static constexpr std::size_t kMostSteps = 256;
    static constexpr int kDeepest = 32;  ///< parentheses and calls within each other

    /// Errors, each with its column: a character or name that means nothing, a wrong number of arguments, a
    /// missing operand or parenthesis, more than the bounds above.
    static Result<Formula> read(std::string_view text);

    bool names(FormulaName name) const;
    /// Not finite where it divides by zero or asks for what no number is.
    float at(const FormulaValues& values) const;

  private:
    friend class FormulaReader;
    enum class Op : std::uint8_t;
    struct Step {
        Op op;
        FormulaName name{};
        float number = 0;
    };
    static float one(Op op, float a);
    static float two(Op op, float a, float b);
    static float three(Op op, float a, float b, float c);

    std::vector<Step> steps_;  ///< in reverse Polish order
};

}  // namespace hairloom
