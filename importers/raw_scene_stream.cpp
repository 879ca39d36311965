// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/raw_scene_stream.h"

namespace hairloom {
namespace {

constexpr auto kSceneMembers = [](auto& archive, auto& scene) {
    const auto track = [&](auto& keys) {
        archive(keys.times);
        archive(keys.values);
    };
    archive(scene.soup.positions);
    archive(scene.soup.offsets);
    archive(scene.soup.corners);
    archive(scene.soup.uvs);
    archive(scene.soup.normals);
    archive(scene.soup.faceGroups);
    archive(scene.soup.faceMaterials);
    archive.each(scene.soup.groupNames, archive);
    archive.each(scene.soup.materialNames, archive);
    archive.each(scene.bones, [&](auto& bone) {
        archive(bone.name);
        archive(bone.parent);
        archive(bone.rest);
        archive(bone.inverseBind);
    });
    archive.each(scene.clips, [&](auto& clip) {
        archive(clip.name);
        archive(clip.duration);
        archive.each(clip.channels, [&](auto& channel) {
            archive(channel.bone);
            track(channel.translation);
            track(channel.rotation);
            track(channel.scale);
        });
        archive.each(clip.morphs, [&](auto& channel) {
            archive(channel.target);
            track(channel.weight);
        });
    });
    archive(scene.skin.bones);
    archive(scene.skin.weights);
    archive.each(scene.morphs, [&](auto& target) {
        archive(target.name);
        archive(target.restWeight);
        archive(target.vertices);
        archive(target.offsets);
    });
    archive.each(scene.warnings, archive);
    archive(scene.metresPerUnit);
    archive(scene.assumedMetresPerUnit);
    archive(scene.statesUp);
};

}  // namespace

void writeRawScene(const Result<RawScene>& scene, const std::string& lacking,
                   const AnswerWriter::Sink& sink) {
    writeAnswer(scene, AnswerKind::Scene, lacking, sink, kSceneMembers);
}

Result<RawScene> readRawScene(const std::string& file, std::span<const std::byte> bytes,
                              std::string& lacking) {
    return readAnswer<RawScene>(file, bytes, AnswerKind::Scene, lacking, kSceneMembers);
}

}  // namespace hairloom
