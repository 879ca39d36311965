// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/stack_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "core/base/log.h"
#include "core/base/parallel.h"
#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/editing/strand_values.h"
#include "core/groom/file/operators_json.h"
#include "core/operations/sculpt.h"
#include "core/operations/stack.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kGrain = 64;

const AttributeData* find(const AttributeSet& attributes, std::string_view name) {
    const auto found = attributes.all().find(name);
    return found == attributes.all().end() ? nullptr : &found->second;
}

/// Exchanges the list and the arrays that come of it as wholes; what both sides have alike is shared.
class RestackCommand final : public Command {
  public:
    RestackCommand(std::string name, const Groom& from, const Groom& to)
        : name_(std::move(name)), operators_(to.operators) {
        std::set<std::string> names;
        for (const Groom* groom : {&from, &to}) {
            for (const auto& [attribute, data] : groom->pointAttributes.all()) names.insert(attribute);
        }
        for (const std::string& attribute : names) {
            if ((attribute != attribute::kPosition && !isOperatorAttribute(attribute)) ||
                (from.pointAttributes.has(attribute) == to.pointAttributes.has(attribute) &&
                 from.pointAttributes.version(attribute) == to.pointAttributes.version(attribute)))
                continue;
            const AttributeData* data = find(to.pointAttributes, attribute);
            arrays_[attribute] = data ? std::optional(*data) : std::nullopt;
        }
    }
    std::string name() const override { return name_; }
    Change exchange(Model& model) override {
        std::swap(model.groom.operators, operators_);
        AttributeSet& attributes = model.groom.pointAttributes;
        for (auto& [name, array] : arrays_) {
            const AttributeData* data = find(attributes, name);
            std::optional<AttributeData> now = data ? std::optional(*data) : std::nullopt;
            std::swap(now, array);
            now ? attributes.set(name, std::move(*now)) : attributes.erase(name);
        }
        return {arrays_.contains(std::string(attribute::kPosition)) ? Part::Operators | Part::Points
                                                                    : Part::Operators,
                {}};
    }
    std::size_t bytes() const override {
        std::size_t bytes = sizeof(*this) + name_.capacity();
        for (const Operator& one : operators_) bytes += sizeof(one) + one.settings.capacity();
        for (const auto& [name, array] : arrays_) bytes += array ? sizeOf(*array) * sizeof(Vec3f) : 0;
        return bytes;
    }

  private:
    std::string name_;
    std::vector<Operator> operators_;
    std::map<std::string, std::optional<AttributeData>> arrays_;
};

/// A cache of its own where the model keeps none.
class CacheOf {
  public:
    explicit CacheOf(const Model& model) : kept_(model.stackCache.get()) {}
    StackCache& get() { return kept_ ? *kept_ : own_; }

  private:
    StackCache* kept_;
    StackCache own_;
};

std::uint32_t freeNumber(const std::vector<Operator>& operators) {
    std::uint32_t number = 1;
    for (const Operator& one : operators) {
        if (one.op == kSculpt) number = std::max(number, one.number + 1);
    }
    return number;
}

/// Arrays of sculpts that are gone go, those of new ones come with nothing in them.
void fitSculpts(Groom& groom) {
    std::set<std::string> wanted;
    for (const Operator& one : groom.operators) {
        if (one.op == kSculpt) wanted.insert(sculptAttribute(one.number));
    }
    std::vector<std::string> gone;
    for (const auto& [name, data] : groom.pointAttributes.all()) {
        if (name.starts_with(kSculptPrefix) && !wanted.contains(name)) gone.push_back(name);
    }
    for (const std::string& name : gone) groom.pointAttributes.erase(name);
    for (const std::string& name : wanted) {
        if (!groom.pointAttributes.has(name))
            groom.pointAttributes.set(name, std::vector<Vec3f>(groom.pointCount(), Vec3f::Zero()));
    }
}

/// `next` is the model's groom with another list, and arrays of sculpts where they are copied.
StackCommand restack(const Model& model, Groom next, std::string name, std::string record) {
    const Groom& groom = model.groom;
    if (next.operators == groom.operators) return nullptr;
    if (next.operators.size() > kMaxOperators)
        return fail(fmt::format("{} operators", next.operators.size()),
                    fmt::format("expected at most {}", kMaxOperators));
    if (groom.operators.empty()) {
        const AttributeData* now = find(groom.pointAttributes, attribute::kPosition);
        next.pointAttributes.set(attribute::kBasePosition, now ? *now : AttributeData(CowArray<Vec3f>()));
    }
    fitSculpts(next);
    CacheOf cache(model);
    auto shape = evaluateStack(next, cache.get());
    if (!shape) return tl::unexpected(shape.error());
    next.pointAttributes.set(attribute::kPosition, std::move(*shape));
    if (next.operators.empty()) next.pointAttributes.erase(attribute::kBasePosition);
    auto command = std::make_unique<RestackCommand>(std::move(name), groom, next);
    command->setRecord(std::move(record));
    return command;
}

