// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/parallel.h"
#include "core/base/profiler.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/point_dye.h"
#include "core/operations/sculpt.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 256;

std::vector<std::string_view> stackNames() {
    std::vector<std::string_view> names;
    for (const StackOperator& known : stackOperators()) names.push_back(known.name);
    return names;
}

const Operation& operationOf(std::string_view name) {
    return *std::ranges::find(operations(), name, &Operation::name);
}

template <class T>
std::span<const T> valuesOf(const AttributeData& data) {
    return std::get<CowArray<T>>(data).view();
}

const char* nameOf(SettingsPart part) {
    return part == SettingsPart::region ? "region" : "mask";
}

AttributeData sculpted(const Groom& groom, const Operator& one, const AttributeData& input) {
    const auto from = valuesOf<Vec3f>(input);
    const auto offsets = groom.pointAttributes.view<Vec3f>(sculptAttribute(one.number));
    std::vector<Vec3f> to(from.begin(), from.end());
    parallelFor(groom.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
            if (count < 2) continue;
            applySculpt(from.subspan(first, count), offsets.subspan(first, count), one.weight,
                        std::span(to).subspan(first, count));
        }
    });
    return CowArray<Vec3f>(std::move(to));
}

/// All settings, or those of the region or mask, which may be left out where they are the default.
nlohmann::ordered_json settingsOf(const Operator& one, SettingsPart part) {
    nlohmann::ordered_json all = nlohmann::ordered_json::parse(one.settings);
    if (part == SettingsPart::own) return all;
    const char* const name = nameOf(part);
    if (all.contains(name)) return all[name];
    return part == SettingsPart::region ? fieldsToJson(Region{}) : toJson(Mask{});
}

/// The same as it stands in a file of its own.
void storePart(Operator& one, SettingsPart part, const nlohmann::ordered_json& settings) {
    nlohmann::ordered_json all = nlohmann::ordered_json::parse(one.settings);
    if (part == SettingsPart::own) {
        all = settings;
    } else {
        all[nameOf(part)] = settings;
    }
    one.settings = all.dump();
}

}  // namespace

const std::vector<StackOperator>& stackOperators() {
    static const std::vector<StackOperator> kKnown = [] {
        std::vector<StackOperator> known;
        for (const Operation& operation : operations()) {
            if (operation.stacks)
                known.push_back({operation.name, operation.meaning, operation.fields(), true,
                                 operation.hasCurve, operation.formulaFields});
        }
        known.push_back({kSculpt, "holds brush strokes", {}, false, false, {}});
        return known;
    }();
    return kKnown;
}

const StackOperator* findStackOperator(std::string_view name) {
    const auto found = std::ranges::find(stackOperators(), name, &StackOperator::name);
    return found == stackOperators().end() ? nullptr : &*found;
}

namespace {

Operator readOperatorFor(JsonReader& reader, float scale) {
    const auto names = stackNames();
    const std::string_view name = names[reader.choice("op", names)];
    Operator one = readOperatorHead(reader);
    if (name != kSculpt) {
        one.settings = operationOf(name).settings(reader)(scale);
    } else if (reader.has("mask")) {
        setMaskOf(one, readMask(reader));
    }
    reader.finish();
    return one;
}

}  // namespace

Operator newOperator(std::string_view name, float scale) {
    const nlohmann::json json{{"op", name}};
    JsonReader reader(json, {});
    return readOperatorFor(reader, scale);
}

Operator readOperator(JsonReader& reader) {
    return readOperatorFor(reader, 1);
}

std::vector<Operator> readOperators(JsonReader& reader) {
    return readOperatorList(reader, readOperator);
}

Status completeOperators(const std::string& file, Groom& groom) {
    if (groom.operators.empty()) return {};
    const nlohmann::json json{{"operators", toJson(groom.operators)}};
    JsonReader reader(json, file);
    auto complete = readOperators(reader);
    if (auto status = reader.status(); !status) return status;
    groom.operators = std::move(complete);
    return {};
}

Result<Groom> openProject(const std::filesystem::path& path) {
    constexpr const char* kExpected = "expected a whole project: save it again, or restore a copy";
    auto groom = readProjectFile(path);
    if (!groom) return tl::unexpected(expecting(groom.error(), kExpected));
    if (auto status = completeOperators(path.string(), *groom); !status)
        return tl::unexpected(expecting(status.error(), kExpected));
    return groom;
}

