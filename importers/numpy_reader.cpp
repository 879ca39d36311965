// SPDX-License-Identifier: GPL-3.0-or-later
// Strands as arrays of NumPy, in .npz or alone in .npy: strands × points × coordinates, or points with
// counts, offsets or numbers of strands beside them. Names decide only where shapes do not.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

#include "importers/curve_set.h"
#include "importers/numpy_array.h"
#include "importers/points_per_strand.h"
#include "importers/zip_file.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30u;
constexpr std::uint64_t kMostPoints = std::numeric_limits<std::uint32_t>::max();

/// An archive whose first file is an array, or an array.
bool isNumpy(std::span<const std::byte> bytes) {
    if (looksLikeNumpy(bytes)) return true;
    if (!looksLikeZip(bytes) || bytes.size() < 64) return false;
    constexpr std::size_t kLocalHeader = 30;
    const std::size_t name =
        std::to_integer<std::size_t>(bytes[26]) + 256 * std::to_integer<std::size_t>(bytes[27]);
    if (kLocalHeader + name > bytes.size() || name < 4) return false;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + kLocalHeader, name);
    return text.ends_with(".npy");
}

/// Whether the name says that an array holds what strands are made of.
bool isNamedSo(std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    constexpr std::array<std::string_view, 8> kWords{"strand", "point", "pos",  "vert",
                                                     "curve",  "hair",  "line", "xyz"};
    return std::ranges::any_of(kWords, [&](std::string_view word) { return name.find(word) != name.npos; });
}

/// A strand's points lie between two offsets; those that are kept, where some were padding.
struct Runs {
    std::vector<std::uint32_t> offsets{0};
    std::vector<std::uint32_t> kept;  ///< of the array's points; empty: all
};

class Reader {
  public:
    Reader(const std::string& file, std::vector<NumpyArray> arrays, std::uint32_t pointsPerStrand)
        : file_(file), arrays_(std::move(arrays)), pointsPerStrand_(pointsPerStrand) {}

    Result<RawStrands> strands() {
        const auto chosen = positions();
        if (!chosen) return tl::unexpected(chosen.error());
        const NumpyArray& from = **chosen;
        width_ = static_cast<std::size_t>(from.shape.back());
        points_ = static_cast<std::size_t>(from.count() / width_);
        if (points_ > kMostPoints)
            return failIn(file_, {}, fmt::format("{} has {} points", from.words(), points_),
                          "expected at most 4,294,967,295");
        const std::vector<float> numbers = from.numbers();
        raw_.format = "NumPy strands";
        raw_.rootFirst = false;
        raw_.positions.reserve(points_);
        for (std::size_t i = 0; i < points_; ++i)
            raw_.positions.emplace_back(numbers[i * width_], numbers[i * width_ + 1],
                                        numbers[i * width_ + 2]);
        auto runs = from.shape.size() >= 3 ? equalRuns(from) : listedRuns(from);
        if (!runs) return tl::unexpected(runs.error());
        if (!runs->kept.empty()) keep(*runs);
        raw_.offsets = std::move(runs->offsets);
        takeAttributes(from, *runs);
        adoptAttributes(raw_);
        return std::move(raw_);
    }

  private:
    std::string allWords() const {
        std::string words;
        for (const NumpyArray& array : arrays_) words += (words.empty() ? "" : ", ") + array.words();
        return words.empty() ? "no array" : words;
    }

    Result<const NumpyArray*> positions() const {
        for (const bool isCube : {true, false}) {
            std::vector<const NumpyArray*> found;
            for (const std::uint64_t last : {3, 4, 6, 7}) {
                for (const NumpyArray& array : arrays_) {
                    const std::size_t sides = array.shape.size();
                    const bool fits = isCube ? sides >= 3 && array.shape[sides - 2] >= 2 : sides == 2;
                    if (fits && array.shape.back() == last && array.count() > 0 && !array.isWhole())
                        found.push_back(&array);
                }
                if (!found.empty()) break;
            }
            if (found.size() > 1)
                std::erase_if(found, [](const auto* array) { return !isNamedSo(array->name); });
            if (found.size() == 1) return found.front();
            if (found.size() > 1)
                return failIn(file_, {}, "has more than one array that may be its strands: " + allWords(),
                              "expected one of strands × points × 3, or of points × 3 with counts");
        }
        return failIn(file_, {}, "holds " + allWords(),
                      "expected an array of strands × points × 3, or of points × 3 with counts");
    }