Status checkIndex(const Model& model, std::size_t index, std::size_t end) {
    if (index < end) return {};
    return fail(fmt::format("operator {} does not exist", index),
                fmt::format("there are {} operators", model.groom.operators.size()));
}

/// "Clump": for the history.
std::string labelOf(const Operator& one) {
    std::string label = one.op;
    std::ranges::replace(label, '_', ' ');
    if (!label.empty()) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
    return label;
}

/// What strokes did to some strands, as a sculpt has it: its values of them, and their points, which are a
/// rounding off those that the brush left. Where the sculpt is new, undoing takes it away.
class SculptCommand final : public Command {
  public:
    SculptCommand(std::vector<Operator> operators, std::string attribute, bool isNew,
                  StrandValues<Vec3f> offsets, StrandValues<Vec3f> points)
        : operators_(std::move(operators)),
          attribute_(std::move(attribute)),
          offsets_(std::move(offsets)),
          points_(std::move(points)),
          isNew_(isNew) {}
    std::string name() const override { return "Sculpt"; }
    Change exchange(Model& model) override {
        Groom& groom = model.groom;
        if (isNew_) std::swap(groom.operators, operators_);
        if (isNew_ && !isDone_)
            groom.pointAttributes.set(attribute_, std::vector<Vec3f>(groom.pointCount(), Vec3f::Zero()));
        const auto offsets = groom.offsets.view();
        offsets_.exchange(offsets, groom.pointAttributes.edit<Vec3f>(attribute_));
        if (!points_.empty())
            points_.exchange(offsets, groom.pointAttributes.edit<Vec3f>(attribute::kPosition));
        if (isNew_ && isDone_) groom.pointAttributes.erase(attribute_);
        isDone_ = !isDone_;
        return {Part::Operators | Part::Points, offsets_.strands()};
    }
    std::size_t bytes() const override {
        return sizeof(*this) + offsets_.heapBytes() + points_.heapBytes() +
               (isNew_ ? operators_.capacity() * sizeof(Operator) : 0);
    }

  private:
    std::vector<Operator> operators_;  ///< of the other side, where the sculpt is new
    std::string attribute_;
    StrandValues<Vec3f> offsets_, points_;
    bool isNew_;
    bool isDone_ = false;
};

}  // namespace

StackCommand addOperator(const Model& model, std::size_t index, Operator added) {
    if (auto status = checkIndex(model, index, model.groom.operators.size() + 1); !status)
        return tl::unexpected(status.error());
    Groom next = model.groom;
    if (added.op == kSculpt) added.number = freeNumber(next.operators);
    const std::string name = "Add " + labelOf(added);
    const std::string record =
        recordOf("add_operator", {{"at", index}, {"operator", hairloom::toJson(added)}});
    next.operators.insert(next.operators.begin() + static_cast<std::ptrdiff_t>(index), std::move(added));
    return restack(model, std::move(next), name, record);
}

StackCommand removeOperator(const Model& model, std::size_t index) {
    if (auto status = checkIndex(model, index, model.groom.operators.size()); !status)
        return tl::unexpected(status.error());
    Groom next = model.groom;
    const std::string name = "Remove " + labelOf(next.operators[index]);
    next.operators.erase(next.operators.begin() + static_cast<std::ptrdiff_t>(index));
    return restack(model, std::move(next), name, recordOf("remove_operator", {{"at", index}}));
}

StackCommand moveOperator(const Model& model, std::size_t from, std::size_t to) {
    for (const std::size_t index : {from, to}) {
        if (auto status = checkIndex(model, index, model.groom.operators.size()); !status)
            return tl::unexpected(status.error());
    }
    Groom next = model.groom;
    Operator moved = std::move(next.operators[from]);
    const std::string name = "Move " + labelOf(moved);
    next.operators.erase(next.operators.begin() + static_cast<std::ptrdiff_t>(from));
    next.operators.insert(next.operators.begin() + static_cast<std::ptrdiff_t>(to), std::move(moved));
    return restack(model, std::move(next), name, recordOf("move_operator", {{"at", from}, {"to", to}}));
}

