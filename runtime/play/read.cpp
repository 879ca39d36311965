// SPDX-License-Identifier: MIT
// What an instance shows: positions, directions and radii of its guides or hairs, in one pass over them.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "follow/follow_kernels.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kRun = FollowHairs::kMaxShownPoints;  ///< points at a time
constexpr float kMillimetre = 1e-3f;

std::size_t bytesOfPosition(std::uint32_t format) {
    return format == HL_FLOAT32 ? sizeof(Float3) : 3 * sizeof(std::uint16_t);
}
std::size_t bytesOfRadius(std::uint32_t format) {
    return format == HL_FLOAT32 ? sizeof(float) : sizeof(std::uint16_t);
}

/// Whether a value of `size` bytes of each of `count` points fits.
Outcome fits(const hl_out& out, const char* what, std::size_t count, std::size_t size) {
    if (!out.data) return std::nullopt;
    if (out.stride < size)
        return Refusal{HL_WRONG_SIZE, std::to_string(out.stride) + " bytes of stride of " + what +
                                          "; expected " + std::to_string(size)};
    if (out.bytes < size || (count > 0 && (out.bytes - size) / out.stride < count - 1))
        return Refusal{HL_WRONG_SIZE, std::to_string(out.bytes) + " bytes for " + std::to_string(count) +
                                          " " + what + " of " + std::to_string(size) + " bytes"};
    return std::nullopt;
}

/// Values of `size` bytes without gaps, to where those of point `first` and later ones go.
void put(const hl_out& out, std::size_t first, std::size_t count, std::size_t size, const void* values) {
    char* to = static_cast<char*>(out.data) + first * out.stride;
    if (out.stride == size) {
        std::memcpy(to, values, count * size);
        return;
    }
    const char* from = static_cast<const char*>(values);
    for (std::size_t i = 0; i < count; ++i, to += out.stride, from += size) std::memcpy(to, from, size);
}

float between(float root, float tip, std::size_t p, std::size_t points) {
    return root + (tip - root) * static_cast<float>(p) / static_cast<float>(points - 1);
}

void lower(std::atomic<float>& least, float value) {
    float now = least.load(std::memory_order_relaxed);
    while (value < now && !least.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
    }
}
void raise(std::atomic<float>& most, float value) {
    float now = most.load(std::memory_order_relaxed);
    while (value > now && !most.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
    }
}

bool isAligned(const void* data) {
    return reinterpret_cast<std::uintptr_t>(data) % alignof(Float3) == 0;
}

}  // namespace

/// One read under way. Runs of points come from whatever threads.
struct Instance::Reading {
    const hl_read& read;
    Shown& shown;
    bool wasShown;  ///< shown.positions has these points
    bool wantsBounds;
    Float3 sinceShown;  ///< what is added to them, so that they are measured from the origin of now
    const FollowKernels& kernels = followKernels();
    Float3 from{read.from[0], read.from[1], read.from[2]};
    Float3 scale{65535.0f / (read.to[0] - read.from[0]), 65535.0f / (read.to[1] - read.from[1]),
                 65535.0f / (read.to[2] - read.from[2])};
    std::array<std::atomic<float>, 3> low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    std::atomic<std::uint32_t> outside = 0;

    /// Where positions may be evaluated at once, as they are wanted and without gaps; or null.
    Float3* const whole = read.positions.data && read.position_format == HL_FLOAT32 &&
                                  read.positions.stride == sizeof(Float3) && isAligned(read.positions.data)
                              ? static_cast<Float3*>(read.positions.data)
                              : nullptr;
    /// Of at most kRun points, in strands of `perStrand`.
    void take(std::size_t first, std::size_t count, std::size_t perStrand, const Float3* positions,
              const float* radii);

  private:
    void putPositions(const hl_out& out, std::size_t first, std::size_t count, const Float3* positions);
    void putTangents(std::size_t first, std::size_t count, std::size_t perStrand, const float* positions);
    void putRadii(std::size_t first, std::size_t count, const float* radii) const;
    void putPrevious(std::size_t first, std::size_t count, const Float3* positions);
};

void Instance::Reading::putPositions(const hl_out& out, std::size_t first, std::size_t count,
                                     const Float3* positions) {
    const auto* const values = reinterpret_cast<const float*>(positions);
    if (read.position_format == HL_FLOAT32) {
        put(out, first, count, sizeof(Float3), values);
        return;
    }
    std::array<std::uint16_t, 3 * kRun> small;
    if (read.position_format == HL_FLOAT16)
        kernels.toHalves(values, count, from, small.data());
    else
        outside += kernels.toNorms(values, count, from, scale, small.data());
    put(out, first, count, 3 * sizeof(std::uint16_t), small.data());
}