    /// Points that are no numbers at the end of a strand are padding.
    Result<Runs> equalRuns(const NumpyArray& from) const {
        const auto size = static_cast<std::size_t>(from.shape[from.shape.size() - 2]);
        Runs runs;
        bool hasPadding = false;
        for (std::size_t begin = 0; begin < points_; begin += size) {
            std::size_t end = begin + size;
            while (end > begin && !raw_.positions[end - 1].allFinite()) --end;
            hasPadding = hasPadding || end < begin + size;
            for (std::size_t i = begin; i < end; ++i) runs.kept.push_back(static_cast<std::uint32_t>(i));
            runs.offsets.push_back(static_cast<std::uint32_t>(runs.kept.size()));
        }
        if (!hasPadding) runs.kept.clear();
        return runs;
    }

    Result<Runs> listedRuns(const NumpyArray& from) {
        Runs runs;
        for (const NumpyArray& array : arrays_) {
            if (&array == &from || !array.isWhole() || array.shape.size() > 2 ||
                (array.shape.size() == 2 && array.shape.back() != 1) || array.count() == 0)
                continue;
            const std::vector<std::int64_t> values = array.whole();
            if (auto offsets = offsetsFrom(values)) {
                runs.offsets = std::move(*offsets);
                lengths_ = &array;
                return runs;
            }
        }
        auto equal = cutIntoStrands(file_, raw_.positions, pointsPerStrand_);
        if (!equal)
            return failIn(file_, {}, fmt::format("{}: {}", allWords(), equal.error().problem),
                          equal.error().expected + "; or an array of counts or offsets");
        noteRuns(*equal, raw_);
        runs.offsets = std::move(raw_.offsets);
        return runs;
    }

    /// Of values that are counts, offsets, first points or, for each point, the number of its strand.
    std::optional<std::vector<std::uint32_t>> offsetsFrom(std::span<const std::int64_t> values) const {
        const auto points = static_cast<std::int64_t>(points_);
        if (std::ranges::any_of(values, [&](std::int64_t v) { return v < 0 || v > points; }))
            return std::nullopt;
        std::vector<std::uint32_t> offsets{0};
        if (std::ranges::is_sorted(values) && values.front() == 0 && values.size() > 1 &&
            values.size() < points_) {
            for (const std::int64_t v : values.subspan(1)) offsets.push_back(static_cast<std::uint32_t>(v));
            if (values.back() != points) offsets.push_back(static_cast<std::uint32_t>(points));
            return offsets;
        }
        std::int64_t sum = 0;
        for (const std::int64_t v : values) {
            sum += v;
            if (sum > points) break;
            offsets.push_back(static_cast<std::uint32_t>(sum));
        }
        if (sum == points) return offsets;
        if (values.size() != points_ || !std::ranges::is_sorted(values)) return std::nullopt;
        offsets.resize(1);
        for (std::size_t i = 1; i < values.size(); ++i) {
            if (values[i] != values[i - 1]) offsets.push_back(static_cast<std::uint32_t>(i));
        }
        offsets.push_back(static_cast<std::uint32_t>(points_));
        return offsets;
    }

    void keep(const Runs& runs) {
        for (std::size_t i = 0; i < runs.kept.size(); ++i) raw_.positions[i] = raw_.positions[runs.kept[i]];
        raw_.positions.resize(runs.kept.size());
    }

