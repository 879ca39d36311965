// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/fibre_bake.h"

#include <cassert>
#include <chrono>

namespace hairloom::render {

void FibreBake::start(const FibreMaterial& material, bool varies) {
    assert(!isRunning());
    result_ =
        std::async(std::launch::async, [material, varies] { return FibreTables::bake(material, varies); });
}

std::optional<FibreTables> FibreBake::take() {
    if (!isRunning() || result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    return result_.get();
}

}  // namespace hairloom::render
