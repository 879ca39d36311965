// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Several files that come together or not at all.

#include "core/base/output_file.h"

namespace hairloom {

/// While it lives, what this thread writes waits beside its places, and commit() puts all of it there. What
/// is not committed is taken away. A second one inside it does nothing of its own.
class OutputBatch {
  public:
    OutputBatch();
    OutputBatch(const OutputBatch&) = delete;
    OutputBatch& operator=(const OutputBatch&) = delete;
    ~OutputBatch();

    /// Errors: one that may not or cannot be put in place; all places are as they were then. Where even that
    /// fails the error says so, and where the old content is.
    Status commit();

  private:
    bool isOuter_ = false;
};

/// The names of files that this thread has written and that wait for their batch, as they were asked for, in
/// order.
std::vector<std::filesystem::path> waitingFiles();

/// Where what this thread has written to that name can be read: there, unless it waits for its batch.
std::filesystem::path whereWritten(const std::filesystem::path& path);

/// One of a sequence: "hair.png" and 7 give "hair_0007.png".
std::filesystem::path numbered(const std::filesystem::path& path, std::size_t number);

}  // namespace hairloom