double settingOf(const Operator& one, const FieldInfo& field, std::uint32_t component, SettingsPart part) {
    const nlohmann::ordered_json value = settingsOf(one, part).at(field.name);
    if (value.is_array()) return value.at(component).get<double>();
    if (field.kind == FieldKind::Choice) {
        const auto name = value.get<std::string>();
        return static_cast<double>(std::ranges::find(field.choices, name) - field.choices.begin());
    }
    return value.is_boolean() ? (value.get<bool>() ? 1 : 0) : value.get<double>();
}

bool setSettingOf(Operator& one, const FieldInfo& field, double value, std::uint32_t component,
                  SettingsPart part) {
    if (!field.holds(value)) return false;
    nlohmann::ordered_json settings = settingsOf(one, part);
    nlohmann::ordered_json& member = settings.at(field.name);
    if (field.kind == FieldKind::Bool) {
        member = value != 0;
    } else if (field.kind == FieldKind::Choice) {
        member = field.choices[static_cast<std::size_t>(value)];
    } else if (field.isWhole()) {
        member = value < runtime::kMaxSeed ? static_cast<std::uint64_t>(value) : ~std::uint64_t{0};
    } else {
        (member.is_array() ? member.at(component) : member) = readableDecimal(static_cast<float>(value));
    }
    storePart(one, part, settings);
    return true;
}

Mask maskOf(const Operator& one) {
    const nlohmann::json json = nlohmann::json::parse(one.settings);
    JsonReader reader(json, {});
    return readMask(reader);
}

void setMaskOf(Operator& one, const Mask& mask) {
    storePart(one, SettingsPart::mask, toJson(mask));
}

DrawnCurve curveOf(const Operator& one) {
    const nlohmann::json json = nlohmann::json::parse(one.settings);
    JsonReader reader(json, {});
    return readCurve(reader);
}

void setCurveOf(Operator& one, const DrawnCurve& curve) {
    auto settings = nlohmann::ordered_json::parse(one.settings);
    settings["curve"] = toJson(curve);
    one.settings = settings.dump();
}

namespace {

SettingFormulas formulasOf(const Operator& one) {
    const nlohmann::json json = nlohmann::json::parse(one.settings);
    const auto found = json.find("formulas");
    return found == json.end() ? SettingFormulas() : found->get<SettingFormulas>();
}

}  // namespace

std::string formulaOf(const Operator& one, std::string_view field) {
    const SettingFormulas formulas = formulasOf(one);
    const auto found = formulas.find(field);
    return found == formulas.end() ? std::string() : found->second;
}

Status setFormulaOf(Operator& one, std::string_view field, const std::string& formula) {
    const StackOperator* const known = findStackOperator(one.op);
    if (!known || std::ranges::find(known->formulaFields, field) == known->formulaFields.end())
        return fail(fmt::format("'{}' of '{}' takes no formula", field, one.op),
                    "expected a setting that `groom --list` has among its formulas");
    if (!formula.empty()) {
        if (const auto read = readSettingFormula(formula); !read) return tl::unexpected(read.error());
    }
    SettingFormulas formulas = formulasOf(one);
    formulas.erase(std::string(field));
    if (!formula.empty()) formulas.emplace(field, formula);
    auto settings = nlohmann::ordered_json::parse(one.settings);
    settings.erase("formulas");
    if (!formulas.empty()) settings["formulas"] = formulas;
    one.settings = settings.dump();
    return {};
}

bool readsMap(const Operator& one, MaskMap map) {
    return readsMap(maskOf(one), map) || std::ranges::count(mapsOf(formulasOf(one)), map) > 0;
}

bool readsMaps(const std::vector<Operator>& operators) {
    return std::ranges::any_of(operators, [](const Operator& one) {
        return readsMaps(maskOf(one)) || !mapsOf(formulasOf(one)).empty();
    });
}

std::uint32_t layerOf(const Operator& one) {
    const auto settings = nlohmann::ordered_json::parse(one.settings);
    return settings.contains("region") ? settings["region"].value("layer", 0u) : 0;
}

void setLayerOf(Operator& one, std::uint32_t layer) {
    auto settings = nlohmann::ordered_json::parse(one.settings);
    settings["region"]["layer"] = layer;
    one.settings = settings.dump();
}

std::size_t StackCache::bytes() const {
    std::size_t bytes = 0;
    for (const Level& level : levels_) bytes += level.key.capacity() + sizeOf(level.output) * sizeof(Vec3f);
    return bytes;
}

