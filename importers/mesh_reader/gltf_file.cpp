// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "importers/mesh_reader/gltf_meshopt.h"
#include "importers/mesh_reader/limited_folder.h"
#include "importers/mesh_reader/tinygltf.h"

namespace hairloom {
namespace {

/// Elements of an accessor that has no bytes in the file but its sparse ones.
constexpr std::uint64_t kMaxZeros = std::uint64_t{1} << 26u;

constexpr std::size_t kBinaryHeader = 12, kChunkHeader = 8;
constexpr const char* kDraco = "KHR_draco_mesh_compression";

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool isBinary(std::span<const std::byte> bytes) {
    return textOf(bytes).starts_with("glTF");
}

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    if (offset + sizeof word <= bytes.size()) std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

/// The JSON of a file; none of it where a binary file's first chunk goes beyond its end.
std::string_view jsonOf(std::span<const std::byte> bytes) {
    if (!isBinary(bytes)) return textOf(bytes);
    const std::uint64_t length = wordAt(bytes, kBinaryHeader);
    const std::size_t begin = kBinaryHeader + kChunkHeader;
    if (begin + length > bytes.size()) return {};
    return textOf(bytes).substr(begin, length);
}

/// Takes the indices of primitives away that draco compressed, whose accessors have no bytes: tinygltf
/// without draco refuses them, and with draco it trusts what a file says of it. Returns whether there are
/// any.
bool dropCompressedIndices(nlohmann::json& gltf) {
    if (!gltf.is_object() || !gltf.contains("meshes") || !gltf["meshes"].is_array()) return false;
    bool isDropped = false;
    for (auto& mesh : gltf["meshes"]) {
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
        for (auto& primitive : mesh["primitives"]) {
            if (!primitive.is_object() || !primitive.contains("extensions")) continue;
            if (primitive["extensions"].is_object() && primitive["extensions"].contains(kDraco))
                isDropped = primitive.erase("indices") > 0 || isDropped;
        }
    }
    return isDropped;
}

/// The file with another head.
std::vector<std::byte> withJson(std::span<const std::byte> bytes, std::size_t textBytes,
                                const nlohmann::json& gltf) {
    std::string changed = gltf.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    ByteWriter out;
    if (isBinary(bytes)) {
        changed.resize((changed.size() + 3) / 4 * 4, ' ');
        const auto rest = bytes.subspan(kBinaryHeader + kChunkHeader + textBytes);
        out.writeArray(bytes.first(8));
        out.write(static_cast<std::uint32_t>(kBinaryHeader + kChunkHeader + changed.size() + rest.size()));
        out.write(static_cast<std::uint32_t>(changed.size()));
        out.writeArray(bytes.subspan(kBinaryHeader + 4, 4));
        out.writeArray(std::span<const char>(changed));
        out.writeArray(rest);
    } else {
        out.writeArray(std::span<const char>(changed));
    }
    return {out.bytes().begin(), out.bytes().end()};
}

tinygltf::FsCallbacks limitedCallbacks(LimitedFolder& folder) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string& path, void* user) {
        return static_cast<LimitedFolder*>(user)->allows(path);
    };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error,
                                 const std::string& path, void* user) {
        auto read = static_cast<LimitedFolder*>(user)->read(path);
        if (!read) {
            *error = read.error().problem;
            return false;
        }
        const auto* const begin = reinterpret_cast<const unsigned char*>(read->data());
        bytes->assign(begin, begin + read->size());
        return true;
    };
    callbacks.user_data = &folder;
    return callbacks;
}

bool skipImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
               void*) {
    return true;
}

/// Extensions that change how a mesh is read and are read, and those that are about looks alone.
bool isKnownExtension(std::string_view name) {
#ifdef HAIRLOOM_HAS_DRACO
    if (name == kDraco) return true;
#endif
    if (name == "KHR_mesh_quantization" || name == kMeshopt) return true;
    constexpr std::array<std::string_view, 7> kLooks{"KHR_materials_",   "KHR_texture_", "EXT_texture_",
                                                     "MSFT_texture_dds", "KHR_lights_",  "KHR_xmp",
                                                     "EXT_lights_"};
    return std::ranges::any_of(kLooks, [&](std::string_view look) { return name.starts_with(look); });
}

Status checkExtensions(const nlohmann::json& gltf) {
    if (!gltf.is_object() || !gltf.contains("extensionsRequired") || !gltf["extensionsRequired"].is_array())
        return {};
    for (const auto& name : gltf["extensionsRequired"]) {
        if (name.is_string() && !isKnownExtension(name.get<std::string>()))
            return fail(
                fmt::format("requires the extension {}, which is not supported", name.get<std::string>()),
                "expected a file exported without it");
    }
    return {};
}

