// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What HLSL has and C++ has not, for shaders that cmake/hlsl_to_cpp.cmake has turned into C++: vectors with
// their functions, and resources as views of plain memory. Only what the shaders use. Names are HLSL's.

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hairloom::software {
// NOLINTBEGIN(readability-identifier-naming, bugprone-macro-parentheses, google-explicit-constructor)

using uint = std::uint32_t;

template <class T>
struct vector2 {
    T x, y;
    vector2() = default;
    constexpr vector2(T all) : x(all), y(all) {}
    constexpr vector2(T a, T b) : x(a), y(b) {}
    template <class U>
    constexpr explicit vector2(vector2<U> v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)) {}
    T& operator[](std::size_t i) { return i == 0 ? x : y; }
    T operator[](std::size_t i) const { return i == 0 ? x : y; }
    vector2 xy() const { return *this; }
    vector2 yx() const { return {y, x}; }
};

template <class T>
struct vector3 {
    T x, y, z;
    vector3() = default;
    constexpr vector3(T all) : x(all), y(all), z(all) {}
    constexpr vector3(T a, T b, T c) : x(a), y(b), z(c) {}
    constexpr vector3(T a, vector2<T> v) : x(a), y(v.x), z(v.y) {}
    constexpr vector3(vector2<T> v, T c) : x(v.x), y(v.y), z(c) {}
    template <class U>
    constexpr explicit vector3(vector3<U> v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}
    T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
    T operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
    vector3 xyz() const { return *this; }
    vector3 yzx() const { return {y, z, x}; }
    vector3 zxy() const { return {z, x, y}; }
    vector2<T> xy() const { return {x, y}; }
    vector2<T> yz() const { return {y, z}; }
};

template <class T>
struct vector4 {
    T x, y, z, w;
    vector4() = default;
    constexpr vector4(T all) : x(all), y(all), z(all), w(all) {}
    constexpr vector4(T a, T b, T c, T d) : x(a), y(b), z(c), w(d) {}
    constexpr vector4(vector3<T> v, T d) : x(v.x), y(v.y), z(v.z), w(d) {}
    constexpr vector4(T a, vector3<T> v) : x(a), y(v.x), z(v.y), w(v.z) {}
    constexpr vector4(vector2<T> u, vector2<T> v) : x(u.x), y(u.y), z(v.x), w(v.y) {}
    constexpr vector4(vector2<T> u, T c, T d) : x(u.x), y(u.y), z(c), w(d) {}
    template <class U>
    constexpr explicit vector4(vector4<U> v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)), w(static_cast<T>(v.w)) {}
    T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
    T operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
    vector2<T> xy() const { return {x, y}; }
    vector2<T> zw() const { return {z, w}; }
    vector2<T> xz() const { return {x, z}; }
    vector2<T> yw() const { return {y, w}; }
    vector2<T> ww() const { return {w, w}; }
    vector3<T> xyz() const { return {x, y, z}; }
    vector3<T> yzw() const { return {y, z, w}; }
};

using float2 = vector2<float>;
using float3 = vector3<float>;
using float4 = vector4<float>;
using int2 = vector2<int>;
using int3 = vector3<int>;
using int4 = vector4<int>;
using uint2 = vector2<uint>;
using uint3 = vector3<uint>;
using uint4 = vector4<uint>;
using bool2 = vector2<bool>;
using bool3 = vector3<bool>;
using bool4 = vector4<bool>;

/// Column-major.
struct float4x4 {
    float m[16];
};

inline float4 mul(const float4x4& a, float4 v) {
    const auto row = [&](int i) {
        return a.m[i] * v.x + a.m[4 + i] * v.y + a.m[8 + i] * v.z + a.m[12 + i] * v.w;
    };
    return {row(0), row(1), row(2), row(3)};
}

