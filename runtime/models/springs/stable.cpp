// SPDX-License-Identifier: MIT
#include "hairloom/stable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "models/springs/springs.h"

namespace hairloom::runtime {
namespace {

using S = SimulationSettings;

/// An offer stays this far inside its region.
constexpr double kMargin = 0.9;

bool coilSprings(const S& s) {
    return s.lengthMethod != LengthMethod::constraint;
}
bool angularForces(const S& s) {
    if (!(greatestStiffness(s) > 0.0f)) return false;
    if (s.angularMethod == AngularMethod::flexion) return true;
    if (s.integrator == Integrator::implicitEuler) return false;
    return s.integrator != Integrator::verlet || s.angularMethod != AngularMethod::implicit;
}

/// K and M of the free points of one strand, in one direction. K has the bandwidth 2.
class StrandMatrix {
  public:
    StrandMatrix(std::uint32_t points, std::uint32_t firstFree) : points_(points), firstFree_(firstFree) {}

    void setMass(std::uint32_t p, double mass) { mass_[p] = mass; }
    /// Adds the energy ½ k (Σ weights_i x_{from+i})²; clamped points do not move.
    void add(double k, std::uint32_t from, std::array<double, 3> weights) {
        for (std::uint32_t a = 0; a < 3; ++a) {
            for (std::uint32_t b = 0; b <= a; ++b) {
                if (weights[a] == 0.0 || weights[b] == 0.0 || from + b < firstFree_) continue;
                bands_[a - b][from + a] += k * weights[a] * weights[b];
            }
        }
    }

    /// The greatest λ of K x = λ M x, from above, to a millionth.
    double greatest() const {
        double high = 0.0;
        for (std::uint32_t p = firstFree_; p < points_; ++p) {
            double row = 0.0;  // Gershgorin
            for (std::uint32_t apart = 0; apart < 3; ++apart) {
                if (p >= apart) row += std::abs(bands_[apart][p]);
                if (apart > 0 && p + apart < points_) row += std::abs(bands_[apart][p + apart]);
            }
            high = std::max(high, row / mass_[p]);
        }
        // Of M⁻¹K the rows bound the eigenvalues as well.
        double low = 0.0;
        while (high - low > 1e-6 * high) {
            const double middle = 0.5 * (low + high);
            (above(middle) ? high : low) = middle;
        }
        return high;
    }

  private:
    /// Whether λ M − K is positive definite, by its Cholesky factors.
    bool above(double lambda) const {
        double d1 = 1.0, d2 = 1.0, l1Before = 0.0;
        for (std::uint32_t p = firstFree_; p < points_; ++p) {
            const double next = p > firstFree_ ? -bands_[1][p] : 0.0;
            const double l2 = p > firstFree_ + 1 ? -bands_[2][p] / d2 : 0.0;
            const double l1 = (next - l2 * d2 * l1Before) / d1;
            const double d = lambda * mass_[p] - bands_[0][p] - l1 * l1 * d1 - l2 * l2 * d2;
            if (!(d > 0.0)) return false;
            d2 = d1;
            d1 = d;
            l1Before = l1;
        }
        return true;
    }

    std::uint32_t points_, firstFree_;
    std::array<double, kMaxPoints> mass_{};
    std::array<std::array<double, kMaxPoints>, 3> bands_{};
};

/// The matrices of one strand of a block.
class StrandForces {
  public:
    StrandForces(const RestShape& shape, const S& settings, const Bend& bend, std::size_t index,
                 std::uint32_t lane)
        : settings_(settings),
          block_(shape.blocks[index]),
          rest_(shape.planes.data() + block_.firstPlane * kRestPlanes),
          stiffness_(bend.planes.empty() ? nullptr : bend.planes.data() + block_.firstPlane),
          lane_(lane) {}

    double coils() const {
        StrandMatrix matrix = empty();
        const double omega = 2.0 * std::numbers::pi * static_cast<double>(settings_.springFrequency);
        for (std::uint32_t s = settings_.clampedPoints - 1; s + 1 < block_.points; ++s) {
            const double k = 2.0 * omega * omega / (1.0 / mass(s) + 1.0 / mass(s + 1));
            addPair(matrix, k, s);
        }
        return std::sqrt(matrix.greatest());
    }

