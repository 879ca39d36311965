// SPDX-License-Identifier: GPL-3.0-or-later
// What glTF can say in more than one way: quantised, sparse, morphed and compressed numbers, keys of every
// kind, files beside it.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "tests/importers/gltf_files.h"
#include "tests/importers/mesh_files.h"

#ifdef HAIRLOOM_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace hairloom::test {
namespace {

using testing::HasSubstr;

/// A square of 0.2 m that looks up, two triangles.
const std::vector<float> kSquare{0, 0, 0, 0.2f, 0, 0, 0, 0, -0.2f, 0.2f, 0, -0.2f};
const std::vector<std::uint16_t> kCorners{0, 1, 2, 1, 3, 2};

class MeshGltf : public MeshFiles {
  protected:
    /// One node with one primitive of the attributes; `more` joins the JSON at its top.
    std::string file(const std::string& accessors, const std::string& attributes,
                     const std::string& primitive = {}, const std::string& more = {},
                     const std::string& node = {}) const {
        return fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"name":"head","mesh":0{}}}],)"
            R"("meshes":[{{"primitives":[{{"attributes":{{{}}}{}}}]}}],"accessors":[{}],{}{}}})",
            node, attributes, primitive, accessors, buffer.json(), more);
    }
    std::string plainSquare(const std::string& more = {}) {
        const int positions = buffer.view(kSquare), corners = buffer.view(kCorners);
        return file(
            accessor(positions, kFloat, 4, "VEC3") + "," + accessor(corners, kUnsignedShort, 6, "SCALAR"),
            R"("POSITION":0)", R"(,"indices":1)", more);
    }
    GltfBuffer buffer;
};

void expectSquare(const Result<ImportedScene>& scene, float tolerance) {
    ASSERT_TRUE(scene) << scene.error().message();
    ASSERT_EQ(scene->mesh.triangleCount(), 2u);
    const Box3f bounds = scene->mesh.bounds();
    EXPECT_NEAR((bounds.min() - Vec3f(0, 0, -0.2f)).norm(), 0, tolerance);
    EXPECT_NEAR((bounds.max() - Vec3f(0.2f, 0, 0)).norm(), 0, tolerance);
    for (const Vec3f& normal : scene->mesh.normals()) EXPECT_NEAR(normal.y(), 1, 0.02f);
}

TEST_F(MeshGltf, PlainNumbers) {
    expectSquare(import("a.gltf", plainSquare()), 1e-7f);
}

TEST_F(MeshGltf, QuantisedPositionsNormalsAndUvs) {
    // Normalised 16 bits for positions with a stride of 8, 8 bits for normals, normalised bytes for UVs.
    const std::int16_t full = 32767;
    const std::int16_t low = -32767;
    const int positions =
        buffer.view(std::vector<std::int16_t>{0, 0, 0, 0, full, 0, 0, 0, 0, 0, low, 0, full, 0, low, 0}, 8);
    const int normals =
        buffer.view(std::vector<std::int8_t>{0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0}, 4);
    const int uvs =
        buffer.view(std::vector<std::uint8_t>{0, 255, 0, 0, 255, 255, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0}, 4);
    const int corners = buffer.view(std::vector<std::uint8_t>{0, 1, 2, 1, 3, 2});
    const std::string json =
        file(accessor(positions, kShort, 4, "VEC3", R"("normalized":true)") + "," +
                 accessor(normals, kByte, 4, "VEC3", R"("normalized":true)") + "," +
                 accessor(uvs, kUnsignedByte, 4, "VEC2", R"("normalized":true)") + "," +
                 accessor(corners, kUnsignedByte, 6, "SCALAR"),
             R"("POSITION":0,"NORMAL":1,"TEXCOORD_0":2)", R"(,"indices":3)",
             R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])",
             R"(,"scale":[0.2,0.2,0.2])");
    const auto scene = import("a.gltf", json);
    expectSquare(scene, 1e-5f);
    // The first corner's V is 1 downwards.
    for (std::size_t corner = 0; corner < 6; ++corner) {
        const Vec3f at = scene->mesh.positions()[scene->mesh.triangles()[corner / 3][corner % 3]];
        EXPECT_NEAR(scene->mesh.cornerUvs()[corner].x(), at.x() / 0.2f, 1e-5f);
        EXPECT_NEAR(scene->mesh.cornerUvs()[corner].y(), -at.z() / 0.2f, 1e-5f);
    }
}

