// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "importers/mesh_reader/tinygltf.h"

namespace hairloom {
namespace {

/// Bytes that a packed one can make at the most: sixteen equal bytes take a quarter of one.
constexpr std::uint64_t kBestRatio = 64;
constexpr std::uint64_t kLargestElement = 256;

struct Packed {
    std::uint64_t offset = 0, bytes = 0, stride = 0, count = 0;
    int buffer = -1;
    std::string mode, filter = "NONE";
};

bool take(const tinygltf::Value& from, const char* name, std::uint64_t& to) {
    const tinygltf::Value& value = memberOf(from, name);
    if (!value.IsInt() || value.GetNumberAsInt() < 0) return false;
    to = static_cast<std::uint64_t>(value.GetNumberAsInt());
    return true;
}

Result<Packed> packedIn(const tinygltf::Value& extension) {
    Packed packed;
    std::uint64_t buffer = 0;
    const tinygltf::Value& mode = memberOf(extension, "mode");
    if (!take(extension, "buffer", buffer) || !take(extension, "byteLength", packed.bytes) ||
        !take(extension, "byteStride", packed.stride) || !take(extension, "count", packed.count) ||
        !mode.IsString())
        return fail(fmt::format("{} lacks its buffer, length, stride, count or mode", kMeshopt));
    packed.buffer = static_cast<int>(buffer);
    if (extension.Has("byteOffset") && !take(extension, "byteOffset", packed.offset))
        return fail(fmt::format("{} has a byteOffset that is no number", kMeshopt));
    packed.mode = mode.Get<std::string>();
    const tinygltf::Value& filter = memberOf(extension, "filter");
    if (filter.IsString()) packed.filter = filter.Get<std::string>();
    return packed;
}

/// What the library trusts its caller with.
Status check(const Packed& packed, std::size_t view, std::uint64_t viewBytes) {
    const auto wrong = [&](std::string problem, std::string expected) {
        return fail(fmt::format("compressed buffer view {}: {}", view, problem), std::move(expected));
    };
    const bool isAttributes = packed.mode == "ATTRIBUTES", isTriangles = packed.mode == "TRIANGLES";
    if (!isAttributes && !isTriangles && packed.mode != "INDICES")
        return wrong(fmt::format("mode {}", packed.mode), "expected ATTRIBUTES, TRIANGLES or INDICES");
    const bool isStride =
        isAttributes ? packed.stride > 0 && packed.stride % 4 == 0 && packed.stride <= kLargestElement
                     : packed.stride == 2 || packed.stride == 4;
    if (!isStride)
        return wrong(fmt::format("elements of {} bytes", packed.stride),
                     isAttributes ? "expected a multiple of 4, at most 256" : "expected 2 or 4");
    if (isTriangles && packed.count % 3 != 0)
        return wrong(fmt::format("{} indices of triangles", packed.count), "expected a multiple of 3");
    const std::uint64_t bytes = packed.count * packed.stride;
    if (bytes != viewBytes)
        return wrong(fmt::format("{} elements of {} bytes", packed.count, packed.stride),
                     fmt::format("the view has {} bytes", viewBytes));
    if (bytes > kBestRatio * packed.bytes)
        return wrong(fmt::format("{} bytes from {} packed ones", bytes, packed.bytes),
                     fmt::format("expected at most {} times as many", kBestRatio));
    const bool isFilter =
        packed.filter == "NONE" ||
        (isAttributes &&
         ((packed.filter == "OCTAHEDRAL" && (packed.stride == 4 || packed.stride == 8)) ||
          (packed.filter == "QUATERNION" && packed.stride == 8) || packed.filter == "EXPONENTIAL"));
    if (!isFilter)
        return wrong(fmt::format("filter {} of elements of {} bytes", packed.filter, packed.stride),
                     "expected OCTAHEDRAL (4 or 8), QUATERNION (8) or EXPONENTIAL");
    return {};
}

Result<std::vector<unsigned char>> unpack(const Packed& packed, const unsigned char* from, std::size_t view) {
    std::vector<unsigned char> bytes(static_cast<std::size_t>(packed.count * packed.stride));
    const auto count = static_cast<std::size_t>(packed.count),
               stride = static_cast<std::size_t>(packed.stride);
    const auto size = static_cast<std::size_t>(packed.bytes);
    if (count == 0) return bytes;
    const int code =
        packed.mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, size)
        : packed.mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, size)
                                     : meshopt_decodeIndexSequence(bytes.data(), count, stride, from, size);
    if (code != 0)
        return fail(
            fmt::format("compressed buffer view {} is damaged or of a newer version ({})", view, code),
            fmt::format("expected bytes of {}", kMeshopt));
    if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
}

}  // namespace

bool fillFallbackBuffers(nlohmann::json& gltf) {
    if (!gltf.is_object() || !gltf.contains("buffers") || !gltf["buffers"].is_array()) return false;
    bool isFilled = false;
    for (auto& buffer : gltf["buffers"]) {
        if (!buffer.is_object() || buffer.contains("uri") || !buffer.contains("extensions")) continue;
        const auto& extensions = buffer["extensions"];
        if (!extensions.is_object() || !extensions.contains(kMeshopt)) continue;
        const auto& about = extensions[kMeshopt];
        if (!about.is_object() || !about.contains("fallback") || about["fallback"] != true) continue;
        buffer["byteLength"] = 1;
        buffer["uri"] = "data:application/octet-stream;base64,AA==";
        isFilled = true;
    }
    return isFilled;
}

Status unpackMeshopt(tinygltf::Model& model) {
    for (std::size_t view = 0; view < model.bufferViews.size(); ++view) {
        const auto extension = model.bufferViews[view].extensions.find(kMeshopt);
        if (extension == model.bufferViews[view].extensions.end()) continue;
        const auto packed = packedIn(extension->second);
        if (!packed) return tl::unexpected(packed.error());
        if (auto status = check(*packed, view, model.bufferViews[view].byteLength); !status) return status;
        if (static_cast<std::size_t>(packed->buffer) >= model.buffers.size())
            return fail(fmt::format("{} names buffer {}", kMeshopt, packed->buffer));
        const auto& data = model.buffers[static_cast<std::size_t>(packed->buffer)].data;
        if (packed->offset > data.size() || packed->bytes > data.size() - packed->offset)
            return fail(fmt::format("compressed buffer view {} goes beyond its buffer", view));
        auto bytes = unpack(*packed, data.data() + packed->offset, view);
        if (!bytes) return tl::unexpected(bytes.error());
        tinygltf::Buffer own;
        own.data = std::move(*bytes);
        model.bufferViews[view].buffer = static_cast<int>(model.buffers.size());
        model.bufferViews[view].byteOffset = 0;
        model.buffers.push_back(std::move(own));
    }
    return {};
}

}  // namespace hairloom
