// SPDX-License-Identifier: MIT
// Rods at rest: the shape without load that hangs in the authored one, and how vertices resist.
#include "models/rods/rods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "engine/double3.h"
#include "hairloom/presets.h"

namespace hairloom::runtime {
namespace {

/// B beyond which single precision cannot tell a strand's weight from its stiffness: a strand of 30 cm that
/// is as stiff hangs within a thousandth of its length of its rest shape.
constexpr double kStiffest = 1e3 * kHairBendingStiffness;
/// Radians by which a strand's own weight may bend it in all.
constexpr double kMaxHeld = 2.5;
/// Share of a vertex' stiffness that has to be left against the load that would make a held shape swing round
/// or buckle.
constexpr double kStableShare = 0.05;
/// A strain, in radians, that counts as none.
constexpr double kStraight = 1e-4;

double lengthOf(Double3 a) {
    return std::sqrt(dotOf(a, a));
}

struct Rotation {
    Double3 v;
    double w = 1.0;
};
Rotation normalized(Rotation q) {
    const double scale = 1.0 / std::sqrt(dotOf(q.v, q.v) + q.w * q.w);
    return {q.v * scale, q.w * scale};
}
Rotation operator*(Rotation a, Rotation b) {
    return {b.v * a.w + a.v * b.w + crossOf(a.v, b.v), a.w * b.w - dotOf(a.v, b.v)};
}
Rotation inverse(Rotation q) {
    return {q.v * -1.0, q.w};
}
Double3 rotate(Rotation q, Double3 v) {
    const Double3 twice = crossOf(q.v, v) * 2.0;
    return v + twice * q.w + crossOf(q.v, twice);
}
/// The least rotation that takes one unit vector to another.
Rotation between(Double3 a, Double3 b) {
    const double c = dotOf(a, b);
    if (c > -0.999999) return normalized({crossOf(a, b), 1.0 + c});
    const Double3 other = std::abs(a.x) < 0.8 ? Double3{1.0, 0.0, 0.0} : Double3{0.0, 1.0, 0.0};
    return normalized({crossOf(a, other), 0.0});
}

struct Matrix3 {
    double at[9] = {};
    double& operator()(int row, int column) { return at[3 * row + column]; }
    double operator()(int row, int column) const { return at[3 * row + column]; }
};
double part(Double3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
/// result −= left · sum⁻¹ · right, or false where the symmetric `sum` is not positive definite.
bool eliminate(const Matrix3& sum, const Matrix3& left, const Matrix3& right, Matrix3& result) {
    double lower[3][3] = {}, pivot[3];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c <= r; ++c) {
            double value = sum(r, c);
            for (int k = 0; k < c; ++k) value -= lower[r][k] * lower[c][k] * pivot[k];
            if (c == r) {
                if (!(value > 0.0)) return false;
                pivot[r] = value;
                lower[r][r] = 1.0;
            } else {
                lower[r][c] = value / pivot[c];
            }
        }
    }
    for (int column = 0; column < 3; ++column) {
        double x[3];
        for (int r = 0; r < 3; ++r) {
            x[r] = right(r, column);
            for (int k = 0; k < r; ++k) x[r] -= lower[r][k] * x[k];
        }
        for (int r = 3; r-- > 0;) {
            x[r] /= pivot[r];
            for (int k = r + 1; k < 3; ++k) x[r] -= lower[k][r] * x[k];
        }
        for (int r = 0; r < 3; ++r)
            result(r, column) -= left(r, 0) * x[0] + left(r, 1) * x[1] + left(r, 2) * x[2];
    }
    return true;
}

/// How a vertex is bent by a moment on its outer segment.
struct Couple {
    double bend;               // B/l̄ of the stiffer bend
    RodSectionRatios section;  // beside it
    Double3 axis, normal;      // of twist, and the long diameter, in the outer segment's frame

