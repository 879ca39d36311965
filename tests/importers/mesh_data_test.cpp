// SPDX-License-Identifier: GPL-3.0-or-later
// Every damaged, odd and fuzzed mesh beside this checkout is either loaded or refused with a message, in
// time.

#include <gtest/gtest.h>
#ifndef _WIN32
#include <sys/resource.h>
#endif

#include <algorithm>
#include <filesystem>

#include "importers/scene.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

const fs::path kData = outsideData();

std::vector<fs::path> filesUnder(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

void expectSound(const ImportedScene& scene) {
    ASSERT_GT(scene.mesh.triangleCount(), 0u);
    for (const Vec3f& position : scene.mesh.positions()) ASSERT_TRUE(position.allFinite());
    for (const Vec3f& normal : scene.mesh.normals()) ASSERT_TRUE(normal.allFinite());
    for (const Triangle& triangle : scene.mesh.triangles()) {
        for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, scene.mesh.vertexCount());
    }
    for (const std::uint32_t group : scene.mesh.triangleGroups())
        ASSERT_LT(group, scene.mesh.groupNames().size());
    if (scene.skin.vertexCount() != 0) {
        ASSERT_EQ(scene.skin.vertexCount(), scene.mesh.vertexCount());
    }
}

/// Of this process and of the readers it ran. Windows keeps no such number of processes that have ended.
void expectLittleMemory() {
#ifndef _WIN32
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        EXPECT_LT(static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0), 2.0);
    }
#endif
}

/// Of this process and of the readers it ran, which other work on this machine does not lengthen.
double processorSeconds() {
#ifdef _WIN32
    return 0;
#else
    double seconds = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
#endif
}

class MeshData : public testing::TestWithParam<const char*> {};

TEST_P(MeshData, EveryFileIsLoadedOrRefusedWithAMessage) {
    const fs::path folder = kData / GetParam();
    if (!fs::exists(folder)) GTEST_SKIP() << "no data beside this checkout: " << folder;
    const auto files = filesUnder(folder);
    ASSERT_FALSE(files.empty());
    std::size_t loaded = 0;
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.string());
        const double start = processorSeconds();
        const auto scene = importScene(file);
        EXPECT_LT(processorSeconds() - start, 10);
        if (scene) {
            ++loaded;
            expectSound(*scene);
        } else {
            EXPECT_EQ(scene.error().file, file.string());
            EXPECT_FALSE(scene.error().problem.empty());
        }
    }
    RecordProperty("loaded", static_cast<int>(loaded));
    RecordProperty("files", static_cast<int>(files.size()));
    expectLittleMemory();
}

INSTANTIATE_TEST_SUITE_P(Folders, MeshData,
                         testing::Values("meshes/obj", "meshes/ply", "meshes/trimesh", "meshes/gltf",
                                         "meshes/invalid", "fuzz/obj", "fuzz/fbx", "heads", "animated",
                                         "strands"));

}  // namespace
}  // namespace hairloom
