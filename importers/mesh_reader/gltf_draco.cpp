// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_draco.h"

#include <fmt/format.h>

#ifdef HAIRLOOM_HAS_DRACO
#include <draco/compression/decode.h>
#endif

#include "importers/mesh_reader/tinygltf.h"

namespace hairloom {
namespace {
constexpr const char* kName = "KHR_draco_mesh_compression";
}

bool isDracoCompressed(const tinygltf::Primitive& primitive) {
    return primitive.extensions.contains(kName);
}

#ifdef HAIRLOOM_HAS_DRACO

namespace {

Result<std::span<const unsigned char>> bytesOf(const tinygltf::Model& model, int number) {
    if (number < 0 || static_cast<std::size_t>(number) >= model.bufferViews.size())
        return fail(fmt::format("{} refers to buffer view {}", kName, number));
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(number)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
        return fail(fmt::format("{} refers to buffer {}", kName, view.buffer));
    const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        return fail("a compressed primitive goes beyond its buffer");
    return std::span<const unsigned char>(data).subspan(view.byteOffset, view.byteLength);
}

Result<DracoPrimitive::Attribute> numbersOf(const draco::Mesh& mesh, const draco::PointAttribute& from,
                                            bool isNormalised) {
    constexpr std::int8_t kMaxComponents = 4;
    if (from.num_components() < 1 || from.num_components() > kMaxComponents)
        return fail(fmt::format("a compressed attribute has {} components", from.num_components()));
    DracoPrimitive::Attribute to;
    to.components = static_cast<std::uint32_t>(from.num_components());
    to.numbers.resize(std::size_t{mesh.num_points()} * to.components);
    // draco scales whole numbers by itself where its own attribute says so; glTF says it of the accessor.
    draco::PointAttribute source;
    source.CopyFrom(from);
    source.set_normalized(isNormalised);
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        float* const values = &to.numbers[std::size_t{point.value()} * to.components];
        if (!source.ConvertValue<float>(source.mapped_index(point), from.num_components(), values))
            return fail("a compressed attribute has no numbers");
    }
    return to;
}

}  // namespace

Result<DracoPrimitive> readDraco(const GltfFile& file, const tinygltf::Primitive& primitive) {
    const tinygltf::Model& model = file.model();
    const tinygltf::Value& extension = primitive.extensions.at(kName);
    const tinygltf::Value& view = memberOf(extension, "bufferView");
    const tinygltf::Value& names = memberOf(extension, "attributes");
    if (!view.IsInt() || !names.IsObject())
        return fail(fmt::format("{} lacks its buffer view or its attributes", kName));
    const auto bytes = bytesOf(model, view.Get<int>());
    if (!bytes) return tl::unexpected(bytes.error());
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    draco::Decoder decoder;
    const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return fail(fmt::format("a compressed primitive cannot be read: {}", decoded.status().error_msg()));
    const draco::Mesh& mesh = *decoded.value();

    DracoPrimitive result;
    result.vertices = mesh.num_points();
    result.indices.reserve(std::size_t{mesh.num_faces()} * 3);
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
        for (const draco::PointIndex& corner : mesh.face(face)) result.indices.push_back(corner.value());
    }
    for (const std::string& name : names.Keys()) {
        const tinygltf::Value& id = names.Get(name);
        const draco::PointAttribute* const from =
            id.IsInt() && id.Get<int>() >= 0
                ? mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id.Get<int>()))
                : nullptr;
        if (from == nullptr) return fail(fmt::format("the compressed primitive has no {}", name));
        const auto accessor = primitive.attributes.find(name);
        const bool isNormalised = accessor != primitive.attributes.end() && accessor->second >= 0 &&
                                  static_cast<std::size_t>(accessor->second) < model.accessors.size() &&
                                  model.accessors[static_cast<std::size_t>(accessor->second)].normalized;
        auto numbers = numbersOf(mesh, *from, isNormalised);
        if (!numbers) return tl::unexpected(numbers.error());
        result.attributes.emplace(name, std::move(*numbers));
    }
    return result;
}

#else

Result<DracoPrimitive> readDraco(const GltfFile&, const tinygltf::Primitive&) {
    return fail("is compressed by draco, which this build cannot read",
                "expected a file exported without compression");
}

#endif

}  // namespace hairloom
