// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/render/light_probe.h"
#include "core/render/passes.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {

/// Runs the passes up to the shadow maps and asks the shader what light does at given places.
class LightTest : public RenderTest {
  protected:
    std::vector<shaders::LightAnswer> light(const RenderScene& scene, const RenderOptions& options,
                                            const std::vector<shaders::LightCase>& cases) {
        auto results = probeLight(*device, scene, options, cases);
        EXPECT_TRUE(results) << (results ? "" : results.error().message());
        return results ? std::move(*results) : std::vector<shaders::LightAnswer>(cases.size());
    }
};

}  // namespace hairloom::render