/// One evaluation.
class StackRun {
  public:
    StackRun(const Groom& groom, StackCache& cache) : groom_(groom), cache_(cache), work_(groom) {
        work_.operators.clear();
        work_.strandAttributes.erase(attribute::kFrozen);
        for (Layer& layer : work_.layers) layer.locked = false;
        const Version ids = groom.strandAttributes.version(attribute::kStrandId);
        const Version layers = groom.strandAttributes.version(attribute::kLayer);
        if (cache.scalp_ != groom.scalp || cache.offsets_ != groom.offsets.version() || cache.ids_ != ids ||
            cache.strandLayers_ != layers)
            cache.levels_.clear();
        if (cache.scalp_ != groom.scalp || !cache.skin_) cache.skin_ = sharedSkin(groom.scalp);
        cache.scalp_ = groom.scalp;
        cache.offsets_ = groom.offsets.version();
        cache.ids_ = ids;
        cache.strandLayers_ = layers;
        // Behind a shorter stack nothing is of use.
        if (cache.levels_.size() > groom.operators.size()) cache.levels_.resize(groom.operators.size());
    }

    Result<AttributeData> run(std::size_t count) {
        // Operators may wait for hair that is still to be placed.
        if (groom_.pointCount() == 0) return AttributeData(CowArray<Vec3f>());
        const auto base = groom_.pointAttributes.all().find(attribute::kBasePosition);
        if (base == groom_.pointAttributes.all().end())
            return fail("the operators have no base shape", "validate says what else is missing");
        AttributeData shape = base->second;
        for (std::size_t i = 0; i < std::min(count, groom_.operators.size()); ++i) {
            const Operator& one = groom_.operators[i];
            if (!one.enabled || !(one.weight > 0)) continue;
            if (cache_.levels_.size() <= i) cache_.levels_.resize(i + 1);
            StackCache::Level& level = cache_.levels_[i];
            const std::string key = keyOf(one);
            if (level.key != key || level.input != versionOf(shape)) {
                auto made = apply(one, shape);
                if (!made) {
                    Error error = made.error();
                    error.problem = fmt::format("operator {}: {}", i, error.problem);
                    return tl::unexpected(std::move(error));
                }
                level = {key, versionOf(shape), std::move(*made)};
            }
            shape = level.output;
        }
        return shape;
    }

  private:
    std::string keyOf(const Operator& one) const {
        const Version strokes =
            one.op == kSculpt ? groom_.pointAttributes.version(sculptAttribute(one.number)) : 0;
        return fmt::format("{} {} {} {} {} {}", one.op, one.weight, strokes, one.settings,
                           mapState(groom_, maskOf(one)), formulaState(groom_, formulasOf(one)));
    }

    Result<AttributeData> apply(const Operator& one, const AttributeData& input) {
        HAIRLOOM_PROFILE("operations: operator");
        if (one.op == kSculpt) return masked(one, input, sculpted(groom_, one, input));
        const auto json = parseJson({}, one.settings);
        if (!json) return tl::unexpected(json.error());
        JsonReader reader(*json, {});
        const RunOperation edit = operationOf(one.op).read(reader);
        reader.finish();
        if (auto status = reader.status(); !status) return tl::unexpected(status.error());
        work_.pointAttributes = {};
        work_.pointAttributes.set(attribute::kPosition, input);
        if (const auto dye = groom_.pointAttributes.all().find(attribute::kPointDye);
            dye != groom_.pointAttributes.all().end())
            work_.pointAttributes.set(attribute::kPointDye, dye->second);
        if (const auto touched = edit(work_); !touched) return tl::unexpected(touched.error());
        const AttributeData output = work_.pointAttributes.all().find(attribute::kPosition)->second;
        if (!(one.weight < 1)) return output;
        return CowArray<Vec3f>(
            blendShapes(groom_, valuesOf<Vec3f>(input), valuesOf<Vec3f>(output), {one.weight, {}}));
    }

    /// Of a sculpt; operations heed their masks themselves.
    Result<AttributeData> masked(const Operator& one, const AttributeData& input,
                                 AttributeData output) const {
        const Mask mask = maskOf(one);
        if (mask.isWhole()) return output;
        const auto from = valuesOf<Vec3f>(input);
        const auto shares = maskShares(groom_, mask, from);
        if (!shares) return tl::unexpected(shares.error());
        return CowArray<Vec3f>(blendShapes(groom_, from, valuesOf<Vec3f>(output), {1, *shares}));
    }

    const Groom& groom_;
    StackCache& cache_;
    Groom work_;
};

Result<AttributeData> evaluateStack(const Groom& groom, StackCache& cache, std::size_t count) {
    HAIRLOOM_PROFILE("operations: stack");
    return StackRun(groom, cache).run(count);
}

}  // namespace hairloom
