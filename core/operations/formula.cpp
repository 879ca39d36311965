// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/base/random.h"
#include "core/base/smooth_step.h"
#include "core/base/utf8.h"

namespace hairloom {

/// In groups by how many operands they take: none, one, two, three.
enum class Formula::Op : std::uint8_t {
    number,
    name,
    negate,
    abs,
    floor,
    fract,
    sqrt,
    sin,
    cos,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    power,
    less,
    lessEqual,
    greater,
    greaterEqual,
    equal,
    unequal,
    min,
    max,
    clamp,
    mix,
    smoothstep,
    choose,
    noise
};

namespace {

/// Smooth noise of three coordinates, −1 … 1: random values at the corners of unit cells, blended.
float noiseAt(float x, float y, float z) {
    constexpr std::uint64_t kStream = 0x6e6f697365;
    const float cx = std::floor(x), cy = std::floor(y), cz = std::floor(z);
    const auto corner = [&](int i, int j, int k) {
        // Cells are told apart by the bits of their corners.
        const auto bits = [](float whole) {
            return std::uint64_t{std::bit_cast<std::uint32_t>(whole + 0.0f)};
        };
        Random first(kStream + bits(cx + static_cast<float>(i)), bits(cy + static_cast<float>(j)));
        return Random(first.next(), bits(cz + static_cast<float>(k))).uniform(-1, 1);
    };
    const auto smooth = [](float w) { return w * w * (3 - 2 * w); };
    const auto mix = [](float a, float b, float w) { return a + w * (b - a); };
    const float wx = smooth(x - cx), wy = smooth(y - cy), wz = smooth(z - cz);
    const auto plane = [&](int k) {
        return mix(mix(corner(0, 0, k), corner(1, 0, k), wx), mix(corner(0, 1, k), corner(1, 1, k), wx), wy);
    };
    return mix(plane(0), plane(1), wz);
}

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

}  // namespace

/// Recursive descent, one function for each strength of binding.
class FormulaReader {
  public:
    explicit FormulaReader(std::string_view text) : text_(text) {}

    Result<Formula> read() {
        if (text_.size() > Formula::kMostCharacters)
            return fail(fmt::format("the formula has {} characters", text_.size()),
                        fmt::format("expected at most {}", Formula::kMostCharacters));
        comparison();
        skipSpace();
        if (!error_ && at_ < text_.size())
            complain("what follows belongs to nothing", "expected an operator");
        if (error_) return tl::unexpected(*error_);
        return std::move(formula_);
    }

  private:
    using Op = Formula::Op;
    struct Function {
        std::string_view name;
        Op op;
        int fewest, most;
    };
    static constexpr Function kFunctions[] = {
        {"abs", Op::abs, 1, 1},     {"floor", Op::floor, 1, 1}, {"fract", Op::fract, 1, 1},
        {"sqrt", Op::sqrt, 1, 1},   {"sin", Op::sin, 1, 1},     {"cos", Op::cos, 1, 1},
        {"min", Op::min, 2, 2},     {"max", Op::max, 2, 2},     {"pow", Op::power, 2, 2},
        {"clamp", Op::clamp, 3, 3}, {"mix", Op::mix, 3, 3},     {"smoothstep", Op::smoothstep, 3, 3},
        {"if", Op::choose, 3, 3},   {"noise", Op::noise, 1, 3}};

    void complain(const std::string& problem, const std::string& expected) {
        if (!error_)
            error_ = Error{{}, {}, fmt::format("formula, column {}: {}", at_ + 1, problem), expected};
    }
    void add(Op op, FormulaName name = {}, float number = 0) {
        if (error_) return;
        if (formula_.steps_.size() == Formula::kMostSteps)
            return complain("the formula is too long",
                            fmt::format("expected at most {} operators", Formula::kMostSteps));
        formula_.steps_.push_back({op, name, number});
    }
    void skipSpace() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    }
    bool take(std::string_view sign) {
        skipSpace();
        if (error_ || !text_.substr(at_).starts_with(sign)) return false;
        at_ += sign.size();
        return true;
    }