void Instance::Reading::putTangents(std::size_t first, std::size_t count, std::size_t perStrand,
                                    const float* positions) {
    std::array<float, 3 * kRun> directions;
    kernels.tangents(positions, count, perStrand, directions.data());
    if (read.tangent_format == HL_FLOAT32) {
        put(read.tangents, first, count, sizeof(Float3), directions.data());
        return;
    }
    std::array<std::uint16_t, 3 * kRun> small;
    if (read.tangent_format == HL_FLOAT16)
        kernels.toHalves(directions.data(), count, {}, small.data());
    else
        kernels.toSignedNorms(directions.data(), 3 * count, reinterpret_cast<std::int16_t*>(small.data()));
    put(read.tangents, first, count, 3 * sizeof(std::uint16_t), small.data());
}

void Instance::Reading::putRadii(std::size_t first, std::size_t count, const float* radii) const {
    if (read.radius_format == HL_FLOAT32) {
        put(read.radii, first, count, sizeof(float), radii);
        return;
    }
    std::array<std::uint16_t, kRun> small;
    if (read.radius_format == HL_FLOAT16) {
        // The kernel takes three at a time.
        std::array<float, kRun + 2> padded{};
        std::array<std::uint16_t, kRun + 2> halves;
        std::copy_n(radii, count, padded.data());
        kernels.toHalves(padded.data(), (count + 2) / 3, {}, halves.data());
        std::copy_n(halves.data(), count, small.data());
    } else {
        for (std::size_t i = 0; i < count; ++i)
            small[i] = static_cast<std::uint16_t>(
                std::clamp(radii[i] * (65535.0f / kMillimetre) + 0.5f, 0.0f, 65535.0f));
    }
    put(read.radii, first, count, sizeof(std::uint16_t), small.data());
}

/// And keeps them for the next read.
void Instance::Reading::putPrevious(std::size_t first, std::size_t count, const Float3* positions) {
    Float3* const kept = shown.positions.data() + first;
    if (wasShown) {
        if (!(sinceShown == Float3{}))
            for (std::size_t i = 0; i < count; ++i) kept[i] = kept[i] + sinceShown;
        putPositions(read.previous, first, count, kept);
    } else {
        putPositions(read.previous, first, count, positions);
    }
    std::copy_n(positions, count, kept);
}

void Instance::Reading::take(std::size_t first, std::size_t count, std::size_t perStrand,
                             const Float3* positions, const float* radii) {
    const auto* const values = reinterpret_cast<const float*>(positions);
    if (read.positions.data && (!whole || positions != whole + first))
        putPositions(read.positions, first, count, positions);
    if (read.previous.data) putPrevious(first, count, positions);
    if (read.tangents.data) putTangents(first, count, perStrand, values);
    if (read.radii.data) putRadii(first, count, radii);
    if (!wantsBounds) return;
    float least[3] = {1e30f, 1e30f, 1e30f}, most[3] = {-1e30f, -1e30f, -1e30f};
    kernels.grow(values, count, least, most);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lower(low[axis], least[axis]);
        raise(high[axis], most[axis]);
    }
}

Outcome Instance::checkRead(const hl_read& read, std::size_t points) const {
    for (const std::uint32_t format : {read.position_format, read.tangent_format, read.radius_format}) {
        if (format > HL_NORM16)
            return Refusal{HL_BAD_VALUE, "format " + std::to_string(format) +
                                             "; expected HL_FLOAT32, HL_FLOAT16 or HL_NORM16"};
    }
    for (std::size_t axis = 0; axis < 3 && read.position_format != HL_FLOAT32; ++axis) {
        const bool box = read.position_format == HL_NORM16;
        if (!std::isfinite(read.from[axis]) || (box && !(read.to[axis] > read.from[axis])) ||
            (box && !std::isfinite(read.to[axis])))
            return Refusal{HL_BAD_VALUE, "positions of 16 bits in a box from " +
                                             std::to_string(read.from[axis]) + " to " +
                                             std::to_string(read.to[axis]) + "; expected more than nothing"};
    }
    if (Outcome no = fits(read.positions, "positions", points, bytesOfPosition(read.position_format)))
        return no;
    if (Outcome no = fits(read.previous, "previous positions", points, bytesOfPosition(read.position_format)))
        return no;
    if (Outcome no = fits(read.tangents, "tangents", points, bytesOfPosition(read.tangent_format))) return no;
    return fits(read.radii, "radii", points, bytesOfRadius(read.radius_format));
}

std::size_t Instance::hairPoints() const {
    return hairs_ ? std::size_t{hairs_->hairCount()} * hairs_->pointsPerHair() : 0;
}

