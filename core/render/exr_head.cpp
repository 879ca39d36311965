// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/exr_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace hairloom::render {
namespace {

constexpr std::uint32_t kMagic = 20000630, kVersion = 2;
constexpr std::uint32_t kTiled = 0x200, kLongNames = 0x400, kDeep = 0x800, kParts = 0x1000;
constexpr std::size_t kLongestName = 255;
constexpr std::size_t kMostAttributes = 1000;  ///< the library looks at 1024

enum Compression : std::uint8_t { None, Rle, Zips, Zip, Piz };

/// Lines of pixels of a block, of each compression.
constexpr std::array<std::uint32_t, 5> kLines{1, 1, 1, 16, 32};
/// Bytes that one packed byte can stand for: a run of 128 in two bytes, and deflate's best. Of Piz, whose
/// codes of no bits stand for runs, no bound is known.
constexpr std::array<std::uint64_t, 5> kBestRatio{1, 64, 1032, 1032,
                                                  std::numeric_limits<std::uint32_t>::max()};

template <class T>
T valueAt(std::span<const std::byte> bytes, std::uint64_t at) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

struct Attribute {
    std::string_view name, type;
    std::uint64_t at = 0;  ///< of its content
    std::uint32_t size = 0;
};

/// An attribute that each file has.
struct Required {
    std::string_view name, type;
    std::uint32_t size;  ///< 0: any
};
constexpr std::array<Required, 8> kRequired{{{"channels", "chlist", 0},
                                             {"compression", "compression", 1},
                                             {"dataWindow", "box2i", 16},
                                             {"displayWindow", "box2i", 16},
                                             {"lineOrder", "lineOrder", 1},
                                             {"pixelAspectRatio", "float", 4},
                                             {"screenWindowCenter", "v2f", 8},
                                             {"screenWindowWidth", "float", 4}}};

tl::unexpected<Error> wrongAt(const std::string& file, std::uint64_t at, std::string problem) {
    return failIn(file, Byte{at}, std::move(problem), "expected an OpenEXR of one part in lines of pixels");
}

class Head {
  public:
    Head(const std::string& file, std::span<const std::byte> bytes) : file_(file), bytes_(bytes) {}

    Result<ExrHead> read() {
        if (auto status = readAll(); !status) return tl::unexpected(status.error());
        return head_;
    }

  private:
    Status readAll() {
        if (bytes_.size() < 8 || valueAt<std::uint32_t>(bytes_, 0) != kMagic)
            return wrong(0, "is not an OpenEXR file");
        const auto version = valueAt<std::uint32_t>(bytes_, 4);
        if ((version & 0xffu) != kVersion) return wrong(4, fmt::format("is of version {}", version & 0xffu));
        if ((version & (kTiled | kDeep | kParts)) != 0) return wrong(4, "is tiled, deep or of several parts");
        if ((version & ~(0xffu | kLongNames)) != 0) return wrong(4, "has flags that OpenEXR does not know");
        if (auto status = readAttributes(); !status) return status;
        if (auto status = checkRequired(); !status) return status;
        head_.width = extent(0, 8);
        head_.height = extent(4, 12);
        head_.top = valueAt<std::int32_t>(bytes_, find("dataWindow")->at + 4);
        head_.compression = valueAt<std::uint8_t>(bytes_, find("compression")->at);
        return readChannels();
    }

    tl::unexpected<Error> wrong(std::uint64_t at, std::string problem) const {
        return wrongAt(file_, at, std::move(problem));
    }

    /// Characters up to a zero, which is taken, too; nothing where it is too long or has none.
    std::optional<std::string_view> takeName(std::uint64_t& at, std::uint64_t end) const {
        const auto* const begin = reinterpret_cast<const char*>(bytes_.data() + at);
        const std::size_t most =
            static_cast<std::size_t>(std::min<std::uint64_t>(end - at, kLongestName + 1));
        const std::string_view name(begin, std::min(most, std::string_view(begin, most).find('\0')));
        if (name.size() == most) return std::nullopt;
        at += name.size() + 1;
        return name;
    }

    Status readAttributes() {
        std::uint64_t at = 8;
        for (;;) {
            const std::uint64_t begin = at;
            const auto name = takeName(at, bytes_.size());
            if (!name) return wrong(begin, "has no end of its head");
            if (name->empty()) break;
            const auto type = takeName(at, bytes_.size());
            if (!type || type->empty() || bytes_.size() - at < sizeof(std::uint32_t))
                return wrong(begin, "has an attribute without type or size");
            const auto size = valueAt<std::uint32_t>(bytes_, at);
            at += sizeof size;
            if (size > bytes_.size() - at) return wrong(begin, "has an attribute that goes beyond its end");
            if (find(*name)) return wrong(begin, "has an attribute twice");
            if (attributes_.size() == kMostAttributes)
                return wrong(begin, fmt::format("has more than {} attributes", kMostAttributes));
            attributes_.push_back({*name, *type, at, size});
            at += size;
        }
        head_.end = at;
        return {};
    }

    std::string_view contentOf(const Attribute& attribute) const {
        return {reinterpret_cast<const char*>(bytes_.data() + attribute.at), attribute.size};
    }

    const Attribute* find(std::string_view name) const {
        const auto found = std::ranges::find(attributes_, name, &Attribute::name);
        return found == attributes_.end() ? nullptr : &*found;
    }

