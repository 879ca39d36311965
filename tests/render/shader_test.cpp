// SPDX-License-Identifier: GPL-3.0-or-later
// The shaders' functions and layouts against C++.
#include "core/render/fibre_tables.h"
#include "core/render/game_fibre.h"
#include "core/render/passes.h"
#include "core/shading/kajiya_kay.h"
#include "core/shading/melanin.h"
#include "core/shading/tables.h"
#include "runtime/shaders/hair_types.h"
#include "shaders/shaders.h"
#include "shaders/shared/render_types.h"
#include "tests/render/render_fixture.h"

namespace hairloom::shaders {
std::span<const Shader> table_test_render();  // NOLINT(readability-identifier-naming)
}

namespace hairloom::render {
namespace {

class ShaderTest : public RenderTest {
  protected:
    template <class T>
    gpu::BufferPtr buffer(const std::vector<T>& content) {
        gpu::BufferDesc desc;
        desc.name = "test";
        desc.size = content.size() * sizeof(T);
        desc.elementBytes = sizeof(T);
        desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
        return device->createBuffer(desc, std::as_bytes(std::span(content))).value();
    }
    std::vector<shaders::float4> run(const char* name, std::size_t results, std::uint32_t groups,
                                     std::vector<gpu::Binding> bindings, std::span<const std::byte> constants,
                                     const FibreTables* fibre = nullptr,
                                     std::span<const std::byte> look = {}) {
        const auto table = shaders::table_test_render();
        const auto shader = std::ranges::find(table, name, &shaders::Shader::name);
        auto module =
            device
                ->createShader({name, gpu::ShaderStage::Compute, std::as_bytes(shader->spirv), shader->dxbc})
                .value();
        auto pipeline = device->createComputePipeline({name, module}).value();
        std::vector<shaders::float4> result(results);
        const gpu::BufferPtr out = buffer(result);
        bindings.push_back(gpu::Binding::write(0, out));
        auto list = device->createCommandList().value();
        list->beginPass({name, {}, {}});
        list->setPipeline(pipeline);
        list->bind(bindings);
        if (!constants.empty()) list->setConstants(0, constants);
        if (fibre != nullptr) fibre->bind(*list);
        if (!look.empty()) list->setConstants(2, look);
        list->dispatch(groups);
        list->endPass();
        const auto submission = device->submit(std::move(list));
        EXPECT_TRUE(submission) << submission.error().message();
        EXPECT_TRUE(device->readBuffer(out, 0, std::as_writable_bytes(std::span(result))));
        return result;
    }
};

Vec3d randomUnit(Random& random) {
    Vec3d v;
    do {
        v = Vec3d(random.uniformDouble(), random.uniformDouble(), random.uniformDouble()) * 2 - Vec3d::Ones();
    } while (v.norm() > 1 || v.norm() < 0.1);
    return v.normalized();
}

shaders::float4 toFloat4(const Vec3d& v, double w) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
            static_cast<float>(w)};
}

TEST_F(ShaderTest, KajiyaKayAgreesWithTheReference) {
    constexpr std::uint32_t kCases = 4096;
    Random random(5);
    std::vector<shaders::KajiyaCase> cases;
    std::vector<std::array<double, 2>> expected;
    for (std::uint32_t i = 0; i < kCases; ++i) {
        const Vec3d tangent = randomUnit(random), toLight = randomUnit(random), toView = randomUnit(random);
        const double exponent = i % 7 == 0 ? 0 : std::exp2(10 * random.uniformDouble());
        const double normalisation = 1 / shading::kajiyaReflectance(exponent);
        cases.push_back({toFloat4(tangent, 0), toFloat4(toLight, exponent), toFloat4(toView, normalisation)});
        expected.push_back({shading::kajiyaDiffuse(tangent, toLight),
                            shading::kajiyaSpecular(tangent, toLight, toView, exponent) * normalisation});
    }
    const auto result =
        run("kajiya_echo.comp", kCases, kCases / 64, {gpu::Binding::read(0, buffer(cases))}, {});
    for (std::uint32_t i = 0; i < kCases; ++i) {
        ASSERT_NEAR(result[i].x, expected[i][0], 1e-3) << i;
        ASSERT_NEAR(result[i].y, expected[i][1], 2e-3 * (1 + expected[i][1])) << i;
    }
}

const Vec3d kGround(0.5, 0.35, 0.27);

struct FibreCases {
    std::vector<shaders::FibreCase> cases;
    std::vector<shading::FibreAngles> angles;

