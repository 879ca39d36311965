// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/mask_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/render/tone_map.h"
#include "importers/foreign_reader.h"

namespace hairloom {

Result<MaskImage> MaskImage::read(const std::string& path) {
    auto image = readPicture(path, {PictureKind::Png});
    if (!image) return tl::unexpected(image.error());
    MaskImage mask;
    mask.image_ = std::move(*image);
    return mask;
}

float MaskImage::at(const Vec2f& uv) const {
    const auto wrapped = [](float x) { return x - std::floor(x); };
    const auto texel = [](float x, std::uint32_t size) {
        return std::min(static_cast<std::uint32_t>(x * static_cast<float>(size)), size - 1);
    };
    const std::uint32_t x = texel(wrapped(uv.x()), image_.width);
    const std::uint32_t y = texel(1 - wrapped(uv.y()), image_.height);
    const float* rgba = &image_.rgba[4 * (std::size_t{y} * image_.width + x)];
    // What people paint as half is half.
    const float luminance = 0.2126f * render::encodeSrgb(rgba[0]) + 0.7152f * render::encodeSrgb(rgba[1]) +
                            0.0722f * render::encodeSrgb(rgba[2]);
    return std::clamp(luminance * rgba[3], 0.0f, 1.0f);
}

Result<std::vector<float>> valuesAtRoots(const MaskImage& image, const Groom& groom) {
    const auto uvs = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    if (uvs.size() != groom.strandCount())
        return fail("the strands have no root UVs to read an image at", "bind them to a scalp with UVs");
    std::vector<float> values(uvs.size());
    for (std::size_t s = 0; s < uvs.size(); ++s) {
        if (!uvs[s].allFinite()) return fail(fmt::format("the root UV of strand {} is not finite", s));
        values[s] = image.at(uvs[s]);
    }
    return values;
}

Result<std::vector<float>> valuesAtVertices(const MaskImage& image, const ScalpMesh& mesh) {
    if (mesh.cornerUvs().empty())
        return fail("the head has no UVs to read an image at", "a mesh with texture coordinates");
    std::vector<float> sums(mesh.vertexCount(), 0.0f), counts(mesh.vertexCount(), 0.0f);
    for (std::size_t corner = 0; corner < mesh.cornerUvs().size(); ++corner) {
        const std::uint32_t vertex = mesh.triangles()[corner / 3][corner % 3];
        sums[vertex] += image.at(mesh.cornerUvs()[corner]);
        counts[vertex] += 1;
    }
    for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = counts[v] > 0 ? sums[v] / counts[v] : 1.0f;
    return sums;
}

}  // namespace hairloom