    double bending(double pull) const {
        StrandMatrix matrix = empty();
        if (stiffness_) addBending(matrix);
        if (pull > 0.0) addTension(matrix, pull);
        return std::sqrt(matrix.greatest());
    }

  private:
    StrandMatrix empty() const {
        StrandMatrix matrix(block_.points, settings_.clampedPoints);
        for (std::uint32_t p = 0; p < block_.points; ++p) matrix.setMass(p, mass(p));
        return matrix;
    }
    static void addPair(StrandMatrix& matrix, double k, std::uint32_t s) {
        matrix.add(k, s, {-1.0, 1.0, 0.0});
    }

    void addBending(StrandMatrix& matrix) const {
        const bool flexion = settings_.angularMethod == AngularMethod::flexion;
        for (std::uint32_t j = settings_.clampedPoints - 1; j + 1 < block_.points; ++j) {
            const double k = static_cast<double>(stiffness_[at(j)]);
            const double outer = inverseLength(j);
            if (j == 0) {
                if (!flexion) matrix.add(k, 0, {-outer, outer, 0.0});
            } else if (flexion) {
                matrix.add(k, j - 1, {-1.0, 0.0, 1.0});
            } else {
                const double inner = inverseLength(j - 1);
                matrix.add(k, j - 1, {inner, -(inner + outer), outer});
            }
        }
    }
    /// A strand that hangs in the acceleration `pull` carries the weight beyond each segment.
    void addTension(StrandMatrix& matrix, double pull) const {
        double beyond = 0.0;
        for (std::uint32_t s = block_.points - 1; s-- > settings_.clampedPoints - 1;) {
            beyond += mass(s + 1);
            addPair(matrix, pull * beyond * inverseLength(s), s);
        }
    }

    std::size_t at(std::uint32_t p) const { return std::size_t{p} * kBlockLanes + lane_; }
    double inverseLength(std::uint32_t s) const {
        return static_cast<double>(rest_[4 * planeSize(block_) + at(s)]);
    }
    double mass(std::uint32_t p) const {
        return 1.0 / static_cast<double>(rest_[5 * planeSize(block_) + at(p)]);
    }

