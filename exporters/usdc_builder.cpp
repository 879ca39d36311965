// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/usdc_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace hairloom {
namespace {

constexpr std::size_t kBootstrap = 88;
constexpr std::uint32_t kAttribute = 1, kPrim = 6, kRoot = 7, kRelationship = 8;
constexpr std::uint8_t kBool = 1, kUChar = 2, kInt = 3, kFloat = 8, kDouble = 9, kString = 10, kToken = 11,
                       kVec2f = 20, kVec3f = 24, kVec4f = 28, kDictionary = 31, kTokenListOp = 32,
                       kPathListOp = 34, kTokenVector = 41, kSpecifier = 42, kVariability = 44,
                       kTimeSamples = 46, kDoubleVector = 48;

UsdcRep inlined(std::uint8_t type, std::uint32_t payload) {
    return {std::uint64_t{1} << 62u | std::uint64_t{type} << 48u | payload};
}

/// One LZ4 block of literals behind the number of blocks, 0.
std::vector<std::byte> literals(std::span<const std::byte> bytes) {
    ByteWriter out;
    out.write(std::uint8_t{0});
    constexpr std::size_t kInToken = 15;
    out.write(static_cast<std::uint8_t>(std::min(bytes.size(), kInToken) << 4u));
    if (bytes.size() >= kInToken) {
        std::size_t more = bytes.size() - kInToken;
        for (; more >= 255; more -= 255) out.write(std::uint8_t{255});
        out.write(static_cast<std::uint8_t>(more));
    }
    out.writeArray(bytes);
    return {out.bytes().begin(), out.bytes().end()};
}

/// Behind their size; every difference to the number before stands in full.
template <class T>
void writeIntegers(ByteWriter& out, std::span<const T> numbers) {
    static_assert(sizeof(T) == sizeof(std::int32_t));
    ByteWriter plain;
    plain.write(std::int32_t{0});  // the common difference, which no code says
    const std::vector<std::uint8_t> codes((numbers.size() * 2 + 7) / 8, 0xff);
    plain.writeArray(std::span<const std::uint8_t>(codes));
    std::uint32_t previous = 0;
    for (const T number : numbers) {
        const auto now = static_cast<std::uint32_t>(number);
        plain.write(now - previous);
        previous = now;
    }
    const auto packed = literals(plain.bytes());
    out.write(std::uint64_t{packed.size()});
    out.writeArray(std::span<const std::byte>(packed));
}

}  // namespace

UsdcBuilder::UsdcBuilder() {
    const std::array<std::byte, kBootstrap> head{};
    out_.writeArray(std::span<const std::byte>(head));
    // Properties are told by a negative token, which 0 cannot be.
    tokenIndex(";-)");
}

std::uint32_t UsdcBuilder::tokenIndex(const std::string& text) {
    const auto [entry, added] = tokenIndices_.try_emplace(text, static_cast<std::uint32_t>(tokens_.size()));
    if (added) tokens_.push_back(text);
    return entry->second;
}

UsdcRep UsdcBuilder::token(const std::string& text) {
    return inlined(kToken, tokenIndex(text));
}

UsdcRep UsdcBuilder::string(const std::string& text) {
    strings_.push_back(tokenIndex(text));
    return inlined(kString, static_cast<std::uint32_t>(strings_.size() - 1));
}

UsdcRep UsdcBuilder::tokens(std::span<const std::string> texts) {
    out_.align(8);
    const std::uint64_t offset = out_.size();
    out_.write(std::uint64_t{texts.size()});
    for (const std::string& text : texts) out_.write(tokenIndex(text));
    return {std::uint64_t{kTokenVector} << 48u | offset};
}

UsdcRep UsdcBuilder::dictionary(const Fields& entries) {
    std::vector<std::uint32_t> names;
    for (const auto& [name, value] : entries) {
        strings_.push_back(tokenIndex(name));
        names.push_back(static_cast<std::uint32_t>(strings_.size() - 1));
    }
    out_.align(8);
    const std::uint64_t offset = out_.size();
    out_.write(std::uint64_t{entries.size()});
    for (std::size_t i = 0; i < entries.size(); ++i) {
        out_.write(names[i]);
        out_.write(std::int64_t{8});  // a jump to what stands behind it
        out_.write(entries[i].second.bits);
    }
    return {std::uint64_t{kDictionary} << 48u | offset};
}

UsdcRep UsdcBuilder::number(double value) {
    const auto single = static_cast<float>(value);
    if (double{single} == value) return inlined(kDouble, std::bit_cast<std::uint32_t>(single));
    out_.align(8);
    const std::uint64_t offset = out_.size();
    out_.write(value);
    return {std::uint64_t{kDouble} << 48u | offset};
}