TEST_F(MeshGltf, SparseValuesReplaceThoseBelowThem) {
    // All zeros but the sparse ones; the view of the other accessor has a value that these replace.
    const int places = buffer.view(std::vector<std::uint16_t>{1, 2, 3});
    const int values = buffer.view(std::vector<float>(kSquare.begin() + 3, kSquare.end()));
    const int corners = buffer.view(kCorners);
    const auto sparse = [&](int count, const char* type) {
        return fmt::format(
            R"("sparse":{{"count":{},"indices":{{"bufferView":{},"componentType":{}}},"values":{{"bufferView":{}}}}})",
            count, places, type, values);
    };
    const auto json = [&](const std::string& positions) {
        return file(positions + "," + accessor(corners, kUnsignedShort, 6, "SCALAR"), R"("POSITION":0)",
                    R"(,"indices":1)");
    };
    expectSquare(import("a.gltf", json(accessor(-1, kFloat, 4, "VEC3", sparse(3, "5123")))), 1e-7f);
    EXPECT_THAT(refusal("b.gltf", json(accessor(-1, kFloat, 3, "VEC3", sparse(3, "5123")))),
                HasSubstr("a sparse value for element 3; there are 3"));
    EXPECT_THAT(refusal("c.gltf", json(accessor(-1, kFloat, 4, "VEC3", sparse(9, "5123")))),
                HasSubstr("do not fit"));
    EXPECT_THAT(refusal("d.gltf", json(accessor(-1, kFloat, 900'000'000, "VEC3", sparse(3, "5123")))),
                HasSubstr("without bytes"));
}

TEST_F(MeshGltf, MorphTargetsStandAtTheirWeightsOfRest) {
    const int positions = buffer.view(kSquare), corners = buffer.view(kCorners);
    const int moved = buffer.view(std::vector<float>{0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0});
    const std::string accessors = accessor(positions, kFloat, 4, "VEC3") + "," +
                                  accessor(corners, kUnsignedShort, 6, "SCALAR") + "," +
                                  accessor(moved, kFloat, 4, "VEC3");
    const auto scene =
        import("a.gltf", file(accessors, R"("POSITION":0)", R"(,"indices":1,"targets":[{"POSITION":2}])", {},
                              R"(,"weights":[0.25])"));
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_FLOAT_EQ(scene->mesh.bounds().min().y(), 0.5f);
    EXPECT_FLOAT_EQ(scene->mesh.bounds().max().y(), 0.5f);
    ASSERT_FALSE(scene->warnings.empty());
    EXPECT_THAT(scene->warnings.front(), HasSubstr("weights of their rest pose"));
}

TEST_F(MeshGltf, StripsAndFansKeepTheirSide) {
    for (const int mode : {5, 6}) {
        buffer = {};
        // A strip goes zigzag, a fan around its first corner.
        const std::vector<float> fan{0, 0, 0, 0.2f, 0, 0, 0.2f, 0, -0.2f, 0, 0, -0.2f};
        const int positions = buffer.view(mode == 5 ? kSquare : fan);
        expectSquare(import("a.gltf", file(accessor(positions, kFloat, 4, "VEC3"), R"("POSITION":0)",
                                           fmt::format(R"(,"mode":{})", mode))),
                     1e-7f);
    }
}