#define HAIRLOOM_OPERATOR(T2, T3, T4, R2, R3, R4, op)              \
    inline R2 operator op(T2 a, T2 b) {                            \
        return R2(a.x op b.x, a.y op b.y);                         \
    }                                                              \
    inline R3 operator op(T3 a, T3 b) {                            \
        return R3(a.x op b.x, a.y op b.y, a.z op b.z);             \
    }                                                              \
    inline R4 operator op(T4 a, T4 b) {                            \
        return R4(a.x op b.x, a.y op b.y, a.z op b.z, a.w op b.w); \
    }
#define HAIRLOOM_ARITHMETIC(T2, T3, T4, op)       \
    HAIRLOOM_OPERATOR(T2, T3, T4, T2, T3, T4, op) \
    inline T2& operator op##=(T2& a, T2 b) {      \
        return a = a op b;                        \
    }                                             \
    inline T3& operator op##=(T3& a, T3 b) {      \
        return a = a op b;                        \
    }                                             \
    inline T4& operator op##=(T4& a, T4 b) {      \
        return a = a op b;                        \
    }
HAIRLOOM_ARITHMETIC(float2, float3, float4, +)
HAIRLOOM_ARITHMETIC(float2, float3, float4, -)
HAIRLOOM_ARITHMETIC(float2, float3, float4, *)
HAIRLOOM_ARITHMETIC(float2, float3, float4, /)
HAIRLOOM_ARITHMETIC(int2, int3, int4, +)
HAIRLOOM_ARITHMETIC(int2, int3, int4, -)
HAIRLOOM_ARITHMETIC(int2, int3, int4, >>)
HAIRLOOM_ARITHMETIC(uint2, uint3, uint4, &)
HAIRLOOM_ARITHMETIC(uint2, uint3, uint4, |)
HAIRLOOM_ARITHMETIC(uint2, uint3, uint4, <<)
HAIRLOOM_OPERATOR(float2, float3, float4, bool2, bool3, bool4, <)
HAIRLOOM_OPERATOR(float2, float3, float4, bool2, bool3, bool4, >)
HAIRLOOM_OPERATOR(float2, float3, float4, bool2, bool3, bool4, >=)
HAIRLOOM_OPERATOR(int2, int3, int4, bool2, bool3, bool4, <)
HAIRLOOM_OPERATOR(int2, int3, int4, bool2, bool3, bool4, >=)
HAIRLOOM_OPERATOR(uint2, uint3, uint4, bool2, bool3, bool4, >=)
#undef HAIRLOOM_ARITHMETIC
#undef HAIRLOOM_OPERATOR
inline float2 operator-(float2 v) {
    return {-v.x, -v.y};
}
inline float3 operator-(float3 v) {
    return {-v.x, -v.y, -v.z};
}
inline float4 operator-(float4 v) {
    return {-v.x, -v.y, -v.z, -v.w};
}

inline bool any(bool2 v) {
    return v.x || v.y;
}
inline bool any(bool3 v) {
    return v.x || v.y || v.z;
}
inline bool all(bool2 v) {
    return v.x && v.y;
}
inline bool all(bool3 v) {
    return v.x && v.y && v.z;
}