UsdcRep UsdcBuilder::single(float value) {
    return inlined(kFloat, std::bit_cast<std::uint32_t>(value));
}

UsdcRep UsdcBuilder::vector(std::span<const float> value) {
    constexpr std::array<std::uint8_t, 5> kTypes{0, kFloat, kVec2f, kVec3f, kVec4f};
    out_.align(8);
    const std::uint64_t offset = out_.size();
    out_.writeArray(value);
    return {std::uint64_t{kTypes[value.size()]} << 48u | offset};
}

UsdcRep UsdcBuilder::boolean(bool value) const {
    return inlined(kBool, value ? 1 : 0);
}

UsdcRep UsdcBuilder::prepended(std::span<const std::string> texts) {
    constexpr std::uint8_t kHasPrepended = 32;
    const std::uint64_t offset = out_.size();
    out_.write(kHasPrepended);
    out_.write(std::uint64_t{texts.size()});
    for (const std::string& text : texts) out_.write(tokenIndex(text));
    return {std::uint64_t{kTokenListOp} << 48u | offset};
}

UsdcRep UsdcBuilder::path(const std::string& path) {
    constexpr std::uint8_t kIsExplicit = 1, kHasItems = 2;
    const std::uint64_t offset = out_.size();
    out_.write(static_cast<std::uint8_t>(kIsExplicit | kHasItems));
    out_.write(std::uint64_t{1});
    named_.emplace_back(out_.size(), path);
    out_.write(std::uint32_t{0});
    return {std::uint64_t{kPathListOp} << 48u | offset};
}

std::vector<std::string> UsdcBuilder::pathTexts() const {
    std::vector<std::string> texts, above;
    for (const Path& path : paths_) {
        // What stands above it: the root has depth 0 and no name.
        above.resize(path.depth > 0 ? path.depth - 1 : 0);
        std::string text;
        for (const std::string& name : above) text += name;
        const bool isProperty = path.type == kAttribute || path.type == kRelationship;
        if (path.depth > 0) above.push_back((isProperty ? "." : "/") + tokens_[path.token]);
        texts.push_back(path.depth > 0 ? text + above.back() : "/");
    }
    return texts;
}

UsdcRep UsdcBuilder::definition() const {
    return inlined(kSpecifier, 0);
}
UsdcRep UsdcBuilder::uniform() const {
    return inlined(kVariability, 1);
}

template <class T>
UsdcRep UsdcBuilder::array(std::uint8_t type, std::span<const T> values) {
    const std::uint64_t bits = std::uint64_t{1} << 63u | std::uint64_t{type} << 48u;
    if (values.empty()) return {bits};
    out_.align(8);
    const std::uint64_t offset = out_.size();
    std::size_t components = 1;
    if (type == kVec2f) components = 2;
    if (type == kVec3f) components = 3;
    if (type == kVec4f) components = 4;
    out_.write(std::uint64_t{values.size() / components});
    out_.writeArray(values);
    return {bits | offset};
}

UsdcRep UsdcBuilder::ints(std::span<const std::int32_t> values) {
    return array(kInt, values);
}
UsdcRep UsdcBuilder::bytes(std::span<const std::uint8_t> values, bool areBools) {
    return array(areBools ? kBool : kUChar, values);
}
UsdcRep UsdcBuilder::floats(std::span<const float> values, std::uint32_t components) {
    constexpr std::array<std::uint8_t, 5> kTypes{0, kFloat, kVec2f, kVec3f, kVec4f};
    return array(kTypes[components], values);
}

UsdcRep UsdcBuilder::samples(std::span<const double> times, std::span<const UsdcRep> values) {
    out_.align(8);
    const std::uint64_t timesAt = out_.size();
    out_.write(std::uint64_t{times.size()});
    out_.writeArray(times);
    out_.align(8);
    const std::uint64_t offset = out_.size();
    constexpr std::int64_t kNext = 8;  // a jump to what stands behind it
    out_.write(kNext);
    out_.write(std::uint64_t{kDoubleVector} << 48u | timesAt);
    out_.write(kNext);
    out_.write(std::uint64_t{values.size()});
    for (const UsdcRep value : values) out_.write(value.bits);
    return {std::uint64_t{kTimeSamples} << 48u | offset};
}

void UsdcBuilder::root(const Fields& fields) {
    assert(paths_.empty());
    add(0, {}, kRoot, fields);
}
void UsdcBuilder::prim(std::uint32_t depth, const std::string& name, const Fields& fields) {
    add(depth, name, kPrim, fields);
}
void UsdcBuilder::attribute(std::uint32_t depth, const std::string& name, const Fields& fields) {
    add(depth, name, kAttribute, fields);
}

void UsdcBuilder::relationship(std::uint32_t depth, const std::string& name, const Fields& fields) {
    add(depth, name, kRelationship, fields);
}

