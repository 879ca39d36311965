// SPDX-License-Identifier: GPL-3.0-or-later
// libstdc++ makes a std::filesystem::path of char by the C library's conversion for the current locale, and
// msvcrt.dll has none for UTF-8: it takes each byte for a character. All text of a program is UTF-8 there
// (hairloom.manifest), so the linker is told to call this instead (--wrap). What is not well-formed becomes
// U+FFFD, not an error: a path would throw, and no file is found by such a name anyway.
#include <cstddef>
#include <cstdint>
#include <cwchar>

namespace {

constexpr std::uint32_t kReplacement = 0xFFFD, kBeyondOneUnit = 0x10000, kBeyondAll = 0x110000;

bool isHighSurrogate(std::uint32_t unit) {
    return unit >= 0xD800 && unit < 0xDC00;
}
bool isLowSurrogate(std::uint32_t unit) {
    return unit >= 0xDC00 && unit < 0xE000;
}

struct Decoded {
    std::uint32_t character;
    std::size_t bytes;
};

constexpr Decoded kIllFormed{kReplacement, 1};

/// `size` >= 1.
Decoded decode(const char* from, std::size_t size) {
    const auto first = static_cast<unsigned char>(*from);
    if (first < 0x80) return {first, 1};
    const std::size_t bytes = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
    if (bytes == 0 || bytes > size) return kIllFormed;
    std::uint32_t character = first & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        const auto next = static_cast<unsigned char>(from[i]);
        if ((next & 0xC0) != 0x80) return kIllFormed;
        character = (character << 6) | (next & 0x3FU);
    }
    const bool needsFewer = character < (bytes == 3 ? 0x800U : bytes == 4 ? kBeyondOneUnit : 0x80U);
    const bool isSurrogate = isHighSurrogate(character) || isLowSurrogate(character);
    return needsFewer || isSurrogate || character >= kBeyondAll ? kIllFormed : Decoded{character, bytes};
}

}  // namespace

// mbstate_t is an integer there. Between the two halves of a character beyond 16 bits it holds the second
// one, for which the last of the four bytes is left.
extern "C" std::size_t __wrap_mbrtowc(wchar_t* to, const char* from, std::size_t size,
                                      std::mbstate_t* state) {
    static std::mbstate_t own = 0;
    std::mbstate_t& pending = state != nullptr ? *state : own;
    if (from == nullptr) {
        pending = 0;
        return 0;
    }
    if (size == 0) return static_cast<std::size_t>(-2);
    wchar_t ignored = 0;
    wchar_t& unit = to != nullptr ? *to : ignored;
    if (pending != 0) {
        unit = static_cast<wchar_t>(pending);
        pending = 0;
        return 1;
    }
    const Decoded decoded = decode(from, size);
    if (decoded.character < kBeyondOneUnit) {
        unit = static_cast<wchar_t>(decoded.character);
        return decoded.character == 0 ? 0 : decoded.bytes;
    }
    const std::uint32_t beyond = decoded.character - kBeyondOneUnit;
    unit = static_cast<wchar_t>(0xD800 | (beyond >> 10));
    pending = static_cast<std::mbstate_t>(0xDC00 | (beyond & 0x3FF));
    return decoded.bytes - 1;
}
