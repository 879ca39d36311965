// SPDX-License-Identifier: GPL-3.0-or-later
// Strands of a PLY: lists of vertices in an element "strand", "line", "polyline" or "curve"; or else edges,
// which are chained; or the vertices after one another, cut by a count a strand, by a number of the strand at
// each vertex, or into equal strands. Other values of vertices come along by their names.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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
        return {};
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
            if (offsets_.back() != raw.positions.size())
                return failIn(file_, {}, fmt::format("its strands have {} points together", offsets_.back()),
                              fmt::format("there are {} vertices", raw.positions.size()));
            raw.offsets = std::move(offsets_);
        } else {
            auto runs = cutIntoStrands(file_, raw.positions, pointsPerStrand_);
            if (!runs)
                return failIn(file_, {}, "is a PLY without strands: it " + runs.error().problem,
                              runs.error().expected);
            noteRuns(*runs, raw);
        }
        takeColours(raw);
        adoptAttributes(raw);
        return raw;
    }

    /// Vertices that follow each other with the same number of a strand are one.
    void offsetsFromNumbers(RawStrands& raw) {
        constexpr std::array<std::string_view, 6> kNames{"strand_id", "strand_index", "strand",
                                                         "hair_id",   "curve_id",     "line_id"};
        const auto found = std::ranges::find_if(raw.attributes, [&](const RawAttribute& attribute) {
            return std::ranges::find(kNames, attribute.name) != kNames.end();
        });
        if (found == raw.attributes.end()) return;
        for (std::size_t i = 1; i < found->numbers.size(); ++i) {
            if (found->numbers[i] != found->numbers[i - 1]) offsets_.push_back(static_cast<std::uint32_t>(i));
        }
        offsets_.push_back(static_cast<std::uint32_t>(raw.positions.size()));
        columns_.erase(columns_.begin() + (found - raw.attributes.begin()));
        raw.attributes.erase(found);
    }

    Status addCount(double count) {
        if (!(count >= 0) || count != std::floor(count) || offsets_.back() + count > 4294967295.0)
            return rows_.wrong(fmt::format("a strand of {} points", count), "expected a count");
        offsets_.push_back(offsets_.back() + static_cast<std::uint32_t>(count));
        return {};
    }

    Status readElement(const PlyElement& element) {
        constexpr std::array<std::string_view, 5> kLists{"strand", "strands", "line", "polyline", "curve"};
        const bool isVertex = element.name == "vertex";
        const bool isList = std::ranges::find(kLists, element.name) != kLists.end();
        const bool isEdge = element.name == "edge";
        if (isVertex) {
            if (!lines_.vertices.empty() || !columns_.empty())
                return rows_.wrong("vertices are in two elements");
            if (auto status = findProperties(element); !status) return status;
            reserve(element);
        }
        const auto list = element.find({"vertex_indices", "vertex_index", "indices"});
        const auto from = element.find({"vertex1"}), to = element.find({"vertex2"});
        const auto length =
            list ? std::nullopt
                 : element.find({"count", "num_points", "point_count", "points", "num_vertices",
                                 "vertex_count", "vertices", "length", "size", "n"});
        const std::size_t countAt = length.value_or(0);
        const bool isCount = isList && length && !element.properties[countAt].listSize;
        hasFaces_ = hasFaces_ || (element.name == "face" && element.count > 0);
        if (isList && !isCount && (!list || !element.properties[*list].listSize))
            return rows_.wrong(fmt::format("'{}' has no vertex indices", element.name),
                               "expected 'property list TYPE TYPE vertex_indices', or a count of points");
        if (isEdge && (!from || !to)) return rows_.wrong("edges without vertex1 and vertex2");
        PlyRow row;
        for (std::uint64_t index = 0; index < element.count; ++index) {
            if (auto status = rows_.row(element, row); !status) return status;
            if (isVertex) addVertex(row);
            if (isCount) {
                if (auto status = addCount(row.values[countAt]); !status) return status;
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

    Status findProperties(const PlyElement& element) {
        position_ = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        if (!position_[0] || !position_[1] || !position_[2])
            return rows_.wrong("vertices without x, y and z");
        for (std::size_t index = 0; index < element.properties.size(); ++index) {
            const PlyProperty& property = element.properties[index];
            if (property.listSize || std::ranges::find(position_, std::optional(index)) != position_.end())
                continue;
            RawAttribute attribute;
            attribute.name =
                property.name == "thickness" || property.name == "diameter" ? "width" : property.name;
            attribute.perPoint = true;
            const bool known =
                std::ranges::find(attributes_, attribute.name, &RawAttribute::name) != attributes_.end();
            if (known) continue;
            attributes_.push_back(std::move(attribute));
            columns_.push_back(
                {index, property.name == "radius" ? 2.0 : 1.0, property.type == PlyType::Uint8});
            if (property.name == "radius") attributes_.back().name = "width";
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
    std::vector<std::uint32_t> offsets_{0};  ///< of strands by counts
    std::array<std::optional<std::size_t>, 3> position_;
    std::vector<Column> columns_;           ///< of `attributes_`
    std::vector<RawAttribute> attributes_;  ///< of vertices
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
