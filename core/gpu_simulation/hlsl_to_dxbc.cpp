// SPDX-License-Identifier: GPL-3.0-or-later
#include <windows.h>
// windows.h first.
#include <d3dcompiler.h>
#include <fmt/format.h>

#include <cstring>

#include "core/gpu_simulation/hlsl_targets.h"

namespace hairloom::gpu_simulation {
namespace {

// COM's interfaces have no virtual destructor.
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"
#endif
/// Sources are known by their file's name.
class Includer final : public ID3DInclude {
  public:
    HRESULT STDMETHODCALLTYPE Open(D3D_INCLUDE_TYPE, LPCSTR name, LPCVOID, LPCVOID* data,
                                   UINT* size) override {
        const shaders::Source* source = findSource(name);
        if (source == nullptr) return E_FAIL;
        *data = source->text.data();
        *size = static_cast<UINT>(source->text.size());
        return S_OK;
    }
    HRESULT STDMETHODCALLTYPE Close(LPCVOID) override { return S_OK; }
};
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

pD3DCompile findCompiler() {
    HMODULE library = LoadLibraryW(L"d3dcompiler_47.dll");
    const FARPROC found = library == nullptr ? nullptr : GetProcAddress(library, "D3DCompile");
    pD3DCompile compile = nullptr;
    std::memcpy(&compile, &found, sizeof(compile));
    return compile;
}

std::string_view bytesIn(ID3DBlob* blob) {
    if (blob == nullptr) return {};
    return {static_cast<const char*>(blob->GetBufferPointer()), blob->GetBufferSize()};
}

void release(ID3DBlob* blob) {
    if (blob != nullptr) blob->Release();
}

}  // namespace

Result<std::vector<std::uint32_t>> compileToDxbc(const std::string& path, const std::string& text) {
    static const pD3DCompile kCompile = findCompiler();
    if (kCompile == nullptr) return fail("no Direct3D shader compiler on this machine", "d3dcompiler_47.dll");
    Includer includer;
    ID3DBlob* code = nullptr;
    ID3DBlob* messages = nullptr;
    // Sums are taken in the order that is written, as on the CPU.
    constexpr UINT kFlags = D3DCOMPILE_OPTIMIZATION_LEVEL3 | D3DCOMPILE_IEEE_STRICTNESS;
    const D3D_SHADER_MACRO macros[] = {{"HAIRLOOM_DXBC", "1"}, {nullptr, nullptr}};
    const HRESULT r = kCompile(text.data(), text.size(), path.c_str(), macros, &includer, "main", "cs_5_0",
                               kFlags, 0, &code, &messages);
    const std::string_view bytes = bytesIn(code);
    const std::string said(bytesIn(messages));
    std::vector<std::uint32_t> words(bytes.size() / 4);
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
    release(code);
    release(messages);
    if (FAILED(r) || words.empty()) return fail(fmt::format("shader '{}' does not compile: {}", path, said));
    return words;
}

}  // namespace hairloom::gpu_simulation
