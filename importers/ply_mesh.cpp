// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/ply_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "importers/obj_text.h"

namespace hairloom {
namespace {

/// Hands out the body's numbers one after another, whatever the encoding.
class Numbers {
  public:
    Numbers(std::string file, std::span<const std::byte> bytes, const PlyHeader& header)
        : file_(std::move(file)),
          text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
          position_(header.bodyOffset),
          line_(header.lines + 1),
          encoding_(header.encoding) {}

    std::uint64_t remaining() const { return text_.size() - position_; }

    Result<double> next(PlyType type) {
        return encoding_ == PlyEncoding::Text ? nextWord() : nextBinary(type);
    }

    tl::unexpected<Error> wrong(std::string problem, std::string expected = {}) const {
        const Place place = encoding_ == PlyEncoding::Text ? Place(Line{line_}) : Place(Byte{position_});
        return failIn(file_, place, std::move(problem), std::move(expected));
    }

  private:
    Result<double> nextWord() {
        while (position_ < text_.size() && isBlank(text_[position_])) line_ += text_[position_++] == '\n';
        const std::size_t begin = position_;
        while (position_ < text_.size() && !isBlank(text_[position_])) ++position_;
        const std::string_view word = text_.substr(begin, position_ - begin);
        if (word.empty()) return wrong("the file ends early");
        const auto number = parseNumber(word);
        if (!number) return wrong(fmt::format("'{}' is no number", shortened(word)));
        return *number;
    }

    static bool isBlank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

    Result<double> nextBinary(PlyType type) {
        const std::size_t size = sizeOf(type);
        if (remaining() < size) return wrong("the file ends early");
        std::array<char, 8> bytes{};
        std::memcpy(bytes.data(), text_.data() + position_, size);
        if (encoding_ == PlyEncoding::BigEndian) std::reverse(bytes.begin(), bytes.begin() + size);
        position_ += size;
        switch (type) {
            case PlyType::Int8:
                return as<std::int8_t>(bytes);
            case PlyType::Uint8:
                return as<std::uint8_t>(bytes);
            case PlyType::Int16:
                return as<std::int16_t>(bytes);
            case PlyType::Uint16:
                return as<std::uint16_t>(bytes);
            case PlyType::Int32:
                return as<std::int32_t>(bytes);
            case PlyType::Uint32:
                return as<std::uint32_t>(bytes);
            case PlyType::Float32:
                return as<float>(bytes);
            case PlyType::Float64:
                return as<double>(bytes);
        }
        return wrong("a value of no known type");
    }

    template <class T>
    static double as(const std::array<char, 8>& bytes) {
        T value;
        std::memcpy(&value, bytes.data(), sizeof value);
        return static_cast<double>(value);
    }

    std::string file_;
    std::string_view text_;
    std::size_t position_;
    std::uint64_t line_;
    PlyEncoding encoding_;
};

/// The properties of one row. Single values are at their property's index; lists are kept where they are
/// wanted.
struct Row {
    std::vector<double> values;
    std::vector<std::vector<double>> lists;
};

class PlyReader {
  public:
    PlyReader(const std::string& file, std::span<const std::byte> bytes, const PlyHeader& header)
        : numbers_(file, bytes, header), header_(header) {}

    Result<RawScene> read() {
        for (const PlyElement& element : header_.elements) {
            if (auto status = readElement(element); !status) return tl::unexpected(status.error());
        }
        finish();
        return std::move(scene_);
    }

  private:
    Status readElement(const PlyElement& element) {
        if (element.properties.empty()) return {};
        if (element.count > numbers_.remaining()) {
            return numbers_.wrong(fmt::format("{} rows of '{}' are promised", element.count, element.name),
                                  fmt::format("only {} bytes are left", numbers_.remaining()));
        }
        const bool isVertex = element.name == "vertex", isFace = element.name == "face";
        if (isVertex) {
            if (auto status = findVertexProperties(element); !status) return status;
        }
        if (isFace) {
            if (auto status = findFaceProperties(element); !status) return status;
        }
        Row row{std::vector<double>(element.properties.size()),
                std::vector<std::vector<double>>(element.properties.size())};
        for (std::uint64_t index = 0; index < element.count; ++index) {
            if (auto status = readRow(element, row); !status) return status;
            if (isVertex) addVertex(row);
            if (!isFace) continue;
            if (auto status = addFace(row); !status) return status;
        }
        return {};
    }

