// SPDX-License-Identifier: MIT
// Plays a runtime asset with Direct3D 11: the CPU steps guides, or with --gpu a kernel does. The kernels of
// share/hairloom-runtime/shaders, compiled here from HLSL, make all hairs of them and draw them as ribbons,
// and nothing is read back but the last image, which is written as PPM.
//   direct3d_hair ASSET SHADERS [-o IMAGE] [--frames N] [--gpu] [--shade] [--share S] [--compare] [--check]
// --frames 0 draws the hair at rest. --shade draws it as its material says, with shadows of hair on hair.
// --share makes and draws that share of the hairs, above 0 to 1, as a character far off has them.
// --compare reads the hairs of each frame back and says how far they are from hl_instance_read_hairs();
// --check fails where that is more than docs/gpu-simulation.md says.

#include "device.h"

#include <array>
#include <iterator>
#include <optional>

namespace {

/// A row of HL_GPU_BINDINGS.
struct Row {
    std::uint32_t pass;
    char kind;  ///< B constants, T read, U written
    UINT number;
    std::uint32_t buffer;
};
#define ROW(pass, kind, number, buffer) {HL_GPU_PASS_##pass, #kind[0], number, HL_GPU_BUFFER_##buffer},
constexpr Row kRows[] = {HL_GPU_BINDINGS(ROW)};
#undef ROW

struct Pass {
    std::uint32_t number;
    hl_gpu_pass_info info{};
    ID3D11ComputeShader* compute = nullptr;
    ID3D11VertexShader* vertex = nullptr;
    ID3D11PixelShader* pixel = nullptr;
};

void makeShaders(const Gpu& gpu, const std::string& shaders, Pass& pass) {
    const std::string file = shaders + "/" + pass.info.file;
    if (pass.info.kind == HL_GPU_COMPUTE) {
        ID3DBlob* const code = gpu.compiled(file + ".comp.hlsl", "cs_5_0");
        check(gpu.device->CreateComputeShader(code->GetBufferPointer(), code->GetBufferSize(), nullptr,
                                              &pass.compute),
              file);
        return;
    }
    ID3DBlob* const vertex = gpu.compiled(file + ".vert.hlsl", "vs_5_0");
    check(gpu.device->CreateVertexShader(vertex->GetBufferPointer(), vertex->GetBufferSize(), nullptr,
                                         &pass.vertex),
          file);
    ID3DBlob* const pixel = gpu.compiled(file + ".frag.hlsl", "ps_5_0");
    check(gpu.device->CreatePixelShader(pixel->GetBufferPointer(), pixel->GetBufferSize(), nullptr,
                                        &pass.pixel),
          file);
}

/// What a pass binds, or with `away` nothing in its place: a buffer that one pass writes and the next reads
/// may not be bound as both.
void bind(const Gpu& gpu, const std::vector<Buffer>& buffers, const Pass& pass, bool away) {
    ID3D11DeviceContext& to = *gpu.context;
    for (const Row& row : kRows) {
        if (row.pass != pass.number) continue;
        const Buffer none{}, &buffer = away ? none : buffers[row.buffer];
        if (row.kind == 'U') {
            to.CSSetUnorderedAccessViews(row.number, 1, &buffer.written, nullptr);
        } else if (pass.compute) {
            if (row.kind == 'B') to.CSSetConstantBuffers(row.number, 1, &buffer.handle);
            if (row.kind == 'T') to.CSSetShaderResources(row.number, 1, &buffer.read);
        } else if (row.kind == 'B') {
            to.VSSetConstantBuffers(row.number, 1, &buffer.handle);
            to.PSSetConstantBuffers(row.number, 1, &buffer.handle);
        } else {
            to.VSSetShaderResources(row.number, 1, &buffer.read);
        }
    }
}

/// Where hair is drawn, and how.
struct Target {
    ID3D11Texture2D* image;
    ID3D11RenderTargetView* colour = nullptr;
    ID3D11DepthStencilView* depth = nullptr;

    explicit Target(const Gpu& gpu)
        : image(gpu.texture(kColour, D3D11_USAGE_DEFAULT, D3D11_BIND_RENDER_TARGET, 0)) {
        check(gpu.device->CreateRenderTargetView(image, nullptr, &colour), "CreateRenderTargetView");
        ID3D11Texture2D* const depths = gpu.texture(kDepth, D3D11_USAGE_DEFAULT, D3D11_BIND_DEPTH_STENCIL, 0);
        check(gpu.device->CreateDepthStencilView(depths, nullptr, &depth), "CreateDepthStencilView");
        D3D11_RASTERIZER_DESC raster{};
        raster.FillMode = D3D11_FILL_SOLID;
        raster.CullMode = D3D11_CULL_NONE;
        raster.DepthClipEnable = TRUE;
        ID3D11RasterizerState* bothFaces = nullptr;
        check(gpu.device->CreateRasterizerState(&raster, &bothFaces), "CreateRasterizerState");
        const D3D11_VIEWPORT view{0, 0, kWidth, kHeight, 0, 1};
        gpu.context->RSSetState(bothFaces);
        gpu.context->RSSetViewports(1, &view);
        gpu.context->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLESTRIP);
        gpu.context->OMSetRenderTargets(1, &colour, depth);
    }
    void write(const Gpu& gpu, const char* name) const {
        ID3D11Texture2D* const staging = gpu.texture(kColour, D3D11_USAGE_STAGING, 0, D3D11_CPU_ACCESS_READ);
        gpu.context->CopyResource(staging, image);
        D3D11_MAPPED_SUBRESOURCE mapped;
        check(gpu.context->Map(staging, 0, D3D11_MAP_READ, 0, &mapped), "Map");
        writeImage(name, mapped.pData, mapped.RowPitch);
        gpu.context->Unmap(staging, 0);
    }
};