    const S& settings_;
    const Block& block_;
    const float* rest_;
    const float* stiffness_;  ///< κ of each joint, or null
    std::uint32_t lane_;
};

/// Greatest c·h of a velocity that decays at the rate c where forces see it.
double airLimit(Integrator integrator) {
    switch (integrator) {
        case Integrator::verlet:
        case Integrator::implicitEuler:
            return std::numeric_limits<double>::infinity();
        case Integrator::rk4:
            return 2.785293563405282;
        case Integrator::velocityVerlet:
        case Integrator::leapfrog:
        case Integrator::explicitEuler:
            break;
    }
    return 2.0;
}

StableRegion regionOf(const FastestWaves& waves, const S& s, double frameTime) {
    const double h = frameTime / substepsIn(s, static_cast<float>(frameTime));
    const bool solves = s.integrator == Integrator::implicitEuler;
    StableRegion region;
    region.step = h;
    if (s.strandModel == StrandModel::rods) return region;  // their step has no limit
    const auto consider = [&](Stiff cause, double frequency, double limit) {
        if (!(frequency > 0.0)) return;
        const double factor = limit > 0.0 ? frequency * h / limit : std::numeric_limits<double>::infinity();
        if (!(factor > region.factor)) return;
        region = {cause, frequency, h, limit, factor};
    };
    const double limit = stableLimit(s, h);
    if (coilSprings(s) && !solves) {
        // The small-angle direction also holds lengths.
        const bool along = angularForces(s) && s.angularMethod != AngularMethod::exact;
        consider(Stiff::coils, std::hypot(waves.coils, along ? waves.bending : 0.0), limit);
    }
    // What is under tension swings too. The length constraint pulls by positions, whatever the integrator, so
    // that there explicit Euler amplifies nothing; position Verlet and implicit Euler are left out, as their
    // constraint holds at any step.
    const bool tense = s.integrator != Integrator::verlet && !solves;
    const bool amplifies = s.integrator == Integrator::explicitEuler && !coilSprings(s);
    const double bending = angularForces(s) ? waves.bending : 0.0;
    consider(Stiff::bending, std::hypot(bending, tense && !amplifies ? waves.tension : 0.0), limit);
    if (amplifies) consider(Stiff::bending, waves.tension, 2.0);
    consider(Stiff::penalty, waves.penalty, limit);
    consider(Stiff::air, static_cast<double>(s.airDrag), airLimit(s.integrator));
    return region;
}

const char* nameOf(Stiff cause) {
    switch (cause) {
        case Stiff::coils:
            return "coil springs";
        case Stiff::bending:
            return "angular springs";
        case Stiff::penalty:
            return "penalty springs";
        case Stiff::air:
            return "air drag";
        case Stiff::nothing:
            break;
    }
    return "nothing";
}

template <class... Values>
std::string text(const char* format, Values... values) {
    std::array<char, 256> buffer{};
    std::snprintf(buffer.data(), buffer.size(), format, values...);
    return buffer.data();
}

std::string wordsFor(const StableRegion& region, const S& s) {
    const char* const who = nameOf(s.integrator);
    if (region.cause == Stiff::air) {
        return text(
            "%s is unstable: air drag of %.3g 1/s takes %.3g of a speed in a substep of %.3g ms, "
            "at most %.3g are stable",
            who, region.frequency, region.frequency * region.step, 1e3 * region.step, region.limit);
    }
    const double hertz = region.frequency / (2.0 * std::numbers::pi);
    std::string words = text("%s is unstable: the fastest wave of the %s swings at %.4g Hz, ", who,
                             nameOf(region.cause), hertz) +
                        text("which in substeps of %.3g ms is ω·h = %.3g; ", 1e3 * region.step,
                             region.frequency * region.step);
    if (region.limit > 0.0)
        return words + text("its limit is %.3g, %.3g times less", region.limit, region.factor);
    return words + "without damping it amplifies every wave";
}

/// Springs whose bending is solved, in the order in which they are offered.
std::vector<StableOffer> implicitOffers(const S& settings) {
    S constrained = settings;
    constrained.integrator = Integrator::verlet;
    constrained.angularMethod = AngularMethod::implicit;
    constrained.lengthMethod = LengthMethod::constraint;
    constrained.lengthIterations = std::max(constrained.lengthIterations, 1u);
    S implicitly = settings;
    implicitly.integrator = Integrator::implicitEuler;
    if (implicitly.angularMethod == AngularMethod::flexion)
        implicitly.angularMethod = AngularMethod::implicit;
    return {{"angular springs solved implicitly and the length constraint, with verlet", constrained},
            {"implicitEuler", implicitly}};
}

StableOffer rodsOffer(const S& settings) {
    S rods = settings;
    rods.strandModel = StrandModel::rods;
    return {"elastic rods, stable at any step", rods};
}

/// Tries whether the hair comes to rest, and what would.
void adviseRest(const StrandsView& strands, const S& settings, float frameTime, StableAdvice& advice) {
    advice.rest = tryRest(strands, settings, frameTime);
    if (!advice.rest.trembles()) return;
    advice.words =
        text("springs with %s tremble at rest: after %.0f s of still air %u of %u strands tried move",
             nameOf(settings.integrator), kTrialSeconds, advice.rest.moving, advice.rest.strands) +
        text(", at up to %.3g m/s; angular springs feed curled hair, and held lengths soft hair",
             static_cast<double>(advice.rest.fastest));
    advice.offers.push_back(rodsOffer(settings));
    const FastestWaves waves = fastestWaves(strands, settings);
    for (StableOffer& offer : implicitOffers(settings)) {
        if (offer.settings == settings ||
            regionOf(waves, offer.settings, static_cast<double>(frameTime)).factor > kMargin ||
            tryRest(strands, offer.settings, frameTime).trembles())
            continue;
        advice.offers.push_back(std::move(offer));
    }
}

}  // namespace

FastestWaves fastestWaves(const StrandsView& strands, const SimulationSettings& settings) {
    FastestWaves waves;
    if (strands.offsets.size() < 2) return waves;
    const auto shape = makeRestShape(strands);
    Bend bend;
    if (greatestStiffness(settings) > 0.0f) bend.planes = Floats(shape->planeFloats, 0.0f);
    // A strand hangs in gravity and in the pull of the wind.
    const double pull = static_cast<double>(length(settings.gravity)) +
                        static_cast<double>(settings.airDrag) * static_cast<double>(settings.windSpeed);
    for (std::size_t b = 0; b < shape->blocks.size(); ++b) {
        const Block& block = shape->blocks[b];
        if (block.points <= settings.clampedPoints) continue;
        if (!bend.planes.empty()) fillBend(*shape, settings, 1.0f, b, bend);
        const Bend none;
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            const StrandForces forces(*shape, settings, bend, b, lane);
            if (coilSprings(settings)) waves.coils = std::max(waves.coils, forces.coils());
            if (!bend.planes.empty()) waves.bending = std::max(waves.bending, forces.bending(0.0));
            if (pull > 0.0) {
                const StrandForces slack(*shape, settings, none, b, lane);
                waves.tension = std::max(waves.tension, slack.bending(pull));
            }
        }
    }
    if (settings.collisionResponse == CollisionResponse::penalty)
        waves.penalty = 2.0 * std::numbers::pi * static_cast<double>(settings.penaltyFrequency);
    return waves;
}

