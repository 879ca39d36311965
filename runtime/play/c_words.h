// SPDX-License-Identifier: MIT
#pragma once
// What all functions of hairloom.h share: codes and words, nothing thrown across, structs of other sizes.

#include <algorithm>
#include <cstring>
#include <new>
#include <string>
#include <string_view>

#include "hairloom/hairloom.h"
#include "play/instance.h"

namespace hairloom::runtime {

static_assert(sizeof(Asset) <= sizeof(hl_asset) && alignof(Asset) <= alignof(hl_asset));
static_assert(std::is_trivially_destructible_v<Asset> && std::is_trivially_copyable_v<Asset>);

inline const Asset& assetOf(const hl_asset* asset) {
    return *std::launder(reinterpret_cast<const Asset*>(asset->inside));
}

inline hl_code say(hl_error* error, hl_code code, std::uint64_t byte, std::string_view words) {
    if (error) {
        error->code = code;
        error->byte = byte;
        const std::size_t size = std::min(words.size(), sizeof error->words - 1);
        std::memcpy(error->words, words.data(), size);
        error->words[size] = 0;
    }
    return code;
}

inline hl_code say(hl_error* error, const AssetError& problem) {
    const bool misaligned = problem.kind == AssetError::Kind::misaligned;
    const hl_code code = problem.kind == AssetError::Kind::newer ? HL_NEWER
                         : misaligned                            ? HL_BAD_VALUE
                                                                 : HL_DAMAGED;
    return say(error, code, misaligned ? HL_NO_PLACE : problem.byte, problem.words);
}

inline hl_code say(hl_error* error, const Outcome& refused) {
    return refused ? say(error, refused->code, refused->byte, refused->words)
                   : say(error, HL_OK, HL_NO_PLACE, "");
}

/// Whatever is thrown inside comes out as a code.
template <class Body>
hl_code guarded(hl_error* error, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return say(error, HL_NO_MEMORY, HL_NO_PLACE, "there is not enough memory");
    } catch (const std::exception& thrown) {
        return say(error, HL_NO_MEMORY, HL_NO_PLACE, thrown.what());
    }
}

/// Of a sound asset.
template <class Body>
hl_code withContent(const hl_asset* opened, hl_error* error, const Body& body) {
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        return body(asset);
    });
}

inline hl_code nullRefused(hl_error* error, const char* what) {
    return say(error, HL_BAD_VALUE, HL_NO_PLACE, std::string_view(what));
}

inline hl_code pastTheLast(hl_error* error, const char* what, std::size_t number, std::size_t count) {
    return say(error, HL_BAD_VALUE, HL_NO_PLACE,
               std::string(what) + " " + std::to_string(number) + " of " + std::to_string(count));
}

/// No struct of any version is larger: what says so is no size.
inline constexpr std::size_t kLargestStruct = 4096;

/// Whether a caller's struct of `size` bytes is one: no smaller than its first version.
template <class Struct>
Outcome checkSize(const char* name, std::size_t size, std::size_t least) {
    // Where pointers have 32 bits, structs are smaller than their first version was with 64: those programs
    // have the structs of this version.
    least = std::min(least, sizeof(Struct));
    if (size >= least && size <= kLargestStruct && size % 4 == 0) return std::nullopt;
    return Refusal{HL_WRONG_SIZE, std::to_string(size) + " bytes of " + name + "; expected " +
                                      std::to_string(sizeof(Struct)) + ", or " + std::to_string(least) +
                                      " and more of other versions"};
}

/// As much of a struct as the caller knows; what this library does not know of becomes 0.
template <class Struct>
void giveBack(const Struct& value, void* out, std::size_t size) {
    std::memcpy(out, &value, std::min(size, sizeof value));
    if (size > sizeof value) std::memset(static_cast<char*>(out) + sizeof value, 0, size - sizeof value);
}

/// A caller's struct that begins with its size, as this library knows it. What older callers do not know of
/// is as in `value`.
template <class Struct>
Outcome takeIn(const Struct* given, const char* name, std::size_t least, Struct& value) {
    if (Outcome refused = checkSize<Struct>(name, given->size, least)) return refused;
    const char* const bytes = reinterpret_cast<const char*>(given);
    if (given->size > sizeof value) {
        const bool asksForNothing =
            std::all_of(bytes + sizeof value, bytes + given->size, [](char byte) { return byte == 0; });
        if (!asksForNothing)
            return Refusal{HL_NEWER, std::string(name) + " of " + std::to_string(given->size) +
                                         " bytes asks for what this library does not know; it has " +
                                         std::to_string(sizeof value)};
    }
    std::memcpy(&value, bytes, std::min(given->size, sizeof value));
    value.size = sizeof value;
    return std::nullopt;
}

// Bytes that structs had in their first version.
inline constexpr std::size_t kFirstAssetInfo = 88, kFirstBone = 72, kFirstLayer = 24, kFirstInstanceInfo = 40,
                             kFirstEffect = 136, kFirstLevel = 28, kFirstViewed = 24, kFirstReport = 12,
                             kFirstFrame = 128, kFirstLimits = 24, kFirstClip = 56, kFirstPlay = 24,
                             kFirstView = 144, kFirstLamp = 96, kFirstPose = 48, kFirstReserve = 24;

/// A frame of any version.
template <class Body>
hl_code withFrame(hl_instance* instance, const hl_frame* given, hl_error* error, const Body& body) {
    if (!instance || !given) return nullRefused(error, "no instance or no frame");
    return guarded(error, [&] {
        hl_frame frame{};
        if (const Outcome refused = takeIn(given, "hl_frame", kFirstFrame, frame)) return say(error, refused);
        return say(error, body(instance->instance, frame));
    });
}

}  // namespace hairloom::runtime
