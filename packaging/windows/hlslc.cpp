// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-hlslc SOURCE PROFILE TOP KERNELS OUTPUT: compiles the function main of one HLSL file to DXBC with
// Microsoft's compiler, twice, and refuses what it warns of, what does not come out alike, and what asks more
// of the hardware than feature level 11_0 has. Shaders see the macro HAIRLOOM_DXBC. Includes are found from
// the folder TOP, then from KERNELS; OUTPUT.d lists them for the build system. The environment variable
// HAIRLOOM_D3DCOMPILER names the DLL; without it the system's is taken.

#include <windows.h>
// windows.h first.
#include <d3dcompiler.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

struct Compiler {
    pD3DCompile compile = nullptr;
    pD3DDisassemble disassemble = nullptr;
};

Compiler loadCompiler() {
    const char* named = std::getenv("HAIRLOOM_D3DCOMPILER");
    HMODULE library = LoadLibraryA(named != nullptr && *named != '\0' ? named : "d3dcompiler_47.dll");
    if (library == nullptr) return {};
    const auto find = [library]<class F>(const char* name, F& function) {
        const FARPROC found = GetProcAddress(library, name);
        static_assert(sizeof(found) == sizeof(function));
        std::memcpy(&function, &found, sizeof(found));
    };
    Compiler compiler;
    find("D3DCompile", compiler.compile);
    find("D3DDisassemble", compiler.disassemble);
    return compiler;
}

bool readText(const std::string& path, std::string& text) {
    std::ifstream file(path, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(file), {});
    return file.good() || file.eof();
}

bool writeBytes(const std::string& path, std::string_view bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file.good();
}

// COM's interfaces have no virtual destructor.
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"
#endif
/// Finds includes from the first folder that has them and remembers them.
class Includes final : public ID3DInclude {
  public:
    explicit Includes(std::vector<std::string> folders) : folders_(std::move(folders)) {}

    HRESULT STDMETHODCALLTYPE Open(D3D_INCLUDE_TYPE, LPCSTR name, LPCVOID, LPCVOID* data,
                                   UINT* size) override {
        for (const std::string& folder : folders_) {
            const std::string path = folder + "/" + name;
            auto text = std::make_unique<std::string>();
            if (!std::ifstream(path).good() || !readText(path, *text)) continue;
            *data = text->data();
            *size = static_cast<UINT>(text->size());
            texts_[path] = std::move(text);
            return S_OK;
        }
        return E_FAIL;
    }
    HRESULT STDMETHODCALLTYPE Close(LPCVOID) override { return S_OK; }

    std::string listed() const {
        std::string list;
        for (const auto& [path, text] : texts_) list += " " + path;
        return list;
    }

  private:
    std::vector<std::string> folders_;
    std::map<std::string, std::unique_ptr<std::string>> texts_;
};
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

std::string textOf(ID3DBlob* blob) {
    if (blob == nullptr) return {};
    std::string text(static_cast<const char*>(blob->GetBufferPointer()), blob->GetBufferSize());
    blob->Release();
    return text;
}

std::string compile(const Compiler& compiler, const std::string& path, const std::string& source,
                    const char* profile, bool inOrder, Includes& includes) {
    ID3DBlob* code = nullptr;
    ID3DBlob* messages = nullptr;
    const UINT flags = D3DCOMPILE_OPTIMIZATION_LEVEL3 | D3DCOMPILE_ENABLE_STRICTNESS |
                       D3DCOMPILE_WARNINGS_ARE_ERRORS | (inOrder ? D3DCOMPILE_IEEE_STRICTNESS : 0u);
    const D3D_SHADER_MACRO macros[] = {{"HAIRLOOM_DXBC", "1"}, {nullptr, nullptr}};
    const HRESULT r = compiler.compile(source.data(), source.size(), path.c_str(), macros, &includes, "main",
                                       profile, flags, 0, &code, &messages);
    std::fputs(textOf(messages).c_str(), stderr);
    std::string bytes = textOf(code);
    return FAILED(r) ? std::string() : bytes;
}

std::string disassemble(const Compiler& compiler, const std::string& code) {
    ID3DBlob* listing = nullptr;
    compiler.disassemble(code.data(), code.size(), 0, nullptr, &listing);
    return textOf(listing);
}

/// What the assembly has that hardware of feature level 11_0 need not have; empty when nothing.
std::string tooMuch(const std::string& assembly) {
    static const std::pair<const char*, const char*> kWords[] = {
        {"ld_uav_typed", "reads a typed unordered access view; use RWStructuredBuffer"},
        {"enableDoublePrecisionFloatOps", "has double precision"},
        {"enable11_1", "needs feature level 11_1"},
        {"enableMinimumPrecision", "has types of minimum precision"},
        {"dcl_uav_structured_opc", "counts inside a buffer"},
        {"imm_atomic_alloc", "appends to a buffer"},
        {"imm_atomic_consume", "consumes a buffer"},
    };
    for (const auto& [word, why] : kWords) {
        if (assembly.find(word) != std::string::npos) return why;
    }
    const bool mayWrite =
        assembly.find("cs_5_0") != std::string::npos || assembly.find("ps_5_0") != std::string::npos;
    std::istringstream lines(assembly);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("dcl_uav", 0) != 0) continue;
        if (!mayWrite) return "writes to memory from another stage than the pixel and the compute shader";
        const std::size_t at = line.find(" u");
        if (at != std::string::npos && std::atoi(line.c_str() + at + 2) > 7) return "has a register above u7";
    }
    return {};
}

int run(const std::string& path, const char* profile, std::vector<std::string> folders,
        const std::string& output) {
    const Compiler compiler = loadCompiler();
    if (compiler.compile == nullptr || compiler.disassemble == nullptr) {
        std::fputs("error: Microsoft's shader compiler (d3dcompiler_47.dll) cannot be loaded\n", stderr);
        return 3;
    }
    std::string source;
    if (!readText(path, source)) {
        std::fprintf(stderr, "error: %s cannot be read\n", path.c_str());
        return 2;
    }
    Includes includes(std::move(folders));
    // Kernels take sums in the order that is written, as their counterparts on the CPU do.
    bool inOrder = std::string_view(profile) == "cs_5_0";
    std::string code = compile(compiler, path, source, profile, inOrder, includes);
    if (code.empty()) return 1;
    std::string assembly = disassemble(compiler, code);
    // Asked for that, Wine's OpenGL renderer makes no valid GLSL of atomic operations that tell what was
    // there before.
    if (inOrder && assembly.find("imm_atomic_") != std::string::npos) {
        inOrder = false;
        code = compile(compiler, path, source, profile, inOrder, includes);
        assembly = disassemble(compiler, code);
    }
    if (compile(compiler, path, source, profile, inOrder, includes) != code) {
        std::fprintf(stderr, "error: %s does not compile to the same bytes twice\n", path.c_str());
        return 1;
    }
    if (assembly.empty() || !tooMuch(assembly).empty()) {
        std::fprintf(stderr, "error: %s %s\n", path.c_str(),
                     assembly.empty() ? "cannot be disassembled" : tooMuch(assembly).c_str());
        return 1;
    }
    const bool written = writeBytes(output + ".asm", assembly) &&
                         writeBytes(output + ".d", output + ":" + includes.listed() + "\n") &&
                         writeBytes(output, code);
    return written ? 0 : 2;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 6) {
        std::fputs("usage: hairloom-hlslc SOURCE PROFILE TOP KERNELS OUTPUT\n", stderr);
        return 2;
    }
    return run(arguments[1], arguments[2], {arguments[3], arguments[4]}, arguments[5]);
}
