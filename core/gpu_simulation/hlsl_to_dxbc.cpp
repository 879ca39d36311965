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

struct Compiler {
    pD3DCompile compile = nullptr;
    pD3DDisassemble disassemble = nullptr;
};

Compiler findCompiler() {
    HMODULE library = LoadLibraryW(L"d3dcompiler_47.dll");
    const auto find = [library]<class F>(const char* name, F& function) {
        const FARPROC found = library == nullptr ? nullptr : GetProcAddress(library, name);
        std::memcpy(&function, &found, sizeof(function));
    };
    Compiler compiler;
    find("D3DCompile", compiler.compile);
    find("D3DDisassemble", compiler.disassemble);
    return compiler;
}

std::string_view bytesIn(ID3DBlob* blob) {
    if (blob == nullptr) return {};
    return {static_cast<const char*>(blob->GetBufferPointer()), blob->GetBufferSize()};
}

void release(ID3DBlob* blob) {
    if (blob != nullptr) blob->Release();
}

/// Whether a kernel asks an atomic operation what was there before.
bool readsAtomics(const Compiler& compiler, std::string_view code) {
    if (compiler.disassemble == nullptr) return false;
    ID3DBlob* listing = nullptr;
    compiler.disassemble(code.data(), code.size(), 0, nullptr, &listing);
    const bool reads = bytesIn(listing).find("imm_atomic_") != std::string_view::npos;
    release(listing);
    return reads;
}

}  // namespace

Result<std::vector<std::uint32_t>> compileToDxbc(const std::string& path, const std::string& text) {
    static const Compiler kCompiler = findCompiler();
    if (kCompiler.compile == nullptr)
        return fail("no Direct3D shader compiler on this machine", "d3dcompiler_47.dll");
    Includer includer;
    const D3D_SHADER_MACRO macros[] = {{"HAIRLOOM_DXBC", "1"}, {nullptr, nullptr}};
    std::vector<std::uint32_t> words;
    std::string said;
    bool readsBack = false;
    const auto compile = [&](UINT flags) {
        ID3DBlob* code = nullptr;
        ID3DBlob* messages = nullptr;
        const HRESULT r = kCompiler.compile(text.data(), text.size(), path.c_str(), macros, &includer, "main",
                                            "cs_5_0", flags, 0, &code, &messages);
        const std::string_view bytes = FAILED(r) ? std::string_view() : bytesIn(code);
        said = bytesIn(messages);
        words.resize(bytes.size() / 4);
        if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
        readsBack = !words.empty() && readsAtomics(kCompiler, bytes);
        release(code);
        release(messages);
    };
    // Sums are taken in the order that is written, as on the CPU. Asked for that, Wine's OpenGL renderer
    // makes no valid GLSL of atomic operations that are asked what was there before
    // (packaging/windows/hlslc.cpp).
    compile(D3DCOMPILE_OPTIMIZATION_LEVEL3 | D3DCOMPILE_IEEE_STRICTNESS);
    if (readsBack) compile(D3DCOMPILE_OPTIMIZATION_LEVEL3);
    if (words.empty()) return fail(fmt::format("shader '{}' does not compile: {}", path, said));
    return words;
}

}  // namespace hairloom::gpu_simulation
