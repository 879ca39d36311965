// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A bake of look-up tables on a thread of its own, while older tables serve.

#include <future>
#include <optional>

#include "core/render/fibre_tables.h"

namespace hairloom::render {

/// One bake at a time. Its result does not depend on the thread it ran on. Destroying it waits for its end.
class FibreBake {
  public:
    bool isRunning() const { return result_.valid(); }
    /// Nothing is under way.
    void start(const FibreMaterial& material, bool varies);
    /// The tables, not yet on the device, once they are baked.
    std::optional<FibreTables> take();

  private:
    std::future<FibreTables> result_;
};

}  // namespace hairloom::render