    explicit FibreCases(std::uint32_t count) {
        constexpr float pigments[] = {1, 0, 0.4f, 2.5f};
        constexpr float lengths[] = {0.3f, 0, 0.04f, 0.1f, 0.02f};
        Random random(12);
        while (cases.size() < count) {
            const Vec3d tangent = randomUnit(random), toLight = randomUnit(random),
                        toView = randomUnit(random);
            const auto here = shading::fibreAngles(tangent, toLight, toView);
            if (std::max(std::abs(here.thetaIn), std::abs(here.thetaOut)) > 1.3) continue;
            const double before = 4 * random.uniformDouble();
            angles.push_back(here);
            cases.push_back(
                {toFloat4(tangent, random.uniformDouble()),
                 toFloat4(toLight, before),
                 toFloat4(toView, before + 4 * random.uniformDouble()),
                 toFloat4(kGround, 0),
                 {random.uniform(), random.uniform(), random.uniform(), random.uniform()},
                 {random.uniform(), random.uniform(), random.uniform(), cases.size() % 3 == 0 ? 1.0f : 0.0f},
                 {pigments[cases.size() % 4], lengths[cases.size() % 5], 0, 0}});
        }
    }
};

FibreMaterial blondFibre(ShadingModel model) {
    shading::MarschnerParameters m;
    m.azimuthal.absorption = shading::absorption({0.3, 0});
    m.azimuthal.width = shading::azimuthalWidth(0.3);
    m.azimuthal.causticWidth = 0;
    FibreMaterial material;
    material.model = model;
    if (model == ShadingModel::marschner) {
        material.marschner = m;
    } else {
        material.sadeghi = shading::sadeghiLike(shading::Marschner(m));
    }
    return material;
}

/// Root mean square of the differences, over that of what is expected.
class RelativeError {
  public:
    void add(const shaders::float4& is, const Vec3d& expected) {
        wrong_ += (Vec3f(is.x, is.y, is.z).cast<double>() - expected).squaredNorm();
        all_ += expected.squaredNorm();
    }
    double value() const { return std::sqrt(wrong_ / all_); }

  private:
    double wrong_ = 0, all_ = 0;
};

TEST_F(ShaderTest, FibreModelsAgreeWithTheReference) {
    constexpr std::uint32_t kCases = 1024;
    const FibreCases given(kCases);
    for (const ShadingModel model : {ShadingModel::marschner, ShadingModel::sadeghi}) {
        const bool isMarschner = model == ShadingModel::marschner;
        const FibreMaterial material = blondFibre(model);
        const auto tables = FibreTables::make(*device, material);
        ASSERT_TRUE(tables) << tables.error().message();
        const auto result = run(isMarschner ? "marschner_echo.comp" : "sadeghi_echo.comp", 2 * kCases,
                                kCases / 64, {gpu::Binding::read(0, buffer(given.cases))}, {}, &*tables);
        const shading::Marschner marschner(material.marschner);
        const shading::DualScattering dual =
            isMarschner ? shading::DualScattering(marschner) : shading::DualScattering(material.sadeghi);
        RelativeError single, multiple;
        for (std::uint32_t i = 0; i < kCases; ++i) {
            const auto& [in, out, phi] = given.angles[i];
            const shaders::FibreCase& c = given.cases[i];
            const Vec3d expected = isMarschner ? marschner(in, out, phi)
                                               : shading::evaluate(material.sadeghi, in, out, phi,
                                                                   static_cast<double>(c.tangent.w));
            single.add(result[2 * i], std::cos(in) * expected);
            multiple.add(result[2 * i + 1],
                         shading::multipleScattering(dual.at(0.5 * std::abs(out - in)), in, out, phi,
                                                     static_cast<double>(c.toLight.w),
                                                     static_cast<double>(c.toView.w), kGround));
        }
        EXPECT_LT(single.value(), 0.01) << isMarschner;
        EXPECT_LT(multiple.value(), 0.02) << isMarschner;
    }
}

/// Blond to brown hair with dark streaks and a red dye.
shading::StrandLook variedLook() {
    shading::StrandLook look;
    look.quantity = shading::LookQuantity::absorption;
    look.root = shading::absorption({1.3, 0.2});
    look.tip = shading::absorption({0.2, 0});
    look.gradient = shading::LinearStep::between(0.2, 0.9);
    look.streakRoot = look.streakTip = shading::absorption({3, 0});
    look.dye = shading::absorptionOfColour(Vec3d(0.5, 0.02, 0.05), 0.3);
    look.dyeAlong = shading::LinearStep::between(0, 0.5);
    look.spread = 0.4;
    look.streakPigment = 1;
    look.regrowth = shading::LinearStep::between(0.02, 0.05);
    look.ownScale = shading::absorptionScale(0.3);
    return look;
}