    /// Moment of the quaternion (v, √(1 − |v|²)).
    Double3 moment(Double3 v) const {
        const double w = std::sqrt(std::max(1.0 - dotOf(v, v), 0.0));
        const double along = section.twist * dotOf(v, axis), across = section.flat * dotOf(v, normal);
        return (v * w + (axis * w + crossOf(axis, v)) * along + (normal * w + crossOf(normal, v)) * across) *
               (2.0 * bend);
    }
    /// The v of a moment: steps of Newton's method with the derivative of a small one. No more than kLargest.
    Double3 solve(Double3 n) const {
        Double3 v{};
        for (int step = 0; step < 24; ++step) {
            const double w = std::sqrt(std::max(1.0 - dotOf(v, v), 0.25));
            const Double3 left = (n - moment(v)) * (0.5 / (bend * w));
            v = v + left + axis * (dotOf(left, axis) * (1.0 / (1.0 + section.twist) - 1.0)) +
                normal * (dotOf(left, normal) * (1.0 / (1.0 + section.flat) - 1.0));
            if (dotOf(left, left) < 1e-24) break;
            const double size = lengthOf(v);
            if (size > kLargest) v = v * (kLargest / size);
        }
        return v;
    }
    static constexpr double kLargest = 0.6;  // 74 degrees of turn, short of where the moment is greatest
};

/// One strand of a block, in double precision and in the frame of its root.
class RestRod {
  public:
    RestRod(const RestShape& shape, const SimulationSettings& settings, RodParts parts, std::size_t index,
            std::uint32_t lane)
        : settings_(settings),
          parts_(parts),
          section_(rodSectionRatios(settings)),
          block_(shape.blocks[index]),
          size_(planeSize(block_)),
          rest_(shape.planes.data() + block_.firstPlane * kRestPlanes),
          lane_(lane),
          rootRotation_(shape.restRoots[block_.strandOfLane[lane]].rotation),
          first_(settings.clampedPoints - 1) {
        for (std::uint32_t j = 0; j + 1 < block_.points; ++j) total_ += segment(j);
        carryFrames();
        if (parts == RodParts::chain) {
            free_ = authored_;
            return;
        }
        if (isFlat()) layFlat();
        turnedAt_.fill(-1.0);
        fillBends();
        weigh();
        stiffen();
    }

    bool isFlat() const { return parts_ == RodParts::section; }
    /// Whether twist matters.
    bool curved() const {
        if (isFlat()) return true;
        for (std::uint32_t j = first_; j + 1 < block_.points; ++j) {
            const Double3 bent = rotate(inverse(inner(free_, j)) * free_[j], kAlong) - kAlong;
            if (lengthOf(bent) > kStraight) return true;
        }
        return false;
    }

    /// As RodRest::planes.
    void write(float* planes) const {
        const std::size_t count = kRodRestPlanes[static_cast<std::size_t>(parts_)];
        for (std::uint32_t p = 0; p < block_.points; ++p) {
            Double3 tangent = kAlong, axis = kAlong, normal{};
            Rotation loaded;
            if (p + 1 < block_.points) {
                tangent = rotate(free_[p], kAlong);
                axis = tangent + rotate(inner(free_, p), kAlong);
                axis = axis * (1.0 / std::max(lengthOf(axis), 1e-9));
                loaded = authored_[p] * inverse(free_[p]);
                if (isFlat()) normal = across(rotate(free_[p], flat_[p]), axis);
            }
            const double bend = parts_ == RodParts::chain ? 0.0 : bend_[p];
            const double values[kRodRestPlanes[3]] = {tangent.x,  tangent.y,  tangent.z,  mass(p),  bend,
                                                      loaded.v.x, loaded.v.y, loaded.v.z, loaded.w, axis.x,
                                                      axis.y,     axis.z,     normal.x,   normal.y, normal.z};
            for (std::size_t plane = 0; plane < count; ++plane)
                planes[plane * size_ + at(p)] = static_cast<float>(values[plane]);
        }
    }

  private:
    using Frames = std::array<Rotation, kMaxPoints>;
    static constexpr Double3 kAlong{0.0, 0.0, 1.0};  // a segment's tangent in its frame
    static constexpr double kNoLength = 1e-9;        // metres
    static constexpr double kTurnShare = 50.0;       // a turn of 1/50 counts as much as what is carried on

    std::size_t at(std::uint32_t p) const { return std::size_t{p} * kBlockLanes + lane_; }
    double segment(std::uint32_t j) const { return static_cast<double>(rest_[3 * size_ + at(j)]); }
    /// Metres of hair; those of a strand add up to its length.
    double mass(std::uint32_t p) const {
        return total_ / block_.points / static_cast<double>(rest_[5 * size_ + at(p)]);
    }
    /// Of the segment before; the root holds the first one as authored.
    const Rotation& inner(const Frames& frames, std::uint32_t j) const {
        return j > 0 ? frames[j - 1] : authored_[0];
    }

