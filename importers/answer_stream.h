// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hairloom-mesh-reader writes to the pipe and its parent reads: values, texts and arrays, one after the
// other. Both come from one build, so there is no version to negotiate; the parent treats the bytes as
// hostile all the same.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom {

/// Values that are their bytes.
template <class T>
inline constexpr bool kIsPlainValue =
    (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) ||
    std::is_same_v<T, std::array<std::uint32_t, 4>> || std::is_same_v<T, std::array<float, 4>> ||
    std::is_same_v<T, std::array<std::uint32_t, 8>> || std::is_same_v<T, std::array<float, 8>> ||
    std::is_same_v<T, Vec2f> || std::is_same_v<T, Vec3f> || std::is_same_v<T, Quatf>;
static_assert(sizeof(Vec2f) == 2 * sizeof(float) && sizeof(Vec3f) == 3 * sizeof(float) &&
              sizeof(Quatf) == 4 * sizeof(float));

// The two visitors have the same members, so that one list of a content's parts serves both.
class AnswerWriter {
  public:
    using Sink = std::function<void(std::span<const std::byte>)>;
    explicit AnswerWriter(Sink sink) : sink_(std::move(sink)) {}

    template <class T>
    requires(kIsPlainValue<T>) void operator()(const T& value) { put(&value, sizeof value); }
    void operator()(const bool& value) { (*this)(static_cast<std::uint8_t>(value ? 1 : 0)); }
    void operator()(const std::string& text) {
        count(text.size());
        put(text.data(), text.size());
    }
    void operator()(const Eigen::Affine3f& matrix) {
        const Eigen::Matrix<float, 3, 4> rows = matrix.matrix().topRows<3>();
        put(rows.data(), sizeof(float) * static_cast<std::size_t>(rows.size()));
    }
    template <class T>
    requires(kIsPlainValue<T>) void operator()(const std::vector<T>& values) {
        count(values.size());
        put(values.data(), values.size() * sizeof(T));
    }
    template <class T, class Members>
    void each(const std::vector<T>& values, Members&& members) {
        count(values.size());
        for (const T& value : values) members(value);
    }
    template <class T, class Members>
    void maybe(const std::optional<T>& value, Members&& members) {
        (*this)(value.has_value());
        if (value) members(*value);
    }
    /// Of an enumeration that ends with `last`.
    template <class E>
    void choice(const E& value, E) {
        (*this)(static_cast<std::uint8_t>(value));
    }

  private:
    void count(std::size_t size) { (*this)(std::uint64_t{size}); }
    /// An empty list may have no memory, which std::fwrite must not be given.
    void put(const void* data, std::size_t size) {
        if (size > 0) sink_({static_cast<const std::byte*>(data), size});
    }

    Sink sink_;
};

/// After the first thing that does not fit everything is empty.
class AnswerReader {
  public:
    explicit AnswerReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    bool ok() const { return ok_; }
    std::size_t remaining() const { return bytes_.size(); }

