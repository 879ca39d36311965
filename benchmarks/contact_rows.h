// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rows of `bench contact`: what is measured where hair touches something, and the mark that it should reach.

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/benchmark.h"
#include "core/groom/groom.h"

namespace hairloom::benchmarks {

struct ContactRow {
    std::string name;
    double value = 0.0;
    std::string unit;     ///< "" for numbers of things
    double mark = 0.0;    ///< the most that it should be
    std::string limited;  ///< what limits it, read where the mark is missed

    bool met() const { return value <= mark; }
};

/// Rods in made-up scenes, held against closed equations. `next` is called before each.
std::vector<ContactRow> contactsOfRods(bool quick, const std::function<void()>& next);
/// Steps of `next` that it takes.
std::size_t contactStepsOfRods(bool quick);

/// The sample hairstyles with their spheres and skin, or those that are named. Errors: no such sample, and
/// those of makeSample().
Result<std::vector<ContactRow>> contactsOfSamples(const Options& options, const std::function<void()>& next);
std::size_t contactStepsOfSamples(const Options& options);

/// Adds what colliders do to a groom with skin that nothing moves. Errors: those of Simulation, and of
/// drawing it in the software renderer.
Status contactsAtRest(const std::string& name, const Groom& groom, bool quick, std::vector<ContactRow>& rows);

}  // namespace hairloom::benchmarks