    /// Frames of the authored shape by parallel transport.
    void carryFrames() {
        Double3 before = kAlong;
        Rotation frame;
        for (std::uint32_t j = 0; j + 1 < block_.points; ++j) {
            const Double3 along{static_cast<double>(rest_[at(j)]), static_cast<double>(rest_[size_ + at(j)]),
                                static_cast<double>(rest_[2 * size_ + at(j)])};
            const double size = lengthOf(along);
            if (size > kNoLength) {
                const Double3 tangent = along * (1.0 / size);
                frame = normalized(between(before, tangent) * frame);
                before = tangent;
            }
            authored_[j] = frame;
        }
    }

    /// The part of a direction across a unit axis, of unit length.
    static Double3 across(Double3 direction, Double3 axis) {
        Double3 part = direction - axis * dotOf(direction, axis);
        if (lengthOf(part) < 1e-6)
            part = crossOf(axis, std::abs(axis.x) < 0.8 ? Double3{1.0, 0.0, 0.0} : Double3{0.0, 1.0, 0.0});
        return part * (1.0 / lengthOf(part));
    }

    /// The long diameter of each segment, in its frame. Flat hair curls about it: where the authored shape
    /// turns it follows the axis of the turn, elsewhere it is carried on, from the root's x on.
    void layFlat() {
        Double3 before = kAlong, normal{1.0, 0.0, 0.0};
        for (std::uint32_t j = 0; j + 1 < block_.points; ++j) {
            const Double3 tangent = rotate(authored_[j], kAlong), turn = crossOf(before, tangent);
            normal = rotate(between(before, tangent), normal);
            const double side = dotOf(turn, normal) < 0.0 ? -kTurnShare : kTurnShare;
            if (j > 0) normal = normal + turn * side;
            normal = across(normal, tangent);
            flat_[j] = rotate(inverse(authored_[j]), normal);
            before = tangent;
        }
    }

    /// B/l̄. The vertex at the clamp stands for the half segment beside it, too.
    void fillBends() {
        const std::uint32_t segments = block_.points - 1;
        const double least = 1e-3 * total_ / segments;
        bend_[segments] = 0.0;
        for (std::uint32_t j = 0; j < segments; ++j) {
            const double along = static_cast<double>(j) / segments;
            const double share =
                static_cast<double>(settings_.angularStiffness) * settings_.angularCurve.at(along);
            const double before = j > 0 ? segment(j - 1) : 0.0;
            double own = 0.5 * (before + segment(j));
            if (j == first_ && j > 0) own += 0.5 * before;
            bend_[j] = std::min(section_.stiffer * bendingStiffnessOf(share), kStiffest) /
                       std::max(own, std::max(least, 1e-9));
        }
    }

    /// The moment about each vertex of what lies beyond it: Σ l t × F with the weight F beyond a segment.
    void weigh() {
        const Float3 down = runtime::rotate(conjugate(rootRotation_), settings_.gravity);
        const Double3 gravity = Double3{down.x, down.y, down.z} * static_cast<double>(settings_.restGravity);
        Double3 moment{};
        double beyond = 0.0;
        for (std::uint32_t j = block_.points - 1; j-- > first_;) {
            beyond += mass(j + 1);
            moment = moment + crossOf(rotate(authored_[j], kAlong), gravity) * (segment(j) * beyond);
            moment_[j] = moment;
        }
    }

    /// Makes hair stiffer where its weight bends it most, which is near the root, until the held shape is
    /// stable: it stands for the hair around that carries it. The radians that the weight bends a strand by
    /// in all are what is searched for.
    void stiffen() {
        const std::array<double, kMaxPoints> own = bend_;
        std::array<double, kMaxPoints> moments, bent;
        for (std::uint32_t j = first_; j + 1 < block_.points; ++j) {
            moments[j] = lengthOf(moment_[j]);
            bent[j] = own[j] > 0.0 ? moments[j] / own[j] : 0.0;
        }
        // Radians by which the weight bends the strand where no vertex bends by more than `most`.
        const auto bentBy = [&](double most) {
            double sum = 0.0;
            for (std::uint32_t j = first_; j + 1 < block_.points; ++j) sum += std::min(bent[j], most);
            return sum;
        };
        const auto holds = [&](double held) {
            bend_ = own;
            if (bentBy(1e30) > held) {
                double low = 0.0, high = held;
                for (int halving = 0; halving < 30; ++halving) {
                    const double middle = 0.5 * (low + high);
                    (bentBy(middle) > held ? high : low) = middle;
                }
                for (std::uint32_t j = first_; j + 1 < block_.points; ++j) {
                    if (bend_[j] > 0.0) bend_[j] = std::max(bend_[j], moments[j] / std::max(low, 1e-9));
                }
            }
            unload();
            return stable();
        };
        if (holds(kMaxHeld)) return;
        double low = -9.0, high = std::log2(kMaxHeld);
        for (int halving = 0; halving < 8; ++halving) {
            const double middle = 0.5 * (low + high);
            (holds(std::exp2(middle)) ? low : high) = middle;
        }
        holds(std::exp2(low));
    }

