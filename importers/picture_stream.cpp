// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/picture_stream.h"

#include <algorithm>
#include <array>

#include "core/render/picture_limits.h"

namespace hairloom {
namespace {

struct KindRow {
    PictureKind kind;
    std::string_view name, beginning;
};
constexpr std::array<KindRow, 3> kKinds{{{PictureKind::Png, "PNG", "\x89PNG"},
                                         {PictureKind::Exr, "OpenEXR", "\x76\x2f\x31\x01"},
                                         {PictureKind::Jpeg, "JPEG", "\xff\xd8\xff"}}};

constexpr auto kPictureMembers = [](auto& archive, auto& picture) {
    archive(picture.width);
    archive(picture.height);
    archive(picture.rgba);
};

}  // namespace

std::string_view name(PictureKind kind) {
    return kKinds[static_cast<std::size_t>(kind)].name;
}

std::optional<PictureKind> pictureKindNamed(std::string_view name) {
    const auto found = std::ranges::find(kKinds, name, &KindRow::name);
    return found == kKinds.end() ? std::nullopt : std::optional(found->kind);
}

std::optional<PictureKind> pictureKindOf(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const KindRow& row : kKinds) {
        if (text.starts_with(row.beginning)) return row.kind;
    }
    return std::nullopt;
}

void writePicture(const Result<render::LinearImage>& picture, const std::string& lacking,
                  const AnswerWriter::Sink& sink) {
    writeAnswer(picture, AnswerKind::Picture, lacking, sink, kPictureMembers);
}

Result<render::LinearImage> readPictureAnswer(const std::string& file, std::span<const std::byte> bytes,
                                              std::string& lacking) {
    auto picture =
        readAnswer<render::LinearImage>(file, bytes, AnswerKind::Picture, lacking, kPictureMembers);
    if (!picture) return picture;
    if (auto status = render::checkPictureSize(file, picture->width, picture->height, 4 * sizeof(float));
        !status)
        return tl::unexpected(status.error());
    if (picture->rgba.size() != std::size_t{4} * picture->width * picture->height)
        return tl::unexpected(invalidAnswer(file, bytes.size()));
    return picture;
}

}  // namespace hairloom
