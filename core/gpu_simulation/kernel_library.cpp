// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/kernel_library.h"

#include <fmt/format.h>

#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/log.h"
#include "core/gpu_simulation/hlsl_compiler.h"
#include "shaders/shaders.h"

namespace hairloom::gpu_simulation {
namespace {

constexpr std::uint32_t kSpirvMagic = 0x07230203;
constexpr std::uint32_t kDxbcMagic = 0x43425844;  // "DXBC"

using Words = std::vector<std::uint32_t>;

/// The macros of a kernel that is compiled with the program: the lines of its file that define some.
std::string definesOf(const shaders::Source& source) {
    std::string defines;
    for (std::size_t at = 0; at < source.text.size();) {
        const std::size_t end = std::min(source.text.find('\n', at), source.text.size());
        const std::string_view line = source.text.substr(at, end - at);
        if (line.starts_with("#define ")) defines.append(line).push_back('\n');
        at = end + 1;
    }
    return defines;
}

/// "simulation/NAME.comp.hlsl" is called NAME.comp in the table of compiled shaders.
const shaders::Shader* findBuiltIn(const std::string& defines) {
    constexpr std::string_view kEnding = ".comp.hlsl";
    for (const shaders::Source& source : shaders::sources()) {
        if (!source.path.ends_with(kEnding) || definesOf(source) != defines) continue;
        const std::size_t slash = source.path.rfind('/');
        return shaders::find(
            source.path.substr(slash + 1, source.path.size() - slash - 1 - std::strlen(".hlsl")));
    }
    return nullptr;
}

Words wordsIn(const shaders::Shader& shader, gpu::Backend backend) {
    if (backend == gpu::Backend::Vulkan) return {shader.spirv.begin(), shader.spirv.end()};
    Words words(shader.dxbc.size() / sizeof(std::uint32_t));
    if (!words.empty()) std::memcpy(words.data(), shader.dxbc.data(), shader.dxbc.size());
    return words;
}

std::optional<Words> readWords(const std::filesystem::path& path) {
    constexpr std::uint64_t kMax = 16u << 20u;
    const auto bytes = readFile(path, kMax);
    if (!bytes || bytes->size() < 8 || bytes->size() % 4 != 0) return {};
    Words words(bytes->size() / 4);
    std::memcpy(words.data(), bytes->data(), bytes->size());
    // The last word is the hash of those before.
    const auto content = std::as_bytes(std::span(words)).first(bytes->size() - 4);
    const bool known = words.front() == kSpirvMagic || words.front() == kDxbcMagic;
    if (!known || words.back() != static_cast<std::uint32_t>(hashBytes(content))) return {};
    words.pop_back();
    return words;
}

Status writeWords(const std::filesystem::path& path, Words words) {
    words.push_back(static_cast<std::uint32_t>(hashBytes(std::as_bytes(std::span(words)))));
    std::error_code failure;
    std::filesystem::create_directories(path.parent_path(), failure);
    return writeFileAtomically(path, std::as_bytes(std::span(words)), Replacing::Anything);
}

struct Entry {
    bool done = false;
    Result<gpu::ComputePipelinePtr> pipeline = gpu::ComputePipelinePtr{};
};

}  // namespace

std::filesystem::path userKernelFolder() {
    const auto folder = [](const char* variable) {
        const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets it
        return std::filesystem::path(value == nullptr ? "" : value);
    };
    std::filesystem::path base = folder("XDG_CACHE_HOME");
    if (base.empty()) base = folder("LOCALAPPDATA");
    if (base.empty()) {
        const std::filesystem::path home = folder("HOME");
        if (home.empty()) return {};
        base = home / ".cache";
    }
    return base / "hairloom" / "kernels";
}

struct KernelLibrary::Impl {
    gpu::Device& device;
    std::filesystem::path folder;
    std::uint64_t version = hlslVersion(device.info().backend);

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::map<std::string, Entry> entries;  // by defines
    std::deque<KernelKey> waiting;
    Sources sources;
    bool stop = false;
    std::thread worker;

