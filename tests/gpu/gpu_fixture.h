// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include "core/gpu/device.h"
#include "shaders/shaders.h"
#include "tests/gpu/test_backend.h"

namespace hairloom::shaders {
std::span<const Shader> table_test_gpu();  // NOLINT(readability-identifier-naming)
}

namespace hairloom::gpu {

/// A device with validation; any message of the layers fails the test.
class GpuTest : public testing::Test {
  protected:
    void SetUp() override {
        auto result = createDevice(testDevice());
        ASSERT_TRUE(result) << result.error().message();
        device = std::move(*result);
    }
    void TearDown() override {
        if (device == nullptr) return;
        for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
    }

    ShaderPtr shader(std::string_view name, ShaderStage stage) {
        for (const shaders::Shader& s : shaders::table_test_gpu()) {
            if (s.name == name)
                return device->createShader({std::string(name), stage, std::as_bytes(s.spirv), s.dxbc})
                    .value();
        }
        ADD_FAILURE() << "no shader " << name;
        return nullptr;
    }
    template <class T>
    BufferPtr buffer(const std::vector<T>& content,
                     Usage usage = Usage::ShaderRead | Usage::UnorderedAccess) {
        BufferDesc desc;
        desc.name = "test";
        desc.size = content.size() * sizeof(T);
        desc.elementBytes = sizeof(T);
        desc.usage = usage;
        return device->createBuffer(desc, std::as_bytes(std::span(content))).value();
    }
    template <class T>
    std::vector<T> read(const BufferPtr& source) {
        std::vector<T> result(source->desc().size / sizeof(T));
        const auto status = device->readBuffer(source, 0, std::as_writable_bytes(std::span(result)));
        EXPECT_TRUE(status) << status.error().message();
        return result;
    }
    template <class T>
    std::vector<T> read(const TexturePtr& source) {
        const TextureDesc& d = source->desc();
        std::vector<T> result(std::size_t{d.width} * d.height * bytesPerTexel(d.format) / sizeof(T));
        const auto status = device->readTexture(source, std::as_writable_bytes(std::span(result)));
        EXPECT_TRUE(status) << status.error().message();
        return result;
    }
    /// The message of the error that submitting gives; empty on success.
    std::string submitError(const std::function<void(CommandList&)>& record) {
        auto list = device->createCommandList();
        if (!list) return list.error().message();
        record(**list);
        const auto submission = device->submit(std::move(*list));
        if (!submission) return submission.error().message();
        const auto status = (*submission)->wait();
        return status ? "" : status.error().message();
    }

    std::unique_ptr<Device> device;
};

}  // namespace hairloom::gpu