void UsdcBuilder::add(std::uint32_t depth, const std::string& name, std::uint32_t type,
                      const Fields& fields) {
    paths_.push_back(
        {depth, name.empty() ? 0 : tokenIndex(name), type, static_cast<std::uint32_t>(fieldSets_.size())});
    for (const auto& [field, value] : fields) {
        fieldSets_.push_back(static_cast<std::uint32_t>(fieldTokens_.size()));
        fieldTokens_.push_back(tokenIndex(field));
        fieldValues_.push_back(value.bits);
    }
    fieldSets_.push_back(0xffffffffu);
}

std::vector<std::int32_t> UsdcBuilder::jumps() const {
    std::vector<std::int32_t> jumps(paths_.size());
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        const std::uint32_t depth = paths_[i].depth;
        const bool hasChild = i + 1 < paths_.size() && paths_[i + 1].depth > depth;
        std::size_t next = i + 1;
        while (next < paths_.size() && paths_[next].depth > depth) ++next;
        const bool hasSibling = next < paths_.size() && paths_[next].depth == depth;
        if (hasChild)
            jumps[i] = hasSibling ? static_cast<std::int32_t>(next - i) : -1;
        else
            jumps[i] = hasSibling ? 0 : -2;
    }
    return jumps;
}

std::vector<std::byte> UsdcBuilder::finish() {
    const std::vector<std::string> texts = pathTexts();
    for (const auto& [at, text] : named_) {
        const auto found = std::ranges::find(texts, text);
        assert(found != texts.end());
        out_.overwrite(at, static_cast<std::uint32_t>(found - texts.begin()));
    }
    struct Section {
        std::array<char, 16> name{};
        std::uint64_t begin = 0, size = 0;
    };
    std::vector<Section> sections;
    const auto section = [&](std::string_view name, auto&& write) {
        Section added;
        std::ranges::copy(name, added.name.begin());
        added.begin = out_.size();
        write();
        added.size = out_.size() - added.begin;
        sections.push_back(added);
    };
    const auto writePacked = [&](std::span<const std::byte> bytes) {
        const auto packed = literals(bytes);
        out_.write(std::uint64_t{packed.size()});
        out_.writeArray(std::span<const std::byte>(packed));
    };
    section("TOKENS", [&] {
        std::string text;
        for (const std::string& token : tokens_) text.append(token).push_back('\0');
        out_.write(std::uint64_t{tokens_.size()});
        out_.write(std::uint64_t{text.size()});
        writePacked(std::as_bytes(std::span(text)));
    });
    section("STRINGS", [&] {
        out_.write(std::uint64_t{strings_.size()});
        out_.writeArray(std::span<const std::uint32_t>(strings_));
    });
    section("FIELDS", [&] {
        out_.write(std::uint64_t{fieldTokens_.size()});
        writeIntegers(out_, std::span<const std::uint32_t>(fieldTokens_));
        writePacked(std::as_bytes(std::span(fieldValues_)));
    });
    section("FIELDSETS", [&] {
        out_.write(std::uint64_t{fieldSets_.size()});
        writeIntegers(out_, std::span<const std::uint32_t>(fieldSets_));
    });
    std::vector<std::uint32_t> indices, sets, types;
    std::vector<std::int32_t> elements;
    for (const Path& path : paths_) {
        indices.push_back(static_cast<std::uint32_t>(indices.size()));
        const auto token = static_cast<std::int32_t>(path.token);
        elements.push_back(path.type == kAttribute || path.type == kRelationship ? -token : token);
        sets.push_back(path.fieldSet);
        types.push_back(path.type);
    }
    section("PATHS", [&] {
        out_.write(std::uint64_t{paths_.size()});
        out_.write(std::uint64_t{paths_.size()});
        writeIntegers(out_, std::span<const std::uint32_t>(indices));
        writeIntegers(out_, std::span<const std::int32_t>(elements));
        const std::vector<std::int32_t> next = jumps();
        writeIntegers(out_, std::span<const std::int32_t>(next));
    });
    section("SPECS", [&] {
        out_.write(std::uint64_t{paths_.size()});
        writeIntegers(out_, std::span<const std::uint32_t>(indices));
        writeIntegers(out_, std::span<const std::uint32_t>(sets));
        writeIntegers(out_, std::span<const std::uint32_t>(types));
    });
    const std::uint64_t contents = out_.size();
    out_.write(std::uint64_t{sections.size()});
    out_.writeArray(std::span<const Section>(sections));
    constexpr std::array<char, 11> kStart{'P', 'X', 'R', '-', 'U', 'S', 'D', 'C', 0, 8, 0};
    out_.overwrite(0, kStart);
    out_.overwrite(16, contents);
    return std::move(out_).take();
}

}  // namespace hairloom
