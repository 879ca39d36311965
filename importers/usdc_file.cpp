// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usdc_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/base/file.h"
#include "importers/usdc_packing.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kBootstrap = 88;  ///< bytes
constexpr std::string_view kStart = "PXR-USDC";
constexpr int kOldest = 4, kNewest = 16;  ///< versions 0.N
constexpr std::uint32_t kEnd = 0xffffffffu;
constexpr std::size_t kMaxFields = 4096;  ///< of one spec

/// Reads one section: counts, and packed numbers behind their length in bytes.
class SectionReader {
  public:
    SectionReader(const std::string& file, std::span<const std::byte> bytes, std::uint64_t begin,
                  std::uint64_t size)
        : file_(file), bytes_(bytes.first(static_cast<std::size_t>(begin + size))), at_(begin) {}

    Result<std::uint64_t> count() {
        if (bytes_.size() - at_ < sizeof(std::uint64_t)) return tl::unexpected(error("ends too early"));
        std::uint64_t value = 0;
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    /// Behind their number of bytes.
    Result<std::span<const std::byte>> packed() {
        const auto size = count();
        if (!size) return tl::unexpected(size.error());
        return take(*size);
    }
    Result<std::span<const std::byte>> take(std::uint64_t size) {
        if (size > bytes_.size() - at_)
            return tl::unexpected(error(fmt::format("{} bytes go beyond the section", size)));
        const auto part = bytes_.subspan(at_, static_cast<std::size_t>(size));
        at_ += size;
        return part;
    }
    Result<std::vector<std::uint32_t>> integers(std::uint64_t count) {
        const auto bytes = packed();
        if (!bytes) return tl::unexpected(bytes.error());
        const auto numbers = unpackIntegers32(*bytes, count);
        if (!numbers) return tl::unexpected(placed(numbers.error()));
        return std::vector<std::uint32_t>(numbers->begin(), numbers->end());
    }
    Error placed(Error error) const {
        error.file = file_;
        error.place = Byte{at_};
        return error;
    }

  private:
    Error error(std::string problem) const { return {file_, Byte{at_}, std::move(problem), {}}; }

    const std::string& file_;
    std::span<const std::byte> bytes_;
    std::uint64_t at_;
};

}  // namespace

tl::unexpected<Error> UsdcFile::error(std::uint64_t offset, std::string problem, std::string expected) const {
    return failIn(file_, Byte{offset}, std::move(problem), std::move(expected));
}

Result<UsdcFile> UsdcFile::open(std::string file, std::span<const std::byte> bytes) {
    UsdcFile crate(std::move(file), bytes);
    if (auto status = crate.read(); !status) return tl::unexpected(status.error());
    return crate;
}

Status UsdcFile::read() {
    if (bytes_.size() < kBootstrap || std::memcmp(bytes_.data(), kStart.data(), kStart.size()) != 0)
        return error(0, "is not a binary USD file", "expected PXR-USDC and a head of 88 bytes");
    const auto major = std::to_integer<int>(bytes_[8]);
    minor_ = std::to_integer<int>(bytes_[9]);
    if (major != 0 || minor_ < kOldest || minor_ > kNewest)
        return error(8, fmt::format("has version {}.{}", major, minor_),
                     fmt::format("expected 0.{} to 0.{}", kOldest, kNewest));
    ByteReader in(file_, bytes_);
    constexpr std::uint64_t kTocOffset = 16;
    static_cast<void>(in.seek(kTocOffset, "the head"));
    const auto toc = in.read<std::uint64_t>("the table of contents' place");
    if (!toc) return tl::unexpected(toc.error());
    if (auto status = in.seek(*toc, "the table of contents"); !status) return status;
    const auto count = in.read<std::uint64_t>("the number of sections");
    if (!count) return tl::unexpected(count.error());
    struct Entry {
        std::array<char, 16> name;
        std::uint64_t begin, size;
    };
    const auto entries = in.readArray<Entry>(*count, "sections");
    if (!entries) return tl::unexpected(entries.error());
    constexpr std::array<std::string_view, SectionCount> kNames{"TOKENS",    "STRINGS", "FIELDS",
                                                                "FIELDSETS", "PATHS",   "SPECS"};
    for (const Entry& entry : *entries) {
        const std::string_view name(entry.name.data(), strnlen(entry.name.data(), entry.name.size()));
        const auto found = std::ranges::find(kNames, name);
        if (found == kNames.end()) continue;
        if (entry.begin > bytes_.size() || entry.size > bytes_.size() - entry.begin)
            return error(*toc, fmt::format("the section {} goes beyond the end of the file", name));
        sections_[static_cast<std::size_t>(found - kNames.begin())] = {entry.begin, entry.size, true};
    }
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        if (!sections_[i].isThere) return error(*toc, fmt::format("has no section {}", kNames[i]));
    }
    for (const auto step : {&UsdcFile::readTokens, &UsdcFile::readStrings, &UsdcFile::readFields,
                            &UsdcFile::readFieldSets, &UsdcFile::readPaths, &UsdcFile::readSpecs}) {
        if (auto status = (this->*step)(); !status) return status;
    }
    return {};
}