    template <class T>
    requires(kIsPlainValue<T>) void operator()(T& value) { take(&value, sizeof value); }
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        (*this)(byte);
        ok_ = ok_ && byte <= 1;
        value = byte == 1;
    }
    void operator()(std::string& text) {
        text.resize(count(1));
        take(text.data(), text.size());
    }
    void operator()(Eigen::Affine3f& matrix) {
        Eigen::Matrix<float, 3, 4> rows = Eigen::Matrix<float, 3, 4>::Zero();
        take(rows.data(), sizeof(float) * static_cast<std::size_t>(rows.size()));
        matrix = Eigen::Affine3f::Identity();
        matrix.matrix().topRows<3>() = rows;
    }
    template <class T>
    requires(kIsPlainValue<T>) void operator()(std::vector<T>& values) {
        values.resize(count(sizeof(T)));
        take(values.data(), values.size() * sizeof(T));
    }
    template <class T, class Members>
    void each(std::vector<T>& values, Members&& members) {
        values.clear();
        const std::uint64_t size = count(1);
        for (std::uint64_t index = 0; index < size && ok_; ++index) members(values.emplace_back());
    }
    template <class T, class Members>
    void maybe(std::optional<T>& value, Members&& members) {
        bool has = false;
        (*this)(has);
        value.reset();
        if (has) members(value.emplace());
    }
    template <class E>
    void choice(E& value, E last) {
        std::uint8_t number = 0;
        (*this)(number);
        ok_ = ok_ && number <= static_cast<std::uint8_t>(last);
        value = ok_ ? static_cast<E>(number) : last;
    }

  private:
    /// Of elements of so many bytes at least, which are all there.
    std::size_t count(std::size_t bytesEach) {
        std::uint64_t size = 0;
        (*this)(size);
        ok_ = ok_ && size <= bytes_.size() / bytesEach;
        return ok_ ? static_cast<std::size_t>(size) : 0;
    }
    void take(void* target, std::size_t size) {
        ok_ = ok_ && size <= bytes_.size();
        if (!ok_ || size == 0) return;
        std::memcpy(target, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }

    std::span<const std::byte> bytes_;
    bool ok_ = true;
};

/// What an answer holds.
enum class AnswerKind : std::uint64_t {
    Error = 0x31524f5252454c48ull,    // "HLERROR1"
    Scene = 0x31454e4543534c48ull,    // "HLSCENE1"
    Strands = 0x31444e5254534c48ull,  // "HLSTRND1"
    Picture = 0x31544349504c4848ull,  // "HHLPICT1"
    // Of hairloom-mesh-writer: what it is asked for, and its answer.
    CardScene = 0x3144524143434c48ull,  // "HLCCARD1"
    MeshFiles = 0x31454c4946434c48ull,  // "HLCFILE1"
};
inline constexpr std::uint64_t kAnswerEnd = 0x31444e45454c4c48ull;  // "HLLEEND1"

void writeError(AnswerWriter& writer, const Error& error);
Error readError(AnswerReader& reader);
/// Of an answer that is none.
Error invalidAnswer(const std::string& file, std::size_t bytes);

/// The length of what follows, the kind, the layers of confinement that were lacking (empty: none), the
/// content or the error, an end. `members` visits a content's parts with either visitor.
template <class Content, class Members>
void writeAnswer(const Result<Content>& content, AnswerKind kind, const std::string& lacking,
                 const AnswerWriter::Sink& sink, const Members& members) {
    const auto writeAll = [&](AnswerWriter& writer) {
        writer(static_cast<std::uint64_t>(content ? kind : AnswerKind::Error));
        writer(lacking);
        if (content)
            members(writer, *content);
        else
            writeError(writer, content.error());
        writer(kAnswerEnd);
    };
    std::uint64_t bytes = 0;
    AnswerWriter counting([&](std::span<const std::byte> piece) { bytes += piece.size(); });
    writeAll(counting);
    AnswerWriter writer(sink);
    writer(bytes);
    writeAll(writer);
}

/// What writeAnswer() wrote. Errors: the error that was written, or that the bytes are none of its kind.
template <class Content, class Members>
Result<Content> readAnswer(const std::string& file, std::span<const std::byte> bytes, AnswerKind kind,
                           std::string& lacking, const Members& members) {
    AnswerReader reader(bytes);
    std::uint64_t length = 0, found = 0, end = 0;
    reader(length);
    reader(found);
    reader(lacking);
    Content content;
    Error error;
    if (found == static_cast<std::uint64_t>(kind))
        members(reader, content);
    else if (found == static_cast<std::uint64_t>(AnswerKind::Error))
        error = readError(reader);
    else
        return tl::unexpected(invalidAnswer(file, bytes.size()));
    reader(end);
    if (!reader.ok() || end != kAnswerEnd || reader.remaining() != 0 ||
        length + sizeof length != bytes.size())
        return tl::unexpected(invalidAnswer(file, bytes.size()));
    if (found == static_cast<std::uint64_t>(AnswerKind::Error)) return tl::unexpected(inFile(error, file));
    return content;
}

}  // namespace hairloom