StackCommand setOperator(const Model& model, std::size_t index, Operator changed, std::string name) {
    if (auto status = checkIndex(model, index, model.groom.operators.size()); !status)
        return tl::unexpected(status.error());
    Groom next = model.groom;
    if (changed.op == kSculpt) {
        const Operator& now = next.operators[index];
        changed.number = now.op == kSculpt ? now.number : freeNumber(next.operators);
    }
    std::string record = recordOf("set_operator", {{"at", index}, {"operator", hairloom::toJson(changed)}});
    next.operators[index] = std::move(changed);
    return restack(model, std::move(next), std::move(name), std::move(record));
}

StackCommand copyOperator(const Model& model, std::size_t index) {
    if (auto status = checkIndex(model, index, model.groom.operators.size()); !status)
        return tl::unexpected(status.error());
    Groom next = model.groom;
    Operator copy = next.operators[index];
    if (copy.op == kSculpt) {
        copy.number = freeNumber(next.operators);
        const AttributeData strokes =
            *find(next.pointAttributes, sculptAttribute(next.operators[index].number));
        next.pointAttributes.set(sculptAttribute(copy.number), strokes);
    }
    const std::string name = "Duplicate " + labelOf(copy);
    next.operators.insert(next.operators.begin() + static_cast<std::ptrdiff_t>(index + 1), std::move(copy));
    return restack(model, std::move(next), name, recordOf("copy_operator", {{"at", index}}));
}

StackCommand soloOperator(const Model& model, std::size_t index) {
    if (auto status = checkIndex(model, index, model.groom.operators.size()); !status)
        return tl::unexpected(status.error());
    std::vector<Operator> operators = model.groom.operators;
    bool isAlone = operators[index].enabled;
    for (std::size_t i = 0; i < operators.size(); ++i)
        isAlone = isAlone && (i == index || !operators[i].enabled);
    for (std::size_t i = 0; i < operators.size(); ++i) operators[i].enabled = isAlone || i == index;
    const std::string name = (isAlone ? "Unsolo" : "Solo " + labelOf(operators[index]));
    return setOperators(model, std::move(operators), name);
}

StackCommand addOperators(const Model& model, std::size_t index, std::vector<Operator> added,
                          std::string name) {
    if (auto status = checkIndex(model, index, model.groom.operators.size() + 1); !status)
        return tl::unexpected(status.error());
    std::vector<Operator> operators = model.groom.operators;
    for (Operator& one : added) one.number = 0;
    operators.insert(operators.begin() + static_cast<std::ptrdiff_t>(index), added.begin(), added.end());
    return setOperators(model, std::move(operators), std::move(name));
}

StackCommand setOperators(const Model& model, std::vector<Operator> operators, std::string name) {
    Groom next = model.groom;
    std::set<std::uint32_t> numbers;
    for (Operator& one : operators) {
        if (one.op != kSculpt) continue;
        if (one.number == 0 || !numbers.insert(one.number).second) {
            one.number = std::max(freeNumber(operators), freeNumber(next.operators));
            numbers.insert(one.number);
        }
    }
    next.operators = std::move(operators);
    std::string record = recordOf("operators", {{"operators", hairloom::toJson(next.operators)}});
    return restack(model, std::move(next), std::move(name), std::move(record));
}

StackCommand addShape(const Model& model, std::span<const Vec3f> shape, Operator sculpt, std::string name,
                      std::string record) {
    assert(shape.size() == model.groom.pointCount() && sculpt.op == kSculpt);
    Groom next = model.groom;
    sculpt.number = freeNumber(next.operators);
    std::vector<Vec3f> offsets(shape.size(), Vec3f::Zero());
    const auto positions = next.positions();
    parallelFor(next.strandCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t first = next.offsets[s], count = next.offsets[s + 1] - first;
            if (count < 2) continue;
            measureSculpt(positions.subspan(first, count), shape.subspan(first, count),
                          std::span(offsets).subspan(first, count));
        }
    });
    next.pointAttributes.set(sculptAttribute(sculpt.number), std::move(offsets));
    next.operators.push_back(std::move(sculpt));
    return restack(model, std::move(next), std::move(name), std::move(record));
}

StackCommand bakeOperators(const Model& model) {
    const Groom& groom = model.groom;
    if (groom.operators.empty()) return nullptr;
    Groom next = groom;
    dropOperators(next);
    auto command = std::make_unique<RestackCommand>("Bake operators", groom, next);
    command->setRecord(recordOf("bake_operators", nlohmann::ordered_json::object()));
    return command;
}