/// Keys of a translation along X at 0, 1 and 2 s.
class GltfKeys : public MeshGltf {
  protected:
    Clip clip(const std::string& interpolation, const std::vector<float>& values) {
        const int positions = buffer.view(kSquare), corners = buffer.view(kCorners);
        const int times = buffer.view(std::vector<float>{0, 1, 2}), keys = buffer.view(values);
        const std::string json = file(
            accessor(positions, kFloat, 4, "VEC3") + "," + accessor(corners, kUnsignedShort, 6, "SCALAR") +
                "," + accessor(times, kFloat, 3, "SCALAR") + "," +
                accessor(keys, kFloat, values.size() / 3, "VEC3"),
            R"("POSITION":0)", R"(,"indices":1)",
            fmt::format(
                R"(,"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],)"
                R"("samplers":[{{"input":2,"output":3,"interpolation":"{}"}}]}}])",
                interpolation));
        auto scene = import("a.gltf", json);
        EXPECT_TRUE(scene) << scene.error().message();
        if (!scene || scene->clips.size() != 1) return {};
        return scene->clips.front();
    }
    static float at(const Clip& clip, float time) {
        return sample(clip.channels.front().translation, time, Vec3f::Zero()).x();
    }
};

TEST_F(GltfKeys, StepsHoldTheirValueToTheNextKey) {
    const Clip steps = clip("STEP", {0, 0, 0, 1, 0, 0, 5, 0, 0});
    ASSERT_FALSE(steps.channels.empty());
    EXPECT_EQ(at(steps, 0.5f), 0);
    EXPECT_EQ(at(steps, 0.9999f), 0);
    EXPECT_EQ(at(steps, 1), 1);
    EXPECT_EQ(at(steps, 1.9999f), 1);
    EXPECT_EQ(at(steps, 2), 5);
    EXPECT_EQ(steps.duration, 2);
}

TEST_F(GltfKeys, CubicSplinesAreFollowed) {
    // In-tangent, value, out-tangent of each key: t³ in the first second, 1 + 3 (t − 1) in the second.
    const Clip cubic = clip("CUBICSPLINE", {0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                                            3, 0, 0, 1, 0, 0, 3, 0, 0,  //
                                            3, 0, 0, 4, 0, 0, 0, 0, 0});
    ASSERT_FALSE(cubic.channels.empty());
    for (float t = 0; t <= 1; t += 0.03f) EXPECT_NEAR(at(cubic, t), t * t * t, 5e-4f) << t;
    for (float t = 1; t <= 2; t += 0.03f) EXPECT_NEAR(at(cubic, t), 3 * t - 2, 1e-5f) << t;
    EXPECT_LT(cubic.channels.front().translation.times.size(), 70u) << "straight pieces stay whole";
}

TEST_F(GltfKeys, UnknownKindsAndNumbersThatDoNotFitAreRefused) {
    const int positions = buffer.view(kSquare), times = buffer.view(std::vector<float>{0, 1});
    const auto json = [&](const std::string& sampler) {
        return file(accessor(positions, kFloat, 4, "VEC3") + "," + accessor(times, kFloat, 2, "SCALAR"),
                    R"("POSITION":0)", {},
                    R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],)"
                    R"("samplers":[)" +
                        sampler + "]}]");
    };
    EXPECT_THAT(refusal("a.gltf", json(R"({"input":1,"output":0,"interpolation":"WAVES"})")),
                HasSubstr("'WAVES'; expected LINEAR"));
    EXPECT_THAT(refusal("b.gltf", json(R"({"input":1,"output":0})")), HasSubstr("2 times of keys with 12"));
    EXPECT_THAT(refusal("c.gltf", json(R"({"input":1,"output":7})")), HasSubstr("accessor 7 has 0 numbers"));
}

