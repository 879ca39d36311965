// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Settings of an operation some of which are formulas, and so differ from strand to strand.

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/operations/formula_values.h"
#include "core/operations/strand_edit.h"

namespace hairloom {

template <class S>
class Varied {
  public:
    /// The same for all strands.
    Varied(const S& settings) : base_(settings) {}  // NOLINT(google-explicit-constructor)

    /// Of the strands that the region reaches. Errors: those of formulaOfStrands(), and a value outside the
    /// field's range, each with the field's name.
    static Result<Varied> make(const Groom& groom, const S& settings, const SettingFormulas& formulas,
                               const Region& region) {
        Varied varied(settings);
        if (formulas.empty()) return varied;
        const std::vector<std::uint32_t> strands = strandsToEdit(groom, region);
        for (const Field<S>& field : fieldsOf(settings)) {
            const auto found = formulas.find(field.name);
            if (found == formulas.end()) continue;
            auto values = valuesOf(groom, field, found->second, strands);
            if (!values) return tl::unexpected(values.error());
            varied.columns_.emplace_back(&field, std::move(*values));
        }
        return varied;
    }

    /// Without the formulas.
    const S& base() const { return base_; }
    S at(std::size_t strand) const {
        S settings = base_;
        for (const auto& [field, values] : columns_)
            field->set(settings, static_cast<double>(values[strand]), 0);
        return settings;
    }

  private:
    static Result<std::vector<float>> valuesOf(const Groom& groom, const Field<S>& field,
                                               const std::string& text,
                                               std::span<const std::uint32_t> strands) {
        const auto formula = readSettingFormula(text);
        if (!formula) return tl::unexpected(named(field, formula.error()));
        auto values = formulaOfStrands(groom, *formula, strands);
        if (!values) return tl::unexpected(named(field, values.error()));
        const auto wrong = std::ranges::find_if(
            strands, [&](std::uint32_t s) { return !field.holds(static_cast<double>((*values)[s])); });
        if (wrong == strands.end()) return values;
        return fail(
            fmt::format("{}: the formula gives {:.6g} at strand {}", field.name, (*values)[*wrong], *wrong),
            fmt::format("expected {}; clamp(…, {:g}, {:g}) keeps it within",
                        rangeText(field.min, field.max, field.unit), field.min, field.max));
    }
    static Error named(const FieldInfo& field, Error error) {
        error.problem = fmt::format("{}: {}", field.name, error.problem);
        return error;
    }

    S base_;
    std::vector<std::pair<const Field<S>*, std::vector<float>>> columns_;
};

}  // namespace hairloom
