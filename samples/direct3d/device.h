// SPDX-License-Identifier: MIT
#pragma once
// A Direct3D 11 device without a window, its buffers and its shaders: nothing of hair.

#include <windows.h>
// windows.h first.
#include <d3d11.h>
#include <d3dcompiler.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "../gpu_host.h"

constexpr DXGI_FORMAT kColour = DXGI_FORMAT_R8G8B8A8_UNORM_SRGB, kDepth = DXGI_FORMAT_D32_FLOAT;

inline void check(HRESULT result, const std::string& what) {
    char number[16];
    std::snprintf(number, sizeof number, "0x%08lx", static_cast<unsigned long>(result));
    if (FAILED(result)) fail(what + ": HRESULT " + number);
}

/// What a shader finds in a register: constants, an array that it reads, one that it writes.
enum class Use { constants, array };

struct Buffer {
    ID3D11Buffer* handle;
    ID3D11ShaderResourceView* read;      ///< null of constants
    ID3D11UnorderedAccessView* written;  ///< likewise
    std::size_t bytes;
};

/// A device without a window. What it makes lives as long as the program.
struct Gpu {
    ID3D11Device* device = nullptr;
    ID3D11DeviceContext* context = nullptr;

    Gpu() {
        const D3D_FEATURE_LEVEL wanted = D3D_FEATURE_LEVEL_11_0;
        // Microsoft's software device, where there is no GPU.
        for (const D3D_DRIVER_TYPE type : {D3D_DRIVER_TYPE_HARDWARE, D3D_DRIVER_TYPE_WARP}) {
            if (SUCCEEDED(D3D11CreateDevice(nullptr, type, nullptr, 0, &wanted, 1, D3D11_SDK_VERSION, &device,
                                            nullptr, &context)))
                return;
        }
        fail("no Direct3D device of feature level 11.0");
    }

    /// `element`: bytes from one to the next.
    Buffer buffer(std::size_t bytes, std::uint32_t element, Use use) const {
        Buffer made{nullptr, nullptr, nullptr, bytes};
        D3D11_BUFFER_DESC info{};
        info.ByteWidth = static_cast<UINT>(std::max<std::size_t>(bytes, element));
        info.BindFlags = use == Use::constants ? D3D11_BIND_CONSTANT_BUFFER
                                               : D3D11_BIND_SHADER_RESOURCE | D3D11_BIND_UNORDERED_ACCESS;
        if (use == Use::array) {
            info.MiscFlags = D3D11_RESOURCE_MISC_BUFFER_STRUCTURED;
            info.StructureByteStride = element;
        }
        check(device->CreateBuffer(&info, nullptr, &made.handle), "CreateBuffer");
        if (use == Use::constants) return made;
        check(device->CreateShaderResourceView(made.handle, nullptr, &made.read), "CreateShaderResourceView");
        check(device->CreateUnorderedAccessView(made.handle, nullptr, &made.written),
              "CreateUnorderedAccessView");
        return made;
    }
    void fill(const Buffer& buffer, const void* data) const {
        if (buffer.bytes > 0) context->UpdateSubresource(buffer.handle, 0, nullptr, data, 0, 0);
    }
    /// Waits for the GPU.
    std::vector<float> readBack(const Buffer& buffer) const {
        D3D11_BUFFER_DESC info{};
        info.ByteWidth = static_cast<UINT>(buffer.bytes);
        info.Usage = D3D11_USAGE_STAGING;
        info.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
        ID3D11Buffer* staging = nullptr;
        check(device->CreateBuffer(&info, nullptr, &staging), "CreateBuffer");
        context->CopyResource(staging, buffer.handle);
        D3D11_MAPPED_SUBRESOURCE mapped;
        check(context->Map(staging, 0, D3D11_MAP_READ, 0, &mapped), "Map");
        std::vector<float> values(buffer.bytes / sizeof(float));
        std::memcpy(values.data(), mapped.pData, values.size() * sizeof(float));
        context->Unmap(staging, 0);
        staging->Release();
        return values;
    }

    ID3D11Texture2D* texture(DXGI_FORMAT format, D3D11_USAGE usage, UINT bind, UINT access) const {
        D3D11_TEXTURE2D_DESC info{};
        info.Width = kWidth;
        info.Height = kHeight;
        info.MipLevels = info.ArraySize = 1;
        info.Format = format;
        info.SampleDesc.Count = 1;
        info.Usage = usage;
        info.BindFlags = bind;
        info.CPUAccessFlags = access;
        ID3D11Texture2D* made = nullptr;
        check(device->CreateTexture2D(&info, nullptr, &made), "CreateTexture2D");
        return made;
    }

    /// Of a file of share/hairloom-runtime/shaders, as it is installed. A game compiles once, by fxc or by
    /// these lines, and ships the bytes: the strict order of sums takes Microsoft's compiler some seconds.
    ID3DBlob* compiled(const std::string& file, const char* profile) const {
        std::wstring wide(file.size() + 1, L'\0');
        wide.resize(static_cast<std::size_t>(MultiByteToWideChar(CP_ACP, 0, file.c_str(),
                                                                 static_cast<int>(file.size()), wide.data(),
                                                                 static_cast<int>(wide.size()))));
        // Kernels take sums in the order that is written, as the CPU does.
        const D3D_SHADER_MACRO macros[] = {{"HAIRLOOM_DXBC", "1"}, {nullptr, nullptr}};
        const UINT flags = D3DCOMPILE_OPTIMIZATION_LEVEL3 | D3DCOMPILE_ENABLE_STRICTNESS |
                           (profile[0] == 'c' ? D3DCOMPILE_IEEE_STRICTNESS : 0u);
        ID3DBlob *code = nullptr, *messages = nullptr;
        const HRESULT result = D3DCompileFromFile(wide.c_str(), macros, D3D_COMPILE_STANDARD_FILE_INCLUDE,
                                                  "main", profile, flags, 0, &code, &messages);
        if (messages) std::fprintf(stderr, "%s", static_cast<const char*>(messages->GetBufferPointer()));
        check(result, file);
        return code;
    }
};