TEST_F(MeshGltf, UnknownRequiredExtensionsAreRefused) {
    EXPECT_THAT(refusal("a.gltf", plainSquare(R"(,"extensionsRequired":["KHR_meshopt_compression"])")),
                HasSubstr("requires the extension KHR_meshopt_compression"));
    buffer = {};
    EXPECT_TRUE(import("b.gltf", plainSquare(R"(,"extensionsUsed":["KHR_meshopt_compression"])")));
}

TEST_F(MeshGltf, AccessorsBeyondTheirBytesAreRefused) {
    const int positions = buffer.view(kSquare);
    const auto json = [&](const std::string& positionsOf) { return file(positionsOf, R"("POSITION":0)"); };
    EXPECT_THAT(refusal("a.gltf", json(accessor(positions, kFloat, 5, "VEC3"))), HasSubstr("do not fit"));
    EXPECT_THAT(refusal("b.gltf", json(accessor(7, kFloat, 4, "VEC3"))), HasSubstr("no buffer view 7"));
    EXPECT_THAT(refusal("c.gltf", json(accessor(positions, kFloat, 4, "VEC3", R"("byteOffset":40)"))),
                HasSubstr("do not fit"));
}

TEST_F(MeshGltf, BuffersOutsideTheFolderAreNotRead) {
    const auto json = [](const std::string& uri) {
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
               R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)" +
               accessor(0, kFloat, 3, "VEC3") +
               R"(],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" + uri +
               R"("}]})";
    };
    const std::vector<float> triangle{0, 0, 0, 0.2f, 0, 0, 0, 0, -0.2f};
    const std::string bytes(reinterpret_cast<const char*>(triangle.data()), 36);
    std::filesystem::create_directories(folder / "inside" / "parts");
    write("secret.bin", bytes);
    write("inside/parts/own.bin", bytes);
    EXPECT_TRUE(import("inside/a.gltf", json("parts/own.bin")));
    EXPECT_THAT(refusal("inside/b.gltf", json("../secret.bin")), HasSubstr("refers to ../secret.bin"));
    EXPECT_THAT(refusal("inside/c.gltf", json("parts/../../secret.bin")), HasSubstr("in its own folder"));
    EXPECT_FALSE(import("inside/d.gltf", json((folder / "secret.bin").string())));
    EXPECT_FALSE(import("inside/e.gltf", json("file://" + (folder / "secret.bin").string())));
#ifndef _WIN32
    std::filesystem::create_symlink("../secret.bin", folder / "inside" / "link.bin");
    EXPECT_THAT(refusal("inside/f.gltf", json("link.bin")), HasSubstr("refers to link.bin"));
#endif
}

#ifdef HAIRLOOM_HAS_DRACO
TEST_F(MeshGltf, CompressedPrimitives) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (int face = 0; face < 2; ++face) {
        const auto corner = [&](int k) {
            return &kSquare[std::size_t{kCorners[static_cast<std::size_t>(face * 3 + k)]} * 3];
        };
        builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(face)), corner(0),
                                          corner(1), corner(2));
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    draco::EncoderBuffer encoded;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &encoded).ok());
    const std::vector<char> bytes(encoded.data(), encoded.data() + encoded.size());
    const auto unique = mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION)->unique_id();
    const auto json = [&](const std::vector<char>& compressed) {
        buffer = {};
        const int view = buffer.view(compressed);
        return file(
            accessor(-1, kFloat, 4, "VEC3") + "," + accessor(-1, kUnsignedShort, 6, "SCALAR"),
            R"("POSITION":0)",
            fmt::format(R"(,"indices":1,"extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{},)"
                        R"("attributes":{{"POSITION":{}}}}}}})",
                        view, unique),
            R"(,"extensionsRequired":["KHR_draco_mesh_compression"])");
    };
    expectSquare(import("a.gltf", json(bytes)), 2e-4f);
    EXPECT_THAT(refusal("b.gltf", json({bytes.begin(), bytes.begin() + 20})),
                HasSubstr("compressed primitive"));
}
#endif

}  // namespace
}  // namespace hairloom::test
