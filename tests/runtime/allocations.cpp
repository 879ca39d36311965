// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/runtime/allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

#ifdef _WIN32
#include <malloc.h>
#endif

namespace {

std::atomic<std::size_t> count{0};

void* counted(std::size_t size) {
    ++count;
    if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}

void* counted(std::size_t size, std::align_val_t alignment) {
    ++count;
    const std::size_t unit = static_cast<std::size_t>(alignment);
#ifdef _WIN32
    if (void* memory = _aligned_malloc(size, unit)) return memory;
#else
    if (void* memory = std::aligned_alloc(unit, (size + unit) / unit * unit)) return memory;
#endif
    throw std::bad_alloc();
}

void freeAligned(void* memory) {
#ifdef _WIN32
    _aligned_free(memory);
#else
    std::free(memory);
#endif
}

}  // namespace

void* operator new(std::size_t size) {
    return counted(size);
}
// std::stable_sort's; the sanitizers have one of their own, whose memory is not free()'s.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++count;
    return std::malloc(size > 0 ? size : 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, alignment);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    freeAligned(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    freeAligned(memory);
}

namespace hairloom::runtime {

std::size_t allocationCount() {
    return count;
}

}  // namespace hairloom::runtime
