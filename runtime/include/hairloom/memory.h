// SPDX-License-Identifier: MIT
#pragma once
// Where the engine has its memory from: C++'s operator new, or what a game lends by hl_set_allocator(). What
// an asset and an instance hold and what their calls work in comes from here. Words of errors do not.

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace hairloom::runtime {

/// What a game lends. Both functions or none, which is operator new.
struct MemoryHost {
    void* user = nullptr;
    void* (*allocate)(void* user, std::size_t bytes, std::size_t alignment) = nullptr;
    void (*release)(void* user, void* data, std::size_t bytes, std::size_t alignment) = nullptr;
};
/// From the next takeMemory() on. False, and nothing is changed, while memory of the former is out.
bool lendMemory(const MemoryHost& host);
/// Never null; throws std::bad_alloc. `alignment` is a power of two.
void* takeMemory(std::size_t bytes, std::size_t alignment);
/// With the numbers that it was taken with.
void returnMemory(void* data, std::size_t bytes, std::size_t alignment) noexcept;

/// Of containers.
template <class T>
struct Memory {
    using value_type = T;
    Memory() = default;
    template <class U>
    Memory(const Memory<U>&) {}  // NOLINT(google-explicit-constructor)
    T* allocate(std::size_t count) {
        if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
        return static_cast<T*>(takeMemory(count * sizeof(T), alignof(T)));
    }
    void deallocate(T* data, std::size_t count) noexcept {
        returnMemory(data, count * sizeof(T), alignof(T));
    }
    friend bool operator==(Memory, Memory) { return true; }
};
template <class T>
using Vector = std::vector<T, Memory<T>>;
using String = std::basic_string<char, std::char_traits<char>, Memory<char>>;
template <class Key, class Value>
using Map = std::map<Key, Value, std::less<Key>, Memory<std::pair<const Key, Value>>>;

template <class T, class... Arguments>
std::shared_ptr<T> makeShared(Arguments&&... arguments) {
    return std::allocate_shared<std::remove_const_t<T>>(Memory<std::remove_const_t<T>>(),
                                                        std::forward<Arguments>(arguments)...);
}

/// Base of what `new` and std::make_unique make.
struct InMemory {
    static void* operator new(std::size_t bytes) { return takeMemory(bytes, kPlain); }
    static void* operator new[](std::size_t bytes) { return takeMemory(bytes, kPlain); }
    static void* operator new(std::size_t bytes, std::align_val_t alignment) {
        return takeMemory(bytes, static_cast<std::size_t>(alignment));
    }
    static void* operator new[](std::size_t bytes, std::align_val_t alignment) {
        return takeMemory(bytes, static_cast<std::size_t>(alignment));
    }
    static void* operator new(std::size_t, void* data) noexcept { return data; }
    static void operator delete(void* data, std::size_t bytes) noexcept { returnMemory(data, bytes, kPlain); }
    static void operator delete[](void* data, std::size_t bytes) noexcept {
        returnMemory(data, bytes, kPlain);
    }
    static void operator delete(void* data, std::size_t bytes, std::align_val_t alignment) noexcept {
        returnMemory(data, bytes, static_cast<std::size_t>(alignment));
    }
    static void operator delete[](void* data, std::size_t bytes, std::align_val_t alignment) noexcept {
        returnMemory(data, bytes, static_cast<std::size_t>(alignment));
    }
    static void operator delete(void*, void*) noexcept {}

  private:
    static constexpr std::size_t kPlain = __STDCPP_DEFAULT_NEW_ALIGNMENT__;
};

}  // namespace hairloom::runtime