Vec3d absorptionOf(const shading::StrandLook& look, const shaders::FibreCase& c) {
    const Vec3d own = Vec3f(c.own.x, c.own.y, c.own.z).cast<double>();
    return shading::lookAt(look, {.along = static_cast<double>(c.place.x),
                                  .random = static_cast<double>(c.place.w),
                                  .streak = static_cast<double>(c.place.y),
                                  .dye = static_cast<double>(c.place.z),
                                  .pigment = static_cast<double>(c.strand.x),
                                  .length = static_cast<double>(c.strand.y),
                                  .ownColour = c.own.w > 0 ? &own : nullptr});
}

TEST_F(ShaderTest, HairThatVariesAgreesWithTheReference) {
    constexpr std::uint32_t kCases = 512;
    const FibreCases given(kCases);
    const shading::StrandLook look = variedLook();
    for (const ShadingModel model : {ShadingModel::marschner, ShadingModel::sadeghi}) {
        const bool isMarschner = model == ShadingModel::marschner;
        FibreMaterial material = blondFibre(model);
        material.marschner = blondFibre(ShadingModel::marschner).marschner;
        const auto tables = FibreTables::make(*device, material, true);
        ASSERT_TRUE(tables) << tables.error().message();
        const auto constants = lookConstants(look);
        const auto result =
            run(isMarschner ? "marschner_look_echo.comp" : "sadeghi_look_echo.comp", 2 * kCases, kCases / 64,
                {gpu::Binding::read(0, buffer(given.cases))}, {}, &*tables, gpu::bytesOf(constants));
        const shading::SadeghiLongitudinal longitudinal(
            material.sadeghi,
            shading::withAbsorption(material.sadeghi, material.marschner.azimuthal, Vec3d::Zero()));
        RelativeError single, multiple;
        for (std::uint32_t i = 0; i < kCases; ++i) {
            const auto& [in, out, phi] = given.angles[i];
            const shaders::FibreCase& c = given.cases[i];
            const Vec3d absorption = absorptionOf(look, c);
            ASSERT_NEAR(static_cast<double>(result[2 * i].w), absorption.x(), 1e-3 * (1 + absorption.x()));
            ASSERT_NEAR(static_cast<double>(result[2 * i + 1].w), absorption.y(),
                        1e-3 * (1 + absorption.y()));
            shading::MarschnerParameters fibre = material.marschner;
            fibre.azimuthal.absorption = absorption;
            const shading::Marschner marschner(fibre);
            const auto sadeghi =
                isMarschner
                    ? material.sadeghi
                    : shading::withAbsorption(material.sadeghi, material.marschner.azimuthal, absorption);
            const shading::DualScattering dual = isMarschner ? shading::DualScattering(marschner)
                                                             : shading::DualScattering(sadeghi, longitudinal);
            const Vec3d expected = isMarschner ? marschner(in, out, phi)
                                               : shading::evaluate(longitudinal, sadeghi, in, out, phi,
                                                                   static_cast<double>(c.tangent.w));
            single.add(result[2 * i], std::cos(in) * expected);
            multiple.add(result[2 * i + 1],
                         shading::multipleScattering(dual.at(0.5 * std::abs(out - in)), in, out, phi,
                                                     static_cast<double>(c.toLight.w),
                                                     static_cast<double>(c.toView.w), kGround));
        }
        RecordProperty(isMarschner ? "marschner_single" : "sadeghi_single", std::to_string(single.value()));
        RecordProperty(isMarschner ? "marschner_multiple" : "sadeghi_multiple",
                       std::to_string(multiple.value()));
        EXPECT_LT(single.value(), 0.02) << isMarschner;
        EXPECT_LT(multiple.value(), 0.03) << isMarschner;
    }
}