    void comparison() {
        sum();
        static constexpr std::pair<std::string_view, Op> kSigns[] = {
            {"<=", Op::lessEqual}, {">=", Op::greaterEqual}, {"==", Op::equal},
            {"!=", Op::unequal},   {"<", Op::less},          {">", Op::greater}};
        for (const auto& [sign, op] : kSigns) {
            if (!take(sign)) continue;
            sum();
            add(op);
            return;
        }
    }
    void sum() {
        product();
        while (!error_) {
            if (take("+")) {
                product();
                add(Op::add);
            } else if (take("-")) {
                product();
                add(Op::subtract);
            } else {
                return;
            }
        }
    }
    void product() {
        sign();
        while (!error_) {
            const Op op = take("*")   ? Op::multiply
                          : take("/") ? Op::divide
                          : take("%") ? Op::modulo
                                      : Op::number;
            if (op == Op::number) return;
            sign();
            add(op);
        }
    }
    void sign() {
        if (!deeper()) return;
        if (take("-")) {
            sign();
            add(Op::negate);
        } else {
            operand();
            if (take("^")) {
                sign();
                add(Op::power);
            }
        }
        --depth_;
    }
    bool deeper() {
        if (++depth_ <= Formula::kDeepest) return true;
        complain("too much within each other", fmt::format("expected at most {} levels", Formula::kDeepest));
        return false;
    }
    void operand() {
        skipSpace();
        if (error_) return;
        if (at_ == text_.size()) return complain("the formula ends", "expected a number, a name or (");
        const char c = text_[at_];
        if (isDigit(c) || c == '.') return number();
        if (isLetter(c)) return word();
        if (!take("("))
            return complain(fmt::format("'{}' means nothing here", character()),
                            "expected a number, a name or (");
        comparison();
        if (!take(")")) complain("a parenthesis is open", "expected )");
    }
    /// The whole character at the place of reading, '?' for what is no UTF-8.
    std::string character() const {
        const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
        std::size_t end = at_ + 1;
        while (end < text_.size() && continues(text_[end])) ++end;
        return cleanUtf8(text_.substr(at_, end - at_));
    }
    void number() {
        float value = 0;
        const auto [end, code] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (code != std::errc() || !std::isfinite(value))
            return complain("no number that can be used", "expected one like 0.4");
        at_ = static_cast<std::size_t>(end - text_.data());
        add(Op::number, {}, value);
    }
    void word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (isLetter(text_[at_]) || isDigit(text_[at_]))) ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        const auto function = std::ranges::find(kFunctions, word, &Function::name);
        if (function != std::end(kFunctions)) return call(*function);
        const auto name = std::ranges::find(kFormulaNames, word);
        if (name != kFormulaNames.end())
            return add(Op::name, static_cast<FormulaName>(name - kFormulaNames.begin()));
        at_ = begin;
        std::string known;
        for (const char* one : kFormulaNames) known += (known.empty() ? "" : ", ") + std::string(one);
        for (const Function& one : kFunctions) known += fmt::format(", {}()", one.name);
        complain(fmt::format("'{}' is not known", word), "expected one of " + known);
    }
    void call(const Function& function) {
        if (!take("("))
            return complain(fmt::format("{} is a function", function.name), "expected ( and its arguments");
        int arguments = 0;
        do {
            comparison();
            ++arguments;
        } while (!error_ && arguments < function.most && take(","));
        if (!error_ && arguments < function.fewest)
            return complain(fmt::format("{} has {} arguments", function.name, arguments),
                            fmt::format("expected {}", function.fewest));
        if (!take(")")) return complain(fmt::format("{} is not closed", function.name), "expected )");
        for (; function.op == Op::noise && arguments < 3; ++arguments) add(Op::number);
        add(function.op);
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int depth_ = 0;
    std::optional<Error> error_;
    Formula formula_;
};

Result<Formula> Formula::read(std::string_view text) {
    return FormulaReader(text).read();
}

bool Formula::names(FormulaName name) const {
    return std::ranges::any_of(steps_,
                               [&](const Step& step) { return step.op == Op::name && step.name == name; });
}

float Formula::one(Op op, float a) {
    switch (op) {
        case Op::negate:
            return -a;
        case Op::abs:
            return std::abs(a);
        case Op::floor:
            return std::floor(a);
        case Op::fract:
            return a - std::floor(a);
        case Op::sqrt:
            return std::sqrt(a);
        case Op::sin:
            return std::sin(a);
        default:
            return std::cos(a);
    }
}

float Formula::two(Op op, float a, float b) {
    switch (op) {
        case Op::add:
            return a + b;
        case Op::subtract:
            return a - b;
        case Op::multiply:
            return a * b;
        case Op::divide:
            return a / b;
        case Op::modulo:
            return a - b * std::floor(a / b);
        case Op::power:
            return std::pow(a, b);
        case Op::less:
            return a < b ? 1.0f : 0.0f;
        case Op::lessEqual:
            return a <= b ? 1.0f : 0.0f;
        case Op::greater:
            return a > b ? 1.0f : 0.0f;
        case Op::greaterEqual:
            return a >= b ? 1.0f : 0.0f;
        case Op::equal:
            return a == b ? 1.0f : 0.0f;
        case Op::unequal:
            return a != b ? 1.0f : 0.0f;
        case Op::min:
            return std::min(a, b);
        default:
            return std::max(a, b);
    }
}

float Formula::three(Op op, float a, float b, float c) {
    switch (op) {
        case Op::clamp:
            return std::min(std::max(a, b), c);
        case Op::mix:
            return a + c * (b - a);
        case Op::smoothstep:
            return smoothStep(std::min(std::max((c - a) / (b - a), 0.0f), 1.0f));
        case Op::choose:
            return a != 0 ? b : c;
        default:
            return noiseAt(a, b, c);
    }
}

float Formula::at(const FormulaValues& values) const {
    std::array<float, kMostSteps> stack;  // each operand is pushed by a step of its own
    std::size_t top = 0;
    for (const Step& step : steps_) {
        if (step.op <= Op::name) {
            stack[top++] = step.op == Op::number ? step.number : values[static_cast<std::size_t>(step.name)];
        } else if (step.op <= Op::cos) {
            stack[top - 1] = one(step.op, stack[top - 1]);
        } else if (step.op <= Op::max) {
            --top;
            stack[top - 1] = two(step.op, stack[top - 1], stack[top]);
        } else {
            top -= 2;
            stack[top - 1] = three(step.op, stack[top - 1], stack[top], stack[top + 1]);
        }
    }
    return stack[0];
}

}  // namespace hairloom