// As shaders have them: what is not a number becomes the other one.
inline float min(float a, float b) {
    return a < b ? a : b;
}
inline float max(float a, float b) {
    return a > b ? a : b;
}
inline int min(int a, int b) {
    return a < b ? a : b;
}
inline int max(int a, int b) {
    return a > b ? a : b;
}
inline uint min(uint a, uint b) {
    return a < b ? a : b;
}
inline uint max(uint a, uint b) {
    return a > b ? a : b;
}
inline float abs(float v) {
    return std::fabs(v);
}
/// Without the function that processors need who have no instruction for it; beyond 2^23 all numbers are
/// whole.
inline float floor(float v) {
    if (!(std::fabs(v) < 8388608.0f)) return v;
    const auto whole = static_cast<float>(static_cast<int>(v));
    return whole > v ? whole - 1.0f : whole;
}
inline float ceil(float v) {
    return -floor(-v);
}
inline float round(float v) {
    return std::nearbyint(v);
}
inline float frac(float v) {
    return v - std::floor(v);
}
inline float sqrt(float v) {
    return std::sqrt(v);
}
inline float rsqrt(float v) {
    return 1.0f / std::sqrt(v);
}
inline float exp(float v) {
    return std::exp(v);
}
inline float exp2(float v) {
    return std::exp2(v);
}
inline float log(float v) {
    return std::log(v);
}
inline float log2(float v) {
    return std::log2(v);
}
inline float asin(float v) {
    return std::asin(v);
}
inline float acos(float v) {
    return std::acos(v);
}
inline float pow(float a, float b) {
    return std::pow(a, b);
}
inline float saturate(float v) {
    return min(max(v, 0.0f), 1.0f);
}
inline float clamp(float v, float low, float high) {
    return min(max(v, low), high);
}
inline int clamp(int v, int low, int high) {
    return min(max(v, low), high);
}
inline float lerp(float a, float b, float t) {
    return a + t * (b - a);
}
inline float smoothstep(float low, float high, float v) {
    const float t = saturate((v - low) / (high - low));
    return t * t * (3.0f - 2.0f * t);
}
inline uint asuint(float v) {
    return std::bit_cast<uint>(v);
}
inline float asfloat(uint v) {
    return std::bit_cast<float>(v);
}

#define HAIRLOOM_OF_ONE(name)                                \
    inline float2 name(float2 v) {                           \
        return {name(v.x), name(v.y)};                       \
    }                                                        \
    inline float3 name(float3 v) {                           \
        return {name(v.x), name(v.y), name(v.z)};            \
    }                                                        \
    inline float4 name(float4 v) {                           \
        return {name(v.x), name(v.y), name(v.z), name(v.w)}; \
    }
#define HAIRLOOM_OF_TWO(name, T2, T3, T4)                                        \
    inline T2 name(T2 a, T2 b) {                                                 \
        return {name(a.x, b.x), name(a.y, b.y)};                                 \
    }                                                                            \
    inline T3 name(T3 a, T3 b) {                                                 \
        return {name(a.x, b.x), name(a.y, b.y), name(a.z, b.z)};                 \
    }                                                                            \
    inline T4 name(T4 a, T4 b) {                                                 \
        return {name(a.x, b.x), name(a.y, b.y), name(a.z, b.z), name(a.w, b.w)}; \
    }
HAIRLOOM_OF_ONE(abs)
HAIRLOOM_OF_ONE(floor)
HAIRLOOM_OF_ONE(ceil)
HAIRLOOM_OF_ONE(round)
HAIRLOOM_OF_ONE(sqrt)
HAIRLOOM_OF_ONE(exp)
HAIRLOOM_OF_ONE(log)
HAIRLOOM_OF_ONE(saturate)
HAIRLOOM_OF_TWO(min, float2, float3, float4)
HAIRLOOM_OF_TWO(max, float2, float3, float4)
HAIRLOOM_OF_TWO(min, int2, int3, int4)
HAIRLOOM_OF_TWO(max, int2, int3, int4)
HAIRLOOM_OF_TWO(pow, float2, float3, float4)
#undef HAIRLOOM_OF_ONE
#undef HAIRLOOM_OF_TWO
inline float2 clamp(float2 v, float2 low, float2 high) {
    return min(max(v, low), high);
}
inline float3 clamp(float3 v, float3 low, float3 high) {
    return min(max(v, low), high);
}
inline float4 clamp(float4 v, float4 low, float4 high) {
    return min(max(v, low), high);
}
inline int2 clamp(int2 v, int2 low, int2 high) {
    return min(max(v, low), high);
}
inline int3 clamp(int3 v, int3 low, int3 high) {
    return min(max(v, low), high);
}
inline float2 lerp(float2 a, float2 b, float2 t) {
    return a + t * (b - a);
}
inline float3 lerp(float3 a, float3 b, float3 t) {
    return a + t * (b - a);
}
inline float4 lerp(float4 a, float4 b, float4 t) {
    return a + t * (b - a);
}