Status UsdcFile::readTokens() {
    SectionReader in(file_, bytes_, sections_[Tokens].begin, sections_[Tokens].size);
    const auto count = in.count(), size = in.count();
    if (!count || !size) return tl::unexpected(count ? size.error() : count.error());
    const auto packed = in.packed();
    if (!packed) return tl::unexpected(packed.error());
    const auto text = unpackBytes(*packed, *size);
    if (!text) return tl::unexpected(in.placed(text.error()));
    // Each ends with a zero.
    if (*count > text->size())
        return error(sections_[Tokens].begin, fmt::format("{} tokens in {} bytes", *count, text->size()));
    const char* at = reinterpret_cast<const char*>(text->data());
    const char* const end = at + text->size();
    while (tokens_.size() < *count) {
        const char* const stop = std::find(at, end, '\0');
        if (stop == end) return error(sections_[Tokens].begin, "a token has no end");
        tokens_.emplace_back(at, stop);
        at = stop + 1;
    }
    return {};
}

Status UsdcFile::readStrings() {
    SectionReader in(file_, bytes_, sections_[Strings].begin, sections_[Strings].size);
    const auto count = in.count();
    if (!count) return tl::unexpected(count.error());
    if (*count > sections_[Strings].size / sizeof(std::uint32_t))
        return error(sections_[Strings].begin, fmt::format("{} texts are more than fit", *count));
    const auto bytes = in.take(*count * sizeof(std::uint32_t));
    if (!bytes) return tl::unexpected(bytes.error());
    strings_.resize(static_cast<std::size_t>(*count));
    if (!strings_.empty()) std::memcpy(strings_.data(), bytes->data(), bytes->size());
    return {};
}

Status UsdcFile::readFields() {
    SectionReader in(file_, bytes_, sections_[Fields].begin, sections_[Fields].size);
    const auto count = in.count();
    if (!count) return tl::unexpected(count.error());
    const auto names = in.integers(*count);
    if (!names) return tl::unexpected(names.error());
    const auto packed = in.packed();
    if (!packed) return tl::unexpected(packed.error());
    const auto values = unpackBytes(*packed, *count * sizeof(std::uint64_t));
    if (!values) return tl::unexpected(in.placed(values.error()));
    if (values->size() != names->size() * sizeof(std::uint64_t))
        return error(sections_[Fields].begin,
                     fmt::format("{} fields, and {} bytes of values", *count, values->size()));
    fields_.resize(names->size());
    for (std::size_t i = 0; i < fields_.size(); ++i) {
        fields_[i].token = (*names)[i];
        std::memcpy(&fields_[i].value.bits, values->data() + i * sizeof(std::uint64_t),
                    sizeof(std::uint64_t));
    }
    return {};
}

Status UsdcFile::readFieldSets() {
    SectionReader in(file_, bytes_, sections_[FieldSets].begin, sections_[FieldSets].size);
    const auto count = in.count();
    if (!count) return tl::unexpected(count.error());
    auto sets = in.integers(*count);
    if (!sets) return tl::unexpected(sets.error());
    fieldSets_ = std::move(*sets);
    return {};
}

