// SPDX-License-Identifier: GPL-3.0-or-later
// Strands of a PLY: lists of vertices in an element "strand", "line", "polyline", "curve"; or else edges,
// which are chained; or the vertices after one another, cut by a count a strand, by a number of the strand at
// each vertex, or into equal strands. Other values of vertices come along by their names.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "importers/curve_set.h"
#include "importers/ply_rows.h"
#include "importers/points_per_strand.h"

namespace hairloom {
namespace {

bool isPly(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "ply", 3) == 0 &&
           (bytes[3] == std::byte{'\n'} || bytes[3] == std::byte{'\r'});
}

class Reader {
  public:
    Reader(const std::string& file, std::span<const std::byte> bytes, const PlyHeader& header,
           std::uint32_t pointsPerStrand)
        : file_(file), rows_(file, bytes, header), header_(header), pointsPerStrand_(pointsPerStrand) {}

    /// All that is needed of the file's bytes.
    Status readAll() {
        for (const PlyElement& element : header_.elements) {
            if (element.properties.empty()) continue;
            if (auto status = rows_.checkCount(element); !status) return status;
            if (auto status = readElement(element); !status) return status;
        }
        return chooseCounts();
    }

    Result<RawStrands> strands() {
        if (lines_.lineOffsets.size() < 2) return strandsOfRuns();
        const auto count = lines_.vertices.size();
        if (std::ranges::any_of(lines_.lineIndices, [&](std::uint32_t index) { return index >= count; }))
            return failIn(file_, {}, "a strand refers to a vertex that does not exist",
                          fmt::format("there are {}", count));
        std::vector<std::uint32_t> vertices;
        auto raw = strandsFromLines(file_, lines_, vertices);
        if (!raw) return raw;
        raw->format = "PLY strands";
        raw->rootFirst = !hasEdges_;
        lines_ = {};
        for (RawAttribute& attribute : attributes_) {
            std::vector<float> ofPoints;
            ofPoints.reserve(vertices.size());
            for (const std::uint32_t vertex : vertices) ofPoints.push_back(attribute.numbers[vertex]);
            attribute.numbers = std::move(ofPoints);
            raw->attributes.push_back(std::move(attribute));
        }
        takeColours(*raw);
        takeValuesOfStrands(*raw);
        adoptAttributes(*raw);
        return raw;
    }

  private:
    /// The vertices are the points of strand after strand.
    Result<RawStrands> strandsOfRuns() {
        if (hasFaces_ && offsets_.size() < 2)
            return failIn(file_, {}, "is a PLY without strands: it has faces",
                          "expected an element of strands or edges, or points alone");
        RawStrands raw;
        raw.format = "PLY strands";
        raw.rootFirst = false;
        raw.positions = std::move(lines_.vertices);
        raw.attributes = std::move(attributes_);
        if (offsets_.size() < 2) offsetsFromNumbers(raw);
        if (offsets_.size() >= 2) {
            raw.offsets = std::move(offsets_);
        } else {
            auto runs = cutIntoStrands(file_, raw.positions, pointsPerStrand_);
            if (!runs)
                return failIn(file_, {}, "is a PLY without strands: it " + runs.error().problem,
                              runs.error().expected);
            noteRuns(*runs, raw);
        }
        takeColours(raw);
        takeValuesOfStrands(raw);
        adoptAttributes(raw);
        return raw;
    }

