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

std::size_t MaskImage::pixelAt(const Vec2f& uv) const {
    const auto wrapped = [](float x) { return x - std::floor(x); };
    const auto texel = [](float x, std::uint32_t size) {
        return std::min(static_cast<std::uint32_t>(x * static_cast<float>(size)), size - 1);
    };
    const std::uint32_t x = texel(wrapped(uv.x()), image_.width);
    const std::uint32_t y = texel(1 - wrapped(uv.y()), image_.height);
    return std::size_t{y} * image_.width + x;
}

float MaskImage::at(const Vec2f& uv) const {
    const float* rgba = &image_.rgba[4 * pixelAt(uv)];
    // What people paint as half is half.
    const float luminance = 0.2126f * render::encodeSrgb(rgba[0]) + 0.7152f * render::encodeSrgb(rgba[1]) +
                            0.0722f * render::encodeSrgb(rgba[2]);
    return std::clamp(luminance * rgba[3], 0.0f, 1.0f);
}

std::optional<std::uint32_t> MaskImage::colourOf(std::size_t pixel) const {
    const float* rgba = &image_.rgba[4 * pixel];
    if (!(rgba[3] >= 0.5f)) return std::nullopt;
    std::uint32_t colour = 0;
    for (int c = 0; c < 3; ++c) {
        const float level = std::clamp(render::encodeSrgb(rgba[c]), 0.0f, 1.0f);
        colour = colour << 8u | static_cast<std::uint32_t>(std::lround(level * 255));
    }
    return colour;
}

std::optional<std::uint32_t> MaskImage::colourAt(const Vec2f& uv) const {
    return colourOf(pixelAt(uv));
}

Result<std::vector<std::uint32_t>> MaskImage::flatColours() const {
    constexpr std::size_t kColours = std::size_t{1} << 24u;
    const std::size_t pixels = std::size_t{image_.width} * image_.height;
    std::vector<std::uint32_t> counts(kColours, 0);
    std::size_t flat = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (const auto colour = colourOf(i)) {
            ++counts[*colour];
        } else {
            ++flat;
        }
    }
    flat += counts[0];
    std::vector<std::uint32_t> colours;
    for (std::size_t colour = kColours - 1; colour > 0; --colour) {
        if (counts[colour] == 0 || counts[colour] * std::size_t{500} < pixels) continue;
        flat += counts[colour];
        colours.push_back(static_cast<std::uint32_t>(colour));
    }
    if (flat * 10 < pixels * 9)
        return fail(fmt::format("{:.0f} % of the image are of colours that fill less than 0.2 % of it each",
                                100.0 - 100.0 * static_cast<double>(flat) / static_cast<double>(pixels)),
                    "expected regions of one colour each, without shades");
    return colours;
}

namespace {

constexpr std::pair<std::uint32_t, const char*> kColourNames[] = {
    {0xff0000, "red"},     {0x00ff00, "green"},  {0x0000ff, "blue"},      {0xffff00, "yellow"},
    {0xff00ff, "magenta"}, {0x00ffff, "cyan"},   {0xffffff, "white"},     {0x808080, "grey"},
    {0xff8000, "orange"},  {0x800080, "purple"}, {0x008000, "dark green"}};

int squaredDistance(std::uint32_t a, std::uint32_t b) {
    int sum = 0;
    for (const unsigned shift : {0u, 8u, 16u}) {
        const int difference = static_cast<int>(a >> shift & 0xffu) - static_cast<int>(b >> shift & 0xffu);
        sum += difference * difference;
    }
    return sum;
}

}  // namespace

std::string colourName(std::uint32_t rgb) {
    const auto known = std::ranges::find(kColourNames, rgb, &std::pair<std::uint32_t, const char*>::first);
    return known != std::end(kColourNames) ? known->second : fmt::format("#{:06x}", rgb);
}

Result<std::vector<ColourRegion>> regionsAtRoots(const MaskImage& image, const Groom& groom) {
    // Its errors about UVs are these, too.
    if (const auto checked = valuesAtRoots(image, groom); !checked) return tl::unexpected(checked.error());
    const auto colours = image.flatColours();
    if (!colours) return tl::unexpected(colours.error());
    if (colours->empty())
        return fail("the image has no regions: it is black or transparent",
                    "expected a colour for each region");
    std::vector<ColourRegion> regions;
    for (const std::uint32_t rgb : *colours)
        regions.push_back({colourName(rgb), rgb, std::vector<float>(groom.strandCount(), 0.0f), 0});
    const auto uvs = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    for (std::size_t s = 0; s < uvs.size(); ++s) {
        const auto colour = image.colourAt(uvs[s]);
        if (!colour) continue;
        const auto nearest = std::ranges::min_element(
            regions, {}, [&](const ColourRegion& region) { return squaredDistance(region.rgb, *colour); });
        if (squaredDistance(0, *colour) < squaredDistance(nearest->rgb, *colour)) continue;
        nearest->shares[s] = 1;
        ++nearest->strands;
    }
    return regions;
}

std::vector<std::string> namesOfRegions(const Groom& groom, std::span<const std::uint32_t> masks,
                                        std::span<const ColourRegion> regions) {
    const auto isColour = [](const std::string& name) {
        return name.starts_with('#') ||
               std::ranges::any_of(kColourNames, [&](const auto& known) { return name == known.second; });
    };
    std::vector<std::string> names;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const auto& given = groom.maskNames;
        const std::string now = masks[i] <= given.size() ? given[masks[i] - 1] : std::string();
        names.push_back(now.empty() || isColour(now) ? regions[i].name : std::string());
    }
    return names;
}

Result<std::vector<float>> valuesAtRoots(const MaskImage& image, const Groom& groom) {
    const auto uvs = groom.strandAttributes.view<Vec2f>(attribute::kRootUv);
    if (uvs.size() != groom.strandCount())
        return fail("the strands have no root UVs to read an image at", "bind them to a scalp with UVs");
    std::vector<float> values(uvs.size());
    for (std::size_t s = 0; s < uvs.size(); ++s) {
        if (!uvs[s].allFinite())
            return fail(fmt::format("the root UV of strand {} is not finite", s),
                        "expected UVs that are numbers");
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