    /// Whether the second variation of the energy of shape and weight is positive in the authored shape, by
    /// elimination from the tip. A vertex adds ½ dᵀH d + dᵀN u in the rotation u of its inner segment and u +
    /// d of its outer one, a segment ½ l uᵀ ((F·t) 1 − ½ (F tᵀ + t Fᵀ)) u with the weight F beyond it.
    bool stable() const {
        const Float3 down = runtime::rotate(conjugate(rootRotation_), settings_.gravity);
        const Double3 gravity = Double3{down.x, down.y, down.z} * static_cast<double>(settings_.restGravity);
        Matrix3 beyond{};
        double weight = 0.0;
        for (std::uint32_t j = block_.points - 1; j-- > first_;) {
            weight += mass(j + 1);
            const Double3 t = rotate(authored_[j], kAlong), force = gravity * weight;
            const double l = segment(j);
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c) {
                    beyond(r, c) += l * ((r == c ? dotOf(force, t) : 0.0) -
                                         0.5 * (part(force, r) * part(t, c) + part(t, r) * part(force, c)));
                }
            }
            const Rotation turn = inverse(inner(free_, j)) * free_[j];
            const Rotation loaded = inverse(inner(authored_, j)) * authored_[j];
            Rotation strain = inverse(turn) * loaded;  // in the outer segment's frame
            if (strain.w < 0.0) strain = {strain.v * -1.0, -strain.w};
            const Double3 both = kAlong + rotate(inverse(turn), kAlong);
            const Double3 v = rotate(authored_[j], strain.v);
            const Double3 a = rotate(authored_[j], both * (1.0 / std::max(lengthOf(both), 1e-9)));
            const Double3 n = isFlat() ? across(rotate(authored_[j], flat_[j]), a) : Double3{};
            const double b = bend_[j], more = b * section_.twist, softer = b * section_.flat;
            const Double3 m = v * b + a * (more * dotOf(a, v)) + n * (softer * dotOf(n, v));
            const Double3 twist = a * strain.w + crossOf(a, v);     // Jᵀ a
            const Double3 softTurn = n * strain.w + crossOf(n, v);  // Jᵀ n
            const Double3 couple = (m * strain.w + crossOf(v, m)) * 2.0;
            Matrix3 sum = beyond, left = beyond, right = beyond;
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c) {
                    sum(r, c) += (r == c ? b - dotOf(m, v) - kStableShare * b : 0.0) -
                                 b * part(v, r) * part(v, c) + more * part(twist, r) * part(twist, c) +
                                 softer * part(softTurn, r) * part(softTurn, c);
                }
            }
            const double half[3][3] = {
                {0.0, -couple.z, couple.y}, {couple.z, 0.0, -couple.x}, {-couple.y, couple.x, 0.0}};
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c) {
                    right(r, c) -= 0.5 * half[r][c];
                    left(r, c) += 0.5 * half[r][c];
                }
            }
            if (!eliminate(sum, left, right, beyond)) return false;
        }
        return true;
    }

    /// The shape without load that hangs in the authored one under its weight. A vertex whose stiffness is
    /// that of the last time turns as then.
    void unload() {
        for (std::uint32_t j = 0; j < first_; ++j) free_[j] = authored_[j];
        for (std::uint32_t j = first_; j + 1 < block_.points; ++j) {
            if (!(bend_[j] == turnedAt_[j])) {
                turn_[j] = turnWithoutLoad(j);
                turnedAt_[j] = bend_[j];
            }
            free_[j] = normalized(inner(free_, j) * turn_[j]);
        }
    }
    Rotation turnWithoutLoad(std::uint32_t j) const {
        const Rotation loaded = inverse(inner(authored_, j)) * authored_[j];
        const Double3 n = rotate(inverse(authored_[j]), moment_[j]);
        Rotation turn = loaded;
        // The axis of twist depends on the shape that is sought.
        for (int step = 0; step < 4 && bend_[j] > 0.0 && lengthOf(n) > 0.0; ++step) {
            const Double3 both = kAlong + rotate(inverse(turn), kAlong);
            const Double3 axis = both * (1.0 / std::max(lengthOf(both), 1e-9));
            const Couple couple{bend_[j], section_, axis, isFlat() ? across(flat_[j], axis) : Double3{}};
            const Double3 v = couple.solve(n);
            const Rotation next = loaded * Rotation{v * -1.0, std::sqrt(1.0 - dotOf(v, v))};
            const bool found = lengthOf(next.v - turn.v) < 1e-9;
            turn = next;
            if (found) break;
        }
        return turn;
    }

    const SimulationSettings& settings_;
    RodParts parts_;
    RodSectionRatios section_;
    const Block& block_;
    std::size_t size_;
    const float* rest_;
    std::uint32_t lane_;
    Quat rootRotation_;
    std::uint32_t first_;  // segment that is free, and vertex
    double total_ = 0.0;
    Frames authored_, free_;  // of segments, with the weight and without load
    std::array<Double3, kMaxPoints> moment_;
    std::array<Double3, kMaxPoints> flat_;  // in segments' frames, of a flat section
    std::array<double, kMaxPoints> bend_;
    Frames turn_;                              // of each vertex without load
    std::array<double, kMaxPoints> turnedAt_;  // stiffness for which that is; −1 where it is not known
};

}  // namespace