std::unique_ptr<Command> stackAfterStrands(const Model& model) {
    CacheOf cache(model);
    auto shape = evaluateStack(model.groom, cache.get());
    if (!shape) {
        log::warning("the operators failed: {}", shape.error().message());
        return nullptr;
    }
    Groom next = model.groom;
    next.pointAttributes.set(attribute::kPosition, std::move(*shape));
    return std::make_unique<RestackCommand>("Operators", model.groom, next);
}

std::unique_ptr<Command> stackAfterStroke(const Model& model, std::span<const std::uint32_t> strands) {
    const Groom& groom = model.groom;
    const Operator& top = groom.operators.back();
    const bool isNew = top.op != kSculpt || !top.enabled || top.weight < 1 || !maskOf(top).isWhole();
    std::vector<Operator> operators = groom.operators;
    if (isNew && operators.size() >= kMaxOperators) return nullptr;
    if (isNew) {
        operators.push_back(newOperator(kSculpt));
        operators.back().number = freeNumber(groom.operators);
    }
    CacheOf cache(model);
    const auto below = evaluateStack(groom, cache.get(), isNew ? kWholeStack : operators.size() - 1);
    if (!below) {
        log::warning("the stroke could not be stored as an operator: {}", below.error().message());
        return nullptr;
    }
    const std::string attribute = sculptAttribute(operators.back().number);
    const auto input = std::get<CowArray<Vec3f>>(*below).view();
    const auto offsets = groom.offsets.view();
    const auto positions = groom.positions();
    std::vector<Vec3f> sculpted(groom.pointCount(), Vec3f::Zero());
    if (!isNew) std::ranges::copy(groom.pointAttributes.view<Vec3f>(attribute), sculpted.begin());
    std::vector<Vec3f> points(positions.begin(), positions.end());
    StrandValues<Vec3f> oldOffsets, oldPoints;
    oldOffsets.keep(offsets, sculpted, strands);
    oldPoints.keep(offsets, points, strands);
    parallelFor(strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t first = offsets[strands[k]], count = offsets[strands[k] + 1] - first;
            if (count < 2) continue;
            const auto shares = std::span(sculpted).subspan(first, count);
            measureSculpt(input.subspan(first, count), positions.subspan(first, count), shares);
            applySculpt(input.subspan(first, count), shares, 1, std::span(points).subspan(first, count));
        }
    });
    oldOffsets.finish(offsets, sculpted);
    oldPoints.finish(offsets, points);
    if (oldOffsets.empty()) return nullptr;
    // The command is made as one that is done, then undone, so that it holds what doing it needs.
    oldOffsets.exchange(offsets, sculpted);
    oldPoints.exchange(offsets, points);
    return std::make_unique<SculptCommand>(std::move(operators), attribute, isNew, std::move(oldOffsets),
                                           std::move(oldPoints));
}

// --- As operations of a script ---

namespace {

MakeCommand readWholeStack(JsonReader& reader) {
    return [operators = readOperators(reader)](const Document& document) {
        return setOperators(document.model(), operators, "Operators");
    };
}

Operator readOneOperator(JsonReader& reader) {
    JsonReader part = reader.object("operator");
    return readOperator(part);
}

std::size_t readIndex(JsonReader& reader, std::string_view name) {
    return static_cast<std::size_t>(reader.count(name, 0, kMaxOperators));
}

MakeCommand readAddOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at"), one = readOneOperator(reader)](const Document& document) {
        return addOperator(document.model(), at, one);
    };
}

MakeCommand readSetOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at"), one = readOneOperator(reader)](const Document& document) {
        return setOperator(document.model(), at, one, "Operator");
    };
}

MakeCommand readMoveOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at"), to = readIndex(reader, "to")](const Document& document) {
        return moveOperator(document.model(), at, to);
    };
}

template <StackCommand (*Make)(const Model&, std::size_t)>
MakeCommand readAtOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at")](const Document& document) { return Make(document.model(), at); };
}

MakeCommand readBake(JsonReader&) {
    return [](const Document& document) { return bakeOperators(document.model()); };
}

constexpr RecordedOperation kStackCommandsRecords[] = {
    {"operators", readWholeStack},
    {"add_operator", readAddOperator},
    {"set_operator", readSetOperator},
    {"move_operator", readMoveOperator},
    {"copy_operator", readAtOperator<copyOperator>},
    {"remove_operator", readAtOperator<removeOperator>},
    {"bake_operators", readBake},
};

}  // namespace

RecordList stackCommandsRecords() {
    return kStackCommandsRecords;
}

}  // namespace hairloom::editing
