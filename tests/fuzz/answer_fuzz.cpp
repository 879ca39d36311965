// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for what the program takes from hairloom-mesh-reader, which a foreign file may have taken
// over. The first byte says which answer it is; the rest are changes of a good one, or the answer itself.

#include <cstdlib>

#include "importers/picture_stream.h"
#include "importers/raw_scene_stream.h"
#include "importers/raw_strands_stream.h"
#include "tests/fuzz/changes.h"

namespace {

using namespace hairloom;

using Bytes = std::vector<std::byte>;

template <class Content, class Write>
Bytes written(const Content& content, const Write& write) {
    Bytes bytes;
    write(Result<Content>(content), "files",
          [&](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
    return bytes;
}

RawStrands sampleStrands() {
    RawStrands strands;
    strands.format = "fuzzed";
    strands.offsets = {0, 2, 5};
    strands.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}};
    strands.thickness.assign(5, 0.001f);
    strands.rootUvs = {{0, 0}, {1, 1}};
    strands.attributes.push_back({.name = "wetness", .numbers = {0, 1}});
    strands.parts = {{"/groom/brows", "brows"}, {"/groom/hair", "hair"}};
    strands.partOfStrand = {0, 1};
    strands.frames = {strands.positions, strands.positions};
    strands.framesPerSecond = 24;
    return strands;
}

RawScene sampleScene() {
    RawScene scene;
    scene.soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    scene.soup.offsets = {0, 3, 6};
    scene.soup.corners = {0, 1, 2, 1, 3, 2};
    scene.soup.uvs.assign(6, Vec2f(0, 0));
    scene.soup.normals.assign(6, Vec3f(0, 0, 1));
    scene.soup.faceGroups = {0, 1};
    scene.soup.faceMaterials = {0, 0};
    scene.soup.groupNames = {"scalp", "ear"};
    scene.soup.materialNames = {"skin"};
    scene.bones = {{.name = "neck"}, {.name = "head", .parent = 0}};
    scene.clips = {{.name = "nod", .duration = 1}};
    Channel channel;
    channel.bone = 1;
    channel.translation = {{0, 1}, {{0, 0, 0}, {0, 1, 0}}};
    channel.rotation = {{0}, {Quatf::Identity()}};
    scene.clips.front().channels = {channel};
    scene.clips.front().morphs = {{0, {{0, 1}, {0, 1}}}};
    scene.morphs = {{"brow", 0.5f, {0, 3}, {{0, 1, 0}, {0, 0, 1}}}};
    scene.skin.bones.assign(4, {0, 1, 0, 0});
    scene.skin.weights.assign(4, {0.5f, 0.5f, 0, 0});
    scene.warnings = {"a warning"};
    scene.metresPerUnit = 0.01f;
    return scene;
}

render::LinearImage samplePicture() {
    render::LinearImage picture;
    picture.width = 2;
    picture.height = 3;
    picture.rgba.assign(24, 0.5f);
    return picture;
}

template <class Content>
void mustSayWhy(const Result<Content>& content) {
    if (!content && content.error().problem.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return -1;
    static const Bytes strands = written(sampleStrands(), writeRawStrands);
    static const Bytes scene = written(sampleScene(), writeRawScene);
    static const Bytes picture = written(samplePicture(), writePicture);
    const unsigned kind = data[0] % 3u;
    const std::span rest(data + 1, size - 1);
    Bytes bytes = kind == 0 ? strands : kind == 1 ? scene : picture;
    if (data[0] >= 128)
        bytes.assign(std::as_bytes(rest).begin(), std::as_bytes(rest).end());
    else
        change(bytes, rest);
    std::string lacking;
    if (kind == 0) {
        const auto read = readRawStrands("fuzzed", bytes, lacking);
        mustSayWhy(read);
    } else if (kind == 1) {
        const auto read = readRawScene("fuzzed", bytes, lacking);
        mustSayWhy(read);
        if (read && validate(*read)) static_cast<void>(ScalpMesh::make(read->soup));
    } else {
        const auto read = readPictureAnswer("fuzzed", bytes, lacking);
        mustSayWhy(read);
        if (read && read->rgba.size() != std::size_t{4} * read->width * read->height) std::abort();
    }
    return 0;
}