/// One frame: the passes in their order. `grey`: linear, behind the hair.
void draw(const Gpu& gpu, const std::vector<Buffer>& buffers, const std::vector<Pass>& passes,
          const Target& target, float grey) {
    const float behind[4] = {grey, grey, grey, 1};
    gpu.context->ClearRenderTargetView(target.colour, behind);
    gpu.context->ClearDepthStencilView(target.depth, D3D11_CLEAR_DEPTH, 1, 0);
    for (const Pass& pass : passes) {
        bind(gpu, buffers, pass, false);
        if (pass.compute) {
            gpu.context->CSSetShader(pass.compute, nullptr, 0);
            gpu.context->Dispatch(pass.info.groups[0], pass.info.groups[1], pass.info.groups[2]);
        } else {
            gpu.context->VSSetShader(pass.vertex, nullptr, 0);
            gpu.context->PSSetShader(pass.pixel, nullptr, 0);
            gpu.context->DrawInstanced(pass.info.vertices, pass.info.instances, 0, 0);
        }
        bind(gpu, buffers, pass, true);
    }
}

bool isConstants(std::uint32_t buffer) {
    return std::any_of(std::begin(kRows), std::end(kRows),
                       [buffer](const Row& row) { return row.buffer == buffer && row.kind == 'B'; });
}

}  // namespace

int main(int count, char** words) {
    const Options options = optionsOf(count, words);
    hl_error error{};
    std::size_t size = 0;
    const std::vector<Piece> bytes = readFile(options.asset, size);
    hairloom::game::Asset asset;
    hairloom::game::Instance hair;
    if (!asset.open(bytes.data(), size, &error)) fail(error.words);
    if (!hair.make(asset, HL_GUIDES | HL_LEVELS, nullptr, &error)) fail(error.words);
    if (!hair.setLevel(HL_LEVEL_FINEST, options.share, &error)) fail(error.words);

    const Gpu gpu;
    std::vector<Buffer> buffers;
    std::vector<hl_gpu_buffer_info> infos(HL_GPU_BUFFER_COUNT);
    std::vector<Piece> filled;  // what is on its way to a buffer
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
        infos[b].size = sizeof infos[b];
        check(hl_gpu_buffer(asset.get(), b, &infos[b], &error), error);
        buffers.push_back(
            gpu.buffer(infos[b].bytes, infos[b].element, isConstants(b) ? Use::constants : Use::array));
        filled.resize(std::max(filled.size(), infos[b].bytes / sizeof(Piece) + 1));
        if (infos[b].fill != HL_GPU_ONCE) continue;
        check(hl_gpu_fill(asset.get(), b, filled.data(), infos[b].bytes, &error), error);
        gpu.fill(buffers[b], filled.data());
        if (b != HL_GPU_BUFFER_NUMBERS) continue;
        numbers.resize(infos[b].bytes / sizeof(std::uint32_t));
        std::memcpy(numbers.data(), filled.data(), infos[b].bytes);
    }
    std::vector<Pass> passes;
    for (std::uint32_t p = 0; p < HL_GPU_PASS_COUNT; ++p) {
        if (!runs(p, options)) continue;
        Pass& pass = passes.emplace_back();
        pass.number = p;
        pass.info.size = sizeof pass.info;
        check(hl_gpu_frame_pass(hair.get(), p, &pass.info, &error), error);
        makeShaders(gpu, options.shaders, pass);
    }
    hl_gpu_view view;
    hl_gpu_lamp lamp;
    check(hl_gpu_view_init(asset.get(), &view, &error), error);
    check(hl_gpu_frame_view(hair.get(), &view, &error), error);
    look(asset.describe(), 1, view, lamp);
    gpu.fill(buffers[HL_GPU_BUFFER_VIEW], &view);
    gpu.fill(buffers[HL_GPU_BUFFER_LAMP], &lamp);

    const auto fill = [&](std::uint32_t kind) {
        for (std::uint32_t b = 0; b < HL_GPU_BUFFER_COUNT; ++b) {
            if (infos[b].fill != kind) continue;
            check(hl_gpu_fill_frame(hair.get(), b, filled.data(), infos[b].bytes, &error), error);
            gpu.fill(buffers[b], filled.data());
        }
    };
    if (options.onGpu) {
        check(hl_gpu_begin(hair.get(), &error), error);
        fill(HL_GPU_BEGIN);
        fill(HL_GPU_GUIDES);
    }
    std::optional<Comparison> comparison;
    if (options.comparing)
        comparison.emplace(asset, options.share, numbers.data(), numbers.size(), view.hairs);
    const Target target(gpu);
    for (int f = std::min(1, options.frames); f <= options.frames; ++f) {
        const Turning turning(f);
        check(options.onGpu ? hl_gpu_step(hair.get(), &turning.frame, &error)
                            : hl_instance_step(hair.get(), &turning.frame, &error),
              error);
        fill(HL_GPU_FRAME);
        fill(options.onGpu ? HL_GPU_STEP : HL_GPU_GUIDES);
        draw(gpu, buffers, passes, target, options.shading ? 0 : 0.5f);
        if (comparison) comparison->step(turning.frame, gpu.readBack(buffers[HL_GPU_BUFFER_POINTS]).data());
    }
    if (options.image) target.write(gpu, options.image);
    std::printf("%u hairs, %d frames\n", view.hairs, options.frames);
    return comparison ? comparison->say(options) : 0;
}