/// What tinygltf can load; empty where that is the file itself. Errors: an extension that is required and not
/// known.
Result<std::vector<std::byte>> loadable(std::span<const std::byte> bytes) {
    const std::string_view text = jsonOf(bytes);
    const auto has = [&](std::string_view word) { return text.find(word) != text.npos; };
    if (!has("extensionsRequired") && !has(kDraco) && !has(kMeshopt)) return std::vector<std::byte>();
    auto gltf = nlohmann::json::parse(text, nullptr, false);
    if (auto status = checkExtensions(gltf); !status) return tl::unexpected(status.error());
    const bool isDropped = has(kDraco) && dropCompressedIndices(gltf);
    const bool isFilled = has(kMeshopt) && fillFallbackBuffers(gltf);
    return isDropped || isFilled ? withJson(bytes, text.size(), gltf) : std::vector<std::byte>();
}

/// tinygltf's first line without what it ends in.
std::string firstLine(std::string text) {
    text = text.substr(0, text.find('\n'));
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
    return text.empty() ? "cannot be read, without a reason from the reader" : text;
}

std::uint32_t sizeOfComponent(int type) {
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    return size > 0 ? static_cast<std::uint32_t>(size) : 0;
}

template <class From>
From valueAt(const unsigned char* at) {
    From value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <class From, class T>
T converted(const unsigned char* at, bool isNormalised) {
    const From value = valueAt<From>(at);
    if constexpr (std::is_same_v<T, float> && std::is_integral_v<From>) {
        if (isNormalised)
            return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<From>::max()),
                            -1.0f);
    }
    return static_cast<T>(value);
}

template <class T>
T component(const unsigned char* at, int type, bool isNormalised) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return converted<std::int8_t, T>(at, isNormalised);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return converted<std::uint8_t, T>(at, isNormalised);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return converted<std::int16_t, T>(at, isNormalised);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return converted<std::uint16_t, T>(at, isNormalised);
        case TINYGLTF_COMPONENT_TYPE_INT:
            return converted<std::int32_t, T>(at, isNormalised);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return converted<std::uint32_t, T>(at, isNormalised);
        default:
            break;
    }
    if constexpr (std::is_same_v<T, float>) {
        if (type == TINYGLTF_COMPONENT_TYPE_FLOAT) return valueAt<float>(at);
        if (type == TINYGLTF_COMPONENT_TYPE_DOUBLE) return static_cast<float>(valueAt<double>(at));
    }
    return T{};
}

/// Bytes of a view from an offset on, `count` elements of `size` bytes every `stride` bytes.
struct Strided {
    const unsigned char* first = nullptr;
    std::size_t stride = 0;
};
Result<Strided> strided(const tinygltf::Model& model, int view, std::uint64_t offset, std::uint64_t count,
                        std::uint64_t size, std::uint64_t stride, const char* what) {
    if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size())
        return fail(fmt::format("{}: there is no buffer view {}", what, view));
    const tinygltf::BufferView& bytes = model.bufferViews[static_cast<std::size_t>(view)];
    if (bytes.buffer < 0 || static_cast<std::size_t>(bytes.buffer) >= model.buffers.size())
        return fail(fmt::format("{}: there is no buffer {}", what, bytes.buffer));
    const auto& data = model.buffers[static_cast<std::size_t>(bytes.buffer)].data;
    const std::uint64_t begin = bytes.byteOffset;
    if (begin > data.size() || bytes.byteLength > data.size() - begin || offset > bytes.byteLength)
        return fail(fmt::format("{}: the buffer view goes beyond its buffer", what));
    const std::uint64_t room = bytes.byteLength - offset;
    if (stride == 0) stride = bytes.byteStride != 0 ? bytes.byteStride : size;
    if (count > 0 && (size > room || (count - 1) > (room - size) / stride))
        return fail(fmt::format("{}: {} elements do not fit their {} bytes", what, count, room),
                    "expected as many as there are");
    return Strided{data.data() + begin + offset, static_cast<std::size_t>(stride)};
}

}  // namespace

bool isFirstGltf(std::span<const std::byte> bytes) {
    if (isBinary(bytes)) return wordAt(bytes, 4) == 1;
    const auto json = nlohmann::json::parse(jsonOf(bytes), nullptr, false);
    if (!json.is_object() || !json.contains("asset")) return false;
    const auto& asset = json["asset"];
    if (!asset.is_object() || !asset.contains("version")) return false;
    const auto& version = asset["version"];
    return version.is_string() && version.get<std::string>().starts_with("1.");
}

GltfFile::GltfFile(std::unique_ptr<tinygltf::Model> model) : model_(std::move(model)) {}
GltfFile::GltfFile(GltfFile&&) noexcept = default;
GltfFile::~GltfFile() = default;

