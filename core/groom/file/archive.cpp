// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <tuple>

#include "core/base/checksum.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {
namespace {

constexpr std::array<char, 8> kMagic = {'H', 'A', 'I', 'R', 'L', 'O', 'O', 'M'};

struct Preamble {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kArchiveVersion;
    std::uint32_t reserved = 0;
    std::uint64_t headBytes = 0;
    std::uint64_t headChecksum = 0;
};
static_assert(sizeof(Preamble) == 32);

constexpr std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + kArchiveAlignment - 1) / kArchiveAlignment * kArchiveAlignment;
}

std::size_t elementSize(const AttributeData& data) {
    return std::visit([](const auto& array) { return sizeof(array[0]); }, data);
}

bool isUtf8(const std::string& text) {
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::exception&) {
        return false;
    }
}

bool allZero(std::span<const std::byte> bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte == std::byte{0}; });
}

constexpr const char* kNewerProgram = "expected a newer Hairloom to read it";
constexpr const char* kWholeFile = "expected a whole file: save it again, or restore a copy";

std::string newerVersion(std::string_view what, std::uint64_t found, std::uint32_t newest) {
    return fmt::format("{} is version {}, but this program reads versions up to {}", what, found, newest);
}

}  // namespace

void ArchiveWriter::add(std::string name, const AttributeData& data) {
    std::visit([&](const auto& array) { add(std::move(name), array.view()); }, data);
}

Result<std::vector<std::byte>> ArchiveWriter::finish(const nlohmann::ordered_json& head) const {
    std::vector<std::uint64_t> checksums(arrays_.size());
    parallelFor(arrays_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) checksums[i] = hashBytes(arrays_[i].bytes);
    });
    nlohmann::ordered_json json;
    json["kind"] = kind_;
    json["version"] = version_;
    for (const auto& item : head.items()) json[item.key()] = item.value();
    auto& table = json["arrays"] = nlohmann::ordered_json::object();
    std::uint64_t offset = 0;
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
        const Array& array = arrays_[i];
        if (!isUtf8(array.name))
            return fail(fmt::format("the name of array {} is not UTF-8", i), "expected UTF-8");
        table[array.name] = {{"type", array.type},
                             {"count", array.count},
                             {"offset", offset},
                             {"checksum", fmt::format("{:016x}", checksums[i])}};
        offset = aligned(offset + array.bytes.size());
    }
    const std::string text =
        json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    if (text.size() > kMaxJsonBytes) {
        return fail(fmt::format("the JSON head would take {} bytes", text.size()),
                    fmt::format("expected at most {}: fewer or shorter names", kMaxJsonBytes));
    }
    const auto headBytes = std::as_bytes(std::span(text));
    Preamble preamble;
    preamble.headBytes = headBytes.size();
    preamble.headChecksum = hashBytes(headBytes);

    const std::uint64_t dataStart = aligned(sizeof(Preamble) + headBytes.size());
    std::vector<std::byte> file;
    file.reserve(dataStart + offset);
    const auto append = [&](std::span<const std::byte> bytes) {
        file.insert(file.end(), bytes.begin(), bytes.end());
    };
    append(std::as_bytes(std::span(&preamble, 1)));
    append(headBytes);
    file.resize(aligned(file.size()));
    for (const Array& array : arrays_) {
        append(array.bytes);
        file.resize(aligned(file.size()));
    }
    return file;
}

Result<ArchiveReader> ArchiveReader::open(std::string file, std::vector<std::byte> bytes,
                                          std::string_view kind, std::uint32_t newestVersion) {
    ArchiveReader reader;
    reader.file_ = std::move(file);
    reader.bytes_ = std::move(bytes);
    Status status = reader.readPreamble();
    if (status) status = reader.readHead(kind, newestVersion);
    if (status) status = reader.readTable();
    if (status) status = reader.checkLayout();
    if (status) status = reader.checkContent();
    if (!status) return tl::unexpected(status.error());
    return reader;
}