    Impl(gpu::Device& d, std::filesystem::path f) : device(d), folder(std::move(f)) {}

    void work();
    Entry& entryOf(const KernelKey& key);
    Result<Words> wordsOf(const KernelKey& key, const std::string& defines);
    Result<gpu::ComputePipelinePtr> make(const KernelKey& key, const std::string& defines);
    void count(std::uint32_t Sources::*source) {
        const std::lock_guard lock(mutex);
        ++(sources.*source);
    }
};

Result<Words> KernelLibrary::Impl::wordsOf(const KernelKey& key, const std::string& defines) {
    if (const shaders::Shader* builtIn = findBuiltIn(defines)) {
        count(&Sources::builtIn);
        return wordsIn(*builtIn, device.info().backend);
    }
    const std::filesystem::path path =
        folder / fmt::format("{:016x}.kernel", hashBytes(std::as_bytes(std::span(defines)), version));
    if (!folder.empty()) {
        if (auto words = readWords(path)) {
            count(&Sources::disk);
            return *words;
        }
    }
    auto words = compileHlsl(key.source(), defines, device.info().backend);
    if (!words) return words;
    count(&Sources::compiled);
    if (!folder.empty()) {
        if (const auto written = writeWords(path, *words); !written)
            log::warning("the kernel is not kept: {}", written.error().message());
    }
    return words;
}

Result<gpu::ComputePipelinePtr> KernelLibrary::Impl::make(const KernelKey& key, const std::string& defines) {
    const auto words = wordsOf(key, defines);
    if (!words) return tl::unexpected(words.error());
    gpu::ShaderDesc desc{"strands", gpu::ShaderStage::Compute};
    const bool direct3d = device.info().backend == gpu::Backend::Direct3D11;
    (direct3d ? desc.dxbc : desc.spirv) = std::as_bytes(std::span(*words));
    const auto shader = device.createShader(desc);
    if (!shader) return tl::unexpected(shader.error());
    return device.createComputePipeline({"strands", *shader, key.shape.wave});
}

void KernelLibrary::Impl::work() {
    std::unique_lock lock(mutex);
    while (true) {
        changed.wait(lock, [&] { return stop || !waiting.empty(); });
        if (stop) return;
        const KernelKey key = std::move(waiting.front());
        waiting.pop_front();
        lock.unlock();
        const std::string defines = key.defines();
        auto pipeline = make(key, defines);
        lock.lock();
        Entry& entry = entries[defines];
        entry.pipeline = std::move(pipeline);
        entry.done = true;
        changed.notify_all();
    }
}

/// Asks for it where nobody has. The mutex is held.
Entry& KernelLibrary::Impl::entryOf(const KernelKey& key) {
    const auto [place, isNew] = entries.try_emplace(key.defines());
    if (isNew) {
        if (!worker.joinable()) worker = std::thread([this] { work(); });
        waiting.push_back(key);
        changed.notify_all();
    }
    return place->second;
}

KernelLibrary::KernelLibrary(gpu::Device& device, std::filesystem::path folder)
    : impl_(std::make_unique<Impl>(device, std::move(folder))) {}

KernelLibrary::~KernelLibrary() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->stop = true;
    }
    impl_->changed.notify_all();
    if (impl_->worker.joinable()) impl_->worker.join();
}

Result<gpu::ComputePipelinePtr> KernelLibrary::poll(const KernelKey& key) {
    const std::lock_guard lock(impl_->mutex);
    const Entry& entry = impl_->entryOf(key);
    if (!entry.done) return gpu::ComputePipelinePtr{};
    return entry.pipeline;
}

Result<gpu::ComputePipelinePtr> KernelLibrary::get(const KernelKey& key) {
    std::unique_lock lock(impl_->mutex);
    const Entry& entry = impl_->entryOf(key);
    impl_->changed.wait(lock, [&] { return entry.done; });
    return entry.pipeline;
}

KernelLibrary::Sources KernelLibrary::sources() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->sources;
}

}  // namespace hairloom::gpu_simulation
