// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Options that every job of the program takes.

#include <CLI/App.hpp>
#include <cstddef>

namespace hairloom::cli {

struct GlobalOptions {
    bool json = false;
    std::size_t threads = 0;
    bool quiet = false;
    bool profile = false;
    bool force = false;
    bool allowUnconfined = false;
    bool manifest = false;
};

/// `options` outlives the parsing.
void addGlobalOptions(CLI::App& app, GlobalOptions& options);

}  // namespace hairloom::cli