    Status readRow(const PlyElement& element, Row& row) {
        for (std::size_t index = 0; index < element.properties.size(); ++index) {
            const PlyProperty& property = element.properties[index];
            if (!property.listSize) {
                const auto value = numbers_.next(property.type);
                if (!value) return tl::unexpected(value.error());
                row.values[index] = *value;
                continue;
            }
            const auto count = numbers_.next(*property.listSize);
            if (!count) return tl::unexpected(count.error());
            if (!(*count >= 0) || *count > static_cast<double>(numbers_.remaining())) {
                return numbers_.wrong(fmt::format("a list of {} values", *count),
                                      fmt::format("only {} bytes are left", numbers_.remaining()));
            }
            row.lists[index].clear();
            for (double entry = 0; entry < *count; ++entry) {
                const auto value = numbers_.next(property.type);
                if (!value) return tl::unexpected(value.error());
                row.lists[index].push_back(*value);
            }
        }
        return {};
    }

    Status findVertexProperties(const PlyElement& element) {
        position_ = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        normal_ = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
        uv_ = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
        if (!position_[0] || !position_[1] || !position_[2])
            return numbers_.wrong("vertices without x, y and z");
        hasNormals_ = normal_[0] && normal_[1] && normal_[2];
        hasUvs_ = uv_[0] && uv_[1];
        return {};
    }

    Status findFaceProperties(const PlyElement& element) {
        indices_ = element.find({"vertex_indices", "vertex_index"});
        if (!indices_ || !element.properties[*indices_].listSize) {
            return numbers_.wrong("faces without vertex indices",
                                  "expected 'property list TYPE TYPE vertex_indices'");
        }
        wedgeUvs_ = element.find({"texcoord"});
        if (wedgeUvs_ && !element.properties[*wedgeUvs_].listSize) wedgeUvs_.reset();
        return {};
    }

    void addVertex(const Row& row) {
        const auto at = [&](const std::optional<std::size_t>& index) {
            return static_cast<float>(row.values[*index]);
        };
        scene_.soup.positions.emplace_back(at(position_[0]), at(position_[1]), at(position_[2]));
        if (hasNormals_) normals_.emplace_back(at(normal_[0]), at(normal_[1]), at(normal_[2]));
        if (hasUvs_) uvs_.emplace_back(at(uv_[0]), at(uv_[1]));
    }

    Status addFace(const Row& row) {
        PolygonSoup& soup = scene_.soup;
        const std::vector<double>& indices = row.lists[*indices_];
        if (indices.size() < 3) {
            ++tooFewCorners_;
            return {};
        }
        for (const double index : indices) {
            if (!(index >= 0) || index > 4294967294.0 || index != std::floor(index)) {
                return numbers_.wrong(fmt::format("a face names vertex {}", index),
                                      "expected an index from 0");
            }
            soup.corners.push_back(static_cast<std::uint32_t>(index));
        }
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        if (!wedgeUvs_) return {};
        const std::vector<double>& uvs = row.lists[*wedgeUvs_];
        for (std::size_t corner = 0; corner < indices.size(); ++corner) {
            const bool given = uvs.size() == 2 * indices.size();
            cornerUvs_.push_back(
                given ? Vec2f(static_cast<float>(uvs[2 * corner]), static_cast<float>(uvs[2 * corner + 1]))
                      : Vec2f::Zero());
        }
        return {};
    }

    void finish() {
        PolygonSoup& soup = scene_.soup;
        soup.groupNames = {"default"};
        soup.faceGroups.assign(soup.offsets.size() - 1, 0);
        if (tooFewCorners_ != 0) {
            scene_.warnings.push_back(
                fmt::format("{} faces with fewer than three corners are left out", tooFewCorners_));
        }
        const auto exists = [&](std::uint32_t corner) { return corner < soup.positions.size(); };
        if (!std::ranges::all_of(soup.corners, exists)) return;
        if (cornerUvs_.size() == soup.corners.size()) {
            soup.uvs = std::move(cornerUvs_);
        } else if (uvs_.size() == soup.positions.size()) {
            for (const std::uint32_t corner : soup.corners) soup.uvs.push_back(uvs_[corner]);
        }
        for (Vec2f& uv : soup.uvs) {
            if (!uv.allFinite()) uv.setZero();
        }
        const auto usable = [](const Vec3f& normal) {
            return normal.allFinite() && normal.squaredNorm() > 0;
        };
        if (normals_.size() != soup.positions.size() || !std::ranges::all_of(normals_, usable)) return;
        for (const std::uint32_t corner : soup.corners) soup.normals.push_back(normals_[corner].normalized());
    }

    Numbers numbers_;
    const PlyHeader& header_;
    RawScene scene_;
    std::array<std::optional<std::size_t>, 3> position_, normal_;
    std::array<std::optional<std::size_t>, 2> uv_;
    std::optional<std::size_t> indices_, wedgeUvs_;
    bool hasNormals_ = false, hasUvs_ = false;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> uvs_, cornerUvs_;
    std::size_t tooFewCorners_ = 0;
};

}  // namespace

Result<RawScene> readPlyMesh(const std::string& file, std::span<const std::byte> bytes) {
    const auto header = readPlyHeader(file, bytes);
    if (!header) return tl::unexpected(header.error());
    return PlyReader(file, bytes, *header).read();
}

}  // namespace hairloom
