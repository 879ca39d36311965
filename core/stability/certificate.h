// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a hairstyle withstands with its settings, found by random storms on its own strands: a game that keeps
// within these limits will not see it break.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

/// What a storm does in each of its frames, or what may be done.
struct StormStrength {
    double step = 0;       ///< seconds
    double rootSpeed = 0;  ///< of the head, m/s
    double turn = 0;       ///< of the head, degrees a frame
    double wind = 0;       ///< m/s
};

struct FailedStorm {
    std::uint32_t number;    ///< of the storm; the same groom and number fail again
    StormStrength strength;  ///< of its frames
    std::string what;        ///< "4.2 m/s after 15 s of rest"
};

struct CertificateOptions {
    std::uint32_t storms = 1000;  ///< ≥ 1
    std::uint32_t first = 0;      ///< number of the first storm: parts of one certificate may run apart
    std::uint32_t strands = 8;    ///< in a storm, ≥ 1, drawn anew for each
    std::function<void(std::size_t done, std::size_t total)> progress;  ///< called on any thread
    std::function<bool()> cancelled;                                    ///< asked on any thread
};

/// How some of a certificate's storms ended.
struct StormTally {
    std::uint32_t first = 0;     ///< number of the first storm
    std::uint32_t storms = 0;    ///< that ran, of consecutive numbers
    std::uint32_t calm = 0;      ///< as in Certificate
    std::uint32_t calmLate = 0;  ///< as in Certificate
    std::vector<FailedStorm> failed;
};

struct Certificate {
    /// None that stayed within 1 + kStormMargin of these has failed, and some have; 0 where there are none.
    StormStrength limits;
    std::uint32_t storms = 0;    ///< that ran
    std::uint32_t within = 0;    ///< of those, within the limits and their margin
    std::uint32_t calm = 0;      ///< with every point below 5 mm/s after 5 s of rest
    std::uint32_t calmLate = 0;  ///< the same after 15 s
    std::vector<FailedStorm> failed;
};

/// Storms try each limit and this share more.
inline constexpr double kStormMargin = 0.25;

/// A storm is forty frames in which the head jumps and turns and the wind blows in random directions, each as
/// strongly as the storm is, then five seconds of rest, and ten more where hair is not calm by then. It fails
/// where a point is no number, a strand had to be put back to rest, a length that is held is off by a
/// hundredth, or a point moves at the end faster by 0.5 m/s than gravity and damping let it. The same for any
/// number of threads. Errors: a groom that cannot be simulated, being cancelled.
Result<StormTally> runStorms(const Groom& groom, const CertificateOptions& options = {});

/// What the tallies of one groom say together: the same as one tally of all their storms. Errors: none, and
/// storms that two tallies hold or that none holds, from storm 0 on.
Result<Certificate> certificateOf(std::vector<StormTally> tallies);

/// Both. Storms count from 0, whatever `first` says.
Result<Certificate> certify(const Groom& groom, CertificateOptions options = {});

/// The strongest storm such that no failed one is as weak in all that it does: from the strongest of all,
/// each is cut off where that costs the least. Nothing where one failed in a calm.
StormStrength boxWithout(std::span<const FailedStorm> failed);

/// "frames of 33 ms, a head that moves at 2 m/s and turns by 20° a frame, and wind of 30 m/s".
std::string inWords(const StormStrength& limits);
/// One paragraph: the limits, how they were found, and what failed beyond them.
std::string inWords(const Certificate& certificate);

}  // namespace hairloom
