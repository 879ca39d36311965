// SPDX-License-Identifier: MIT
#include "hairloom/memory.h"

#include <atomic>
#include <new>

namespace hairloom::runtime {
namespace {

MemoryHost lentMemory;
/// Pieces that are out.
std::atomic<std::size_t> piecesOut{0};

}  // namespace

bool lendMemory(const MemoryHost& host) {
    if (piecesOut.load() > 0) return false;
    lentMemory = host;
    return true;
}

void* takeMemory(std::size_t bytes, std::size_t alignment) {
    // Before it is asked for: another thread that lends memory now is refused.
    ++piecesOut;
    void* data = nullptr;
    try {
        if (lentMemory.allocate)
            data = lentMemory.allocate(lentMemory.user, bytes, alignment);
        else if (alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__)
            data = ::operator new (bytes, std::align_val_t{alignment});
        else
            data = ::operator new(bytes);
        if (!data) throw std::bad_alloc();
    } catch (...) {
        --piecesOut;
        throw;
    }
    return data;
}

void returnMemory(void* data, std::size_t bytes, std::size_t alignment) noexcept {
    if (!data) return;
    if (lentMemory.release)
        lentMemory.release(lentMemory.user, data, bytes, alignment);
    else if (alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__)
        ::operator delete (data, std::align_val_t{alignment});
    else
        ::operator delete(data);
    --piecesOut;
}

}  // namespace hairloom::runtime
