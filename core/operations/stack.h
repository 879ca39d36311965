// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Runs the operators of a groom (core/groom/operator_stack.h). An operator acts on all strands of its region,
// frozen and locked ones too: these keep brushes away, and would fall back to the base shape else.

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/operations/operation.h"

namespace hairloom {

/// What a stack may hold, in the order of lists: operations that move points and nothing else, and the
/// sculpt.
struct StackOperator {
    std::string_view name;
    std::string_view meaning;
    std::vector<FieldRow> fields;
    bool hasRegion;
    bool hasCurve;                               ///< one is drawn for it
    std::span<const char* const> formulaFields;  ///< names of the fields that may be formulas
};
const std::vector<StackOperator>& stackOperators();
/// The one of that name, or null.
const StackOperator* findStackOperator(std::string_view name);

/// With its defaults, for a head of that headScale(). `name` is one of stackOperators().
Operator newOperator(std::string_view name, float scale = 1);

/// An operator as scripts have it, with all settings and the region written out. Complaints are the reader's:
/// an unknown name or member, a value out of range.
Operator readOperator(JsonReader& reader);
/// The member "operators", with at most kMaxOperators of them.
std::vector<Operator> readOperators(JsonReader& reader);
/// The same for those of a groom that was loaded from `file`: settings that it lacks get their defaults.
/// Error: the first that does not hold, with its JSON path.
Status completeOperators(const std::string& file, Groom& groom);
/// A project file with its operators complete. Errors: those of readProjectFile() and completeOperators().
Result<Groom> openProject(const std::filesystem::path& path);

/// Which of its fields: the operation's, scriptRegionFields() or scriptMaskFields().
enum class SettingsPart : std::uint8_t { own, region, mask };
/// A setting of an operator whose settings are complete. The field is no ramp.
double settingOf(const Operator& one, const FieldInfo& field, std::uint32_t component,
                 SettingsPart part = SettingsPart::own);
/// False, and no change, where the field does not hold the value.
bool setSettingOf(Operator& one, const FieldInfo& field, double value, std::uint32_t component,
                  SettingsPart part = SettingsPart::own);

/// Every operator has one; it is whole where none is written.
Mask maskOf(const Operator& one);
void setMaskOf(Operator& one, const Mask& mask);

/// The formula of a setting, empty where it has none. The plain value stays beside it.
std::string formulaOf(const Operator& one, std::string_view field);
/// An empty text takes it away. Errors, and no change: a field that takes none, a formula that does not read.
Status setFormulaOf(Operator& one, std::string_view field, const std::string& formula);

/// Whether it reads what is painted there, by its mask or a formula.
bool readsMap(const Operator& one, MaskMap map);

/// The layer that an operator's region names, counted from 1; 0 where it reaches all.
std::uint32_t layerOf(const Operator& one);
/// Of an operator whose region names one.
void setLayerOf(Operator& one, std::uint32_t layer);

/// What the operators made last. One thread at a time.
class StackCache {
  public:
    /// Bytes held.
    std::size_t bytes() const;

  private:
    friend class StackRun;
    struct Level {
        std::string key;
        Version input = 0;
        AttributeData output;
    };
    std::shared_ptr<const void> scalp_;      ///< that the levels were made with
    std::shared_ptr<const SkinField> skin_;  ///< kept for the next run
    Version offsets_ = 0, ids_ = 0, strandLayers_ = 0;
    std::vector<Level> levels_;
};

inline constexpr std::size_t kWholeStack = std::numeric_limits<std::size_t>::max();

/// Of an operator that has one.
DrawnCurve curveOf(const Operator& one);
void setCurveOf(Operator& one, const DrawnCurve& curve);

/// Whether a mask or formula of the stack shows what is painted on a map, so that it runs again where that
/// changes.
bool readsMaps(const std::vector<Operator>& operators);

/// The positions that the first `count` operators make of the groom's base shape; the base shape itself where
/// none does anything. Only operators from the first that has changed since the cache was filled run. The
/// same bits for any number of threads and any cache. Error: an operator that cannot work on this groom.
Result<AttributeData> evaluateStack(const Groom& groom, StackCache& cache, std::size_t count = kWholeStack);

}  // namespace hairloom
