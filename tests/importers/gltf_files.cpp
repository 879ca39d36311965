// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/importers/gltf_files.h"

#include <fmt/format.h>

namespace hairloom::test {

std::string base64(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8u | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63u];
    }
    return text;
}

int GltfBuffer::add(std::span<const std::byte> bytes, int stride) {
    views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", count_ == 0 ? "" : ",",
                          bytes_.size(), bytes.size(),
                          stride == 0 ? std::string() : fmt::format(R"(,"byteStride":{})", stride));
    bytes_.writeArray(bytes);
    return count_++;
}

std::string GltfBuffer::json() const {
    return fmt::format(
        R"("buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}],"bufferViews":[{}])",
        bytes_.size(), base64(bytes_.bytes()), views_);
}

std::string accessor(int view, int componentType, std::size_t count, const std::string& type,
                     const std::string& more) {
    const std::string bytes = view < 0 ? std::string() : fmt::format(R"("bufferView":{},)", view);
    return fmt::format(R"({{{}"componentType":{},"count":{},"type":"{}"{}{}}})", bytes, componentType, count,
                       type, more.empty() ? "" : ",", more);
}

}  // namespace hairloom::test
