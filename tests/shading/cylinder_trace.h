// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Rays through a dielectric cylinder by nothing but Snell's law, Fresnel's formulas and the way's length in
// three dimensions; it knows no Bravais index and no angle γ. Axis Z (towards the tip), radius 1, light from
// the XZ half-plane with X > 0.

#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "core/base/math.h"
#include "core/base/random.h"

namespace hairloom::test {

/// One way out of the fibre: after `order` crossings of the inside (0: R, 1: TT, 2: TRT).
struct Exit {
    int order;
    Vec3d direction;
    double weight;
};

class CylinderTrace {
  public:
    double ior = 1.55;
    double absorption = 0;  ///< per radius
    /// Tilts the surface's normal at each hit, radians towards the tip; as rough scales do.
    std::function<double(Random&)> normalTilt = [](Random&) { return 0.0; };

    /// Follows all ways of the ray with the offset `h` in −1…1 up to `orders` crossings.
    template <class Body>
    void trace(double thetaIn, double h, int orders, Random& random, const Body& body) const {
        Vec3d direction(-std::cos(thetaIn), 0, -std::sin(thetaIn));
        Vec3d point(std::sqrt(1 - h * h), h, 0);
        const Border border = meet(direction, normalAt(point, random), ior);
        body(Exit{0, border.reflected, border.reflectance});
        double weight = 1 - border.reflectance;
        if (!border.refracted) return;
        direction = *border.refracted;
        for (int order = 1; order <= orders; ++order) {
            // From one side of the circle to the other.
            const double flat = direction.x() * direction.x() + direction.y() * direction.y();
            const double way = -2 * (point.x() * direction.x() + point.y() * direction.y()) / flat;
            if (!(way > 0)) return;
            point += way * direction;
            weight *= std::exp(-absorption * way);
            const Border inside = meet(direction, normalAt(point, random), ior);
            if (inside.refracted) body(Exit{order, *inside.refracted, weight * (1 - inside.reflectance)});
            weight *= inside.reflectance;
            direction = inside.reflected;
        }
    }

  private:
    struct Border {
        Vec3d reflected;
        std::optional<Vec3d> refracted;
        double reflectance;
    };

    Vec3d normalAt(const Vec3d& point, Random& random) const {
        const double tilt = normalTilt(random);
        return std::cos(tilt) * Vec3d(point.x(), point.y(), 0).normalized() + std::sin(tilt) * Vec3d::UnitZ();
    }

    /// Light meeting a plane with the outward normal; from inside when it runs with the normal.
    static Border meet(const Vec3d& direction, const Vec3d& outward, double ior) {
        const bool inside = direction.dot(outward) > 0;
        const Vec3d normal = inside ? Vec3d(-outward) : outward;
        const double ratio = inside ? ior : 1 / ior;  // of the indices, before over behind
        const double cosine = -direction.dot(normal);
        const Vec3d reflected = direction + 2 * cosine * normal;
        const double sineSquared = ratio * ratio * (1 - cosine * cosine);
        if (sineSquared >= 1) return {reflected, std::nullopt, 1};
        const double behind = std::sqrt(1 - sineSquared);
        const double s = (ratio * cosine - behind) / (ratio * cosine + behind);
        const double p = (cosine - ratio * behind) / (cosine + ratio * behind);
        return {reflected, ratio * direction + (ratio * cosine - behind) * normal, 0.5 * (s * s + p * p)};
    }
};

/// A standard normal number (Box and Muller 1958).
inline double normalNumber(Random& random) {
    const double u = 1 - random.uniformDouble();
    return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * random.uniformDouble());
}

}  // namespace hairloom::test