RodSectionRatios rodSectionRatios(const SimulationSettings& settings) {
    // Of an ellipse with the diameters b ≤ a: I₁ = π a³b/64, I₂ = π a b³/64, and J = π a³b³/(16 (a² + b²)).
    const double ratio = static_cast<double>(settings.sectionRatio);
    const double torsion =
        static_cast<double>(settings.torsionRatio) * 2.0 * ratio * ratio / (1.0 + ratio * ratio);
    return {1.0 / ratio, torsion - 1.0, ratio * ratio - 1.0};
}

bool haveEqualRodEnergy(const SimulationSettings& a, const SimulationSettings& b) {
    return a.gravity == b.gravity && a.restGravity == b.restGravity && a.clampedPoints == b.clampedPoints &&
           a.angularStiffness == b.angularStiffness && a.angularCurve == b.angularCurve &&
           a.torsionRatio == b.torsionRatio && a.sectionRatio == b.sectionRatio;
}

RodParts rodPartsOf(const SimulationSettings& settings, bool straight) {
    if (!(greatestStiffness(settings) > 0.0f)) return RodParts::chain;
    if (rodSectionRatios(settings).flat != 0.0) return RodParts::section;
    const bool held = length(settings.gravity) > 0.0f && settings.restGravity > 0.0f;
    return straight && !held ? RodParts::bending : RodParts::twist;
}

RodParts rodPartsOf(const RestShape& shape, const SimulationSettings& settings) {
    return shape.longestPointCount > settings.clampedPoints ? rodPartsOf(settings, shape.straight)
                                                            : RodParts::chain;
}

RodRest makeRodRest(const RestShape& shape, const SimulationSettings& settings, const Host& host) {
    RodRest rest;
    rest.parts = rodPartsOf(shape, settings);
    const bool twists = rest.parts >= RodParts::twist;
    rest.planes.assign(shape.planeFloats * rest.planeCount(), 0.0f);
    if (twists) rest.curved.assign(shape.blocks.size(), 0);
    const auto fill = [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                const auto rod = std::make_unique<RestRod>(shape, settings, rest.parts, b,
                                                           lane);  // too large for a game's stack
                if (twists && rod->curved()) rest.curved[b] = 1;
                rod->write(rest.planes.data() + shape.blocks[b].firstPlane * rest.planeCount());
            }
        }
    };
    constexpr std::size_t kBlocksPerPiece = 4;
    if (host.parallelFor)
        host.parallelFor(shape.blocks.size(), kBlocksPerPiece, fill);
    else
        fill(0, shape.blocks.size());
    return rest;
}

}  // namespace hairloom::runtime
