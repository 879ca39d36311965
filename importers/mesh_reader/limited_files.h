// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Assimp's way to files: the one asked for, and what LimitedFolder allows.

#include <assimp/DefaultIOSystem.h>

#include <string>

#include "importers/mesh_reader/limited_folder.h"

namespace hairloom {

/// Gives the file out under a name whose extension is that of its content, which is what assimp chooses a
/// reader by.
class LimitedFiles : public Assimp::DefaultIOSystem {
  public:
    LimitedFiles(std::string path, const std::string& extension);

    /// The name to ask assimp for.
    const std::string& alias() const { return alias_; }

    bool Exists(const char* file) const override;
    Assimp::IOStream* Open(const char* file, const char* mode) override;

  private:
    std::string real(const char* file) const;

    std::string path_;
    std::string alias_;
    LimitedFolder folder_;
};

}  // namespace hairloom