double stableLimit(const SimulationSettings& settings, double h) {
    const double tau = static_cast<double>(settings.dampingTime);
    const double kept = tau > 0.0 ? std::exp(-h / tau) : 1.0;
    switch (settings.integrator) {
        case Integrator::rk4:
            return 2.0 * std::numbers::sqrt2;
        case Integrator::explicitEuler:
            // x' = x + s u, u' = s u − (ωh)² x has the determinant s (1 + (ωh)²).
            return std::sqrt(1.0 / kept - 1.0);
        case Integrator::verlet:
        case Integrator::implicitEuler:
            // u' = s u − (ωh)² x, x' = x + u': of trace 1 + s − (ωh)² and determinant s.
            return std::sqrt(2.0 * (1.0 + kept));
        case Integrator::velocityVerlet:
        case Integrator::leapfrog:
            break;
    }
    return 2.0;
}

StableRegion stableRegion(const StrandsView& strands, const SimulationSettings& settings, float frameTime) {
    return regionOf(fastestWaves(strands, settings), settings, static_cast<double>(frameTime));
}

double longestStableStep(const FastestWaves& waves, const SimulationSettings& settings) {
    S one = settings;
    one.substeps = 1;
    const auto isStable = [&](double h) { return regionOf(waves, one, h).stable(); };
    double unstable = static_cast<double>(kUsualFrame), stable = 1e-6;
    if (isStable(unstable)) return std::numeric_limits<double>::infinity();
    if (!isStable(stable)) return 0.0;
    constexpr int kHalvings = 40;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = std::sqrt(stable * unstable);
        (isStable(middle) ? stable : unstable) = middle;
    }
    return stable;
}

StableAdvice adviseStability(const StrandsView& strands, const SimulationSettings& settings,
                             float frameTime) {
    const double frame = static_cast<double>(frameTime);
    StableAdvice advice;
    if (settings.strandModel == StrandModel::rods) return advice;
    const FastestWaves waves = fastestWaves(strands, settings);
    advice.region = regionOf(waves, settings, frame);
    if (advice.region.stable()) {
        adviseRest(strands, settings, frameTime, advice);
        return advice;
    }
    advice.words = wordsFor(advice.region, settings);

    const auto inside = [&](const S& candidate) {
        return regionOf(fastestWaves(strands, candidate), candidate, frame).factor <= kMargin;
    };
    S finer = settings;
    for (std::uint32_t count = settings.substeps + 1; count <= kMaxSubsteps; ++count) {
        finer.substeps = count;
        if (regionOf(waves, finer, frame).factor > kMargin) continue;
        advice.offers.push_back({text("%u substeps instead of %u", count, settings.substeps), finer});
        break;
    }
    for (StableOffer& offer : implicitOffers(settings)) {
        if (!inside(offer.settings) && offer.settings.collisionResponse == CollisionResponse::penalty) {
            offer.settings.collisionResponse = CollisionResponse::radial;
            offer.words += ", and collisions by places";
        }
        if (inside(offer.settings) && !tryRest(strands, offer.settings, frameTime).trembles())
            advice.offers.push_back(std::move(offer));
    }
    advice.offers.push_back(rodsOffer(settings));
    return advice;
}

}  // namespace hairloom::runtime
