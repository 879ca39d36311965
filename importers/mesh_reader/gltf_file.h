// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A glTF 2.0 file and the numbers of its accessors.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace tinygltf {
class Model;
}

namespace hairloom {

/// Whether the JSON of a .gltf or .glb file says version 1, which tinygltf does not read.
bool isFirstGltf(std::span<const std::byte> bytes);

class GltfFile {
  public:
    /// Pictures are not looked at. Buffers of their own files are read where these lie in the file's folder
    /// or below it, links followed. Errors: tinygltf's, an extension that the file requires and that is not
    /// known.
    static Result<GltfFile> load(const char* file, std::span<const std::byte> bytes);
    GltfFile(GltfFile&&) noexcept;
    ~GltfFile();

    const tinygltf::Model& model() const { return *model_; }

    /// All elements of an accessor after one another, sparse values in place. Normalised integers are
    /// −1 … 1 or 0 … 1, others as they are. Errors: no accessor of that number or of another kind
    /// (`components`: numbers of an element), bytes beyond the end of a buffer.
    Result<std::vector<float>> numbers(int accessor, std::uint32_t components, const char* what) const;
    /// Numbers of an element of an accessor; 0 where there is none of that number.
    std::uint32_t componentsOf(int accessor) const;
    /// Of an accessor of whole numbers without sign.
    Result<std::vector<std::uint32_t>> indices(int accessor, const char* what) const;

  private:
    explicit GltfFile(std::unique_ptr<tinygltf::Model> model);
    template <class T>
    Result<std::vector<T>> elements(int accessor, std::uint32_t components, const char* what) const;

    std::unique_ptr<tinygltf::Model> model_;
};

}  // namespace hairloom
