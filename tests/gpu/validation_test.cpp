// SPDX-License-Identifier: GPL-3.0-or-later
// Each mistake that the validation device names, made once; and what it records.
#include "core/gpu/validation.h"

#include <gmock/gmock.h>

#include <thread>

#include "tests/gpu/gpu_fixture.h"

namespace hairloom::gpu {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class ValidationTest : public GpuTest {
  protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(GpuTest::SetUp());
        watch = validationOf(*device);
        ASSERT_NE(watch, nullptr);
        doubling =
            device->createComputePipeline({"double", shader("double.comp", ShaderStage::Compute)}).value();
    }
    BufferPtr named(const std::string& name, bool written, Usage usage,
                    MemoryKind memory = MemoryKind::Device) {
        BufferDesc desc;
        desc.name = name;
        desc.size = 256;
        desc.elementBytes = memory == MemoryKind::Device ? 4 : 0;
        desc.usage = usage;
        desc.memory = memory;
        const std::vector<std::byte> zeros(written ? desc.size : 0);
        return device->createBuffer(desc, zeros).value();
    }
    TexturePtr target(const std::string& name, Format format = Format::Rgba32Float) {
        TextureDesc desc;
        desc.name = name;
        desc.width = desc.height = 8;
        desc.format = format;
        desc.usage = Usage::RenderTarget | Usage::ShaderRead;
        return device->createTexture(desc).value();
    }
    void dispatch(CommandList& list, const BufferPtr& in, const BufferPtr& out) {
        constexpr std::array<std::uint32_t, 4> kParameters{64, 1, 0, 0};
        const Binding bindings[] = {Binding::read(0, in), Binding::write(0, out)};
        list.beginPass({"work", {}, {}});
        list.setPipeline(doubling);
        list.setConstants(0, bytesOf(kParameters));
        list.bind(bindings);
        list.dispatch(1);
        list.endPass();
    }
    GraphicsPipelinePtr triangle() {
        GraphicsPipelineDesc desc;
        desc.name = "triangle";
        desc.vertex = shader("triangle.vert", ShaderStage::Vertex);
        desc.pixel = shader("triangle.frag", ShaderStage::Pixel);
        desc.attributes = {VertexAttribute{}};
        desc.vertexStride = 12;
        desc.colourFormats = {Format::Rgba32Float};
        desc.blend = {BlendDesc{}};
        return device->createGraphicsPipeline(desc).value();
    }

    static constexpr Usage kBoth = Usage::ShaderRead | Usage::UnorderedAccess;
    ValidationDevice* watch = nullptr;
    ComputePipelinePtr doubling;
};

TEST_F(ValidationTest, ReadingWhatNothingHasWritten) {
    const BufferPtr empty = named("empty", false, kBoth), out = named("out", false, kBoth);
    EXPECT_THAT(submitError([&](CommandList& list) { dispatch(list, empty, out); }),
                AllOf(HasSubstr("pass 'work'"), HasSubstr("'empty'"), HasSubstr("nothing has written")));
    EXPECT_EQ(submitError([&](CommandList& list) {
                  dispatch(list, named("given", true, kBoth), empty);
                  dispatch(list, empty, out);
              }),
              "");
}

TEST_F(ValidationTest, AbandonedListsHaveWrittenNothing) {
    const BufferPtr given = named("given", true, kBoth), out = named("out", false, kBoth);
    {
        auto list = device->createCommandList();
        dispatch(**list, given, out);
    }
    EXPECT_THAT(submitError([&](CommandList& list) { dispatch(list, out, given); }), HasSubstr("'out'"));
    std::vector<std::byte> bytes(256);
    EXPECT_FALSE(device->readBuffer(out, 0, bytes));
}

TEST_F(ValidationTest, ReadingWhatIsWritten) {
    const BufferPtr given = named("given", true, kBoth);
    EXPECT_THAT(submitError([&](CommandList& list) { dispatch(list, given, given); }),
                AllOf(HasSubstr("pass 'work'"), HasSubstr("pipeline 'double'"), HasSubstr("'given'"),
                      HasSubstr("while it is written")));
}

TEST_F(ValidationTest, UnboundRegistersArePassedOn) {
    EXPECT_THAT(submitError([&](CommandList& list) {
                    list.beginPass({"work", {}, {}});
                    list.setPipeline(doubling);
                    list.dispatch(1);
                    list.endPass();
                }),
                AllOf(HasSubstr("pass 'work'"), HasSubstr("'double'"), HasSubstr("not bound")));
}

TEST_F(ValidationTest, LoadingATargetWithoutContent) {
    const TexturePtr picture = target("picture");
    const auto pass = [&](LoadOp load) {
        return submitError([&](CommandList& list) {
            list.beginPass({"paint", {{picture, load, {}, {}}}, {}});
            list.endPass();
        });
    };
    EXPECT_THAT(pass(LoadOp::Load), AllOf(HasSubstr("pass 'paint'"), HasSubstr("'picture'")));
    EXPECT_EQ(pass(LoadOp::Clear), "");
    EXPECT_EQ(pass(LoadOp::Load), "");
}