bool startsAsArchive(std::span<const std::byte> bytes) {
    return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

Status ArchiveReader::readPreamble() {
    ByteReader reader(file_, bytes_);
    const auto preamble = reader.read<Preamble>("a Hairloom file's preamble");
    if (!startsAsArchive(bytes_))
        return failIn(file_, Byte{0}, "is not a Hairloom file", "expected it to begin with HAIRLOOM");
    if (!preamble) return tl::unexpected(preamble.error());
    if (preamble->version > kArchiveVersion || preamble->version == 0) {
        return failIn(file_, Byte{8}, newerVersion("container", preamble->version, kArchiveVersion),
                      kNewerProgram);
    }
    if (preamble->reserved != 0) return failIn(file_, Byte{12}, "preamble is damaged", "expected zeros");
    if (preamble->headBytes > reader.remaining() || preamble->headBytes > kMaxJsonBytes) {
        return failIn(
            file_, Byte{16}, fmt::format("head of {} bytes", preamble->headBytes),
            fmt::format("the file has {} bytes and a head at most {}", bytes_.size(), kMaxJsonBytes));
    }
    headBytes_ = preamble->headBytes;
    const auto head = std::span(bytes_).subspan(sizeof(Preamble), headBytes_);
    if (!isChecksum(hashBytes(head), preamble->headChecksum)) {
        return failIn(file_, Byte{sizeof(Preamble)}, "JSON head is damaged: it does not match its checksum",
                      kWholeFile);
    }
    return {};
}

Status ArchiveReader::readHead(std::string_view kind, std::uint32_t newestVersion) {
    std::string text(headBytes_, '\0');
    std::memcpy(text.data(), bytes_.data() + sizeof(Preamble), headBytes_);
    auto head = parseJson(file_, text, sizeof(Preamble));
    if (!head) return tl::unexpected(head.error());
    head_ = std::move(*head);
    JsonReader reader(head_, file_);
    const std::string found = reader.string("kind");
    if (reader.ok() && found != kind) {
        reader.complain("kind", fmt::format("is '{}'", found), fmt::format("expected '{}'", kind));
    }
    const auto version = reader.count("version", 1, std::numeric_limits<std::uint32_t>::max());
    if (auto status = reader.status(); !status) return status;
    if (version > newestVersion)
        return failIn(file_, {}, newerVersion(kind, version, newestVersion), kNewerProgram);
    version_ = static_cast<std::uint32_t>(version);
    return {};
}

Status ArchiveReader::readTable() {
    JsonReader reader(head_, file_);
    JsonReader table = reader.object("arrays");
    const std::uint64_t dataStart = aligned(sizeof(Preamble) + headBytes_);
    for (const std::string& name : table.keys()) {
        JsonReader entry = table.object(name);
        Array array;
        array.type = entry.string("type");
        const auto type = emptyOfType(array.type);
        if (!type) entry.complain("type", type.error().problem, type.error().expected);
        const std::uint64_t size = type ? elementSize(*type) : 1;
        array.count = entry.count("count", 0, bytes_.size() / size);
        array.bytes = array.count * size;
        array.offset = dataStart + entry.count("offset", 0, bytes_.size());
        const std::string checksum = entry.string("checksum");
        const char* end = checksum.data() + checksum.size();
        const auto parsed = std::from_chars(checksum.data(), end, array.checksum, 16);
        if (checksum.size() != 16 || parsed.ec != std::errc() || parsed.ptr != end) {
            entry.complain("checksum", "is malformed", "expected 16 hexadecimal digits");
        }
        entry.finish();
        if (!reader.ok()) return reader.status();
        arrays_.emplace(name, std::move(array));
    }
    return reader.status();
}

Status ArchiveReader::checkLayout() const {
    std::vector<const std::pair<const std::string, Array>*> order;
    for (const auto& item : arrays_) order.push_back(&item);
    std::sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
        return std::tie(a->second.offset, a->second.bytes) < std::tie(b->second.offset, b->second.bytes);
    });
    std::uint64_t end = sizeof(Preamble) + headBytes_;
    const auto skipPadding = [&]() -> Status {
        const std::uint64_t start = end;
        end = aligned(end);
        if (end > bytes_.size()) {
            return failIn(file_, Byte{bytes_.size()}, "file ends early",
                          fmt::format("expected {} bytes", end));
        }
        if (!allZero(std::span(bytes_).subspan(start, end - start))) {
            return failIn(file_, Byte{start}, "padding is damaged", "expected zeros");
        }
        return {};
    };
    for (const auto* item : order) {
        if (auto status = skipPadding(); !status) return status;
        const auto& [name, array] = *item;
        if (array.offset != end) {
            return failIn(file_, Byte{end}, fmt::format("array '{}' starts at byte {}", name, array.offset),
                          fmt::format("expected byte {}, where the array before it ends", end));
        }
        if (array.bytes > bytes_.size() - end) {
            return failIn(file_, Byte{bytes_.size()}, fmt::format("file ends within array '{}'", name),
                          fmt::format("expected {} more bytes", array.bytes - (bytes_.size() - end)));
        }
        end += array.bytes;
    }
    if (auto status = skipPadding(); !status) return status;
    if (end != bytes_.size()) {
        return failIn(file_, Byte{end}, fmt::format("{} bytes follow the last array", bytes_.size() - end),
                      "expected the end of the file");
    }
    return {};
}

Status ArchiveReader::checkContent() const {
    std::vector<const std::pair<const std::string, Array>*> order;
    for (const auto& item : arrays_) order.push_back(&item);
    std::vector<std::uint8_t> damaged(order.size(), 0);
    parallelFor(order.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Array& array = order[i]->second;
            damaged[i] =
                !isChecksum(hashBytes(std::span(bytes_).subspan(array.offset, array.bytes)), array.checksum);
        }
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (damaged[i])
            return tl::unexpected(errorAt(order[i]->first, "is damaged: it does not match its checksum"));
    }
    return {};
}

std::vector<std::string> ArchiveReader::names() const {
    std::vector<std::string> names;
    for (const auto& [name, array] : arrays_) names.push_back(name);
    return names;
}

Result<const ArchiveReader::Array*> ArchiveReader::find(std::string_view name, std::string_view type) const {
    const auto found = arrays_.find(name);
    if (found == arrays_.end())
        return failIn(file_, {}, fmt::format("array '{}' is missing", name), kWholeFile);
    if (found->second.type != type) {
        return tl::unexpected(errorAt(name, fmt::format("is of type {}", found->second.type),
                                      fmt::format("expected {}", type)));
    }
    return &found->second;
}

Result<AttributeData> ArchiveReader::readAny(std::string_view name) const {
    const auto found = arrays_.find(name);
    if (found == arrays_.end())
        return failIn(file_, {}, fmt::format("array '{}' is missing", name), kWholeFile);
    auto data = emptyOfType(found->second.type);
    if (!data) return data;
    std::visit(
        [&]<class T>(CowArray<T>& array) {
            if (found->second.count > 0) array = CowArray<T>(copy<T>(found->second));
        },
        *data);
    return data;
}

Error ArchiveReader::errorAt(std::string_view name, std::string problem, std::string expected) const {
    const auto found = arrays_.find(name);
    const Place place = found == arrays_.end() ? Place{} : Place{Byte{found->second.offset}};
    return {file_, place, fmt::format("array '{}' {}", name, problem), std::move(expected)};
}

}  // namespace hairloom