    Status checkRequired() const {
        for (const Required& required : kRequired) {
            const Attribute* const found = find(required.name);
            if (!found) return wrong(head_.end, fmt::format("has no attribute {}", required.name));
            if (found->type != required.type || (required.size != 0 && found->size != required.size))
                return wrong(found->at, fmt::format("has another {} than each file has", required.name));
        }
        if (const Attribute* const type = find("type"); type && contentOf(*type) != "scanlineimage")
            return wrong(type->at, "says that it is no image in lines of pixels");
        const std::uint64_t compression = find("compression")->at, order = find("lineOrder")->at;
        if (valueAt<std::uint8_t>(bytes_, compression) >= kLines.size())
            return wrong(compression, "is packed in a way that is not read (none, RLE, ZIP and PIZ are)");
        if (valueAt<std::uint8_t>(bytes_, order) > 1)
            return wrong(order, "has lines in an order that is none");
        return {};
    }

    Status readChannels() {
        const Attribute& list = *find("channels");
        std::uint64_t at = list.at;
        const std::uint64_t end = list.at + list.size;
        std::set<std::string_view> names;
        for (;;) {
            const std::uint64_t begin = at;
            if (at == end) return wrong(at, "has a list of channels without an end");
            const auto name = takeName(at, end);
            if (!name) return wrong(begin, "has a channel without a name");
            if (name->empty()) break;
            if (end - at < 16) return wrong(begin, "has a channel that goes beyond its list");
            const auto type = valueAt<std::uint32_t>(bytes_, at);
            if (type > 2) return wrong(at, "has a channel of a type that is none");
            if (valueAt<std::int32_t>(bytes_, at + 8) != 1 || valueAt<std::int32_t>(bytes_, at + 12) != 1)
                return wrong(at + 8, "has a channel with fewer values than pixels");
            if (!names.insert(*name).second) return wrong(begin, "has a channel twice");
            head_.bytesPerLine += head_.width * (type == 1 ? 2 : 4);
            at += 16;
        }
        if (at != end || names.empty()) return wrong(at, "has a list of channels that is none");
        head_.channels = static_cast<std::uint32_t>(names.size());
        return {};
    }

    /// Of the data's window, from two of its numbers.
    std::uint64_t extent(std::uint64_t low, std::uint64_t high) const {
        const std::uint64_t window = find("dataWindow")->at;
        const std::int64_t pixels = std::int64_t{valueAt<std::int32_t>(bytes_, window + high)} -
                                    std::int64_t{valueAt<std::int32_t>(bytes_, window + low)} + 1;
        return pixels > 0 ? static_cast<std::uint64_t>(pixels) : 0;
    }

    const std::string& file_;
    std::span<const std::byte> bytes_;
    std::vector<Attribute> attributes_;
    ExrHead head_;
};

/// That its parts lie in the block: which values there are, two numbers and a bit for each from one to
/// the other; then the length of the codes, with a head of their own, to the end of the block.
bool isPiz(std::span<const std::byte> block) {
    constexpr std::size_t kRange = 4, kLength = 4, kCodesHead = 20;
    if (block.size() < kRange + kLength + kCodesHead) return false;
    const std::size_t first = valueAt<std::uint16_t>(block, 0), last = valueAt<std::uint16_t>(block, 2);
    const std::size_t bits = first <= last ? last - first + 1 : 0;
    if (bits > block.size() - kRange - kLength - kCodesHead) return false;
    const std::size_t length = valueAt<std::uint32_t>(block, kRange + bits);
    return length >= kCodesHead && length <= block.size() - kRange - bits - kLength;
}

}  // namespace

Result<ExrHead> readExrHead(const std::string& file, std::span<const std::byte> content) {
    return Head(file, content).read();
}

Status checkExrBlocks(const std::string& file, std::span<const std::byte> content, const ExrHead& head) {
    const auto wrong = [&](std::uint64_t at, std::string problem) {
        return wrongAt(file, at, std::move(problem));
    };
    const std::uint8_t compression = head.compression;
    const std::uint64_t lines = kLines.at(compression);
    const std::uint64_t blocks = (head.height + lines - 1) / lines;
    if (blocks > (content.size() - head.end) / sizeof(std::uint64_t))
        return wrong(content.size(), "ends within the table of its lines of pixels");
    std::vector<std::uint64_t> places(static_cast<std::size_t>(blocks));
    std::memcpy(places.data(), content.data() + head.end, places.size() * sizeof(std::uint64_t));
    std::vector<std::uint64_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::uint64_t i) { return places[static_cast<std::size_t>(i)]; });
    std::uint64_t at = head.end + blocks * sizeof(std::uint64_t);
    for (const std::uint64_t block : order) {
        if (places[static_cast<std::size_t>(block)] != at)
            return wrong(head.end + block * sizeof(std::uint64_t),
                         at < content.size() ? "is damaged: lines of pixels are not where the table says"
                                             : "ends within its pixels");
        if (content.size() - at < 8) return wrong(content.size(), "ends within its pixels");
        if (valueAt<std::int32_t>(content, at) != head.top + static_cast<std::int64_t>(block * lines))
            return wrong(at, "is damaged: other lines of pixels than the table says");
        const std::uint64_t packed = valueAt<std::uint32_t>(content, at + 4);
        if (packed > content.size() - at - 8)
            return wrong(at, "is damaged: lines of pixels do not end where the next begin");
        const std::uint64_t raw = head.bytesPerLine * std::min(lines, head.height - block * lines);
        if (packed > raw || raw > packed * kBestRatio.at(compression) ||
            (compression == None && packed != raw))
            return wrong(at, fmt::format("is damaged: {} bytes hold {} of pixels", packed, raw));
        if (compression == Piz && packed < raw && !isPiz(content.subspan(at + 8, packed)))
            return wrong(at, "is damaged: its wavelets are cut");
        at += 8 + packed;
    }
    if (at == content.size()) return {};
    return wrong(at, "is damaged: it continues after its lines of pixels");
}

}  // namespace hairloom::render