inline float dot(float2 a, float2 b) {
    return a.x * b.x + a.y * b.y;
}
inline float dot(float3 a, float3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float dot(float4 a, float4 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
inline float3 cross(float3 a, float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(float2 v) {
    return std::sqrt(dot(v, v));
}
inline float length(float3 v) {
    return std::sqrt(dot(v, v));
}
inline float3 normalize(float3 v) {
    return v * (1.0f / length(v));
}

template <class T>
struct StructuredBuffer {
    const T* elements = nullptr;
    const T& operator[](std::size_t i) const { return elements[i]; }
};

/// Words that other threads may write as well: each access is whole, no more.
class SharedWord {
  public:
    explicit SharedWord(uint& word) : word_(&word) {}
    operator uint() const { return std::atomic_ref(*word_).load(std::memory_order_relaxed); }
    const SharedWord& operator=(uint value) const {
        std::atomic_ref(*word_).store(value, std::memory_order_relaxed);
        return *this;
    }
    std::atomic_ref<uint> atomic() const { return std::atomic_ref(*word_); }

  private:
    uint* word_;
};

template <class T>
struct RWStructuredBuffer {
    T* elements = nullptr;
    T& operator[](std::size_t i) const { return elements[i]; }
};
template <>
struct RWStructuredBuffer<uint> {
    uint* elements = nullptr;
    SharedWord operator[](std::size_t i) const { return SharedWord(elements[i]); }
};

inline uint fetchMin(const SharedWord& word, uint value) {
    uint before = word;
    while (value < before && !word.atomic().compare_exchange_weak(before, value, std::memory_order_relaxed)) {
    }
    return before;
}
inline void InterlockedMin(const SharedWord& word, uint value) {
    fetchMin(word, value);
}
inline void InterlockedMin(const SharedWord& word, uint value, uint& before) {
    before = fetchMin(word, value);
}
inline void InterlockedMax(const SharedWord& word, uint value) {
    uint before = word;
    while (value > before && !word.atomic().compare_exchange_weak(before, value, std::memory_order_relaxed)) {
    }
}
inline void InterlockedAdd(const SharedWord& word, uint value) {
    word.atomic().fetch_add(value, std::memory_order_relaxed);
}
inline void InterlockedAdd(const SharedWord& word, uint value, uint& before) {
    before = word.atomic().fetch_add(value, std::memory_order_relaxed);
}
inline void InterlockedExchange(const SharedWord& word, uint value, uint& before) {
    before = word.atomic().exchange(value, std::memory_order_relaxed);
}
inline void InterlockedOr(const SharedWord& word, uint value) {
    word.atomic().fetch_or(value, std::memory_order_relaxed);
}

struct SamplerState {};

/// Texels as floats, rows from the top.
template <class T>
struct Texture2D {
    const T* texels = nullptr;
    int width = 0, height = 0;

    T Load(int3 at) const {
        return texels[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(at.x)];
    }
    void GetDimensions(float& w, float& h) const {
        w = static_cast<float>(width);
        h = static_cast<float>(height);
    }
    /// Linear between the middles of texels, held at the edges.
    T SampleLevel(SamplerState, float2 uv, float) const {
        const float x = clamp(uv.x * static_cast<float>(width) - 0.5f, 0.0f, static_cast<float>(width - 1));
        const float y = clamp(uv.y * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
        const int x0 = static_cast<int>(x);
        const int y0 = static_cast<int>(y);
        const T* upper = texels + static_cast<std::size_t>(y0) * static_cast<std::size_t>(width) + x0;
        const T* lower = upper + (y0 + 1 < height ? width : 0);
        const int right = x0 + 1 < width ? 1 : 0;
        const float fx = x - static_cast<float>(x0);
        const float fy = y - static_cast<float>(y0);
        const T a = upper[0] + (upper[right] - upper[0]) * fx;
        const T b = lower[0] + (lower[right] - lower[0]) * fx;
        return a + (b - a) * fy;
    }
};

// NOLINTEND(readability-identifier-naming, bugprone-macro-parentheses, google-explicit-constructor)
}  // namespace hairloom::software