TEST_F(ShaderTest, FibresOfGamesAgreeWithTheReference) {
    constexpr std::uint32_t kCases = 1024;
    const FibreCases given(kCases);
    const shading::MarschnerParameters fibre = blondFibre(ShadingModel::marschner).marschner;
    const shading::StrandLook look = variedLook();
    const shading::Marschner clear(fibre);
    shaders::HairMaterial material{};
    material.look = lookConstants(look);
    for (const shading::Lobe lobe : shading::kLobes) {
        const shading::LongitudinalLobe& l = clear.longitudinalLobe(lobe);
        const auto put = [&](shaders::float4& to, double value) {
            (&to.x)[shading::index(lobe)] = static_cast<float>(value);
        };
        put(material.tilts, l.tilt());
        put(material.widths, l.width());
        put(material.scales, clear.scale(lobe));
    }
    std::vector<float> tables;
    for (const std::uint16_t half : gameFibreTables(fibre)) {
        Eigen::half value;
        value.x = half;
        tables.push_back(static_cast<float>(value));
    }
    ASSERT_EQ(tables.size(), std::size_t{HAIR_TABLE_FLOATS});
    const auto result =
        run("hair_fibre_echo.comp", 2 * kCases, kCases / 64,
            {gpu::Binding::read(0, buffer(given.cases)), gpu::Binding::read(1, buffer(tables)),
             gpu::Binding::read(2, buffer(std::vector<shaders::HairMaterial>{material}))},
            {});
    RelativeError single, multiple;
    for (std::uint32_t i = 0; i < kCases; ++i) {
        const auto& [in, out, phi] = given.angles[i];
        const shaders::FibreCase& c = given.cases[i];
        const Vec3d absorption = absorptionOf(look, c);
        ASSERT_NEAR(static_cast<double>(result[2 * i].w), absorption.x(), 1e-3 * (1 + absorption.x()));
        shading::MarschnerParameters there = fibre;
        there.azimuthal.absorption = absorption;
        const shading::Marschner marschner(there);
        const shading::DualScattering dual(marschner);
        const auto before = static_cast<double>(c.toLight.w);
        single.add(result[2 * i], std::cos(in) * marschner(in, out, phi));
        shaders::float4 others = result[2 * i + 1];
        const auto passed = static_cast<float>(std::exp(-before));
        others.x -= passed * result[2 * i].x;
        others.y -= passed * result[2 * i].y;
        others.z -= passed * result[2 * i].z;
        multiple.add(others, shading::multipleScattering(dual.at(0.5 * std::abs(out - in)), in, out, phi,
                                                         before, static_cast<double>(c.toView.w), kGround));
    }
    RecordProperty("single", std::to_string(single.value()));
    RecordProperty("multiple", std::to_string(multiple.value()));
    EXPECT_LT(single.value(), 0.02);
    EXPECT_LT(multiple.value(), 0.03);
}

TEST_F(ShaderTest, SharedLayoutsAgree) {
    shaders::ShadeConstants shade{};
    shade.eye_ws = {1, 2, 3, 4};
    shade.primaryExponent = 5;
    shade.diffuse = 6;
    shade.brightnessVariation = 7;
    shade.clumping = 8;
    shade.count = 9;
    shade.lightCount = 10;
    shade.rowThreads = 11;
    shade.subdivisions = 12;
    shade.lights[1].irradiance = {13, 14, 15, 16};
    shade.lights[2].depthRange = 17;
    shade.lights[2].shadows = 18;
    shade.lights[2].nearPlane = 19;
    shade.lights[2].hairBegins = 20;
    for (int i = 0; i < 4; ++i) shade.lights[1].clipFromWorld.m[12 + i] = static_cast<float>(21 + i);
    std::vector<shaders::StrandHeader> strands(2);
    strands[1] = {30, 31, 32, 0.5f, {33, 34, 35, 36}, 37, 0.25f, 0.75f, 0, 38, 39, 0, 0};
    std::vector<shaders::CurvePoint> curve(2);
    curve[1] = {{1, 1, 1, 1}, 40, 0.25f, 41, 0.5f};
    const auto r = run("layout_echo.comp", 9, 1,
                       {gpu::Binding::read(0, buffer(strands)), gpu::Binding::read(1, buffer(curve))},
                       gpu::bytesOf(shade));
    const auto expect = [&](std::size_t i, float x, float y, float z, float w) {
        EXPECT_EQ(r[i].x, x) << i;
        EXPECT_EQ(r[i].y, y) << i;
        EXPECT_EQ(r[i].z, z) << i;
        EXPECT_EQ(r[i].w, w) << i;
    };
    expect(0, 1, 2, 3, 4);
    expect(1, 5, 6, 7, 8);
    expect(2, std::bit_cast<float>(9u), std::bit_cast<float>(10u), std::bit_cast<float>(11u),
           std::bit_cast<float>(12u));
    expect(3, 13, 14, 15, 16);
    expect(4, 17, 18, 19, 20);
    expect(5, 21, 22, 23, 24);
    expect(6, 33, 34, 35, 36);
    expect(7, 0.5f, std::bit_cast<float>(32u), 0.25f, std::bit_cast<float>(41u));
    expect(8, 0.25f, 0.75f, 0.5f, 39);
}

}  // namespace
}  // namespace hairloom::render