Outcome Instance::read(hl_read& read, bool wantsBounds) {
    const bool hairs = read.hairs != 0;
    if (hairs && !hairs_)
        return Refusal{HL_BAD_VALUE, "the instance was made without follow hairs, or the asset has none"};
    const std::size_t points = hairs ? std::size_t{hairsRead()} * hairs_->pointsPerHair() : positions_.size();
    if (Outcome refused = checkRead(read, points)) return refused;
    Shown& shown = shown_[hairs ? 1 : 0];
    const std::uint64_t now = stateOf(hairs);
    const auto tellBounds = [&] {
        std::memcpy(read.bounds_min, &shown.low, sizeof shown.low);
        std::memcpy(read.bounds_max, &shown.high, sizeof shown.high);
    };
    read.outside = 0;
    read.changed = read.state != now || (read.previous.data && !shown.still) ? 1 : 0;
    if (!read.changed && shown.boundsOf == now) {
        tellBounds();
        return std::nullopt;
    }
    read.changed = 1;
    const bool wasShown = shown.state != 0 && shown.positions.size() == points;
    if (read.previous.data) shown.positions.resize(points);
    Float3 sinceShown{};
    if (wasShown) {
        sinceShown = {static_cast<float>(shown.origin[0] - origin_[0]),
                      static_cast<float>(shown.origin[1] - origin_[1]),
                      static_cast<float>(shown.origin[2] - origin_[2])};
    }
    Reading reading{read, shown, wasShown, wantsBounds, sinceShown};
    showPositions();
    if (hairs)
        readHairsInto(reading);
    else
        readGuidesInto(reading);
    if (read.previous.data) {
        shown.still = !wasShown || shown.state == now;
        shown.state = now;
        shown.origin = origin_;
    }
    read.state = now;
    read.outside = reading.outside;
    if (!wantsBounds) return std::nullopt;
    const bool any = reading.low[0] <= reading.high[0];
    shown.low = any ? Float3{reading.low[0], reading.low[1], reading.low[2]} : Float3{};
    shown.high = any ? Float3{reading.high[0], reading.high[1], reading.high[2]} : Float3{};
    shown.boundsOf = now;
    tellBounds();
    return std::nullopt;
}

void Instance::readGuidesInto(Reading& reading) {
    std::array<float, kRun> radii;
    for (std::size_t s = 0; s + 1 < offsets_.size(); ++s) {
        const std::size_t first = offsets_[s], count = offsets_[s + 1] - first;
        for (std::size_t p = 0; p < count; ++p)
            radii[p] =
                radii_.own.empty() ? between(radii_.root, radii_.tip, p, count) : radii_.own[first + p];
        reading.take(first, count, count, &positions_[first], radii.data());
    }
}

void Instance::readHairsInto(Reading& reading) {
    showVelocities();
    const Vector<std::uint32_t>& taken = levels_ ? levels_->taken : hairGroups_;
    const std::size_t count = hairs_->pointsPerHair();
    // Fewer hairs cover what all did.
    const float wider = static_cast<float>(hairs_->hairCount()) / static_cast<float>(hairsRead());
    const auto radiiOfHair = [&](std::size_t hair) -> std::array<float, 2> {
        if (radii_.ofHairs.empty()) return {radii_.root, radii_.tip};
        const auto next = std::upper_bound(taken.begin(), taken.end(), hair);
        return radii_.ofHairs[static_cast<std::size_t>(next - taken.begin() - 1)];
    };
    const auto write = [&](std::size_t first, std::size_t some, const Float3* positions) {
        std::array<float, kRun> radii;
        for (std::size_t h = 0; reading.read.radii.data && h < some; ++h) {
            const auto [root, tip] = radiiOfHair(first + h);
            for (std::size_t p = 0; p < count; ++p)
                radii[h * count + p] = between(root, tip, p, count) * wider;
        }
        reading.take(first * count, some * count, count, positions, radii.data());
    };
    hairs_->showSome({positions_, velocities_, turns_}, hairGroups_, taken, reading.whole, std::cref(write),
                     host_);
}

Outcome Instance::readHairNumbers(std::span<std::uint32_t> numbers) const {
    if (numbers.size() != hairsRead())
        return Refusal{HL_WRONG_SIZE, "space for " + std::to_string(numbers.size()) + " numbers of " +
                                          std::to_string(hairsRead()) + " hairs"};
    const Vector<std::uint32_t>& taken = levels_ ? levels_->taken : hairGroups_;
    for (std::size_t g = 0; g + 1 < taken.size(); ++g) {
        for (std::uint32_t h = taken[g]; h < taken[g + 1]; ++h) numbers[h] = hairGroups_[g] + h - taken[g];
    }
    return std::nullopt;
}

}  // namespace hairloom::runtime