    /// "strand_id", "StrandIndex", "curves".
    static bool namesAStrand(std::string_view name) {
        std::string plain;
        for (const char c : name) {
            if (c != '_' && c != '-') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
        for (const std::string_view end : {"index", "number", "idx", "id", "s"}) {
            if (!plain.ends_with(end)) continue;
            plain.resize(plain.size() - end.size());
            break;
        }
        constexpr std::array<std::string_view, 8> kNames{"strand", "hair",  "hairstrand", "curve",
                                                         "line",   "fiber", "fibre",      "polyline"};
        return std::ranges::find(kNames, plain) != kNames.end();
    }

    /// Vertices with the same number of a strand are one, in their order; strands in that of their first
    /// ones.
    void offsetsFromNumbers(RawStrands& raw) {
        const auto found = std::ranges::find_if(
            raw.attributes, [](const RawAttribute& attribute) { return namesAStrand(attribute.name); });
        if (found == raw.attributes.end()) return;
        // A float holds whole numbers up to 2^24: above, strands would become one.
        if (std::ranges::any_of(found->numbers, [](float n) { return !(std::abs(n) < 16'777'216.0f); }))
            return;
        const std::vector<float> numbers = std::move(found->numbers);
        columns_.erase(columns_.begin() + (found - raw.attributes.begin()));
        raw.attributes.erase(found);
        std::unordered_map<float, std::uint32_t> strands;
        std::vector<std::uint32_t> strandOf(numbers.size()), counts;
        std::size_t runs = 0;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            if (i == 0 || numbers[i] != numbers[i - 1]) ++runs;
            const auto next = static_cast<std::uint32_t>(strands.size());
            strandOf[i] = strands.try_emplace(numbers[i], next).first->second;
            if (strandOf[i] == counts.size()) counts.push_back(0);
            ++counts[strandOf[i]];
        }
        for (const std::uint32_t count : counts) offsets_.push_back(offsets_.back() + count);
        if (runs != counts.size()) gather(strandOf, raw);
    }

    /// Brings the points of each strand together.
    static void gather(const std::vector<std::uint32_t>& strandOf, RawStrands& raw) {
        std::vector<std::uint32_t> order(strandOf.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, {}, [&](std::uint32_t point) { return strandOf[point]; });
        const auto apply = [&]<class T>(std::vector<T>& values) {
            std::vector<T> sorted;
            sorted.reserve(values.size());
            for (const std::uint32_t point : order) sorted.push_back(values[point]);
            values = std::move(sorted);
        };
        apply(raw.positions);
        for (RawAttribute& attribute : raw.attributes) apply(attribute.numbers);
        raw.warnings.push_back(fileNote(
            "the points of a strand did not stand together, and were gathered by its number", "points"));
    }

    /// Of single values of strands those that may be their numbers of points: which, the sum decides.
    struct Counts {
        std::size_t property = 0;
        bool isNamed = false, isPossible = true;
        std::vector<std::uint32_t> offsets{0};

        void add(double count) {
            isPossible = isPossible && count >= 0 && count == std::floor(count) &&
                         offsets.back() + count <= 4294967295.0;
            if (isPossible) offsets.push_back(offsets.back() + static_cast<std::uint32_t>(count));
        }
    };

    void findCounts(const PlyElement& element) {
        constexpr std::array<std::string_view, 12> kNames{
            "count",      "num_points",   "n_points", "point_count", "points", "num_vertices",
            "n_vertices", "vertex_count", "vertices", "length",      "size",   "n"};
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            if (element.properties[i].listSize) continue;
            counts_.push_back({i, std::ranges::find(kNames, element.properties[i].name) != kNames.end()});
        }
        std::stable_partition(counts_.begin(), counts_.end(), std::mem_fn(&Counts::isNamed));
    }