Result<GltfFile> GltfFile::load(const char* file, std::span<const std::byte> bytes) {
    const auto changed = loadable(bytes);
    if (!changed) return tl::unexpected(changed.error());
    if (!changed->empty()) bytes = *changed;
    LimitedFolder folder(file);
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(limitedCallbacks(folder));
    loader.SetImageLoader(skipImage, nullptr);
    auto model = std::make_unique<tinygltf::Model>();
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const bool loaded =
        isBinary(bytes) ? loader.LoadBinaryFromMemory(model.get(), &error, &warning,
                                                      reinterpret_cast<const unsigned char*>(bytes.data()),
                                                      size, folder.path(), tinygltf::REQUIRE_VERSION)
                        : loader.LoadASCIIFromString(model.get(), &error, &warning,
                                                     reinterpret_cast<const char*>(bytes.data()), size,
                                                     folder.path(), tinygltf::REQUIRE_VERSION);
    // What the folder refused is the reason behind what tinygltf did not find.
    if (!loaded && !folder.refused().empty())
        return fail(fmt::format("refers to {}", folder.refused()),
                    "expected files in its own folder or below it");
    if (!loaded) return fail(firstLine(error.empty() ? warning : error));
    if (auto status = unpackMeshopt(*model); !status) return tl::unexpected(status.error());
    return GltfFile(std::move(model));
}

std::uint32_t GltfFile::componentsOf(int accessor) const {
    if (accessor < 0 || static_cast<std::size_t>(accessor) >= model_->accessors.size()) return 0;
    const int type = model_->accessors[static_cast<std::size_t>(accessor)].type;
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
    return components > 0 ? static_cast<std::uint32_t>(components) : 0;
}

template <class T>
Result<std::vector<T>> GltfFile::elements(int accessor, std::uint32_t components, const char* what) const {
    if (componentsOf(accessor) != components)
        return fail(fmt::format("{}: accessor {} has {} numbers in an element", what, accessor,
                                componentsOf(accessor)),
                    fmt::format("expected {}", components));
    const tinygltf::Accessor& source = model_->accessors[static_cast<std::size_t>(accessor)];
    const std::uint64_t componentSize = sizeOfComponent(source.componentType);
    const std::uint64_t size = componentSize * components;
    if (size == 0) return fail(fmt::format("{}: numbers of type {}", what, source.componentType));
    std::vector<T> values;
    const auto take = [&](const unsigned char* at, T* to) {
        for (std::uint32_t c = 0; c < components; ++c)
            to[c] = component<T>(at + c * componentSize, source.componentType, source.normalized);
    };
    if (source.bufferView >= 0) {
        const auto from = strided(*model_, source.bufferView, source.byteOffset, source.count, size, 0, what);
        if (!from) return tl::unexpected(from.error());
        values.resize(source.count * components);
        for (std::size_t i = 0; i < source.count; ++i)
            take(from->first + i * from->stride, &values[i * components]);
    } else {
        if (source.count > kMaxZeros)
            return fail(fmt::format("{}: {} elements without bytes", what, source.count),
                        fmt::format("expected at most {}", kMaxZeros));
        values.resize(source.count * components);
    }
    if (!source.sparse.isSparse) return values;
    const auto& sparse = source.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        return fail(fmt::format("{}: a negative number of sparse values", what));
    const auto count = static_cast<std::uint64_t>(sparse.count);
    const std::uint64_t indexSize = sizeOfComponent(sparse.indices.componentType);
    if (indexSize == 0) return fail(fmt::format("{}: sparse indices of an unknown type", what));
    const auto places =
        strided(*model_, sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
                count, indexSize, indexSize, what);
    if (!places) return tl::unexpected(places.error());
    const auto from = strided(*model_, sparse.values.bufferView,
                              static_cast<std::uint64_t>(sparse.values.byteOffset), count, size, size, what);
    if (!from) return tl::unexpected(from.error());
    for (std::size_t i = 0; i < count; ++i) {
        const auto place =
            component<std::uint32_t>(places->first + i * places->stride, sparse.indices.componentType, false);
        if (place >= source.count)
            return fail(fmt::format("{}: a sparse value for element {}", what, place),
                        fmt::format("there are {}", source.count));
        take(from->first + i * from->stride, &values[place * std::size_t{components}]);
    }
    return values;
}

Result<std::vector<float>> GltfFile::numbers(int accessor, std::uint32_t components, const char* what) const {
    return elements<float>(accessor, components, what);
}

Result<std::vector<std::uint32_t>> GltfFile::indices(int accessor, const char* what) const {
    return elements<std::uint32_t>(accessor, 1, what);
}

}  // namespace hairloom
