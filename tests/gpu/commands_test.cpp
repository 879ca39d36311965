// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <numeric>

#include "tests/gpu/gpu_fixture.h"

namespace hairloom::gpu {
namespace {

using testing::HasSubstr;

struct Parameters {
    std::uint32_t count, added, unused0 = 0, unused1 = 0;
};

class ComputeTest : public GpuTest {
  protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(GpuTest::SetUp());
        pipeline =
            device->createComputePipeline({"double", shader("double.comp", ShaderStage::Compute)}).value();
    }
    void bind(CommandList& list, const BufferPtr& in, const BufferPtr& out) {
        const Binding bindings[] = {Binding::read(0, in), Binding::write(0, out)};
        list.bind(bindings);
    }
    ComputePipelinePtr pipeline;
};

TEST_F(ComputeTest, AgreesWithTheCpu) {
    std::vector<std::uint32_t> content(1000);
    std::iota(content.begin(), content.end(), 5u);
    const BufferPtr in = buffer(content);
    const BufferPtr out = buffer(std::vector<std::uint32_t>(1000, 0u));
    EXPECT_EQ(submitError([&](CommandList& list) {
                  list.beginPass({"double", {}, {}});
                  list.setPipeline(pipeline);
                  list.setConstants(0, bytesOf(Parameters{1000, 3}));
                  bind(list, in, out);
                  list.dispatch(16);
                  list.endPass();
              }),
              "");
    for (auto& value : content) value = 2 * value + 3;
    EXPECT_EQ(read<std::uint32_t>(out), content);
}

// Each dispatch reads what the one before wrote, and overwrites what that one read.
TEST_F(ComputeTest, DispatchesSeeEachOther) {
    const std::vector<std::uint32_t> zeros(256, 0u);
    const BufferPtr a = buffer(zeros);
    const BufferPtr b = buffer(zeros);
    EXPECT_EQ(submitError([&](CommandList& list) {
                  list.beginPass({"chain", {}, {}});
                  list.setPipeline(pipeline);
                  list.setConstants(0, bytesOf(Parameters{256, 1}));
                  for (int i = 0; i < 20; ++i) {
                      bind(list, i % 2 == 0 ? a : b, i % 2 == 0 ? b : a);
                      list.dispatch(4);
                  }
                  list.endPass();
                  list.updateBuffer(b, 0, std::as_bytes(std::span(zeros)));
                  list.copyBuffer(a, 0, b, 512, 512);
              }),
              "");
    EXPECT_THAT(read<std::uint32_t>(a), testing::Each((1u << 20u) - 1u));
    const auto copied = read<std::uint32_t>(b);
    EXPECT_EQ(copied[127], 0u);
    EXPECT_EQ(copied[128], (1u << 20u) - 1u);
}

TEST_F(ComputeTest, SamplersFilterAndTypedBuffersTakeFloats) {
    TextureDesc desc;
    desc.name = "four texels";
    desc.width = desc.height = 2;
    desc.format = Format::Rgba32Float;
    const std::vector<float> texels = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    const TexturePtr texture = device->createTexture(desc, std::as_bytes(std::span(texels))).value();
    BufferDesc typed;
    typed.name = "typed";
    typed.size = 48;
    typed.usage = Usage::UnorderedAccess;
    typed.typedFormat = Format::Rgba32Float;
    const BufferPtr out = device->createBuffer(typed).value();
    const auto sampling =
        device->createComputePipeline({"sample", shader("sample.comp", ShaderStage::Compute)}).value();
    const SamplerPtr sampler = device->createSampler({Filter::Linear, AddressMode::Border, true}).value();
    EXPECT_EQ(submitError([&](CommandList& list) {
                  list.beginPass({"sample", {}, {}});
                  list.setPipeline(sampling);
                  const Binding bindings[] = {Binding::read(0, texture), Binding::sample(0, sampler),
                                              Binding::write(0, out)};
                  list.bind(bindings);
                  list.dispatch(1);
                  list.endPass();
              }),
              "");
    EXPECT_THAT(read<float>(out), testing::ElementsAre(3, 4, 5, 6, 9, 10, 11, 12, 1, 1, 1, 1));
}

TEST_F(ComputeTest, IndirectArgumentsCountGroups) {
    const BufferPtr in = buffer(std::vector<std::uint32_t>(256, 1u));
    const BufferPtr out = buffer(std::vector<std::uint32_t>(256, 0u));
    const BufferPtr arguments = buffer(std::vector<std::uint32_t>{9, 2, 1, 1}, Usage::Indirect);
    EXPECT_EQ(submitError([&](CommandList& list) {
                  list.beginPass({"indirect", {}, {}});
                  list.setPipeline(pipeline);
                  list.setConstants(0, bytesOf(Parameters{256, 0}));
                  bind(list, in, out);
                  list.dispatchIndirect(arguments, 4);
                  list.endPass();
              }),
              "");
    const auto result = read<std::uint32_t>(out);
    EXPECT_EQ(result[127], 2u);
    EXPECT_EQ(result[128], 0u);
}

TEST_F(ComputeTest, ReleasedResourcesLiveUntilTheDeviceIsDone) {
    BufferPtr in = buffer(std::vector<std::uint32_t>(1u << 20u, 1u));
    BufferPtr out = buffer(std::vector<std::uint32_t>(1u << 20u, 0u));
    auto list = device->createCommandList().value();
    list->beginPass({"double", {}, {}});
    list->setPipeline(pipeline);
    list->setConstants(0, bytesOf(Parameters{1u << 20u, 0}));
    bind(*list, in, out);
    list->dispatch(1u << 14u);
    list->endPass();
    in.reset();
    out.reset();
    pipeline.reset();
    const auto submission = device->submit(std::move(list));
    ASSERT_TRUE(submission);
    EXPECT_TRUE((*submission)->wait());
    EXPECT_TRUE((*submission)->isDone());
}

TEST_F(ComputeTest, PassesHaveTimes) {
    const BufferPtr in = buffer(std::vector<std::uint32_t>(1u << 20u, 1u));
    const BufferPtr out = buffer(std::vector<std::uint32_t>(1u << 20u, 0u));
    auto list = device->createCommandList().value();
    for (const char* name : {"first", "second"}) {
        list->beginPass({name, {}, {}});
        list->setPipeline(pipeline);
        list->setConstants(0, bytesOf(Parameters{1u << 20u, 0}));
        bind(*list, in, out);
        list->dispatch(1u << 14u);
        list->endPass();
    }
    const auto times = device->submit(std::move(list)).value()->passTimes();
    ASSERT_TRUE(times);
    ASSERT_EQ(times->size(), 2u);
    EXPECT_EQ((*times)[0].name, "first");
    EXPECT_EQ((*times)[1].name, "second");
    for (const PassTime& time : *times) {
        EXPECT_GT(time.milliseconds, 0);
        EXPECT_LT(time.milliseconds, 60000);
    }
}

TEST_F(ComputeTest, AbandonedListsLeaveNoTrace) {
    const BufferPtr in = buffer(std::vector<std::uint32_t>(64, 21u));
    const BufferPtr out = buffer(std::vector<std::uint32_t>(64, 0u));
    const auto record = [&](CommandList& list) {
        list.beginPass({"double", {}, {}});
        list.setPipeline(pipeline);
        list.setConstants(0, bytesOf(Parameters{64, 0}));
        bind(list, in, out);
        list.dispatch(1);
        list.endPass();
    };
    {
        auto list = device->createCommandList().value();
        record(*list);
    }
    EXPECT_THAT(read<std::uint32_t>(out), testing::Each(0u));
    EXPECT_EQ(submitError(record), "");
    EXPECT_THAT(read<std::uint32_t>(out), testing::Each(42u));
}

TEST_F(ComputeTest, WrongUseIsNamed) {
    const BufferPtr some = buffer(std::vector<std::uint32_t>(64, 0u));
    EXPECT_THAT(submitError([&](CommandList& list) { list.dispatch(1); }),
                HasSubstr("outside a compute pass"));
    EXPECT_THAT(submitError([&](CommandList& list) {
                    list.beginPass({"lonely", {}, {}});
                    list.setPipeline(pipeline);
                    list.setConstants(0, bytesOf(Parameters{64, 0}));
                    const Binding in = Binding::read(0, some);
                    list.bind({&in, 1});
                    list.dispatch(1);
                    list.endPass();
                }),
                testing::AllOf(HasSubstr("lonely"), HasSubstr("u0"), HasSubstr("not bound")));
    EXPECT_THAT(submitError([&](CommandList& list) {
                    list.copyBuffer(some, 0, buffer(std::vector<std::uint32_t>(4)), 0, 32);
                }),
                HasSubstr("outside buffer 'test'"));
    EXPECT_THAT(submitError([&](CommandList& list) {
                    list.beginPass({"open", {}, {}});
                }),
                HasSubstr("not ended"));
    const std::uint64_t past = 250;
    EXPECT_THAT(submitError([&](CommandList& list) {
                    list.updateBuffer(some, past, bytesOf(Parameters{1, 1}));
                }),
                HasSubstr("outside"));
    std::vector<std::byte> target(300);
    EXPECT_FALSE(device->readBuffer(some, 0, target));
    EXPECT_FALSE(device->readMapped(some, 0, std::span(target).first(4)));
}

}  // namespace
}  // namespace hairloom::gpu