TEST_F(ValidationTest, VerticesAndIndicesBeyondTheirBuffer) {
    const TexturePtr picture = target("picture");
    const GraphicsPipelinePtr pipeline = triangle();
    const BufferPtr corners = buffer(std::vector<float>(9, 0.0f), Usage::Vertex);
    const BufferPtr indices = buffer(std::vector<std::uint32_t>{0, 1, 2}, Usage::Index);
    const auto draw = [&](std::uint32_t vertices, std::uint32_t count) {
        return submitError([&](CommandList& list) {
            list.beginPass({"paint", {{picture, LoadOp::Clear, {}, {}}}, {}});
            list.setPipeline(pipeline);
            list.setVertexBuffer(corners, 0);
            list.setIndexBuffer(indices, 0);
            if (vertices > 0) list.draw(vertices);
            if (count > 0) list.drawIndexed(count);
            list.endPass();
        });
    };
    EXPECT_EQ(draw(3, 3), "");
    EXPECT_THAT(draw(4, 0), AllOf(HasSubstr("pass 'paint'"), HasSubstr("48"), HasSubstr("36")));
    EXPECT_THAT(draw(0, 4), AllOf(HasSubstr("indices"), HasSubstr("16"), HasSubstr("12")));
}

TEST_F(ValidationTest, ReadBackBeforeTheCopyIsDone) {
    const BufferPtr given = named("given", true, kBoth);
    const BufferPtr back = named("back", false, Usage::None, MemoryKind::ReadBack);
    std::vector<std::byte> bytes(256);
    EXPECT_FALSE(device->readMapped(back, 0, bytes));
    auto list = device->createCommandList();
    (*list)->copyBuffer(given, 0, back, 0, 256);
    const auto submission = device->submit(std::move(*list));
    ASSERT_TRUE(submission);
    const auto early = device->readMapped(back, 0, bytes);
    // The device may be quick; only an error has to be the right one.
    if (!early) {
        EXPECT_THAT(early.error().message(), HasSubstr("'back'"));
    }
    ASSERT_TRUE((*submission)->wait());
    EXPECT_TRUE(device->readMapped(back, 0, bytes));
}

TEST_F(ValidationTest, RecordsWhatRanAndWhatLives) {
    const BufferPtr in = named("in", true, kBoth);
    {
        const BufferPtr out = named("out", false, kBoth);
        EXPECT_EQ(submitError([&](CommandList& list) { dispatch(list, in, out); }), "");
        EXPECT_EQ(watch->living().size(), 2u);
    }
    ASSERT_EQ(watch->record().size(), 1u);
    const RecordedWork& work = watch->record().front();
    EXPECT_EQ(work.kind, RecordedWork::Kind::Dispatch);
    EXPECT_EQ(work.pass, "work");
    EXPECT_EQ(work.pipeline, "double");
    EXPECT_THAT(work.reads, ElementsAre(HasSubstr("'in'")));
    EXPECT_THAT(work.writes, ElementsAre(HasSubstr("'out'")));
    watch->clearRecord();
    EXPECT_TRUE(watch->record().empty());
    // A later list makes the device let go of what the earlier one held.
    EXPECT_EQ(submitError([](CommandList&) {}), "");
    const auto living = watch->living();
    ASSERT_EQ(living.size(), 1u);
    EXPECT_EQ(living.front().name, "in");
    EXPECT_EQ(living.front().bytes, 256u);
}

/// Shaders and compute pipelines may be made on another thread; what counts creations counts those too.
TEST_F(ValidationTest, CreationsOfTwoThreadsAreCountedTogether) {
    constexpr int kEach = 200;
    const ShaderPtr code = shader("double.comp", ShaderStage::Compute);
    watch->failCreation(kEach);
    int failedThere = 0, failedHere = 0;
    std::thread other([&] {
        for (int i = 0; i < kEach; ++i) failedThere += device->createComputePipeline({"other", code}) ? 0 : 1;
    });
    BufferDesc desc;
    desc.name = "here";
    desc.size = 16;
    for (int i = 0; i < kEach; ++i) failedHere += device->createBuffer(desc) ? 0 : 1;
    other.join();
    EXPECT_EQ(failedThere + failedHere, 1);
    EXPECT_TRUE(device->createBuffer(desc));
}

TEST_F(ValidationTest, FaultsComeOnceOrForGood) {
    watch->failCreation(1);
    EXPECT_NE(named("first", true, kBoth), nullptr);
    BufferDesc desc;
    desc.name = "second";
    desc.size = 16;
    const auto second = device->createBuffer(desc);
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message(), AllOf(HasSubstr("'second'"), HasSubstr("memory")));
    EXPECT_TRUE(device->createBuffer(desc));
    watch->loseDevice(1);
    EXPECT_EQ(submitError([](CommandList&) {}), "");
    EXPECT_THAT(submitError([](CommandList&) {}), HasSubstr("lost"));
    EXPECT_THAT(submitError([](CommandList&) {}), HasSubstr("lost"));
    EXPECT_FALSE(device->createBuffer(desc));
}

}  // namespace
}  // namespace hairloom::gpu
