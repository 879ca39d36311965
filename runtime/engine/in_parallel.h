// SPDX-License-Identifier: MIT
#pragma once
// Loops over pieces of an array, on what threads the host lends.

#include <cstddef>
#include <functional>

#include "hairloom/host.h"

namespace hairloom::runtime {

/// body(begin, end) for pieces of [0, count) of about `grain`: on the host's threads, else all at once.
template <class Body>
void inParallel(const Host& host, std::size_t count, std::size_t grain, const Body& body) {
    if (!host.parallelFor) return body(std::size_t{0}, count);
    // By reference: a std::function that copied the captures would allocate.
    host.parallelFor(count, grain, std::cref(body));
}

}  // namespace hairloom::runtime
