// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/child_watch.h"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "core/base/stop_scope.h"

namespace hairloom {

ChildWatch::ChildWatch(std::string name, const ChildLimits& limits,
                       std::function<std::uint64_t()> residentBytes)
    : name_(std::move(name)),
      limits_(limits),
      residentBytes_(std::move(residentBytes)),
      start_(Clock::now()),
      nextLook_(start_) {}

Status ChildWatch::check(std::size_t outputBytes) {
    if (auto status = checkStop(); !status) return status;
    const auto now = Clock::now();
    if (now - start_ >= limits_.time) {
        return over(
            fmt::format("did not finish within {} s", static_cast<double>(limits_.time.count()) / 1000.0));
    }
    if (outputBytes > limits_.outputBytes) {
        return over(fmt::format("found more than {} MiB of data", limits_.outputBytes >> 20u));
    }
    if (now < nextLook_) return {};
    nextLook_ = now + kWatchInterval;
    if (residentBytes_() > limits_.residentBytes) {
        return over(fmt::format("needed more than {} MiB of memory", limits_.residentBytes >> 20u));
    }
    return {};
}

Status ChildWatch::over(const std::string& what) const {
    return fail(fmt::format("{} {} for this file and was stopped", name_, what),
                "the file is damaged or too large");
}

void makeRoom(const ChildLimits& limits, std::vector<std::byte>& output) {
    std::uint64_t length = 0;
    if (!limits.startsWithLength || output.size() < sizeof length || output.capacity() > limits.outputBytes)
        return;
    std::memcpy(&length, output.data(), sizeof length);
    if (length <= limits.outputBytes) output.reserve(static_cast<std::size_t>(length) + sizeof length);
}

Status crashed(const std::string& name, const std::string& how) {
    return fail(fmt::format("{} crashed on this file ({})", name, how),
                "the file is damaged; nothing was changed");
}

Status gaveUp(const std::string& name, int status) {
    return fail(fmt::format("{} could not read this file (status {})", name, status),
                "the file is damaged; nothing was changed");
}

tl::unexpected<Error> notStarted(const std::string& name, const std::filesystem::path& program,
                                 const std::string& why) {
    return fail(fmt::format("{} cannot be started: {}", name, why),
                fmt::format("expected the program {}", program.string()));
}

}  // namespace hairloom
