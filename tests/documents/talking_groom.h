// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Short hair all over a bust that talks.

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/animation/root_motion.h"
#include "core/base/output_file.h"
#include "core/documents/head_import.h"
#include "core/documents/motions.h"
#include "tests/support/source_dir.h"
#include "tests/support/talking_skin.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {

inline std::string bustFile() {
    return (sourceDir() / "samples/bust/bust.glb").string();
}

class TalkingGroom {
  public:
    /// A strand of 2 cm on every `step`-th triangle of the front.
    explicit TalkingGroom(std::uint32_t step = 3) {
        file = (folder_.path() / "talking.glb").string();
        EXPECT_TRUE(writeFileAtomically(file, talkingBust(bustFile())));
        auto head = importHead(file, {});
        if (!head) throw std::runtime_error(head.error().message());
        const auto mesh = std::make_shared<const ScalpMesh>(std::move(head->scene.mesh));
        std::vector<std::uint32_t> offsets{0};
        std::vector<Vec3f> positions;
        for (std::uint32_t t = 0; t < mesh->triangleCount(); t += step) {
            const Triangle& corners = mesh->triangles()[t];
            Vec3f centre = Vec3f::Zero();
            for (const std::uint32_t v : corners) centre += mesh->positions()[v] / 3;
            if (centre.z() < 0) continue;
            roots_.push_back({t, Vec3f::Constant(1.0f / 3)});
            for (int p = 0; p < 5; ++p)
                positions.push_back(centre + 0.005f * static_cast<float>(p) * mesh->triangleNormal(t));
            offsets.push_back(static_cast<std::uint32_t>(positions.size()));
        }
        groom = makeGroom(std::move(offsets), std::move(positions));
        groom.scalp = mesh;
        groom.characterFile = file;
        for (const SurfacePoint& root : roots_) groom.scalpSelection.push_back(root.triangle);
        groom.setRootBindings(roots_);
        auto actor = loadActor({}, groom);
        if (!actor) throw std::runtime_error(actor.error().message());
        actor_ = std::move(*actor);
    }

    /// As test::offSkin().
    double offSkin(std::span<const Vec3f> points_ws, const FaceAt& now) const {
        return test::offSkin(groom, *actor_, points_ws, now);
    }
    /// Points of which the first of each strand are where the pose has the roots.
    std::vector<Vec3f> rootsAt(const HeadPose& pose) const {
        std::vector<Vec3f> points(groom.positions().begin(), groom.positions().end());
        const auto moves = rootTransforms(*groom.scalp, pose.scalpPositions_ws, roots_);
        for (std::size_t s = 0; s < groom.strandCount(); ++s)
            points[groom.offsets[s]] = moves[s] * points[groom.offsets[s]];
        return points;
    }

    std::string file;
    Groom groom;

  private:
    const TemporaryFolder folder_;
    std::vector<SurfacePoint> roots_;
    std::shared_ptr<const Actor> actor_;
};

}  // namespace hairloom::test