    void findValuesOfStrands(const PlyElement& element) {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const std::string name = nameOf(element.properties[i]);
            const bool isKnown =
                std::ranges::any_of(ofStrands_, [&](const auto& known) { return known.second.name == name; });
            if (element.properties[i].listSize || isKnown) continue;
            RawAttribute attribute;
            attribute.name = name;
            ofStrands_.emplace_back(i, std::move(attribute));
        }
    }

    /// What the file says of whole strands.
    void takeValuesOfStrands(RawStrands& raw) {
        for (auto& [property, attribute] : ofStrands_) {
            const bool isOfAll =
                attribute.numbers.size() + 1 == raw.offsets.size() && raw.sourceIndices.empty();
            if (isOfAll)
                raw.attributes.push_back(std::move(attribute));
            else
                raw.warnings.push_back(
                    fileNote(attribute.name + " has other numbers of values than there are strands",
                             "strands", "it was left out"));
        }
    }

    Status chooseCounts() {
        if (counts_.empty()) return {};
        const auto fits = std::ranges::find_if(counts_, [&](const Counts& counts) {
            return counts.isPossible && counts.offsets.back() == lines_.vertices.size();
        });
        if (fits != counts_.end()) {
            offsets_ = std::move(fits->offsets);
            std::erase_if(ofStrands_, [&](const auto& column) { return column.first == fits->property; });
            return {};
        }
        const auto named = std::ranges::find_if(counts_, &Counts::isNamed);
        if (named == counts_.end() || !named->isPossible) return {};
        return failIn(file_, {}, fmt::format("its strands have {} points together", named->offsets.back()),
                      fmt::format("there are {} vertices", lines_.vertices.size()));
    }

    Status readElement(const PlyElement& element) {
        const bool isVertex = element.name == "vertex";
        const bool isStrands = namesAStrand(element.name);
        const bool isEdge = element.name == "edge";
        if (isVertex) {
            if (!lines_.vertices.empty() || !columns_.empty())
                return rows_.wrong("vertices are in two elements");
            if (auto status = findProperties(element); !status) return status;
            reserve(element);
        }
        const auto list = element.find({"vertex_indices", "vertex_index", "indices"});
        const auto from = element.find({"vertex1"}), to = element.find({"vertex2"});
        const bool isList = isStrands && list && element.properties[*list].listSize;
        const bool isFirst = isStrands && !std::exchange(hasStrands_, true);
        if (isStrands && !isList && !isFirst) return rows_.wrong("strands are in two elements");
        if (isFirst && !isList) findCounts(element);
        if (isFirst) findValuesOfStrands(element);
        hasFaces_ = hasFaces_ || (element.name == "face" && element.count > 0);
        if (isEdge && (!from || !to)) return rows_.wrong("edges without vertex1 and vertex2");
        PlyRow row;
        for (std::uint64_t index = 0; index < element.count; ++index) {
            if (auto status = rows_.row(element, row); !status) return status;
            if (isVertex) addVertex(row);
            if (isFirst) {
                for (auto& [property, attribute] : ofStrands_)
                    attribute.numbers.push_back(static_cast<float>(
                        (element.properties[property].name == "radius" ? 2 : 1) * row.values[property]));
            }
            if (isStrands && !isList) {
                for (Counts& counts : counts_) counts.add(row.values[counts.property]);
            } else if (isList) {
                if (auto status = addLine(row.lists[*list]); !status) return status;
            } else if (isEdge) {
                hasEdges_ = true;
                if (auto status = addLine(std::array{row.values[*from], row.values[*to]}); !status)
                    return status;
            }
        }
        return {};
    }

    static std::string nameOf(const PlyProperty& property) {
        for (const char* const width : {"thickness", "diameter", "radius"}) {
            if (property.name == width) return "width";
        }
        return property.name;
    }

    Status findProperties(const PlyElement& element) {
        position_ = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        if (!position_[0] || !position_[1] || !position_[2])
            return rows_.wrong("vertices without x, y and z");
        for (std::size_t index = 0; index < element.properties.size(); ++index) {
            const PlyProperty& property = element.properties[index];
            if (property.listSize || std::ranges::find(position_, std::optional(index)) != position_.end())
                continue;
            RawAttribute attribute;
            attribute.name = nameOf(property);
            attribute.perPoint = true;
            const bool known =
                std::ranges::find(attributes_, attribute.name, &RawAttribute::name) != attributes_.end();
            if (known) continue;
            attributes_.push_back(std::move(attribute));
            columns_.push_back(
                {index, property.name == "radius" ? 2.0 : 1.0, property.type == PlyType::Uint8});
        }
        return {};
    }

    /// Never more than the file can hold, whatever it promises: a value takes a byte or more.
    void reserve(const PlyElement& element) {
        const auto rows = static_cast<std::size_t>(
            std::min<std::uint64_t>(element.count, rows_.remaining() / element.properties.size()));
        lines_.vertices.reserve(rows);
        for (RawAttribute& attribute : attributes_) attribute.numbers.reserve(rows);
    }

    void addVertex(const PlyRow& row) {
        const auto at = [&](std::size_t axis) { return static_cast<float>(row.values[*position_[axis]]); };
        lines_.vertices.emplace_back(at(0), at(1), at(2));
        for (std::size_t k = 0; k < columns_.size(); ++k)
            attributes_[k].numbers.push_back(
                static_cast<float>(columns_[k].factor * row.values[columns_[k].index]));
    }

    template <class Indices>
    Status addLine(const Indices& indices) {
        for (const double index : indices) {
            if (!(index >= 0) || index > 4294967294.0 || index != std::floor(index))
                return rows_.wrong(fmt::format("a strand refers to vertex {}", index),
                                   "expected an index from 0");
            lines_.lineIndices.push_back(static_cast<std::uint32_t>(index));
        }
        lines_.lineOffsets.push_back(static_cast<std::uint32_t>(lines_.lineIndices.size()));
        return {};
    }

    /// Red, green and blue, bytes or 0 … 1, are the points' colour.
    void takeColours(RawStrands& raw) const {
        std::array<std::size_t, 3> channels{};
        constexpr std::array<std::string_view, 3> kNames{"red", "green", "blue"};
        for (std::size_t c = 0; c < 3; ++c) {
            const auto found = std::ranges::find(raw.attributes, kNames[c], &RawAttribute::name);
            if (found == raw.attributes.end()) return;
            channels[c] = static_cast<std::size_t>(found - raw.attributes.begin());
        }
        const float scale = columns_[channels[0]].isByte ? 1 / 255.0f : 1.0f;
        for (std::size_t point = 0; point < raw.positions.size(); ++point)
            raw.colours.emplace_back(scale * Vec3f(raw.attributes[channels[0]].numbers[point],
                                                   raw.attributes[channels[1]].numbers[point],
                                                   raw.attributes[channels[2]].numbers[point]));
        std::erase_if(raw.attributes, [&](const RawAttribute& attribute) {
            return std::ranges::find(kNames, attribute.name) != kNames.end();
        });
    }

    struct Column {
        std::size_t index;
        double factor;
        bool isByte;
    };

    const std::string& file_;
    PlyRows rows_;
    const PlyHeader& header_;
    std::uint32_t pointsPerStrand_;
    ObjStrandText lines_;
    std::vector<Counts> counts_;
    std::vector<std::uint32_t> offsets_{0};  ///< of strands by counts or numbers
    std::array<std::optional<std::size_t>, 3> position_;
    std::vector<Column> columns_;                                  ///< of `attributes_`
    std::vector<RawAttribute> attributes_;                         ///< of vertices
    std::vector<std::pair<std::size_t, RawAttribute>> ofStrands_;  ///< by their properties
    bool hasStrands_ = false;
    bool hasEdges_ = false;
    bool hasFaces_ = false;
};

Result<RawStrands> readPly(const std::string& file, std::vector<std::byte>&& bytes,
                           const StrandImportOptions& options) {
    const auto header = readPlyHeader(file, bytes);
    if (!header) return tl::unexpected(header.error());
    Reader reader(file, bytes, *header, options.pointsPerStrand);
    if (auto status = reader.readAll(); !status) return tl::unexpected(status.error());
    std::vector<std::byte>().swap(bytes);
    return reader.strands();
}

}  // namespace

StrandReader plyReader() {
    return {{"PLY strands", {"ply"}}, Recognition::Guess, isPly, readPly};
}

}  // namespace hairloom