Status UsdcFile::readPaths() {
    SectionReader in(file_, bytes_, sections_[Paths].begin, sections_[Paths].size);
    const auto total = in.count(), count = in.count();
    if (!total || !count) return tl::unexpected(total ? count.error() : total.error());
    const auto indices = in.integers(*count), tokens = in.integers(*count), jumps = in.integers(*count);
    for (const auto* numbers : {&indices, &tokens, &jumps}) {
        if (!*numbers) return tl::unexpected(numbers->error());
    }
    // The empty path, which a reference to a default prim has, is in the table and not in the list.
    if (*total > *count && *total - *count > 1)
        return error(sections_[Paths].begin, fmt::format("{} paths of {} that are listed", *total, *count));
    paths_.resize(static_cast<std::size_t>(*total));
    // Depth first: a jump says where the next sibling stands behind the children, 0 that it follows at once,
    // −1 that there are children alone, −2 neither.
    struct Waiting {
        std::size_t entry;
        std::uint32_t parent;
    };
    std::vector<Waiting> waiting{{0, kEnd}};
    std::size_t visited = 0;
    while (!waiting.empty()) {
        auto [entry, parent] = waiting.back();
        waiting.pop_back();
        for (bool goesOn = true; goesOn;) {
            if (entry >= indices->size() || (*indices)[entry] >= paths_.size() ||
                visited++ >= indices->size())
                return error(sections_[Paths].begin, "paths lead nowhere or form a cycle");
            const auto token = static_cast<std::int32_t>((*tokens)[entry]);
            const auto jump = static_cast<std::int32_t>((*jumps)[entry]);
            const std::uint32_t path = (*indices)[entry];
            paths_[path] = {parent, static_cast<std::uint32_t>(token < 0 ? -std::int64_t{token} : token),
                            token < 0};
            if (jump > 0) waiting.push_back({entry + static_cast<std::size_t>(jump), parent});
            goesOn = jump >= -1;
            if (jump > 0 || jump == -1) parent = path;
            ++entry;
        }
    }
    return {};
}

Status UsdcFile::readSpecs() {
    SectionReader in(file_, bytes_, sections_[Specs].begin, sections_[Specs].size);
    const auto count = in.count();
    if (!count) return tl::unexpected(count.error());
    const auto paths = in.integers(*count), sets = in.integers(*count), types = in.integers(*count);
    for (const auto* numbers : {&paths, &sets, &types}) {
        if (!*numbers) return tl::unexpected(numbers->error());
    }
    for (std::size_t i = 0; i < paths->size(); ++i) {
        if ((*paths)[i] >= paths_.size() || (*sets)[i] >= fieldSets_.size())
            return error(sections_[Specs].begin,
                         fmt::format("spec {} refers to something that does not exist", i));
        specs_.push_back({(*paths)[i], (*sets)[i], (*types)[i]});
    }
    return {};
}

std::vector<UsdcField> UsdcFile::fieldsOf(const UsdcSpec& spec) const {
    std::vector<UsdcField> fields;
    for (std::size_t i = spec.fieldSet;
         i < fieldSets_.size() && fieldSets_[i] != kEnd && fields.size() < kMaxFields; ++i) {
        if (fieldSets_[i] < fields_.size()) fields.push_back(fields_[fieldSets_[i]]);
    }
    return fields;
}

const std::string& UsdcFile::token(std::uint64_t index) const {
    static const std::string kNone;
    return index < tokens_.size() ? tokens_[index] : kNone;
}

const std::string& UsdcFile::string(std::uint64_t index) const {
    return token(index < strings_.size() ? strings_[index] : tokens_.size());
}

std::string UsdcFile::pathText(std::uint64_t index) const {
    constexpr std::size_t kMaxElements = 256;
    std::vector<const UsdcPath*> elements;
    while (index < paths_.size() && elements.size() < kMaxElements) {
        elements.push_back(&paths_[static_cast<std::size_t>(index)]);
        index = elements.back()->parent;
    }
    if (elements.empty()) return {};
    elements.pop_back();  // the root
    std::string text = elements.empty() ? "/" : "";
    for (auto element = elements.rbegin(); element != elements.rend(); ++element) {
        const std::string& name = token((*element)->token);
        const bool isVariant = name.starts_with('{');
        if ((*element)->isProperty)
            text += '.';
        else if (!isVariant && !text.ends_with('}'))
            text += '/';
        text += name;
    }
    return text;
}

}  // namespace hairloom