    /// Arrays with as many values as there are strands or points.
    void takeAttributes(const NumpyArray& positions, const Runs& runs) {
        const std::size_t strands = raw_.offsets.size() - 1;
        std::string leftOut;
        for (const NumpyArray& array : arrays_) {
            if (&array == &positions || &array == lengths_ || array.count() == 0) continue;
            std::uint64_t components = 1;
            for (const bool perPoint : {true, false}) {
                const std::uint64_t elements = perPoint ? points_ : strands;
                components = array.count() % elements == 0 ? array.count() / elements : 0;
                if (components < 1 || components > 4) continue;
                const bool isSide = components == 1 || array.shape.back() == components;
                if (!isSide) continue;
                add(array, perPoint, static_cast<std::uint32_t>(components), runs);
                components = 0;
                break;
            }
            if (components != 0) leftOut += (leftOut.empty() ? "" : ", ") + array.words();
        }
        if (!leftOut.empty())
            raw_.warnings.push_back(
                fileNote(fmt::format("arrays that fit neither strands nor points were left out: {}", leftOut),
                         "arrays"));
    }

    void add(const NumpyArray& array, bool perPoint, std::uint32_t components, const Runs& runs) {
        RawAttribute attribute;
        attribute.name = array.name;
        attribute.perPoint = perPoint;
        attribute.components = components;
        const std::vector<float> numbers = array.numbers();
        const bool isRadius = attribute.name == "radius" || attribute.name == "radii";
        const bool isWidth = isRadius || attribute.name == "thickness" || attribute.name == "widths";
        if (components == 1 && isWidth) attribute.name = "width";
        if (components == 3 && (attribute.name == "colors" || attribute.name == "colours"))
            attribute.name = "displayColor";
        const auto value = [&](std::size_t at) { return (isRadius ? 2.0f : 1.0f) * numbers[at]; };
        const bool isPart = perPoint && !runs.kept.empty();
        const std::size_t elements = isPart ? runs.kept.size() : numbers.size() / components;
        for (std::size_t i = 0; i < elements; ++i) {
            for (std::size_t c = 0; c < components; ++c)
                attribute.numbers.push_back(value((isPart ? runs.kept[i] : i) * components + c));
        }
        const bool isKnown =
            std::ranges::find(raw_.attributes, attribute.name, &RawAttribute::name) != raw_.attributes.end();
        if (!isKnown) raw_.attributes.push_back(std::move(attribute));
    }

    const std::string& file_;
    std::vector<NumpyArray> arrays_;
    std::uint32_t pointsPerStrand_;
    const NumpyArray* lengths_ = nullptr;
    std::size_t width_ = 3, points_ = 0;
    RawStrands raw_;
};

Result<RawStrands> readArrays(const std::string& file, std::vector<std::byte>&& bytes,
                              const StrandImportOptions& options) {
    std::vector<NumpyArray> arrays;
    std::vector<std::vector<std::byte>> unpacked;
    const auto take = [&](const std::string& name, std::span<const std::byte> from) -> Status {
        auto array = readNumpy(file, name, from);
        if (!array) return tl::unexpected(array.error());
        arrays.push_back(std::move(*array));
        return {};
    };
    if (looksLikeNumpy(bytes)) {
        if (auto status = take("array", bytes); !status) return tl::unexpected(status.error());
        return Reader(file, std::move(arrays), options.pointsPerStrand).strands();
    }
    const auto zip = ZipFile::open(file, bytes);
    if (!zip) return tl::unexpected(zip.error());
    std::uint64_t room = kMostBytes;
    std::optional<Error> first;
    for (const ZipEntry& entry : zip->entries()) {
        if (!entry.name.ends_with(".npy")) continue;
        auto data = zip->read(entry, room);
        if (!data) return tl::unexpected(data.error());
        room -= data->size();
        unpacked.push_back(std::move(*data));
        const Status taken = take(entry.name.substr(0, entry.name.size() - 4), unpacked.back());
        // Words and objects may stand beside the arrays that count.
        if (!taken && !first) first = taken.error();
    }
    if (arrays.empty() && first) return tl::unexpected(*first);
    auto raw = Reader(file, std::move(arrays), options.pointsPerStrand).strands();
    if (!raw && first) return tl::unexpected(*first);
    if (raw && first) raw->warnings.push_back(fileNote(first->problem, "arrays", "it was left out"));
    return raw;
}

}  // namespace

StrandReader numpyReader() {
    return {{"NumPy .npz, .npy", {"npz", "npy"}}, Recognition::Structure, isNumpy, readArrays};
}

}  // namespace hairloom
