// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

namespace hairloom {
namespace {

std::unique_ptr<tbb::global_control>& limit() {
    static std::unique_ptr<tbb::global_control> control;
    return control;
}

}  // namespace

void setThreadCount(std::size_t count) {
    limit().reset();
    if (count == 0) return;
    limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

std::size_t threadCount() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t pieces = (count + grain - 1) / grain;
    const auto piece = [&](std::size_t index) { body(index * grain, std::min(count, (index + 1) * grain)); };
    if (pieces == 1) return piece(0);
    tbb::parallel_for(std::size_t{0}, pieces, piece);
}

}  // namespace hairloom
