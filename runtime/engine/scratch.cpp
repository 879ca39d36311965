// SPDX-License-Identifier: MIT
#include "engine/scratch.h"

#include <algorithm>
#include <thread>

namespace hairloom::runtime {
namespace {

/// Counts threads in the order in which they first ask: those of a pool then start at different pieces.
std::size_t threadNumber() {
    static std::atomic<std::size_t> next{0};
    thread_local const std::size_t kNumber = next.fetch_add(1, std::memory_order_relaxed);
    return kNumber;
}

}  // namespace

void Scratch::grow(std::size_t count, std::size_t own, std::size_t floats) {
    if (count != count_ || own != own_ || floats > floats_) make(count, own, std::max(floats, floats_));
}

void Scratch::make(std::size_t count, std::size_t own, std::size_t floats) {
    pieces_ = count > 0 ? std::make_unique<Piece[]>(count) : nullptr;
    for (std::size_t i = 0; i < count; ++i) {
        pieces_[i].memory = Floats(own + floats, 0.0f);
        pieces_[i].lanes.own = pieces_[i].memory.data();
        pieces_[i].lanes.solver = pieces_[i].memory.data() + own;
    }
    count_ = count;
    own_ = own;
    floats_ = floats;
}

void Scratch::reserveSpheres(std::size_t count, std::size_t capsules) {
    for (std::size_t i = 0; i < count_; ++i) {
        pieces_[i].lanes.touchable.reserve(count);
        pieces_[i].lanes.touchableCapsules.reserve(capsules);
    }
}

Scratch::Piece& Scratch::take() {
    const std::size_t own = threadNumber() % count_;
    for (;;) {
        for (std::size_t i = 0; i < count_; ++i) {
            Piece& piece = pieces_[(own + i) % count_];
            if (!piece.taken.exchange(true, std::memory_order_acquire)) return piece;
        }
        std::this_thread::yield();
    }
}

std::size_t Scratch::bytes() const {
    return count_ * (sizeof(Piece) + (own_ + floats_) * sizeof(float));
}

std::size_t scratchPieces(std::size_t jobs) {
    const std::size_t threads = std::max(std::thread::hardware_concurrency(), 1u);
    return std::max(std::min(jobs, threads), std::size_t{1});
}

}  // namespace hairloom::runtime
