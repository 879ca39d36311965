// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/hair_flow.h"

#include <cmath>

#include "engine/in_parallel.h"
#include "models/alternatives/hair_spacing.h"

namespace hairloom::runtime {
namespace {

constexpr float kSpacings = 2.0f;  // of the hair, in a cell that nobody gave
constexpr std::size_t kPerJob = 1024;
constexpr std::uint32_t kMaxIterations = 400;
constexpr double kSolved = 1e-6;    // share of the largest divergence at which iterations end
constexpr double kThinnest = 1e-4;  // of a cell's density that a face has at least
constexpr double kNoMass = 1e-12;   // metres of hair
constexpr double kSlack = 1.5;      // thin hair counts as up to 1.42 times as dense, as it lies to the cells

std::array<double, 3> toDoubles(Float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
float& component(Float3& v, std::size_t axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Where the faces before the cells stand, in cells, and with axis 3 the middles of the cells.
Float3 offsetOf(std::size_t axis) {
    return {axis == 0 ? 0.0f : 0.5f, axis == 1 ? 0.0f : 0.5f, axis == 2 ? 0.0f : 0.5f};
}

}  // namespace

HairFlow::Result HairFlow::make(const StrandsView& strands, const HairFlowSettings& settings, Host host) {
    std::string error;
    const auto check = [&](const char* name, float value, double high) {
        refuseOutside(error, name, static_cast<double>(value), 0.0, high);
    };
    check("cellSize", settings.cellSize, 1.0);
    refuseOutside(error, "maxCells", settings.maxCells, 125.0, 1e7);
    check("friction", settings.friction, 1000.0);
    check("spreading", settings.spreading, 1000.0);
    check("fill", settings.fill, 1.0);
    if (error.empty()) error = validationError(strands);
    if (error.empty() && strands.restPositions_ss.empty()) error = "no strands; expected one at least";
    if (!error.empty()) return {std::nullopt, std::move(error)};
    HairFlow made;
    made.settings_ = settings;
    made.host_ = std::move(host);
    made.masses_ = massesOf(strands);
    const float cell = settings.cellSize > 0.0f ? settings.cellSize : kSpacings * spacingOf(strands);
    made.wanted_ = static_cast<double>(std::max(cell, 1e-5f));
    // What the cells around a point hold at rest.
    const std::vector<Float3> still(made.masses_.size());
    made.restDensities_.assign(made.masses_.size(), 0.0f);
    made.layOut(strands.restPositions_ss, still);
    made.smoothRest_ = made.densitiesOf(strands.restPositions_ss, still);
    made.gatherCells(strands.restPositions_ss, still);
    const double volume = made.cell_ * made.cell_ * made.cell_;
    for (std::size_t i = 0; i < made.masses_.size(); ++i) {
        double density = 0.0;
        made.forNodes(strands.restPositions_ss[i], offsetOf(3), [&](std::size_t cellAt, double weight) {
            density += made.cells_[cellAt].mass * weight / volume;
        });
        made.restDensities_[i] = static_cast<float>(density);
    }
    return {std::move(made), {}};
}

/// Cells at multiples of their size, with two around all points. False where no point counts.
bool HairFlow::layOut(std::span<const Float3> positions, std::span<const Float3> velocities) {
    std::array<double, 3> low{}, high{};
    bool any = false;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!countsIn(positions[i], velocities[i])) continue;
        const auto at = toDoubles(positions[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = any ? std::min(low[axis], at[axis]) : at[axis];
            high[axis] = any ? std::max(high[axis], at[axis]) : at[axis];
        }
        any = true;
    }
    size_ = {};
    if (!any) return false;
    for (cell_ = wanted_;; cell_ *= 2.0) {
        std::array<double, 3> first{}, count{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = std::floor(low[axis] / cell_) - 2.0;
            count[axis] = std::floor(high[axis] / cell_) + 3.0 - first[axis];
        }
        if (count[0] * count[1] * count[2] > static_cast<double>(settings_.maxCells)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = static_cast<std::int64_t>(first[axis]);
            size_[axis] = static_cast<std::uint32_t>(count[axis]);
        }
        return true;
    }
}

/// visit(node, weight) for the eight nodes around a position of a grid that is shifted by `offset` cells.
template <class Visit>
void HairFlow::forNodes(Float3 position, Float3 offset, const Visit& visit) const {
    const auto at = toDoubles(position), shift = toDoubles(offset);
    std::array<std::size_t, 3> corner{};
    std::array<double, 3> share{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells = at[axis] / cell_ - static_cast<double>(origin_[axis]) - shift[axis];
        const double floor = std::floor(cells);
        corner[axis] = static_cast<std::size_t>(floor);
        share[axis] = cells - floor;
    }
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t j = 0; j < 2; ++j) {
            for (std::size_t i = 0; i < 2; ++i) {
                const double weight = (i ? share[0] : 1.0 - share[0]) * (j ? share[1] : 1.0 - share[1]) *
                                      (k ? share[2] : 1.0 - share[2]);
                visit(((corner[2] + k) * size_[1] + corner[1] + j) * size_[0] + corner[0] + i, weight);
            }
        }
    }
}

/// By point, metres of hair per m³: summed and read by quadratic splines, which depend less than trilinear
/// weights on how hair lies to the cells.
std::vector<float> HairFlow::densitiesOf(std::span<const Float3> positions,
                                         std::span<const Float3> velocities) const {
    const auto forSmooth = [&](Float3 position, const auto& visit) {
        const auto at = toDoubles(position);
        std::array<std::size_t, 3> middle{};
        std::array<std::array<double, 3>, 3> weights{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double cells = at[axis] / cell_ - static_cast<double>(origin_[axis]);
            const double floor = std::floor(cells), t = cells - floor - 0.5;
            middle[axis] = static_cast<std::size_t>(floor);
            weights[axis] = {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)};
        }
        for (std::size_t n = 0; n < 27; ++n) {
            const std::size_t i = n % 3, j = n / 3 % 3, k = n / 9;
            visit(((middle[2] + k - 1) * size_[1] + middle[1] + j - 1) * size_[0] + middle[0] + i - 1,
                  weights[0][i] * weights[1][j] * weights[2][k]);
        }
    };
    std::vector<double> nodes(std::size_t{size_[0]} * size_[1] * size_[2], 0.0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!countsIn(positions[i], velocities[i])) continue;
        forSmooth(positions[i], [&](std::size_t node, double weight) {
            nodes[node] += weight * static_cast<double>(masses_[i]) / (cell_ * cell_ * cell_);
        });
    }
    std::vector<float> densities(positions.size(), 0.0f);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!countsIn(positions[i], velocities[i])) continue;
        double density = 0.0;
        forSmooth(positions[i], [&](std::size_t node, double weight) { density += weight * nodes[node]; });
        densities[i] = static_cast<float>(density);
    }
    return densities;
}

void HairFlow::gatherCells(std::span<const Float3> positions, std::span<const Float3> velocities) {
    cells_.assign(std::size_t{size_[0]} * size_[1] * size_[2], Cell{});
    const std::vector<float> densities = densitiesOf(positions, velocities);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!countsIn(positions[i], velocities[i])) continue;
        const double mass = static_cast<double>(masses_[i]), rest = static_cast<double>(restDensities_[i]);
        const double packing =
            smoothRest_[i] > 0.0f ? static_cast<double>(densities[i] / smoothRest_[i]) : 0.0;
        forNodes(positions[i], offsetOf(3), [&](std::size_t cell, double weight) {
            cells_[cell].mass += weight * mass;
            cells_[cell].rest += weight * mass * rest;
            cells_[cell].packing += weight * mass * packing;
        });
    }
}

void HairFlow::gatherFaces(std::span<const Float3> positions, std::span<const Float3> velocities) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        faces_[axis].assign(cells_.size(), Face{});
        for (std::size_t i = 0; i < positions.size(); ++i) {
            if (!countsIn(positions[i], velocities[i])) continue;
            const double mass = static_cast<double>(masses_[i]), speed = toDoubles(velocities[i])[axis];
            forNodes(positions[i], offsetOf(axis), [&](std::size_t face, double weight) {
                faces_[axis][face].mass += weight * mass;
                faces_[axis][face].velocity += weight * mass * speed;
            });
        }
        for (Face& face : faces_[axis]) face.velocity = face.mass > kNoMass ? face.velocity / face.mass : 0.0;
    }
}

/// A row for each filled cell; the outermost cells hold no hair.
void HairFlow::makeRows(double& divergence) {
    const double volume = cell_ * cell_ * cell_, fill = static_cast<double>(settings_.fill);
    const std::array<std::size_t, 3> stride{1, size_[0], std::size_t{size_[0]} * size_[1]};
    unknowns_.assign(cells_.size(), -1);
    rows_.clear();
    for (std::size_t c = 0; c < cells_.size(); ++c) {
        const Cell& cell = cells_[c];
        if (!(cell.mass > kNoMass) || cell.mass / volume < fill * cell.rest / cell.mass) continue;
        unknowns_[c] = static_cast<std::int32_t>(rows_.size());
        rows_.push_back({});
        rows_.back().cell = c;
    }
    for (Row& row : rows_) {
        const Cell& cell = cells_[row.cell];
        const double density = cell.mass / volume;
        const double above = std::clamp(cell.packing / cell.mass - kSlack, 0.0, 1.0);
        double flow = -static_cast<double>(settings_.spreading) * above * cell_;
        for (std::size_t side = 0; side < 6; ++side) {
            const std::size_t axis = side / 2, face = row.cell + (side % 2) * stride[axis];
            const std::size_t other = side % 2 == 0 ? row.cell - stride[axis] : face;
            // Alike from both sides.
            const double thinnest = kThinnest * std::max(density, cells_[other].mass / volume);
            row.other[side] = unknowns_[other];
            row.weight[side] = 1.0 / std::max(faces_[axis][face].mass / volume, thinnest);
            row.diagonal += row.weight[side];
            flow += (side % 2 == 0 ? -1.0 : 1.0) * faces_[axis][face].velocity;
        }
        // Pressure times dt over the cell's size.
        row.right = -flow;
        divergence = std::max(divergence, std::abs(flow) / cell_);
    }
}

/// Conjugate gradients with the diagonal for a preconditioner.
std::uint32_t HairFlow::solve() {
    double product = 0.0, most = 0.0;
    for (Row& row : rows_) {
        row.residual = row.right;
        row.direction = row.residual / row.diagonal;
        product += row.residual * row.direction;
        most = std::max(most, std::abs(row.residual));
    }
    const double enough = most * kSolved;
    std::uint32_t iterations = 0;
    while (iterations < kMaxIterations && most > enough && product > 0.0) {
        double curvature = 0.0;
        for (Row& row : rows_) {
            double sum = row.diagonal * row.direction;
            for (std::size_t side = 0; side < 6; ++side) {
                if (row.other[side] >= 0)
                    sum -= row.weight[side] * rows_[static_cast<std::size_t>(row.other[side])].direction;
            }
            row.image = sum;
            curvature += row.direction * sum;
        }
        if (!(curvature > 0.0)) break;
        const double along = product / curvature, last = product;
        product = most = 0.0;
        for (Row& row : rows_) {
            row.pressure += along * row.direction;
            row.residual -= along * row.image;
            product += row.residual * row.residual / row.diagonal;
            most = std::max(most, std::abs(row.residual));
        }
        for (Row& row : rows_) row.direction = row.residual / row.diagonal + row.direction * (product / last);
        ++iterations;
    }
    return iterations;
}

void HairFlow::project() {
    const std::array<std::size_t, 3> stride{1, size_[0], std::size_t{size_[0]} * size_[1]};
    for (const Row& row : rows_) {
        for (std::size_t side = 0; side < 6; ++side) {
            const std::size_t axis = side / 2;
            Face& face = faces_[axis][row.cell + (side % 2) * stride[axis]];
            face.change += (side % 2 == 0 ? -1.0 : 1.0) * row.weight[side] * row.pressure;
        }
    }
    for (auto& faces : faces_) {
        for (Face& face : faces) face.velocity += face.change;
    }
}

double HairFlow::divergenceLeft() const {
    double most = 0.0;
    for (const Row& row : rows_) most = std::max(most, std::abs(row.residual) / cell_);
    return most;
}

HairFlow::Report HairFlow::apply(std::span<const Float3> positions_ws, std::span<Float3> velocities_ws,
                                 float dt) {
    Report report;
    if (!(dt > 0.0f) || !std::isfinite(dt) || positions_ws.size() != masses_.size() ||
        velocities_ws.size() != masses_.size())
        return report;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        if (!countsIn(positions_ws[i], velocities_ws[i])) ++report.leftOut;
    }
    if (!layOut(positions_ws, velocities_ws)) return report;
    gatherCells(positions_ws, velocities_ws);
    gatherFaces(positions_ws, velocities_ws);
    makeRows(report.divergence);
    report.cellSize = static_cast<float>(cell_);
    report.cells = static_cast<std::uint32_t>(rows_.size());
    report.iterations = solve();
    report.left = divergenceLeft();
    project();
    const double pic = -std::expm1(-static_cast<double>(settings_.friction) * static_cast<double>(dt));
    inParallel(host_, masses_.size(), kPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!countsIn(positions_ws[i], velocities_ws[i])) continue;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double change = 0.0, velocity = 0.0;
                forNodes(positions_ws[i], offsetOf(axis), [&](std::size_t face, double weight) {
                    change += weight * faces_[axis][face].change;
                    velocity += weight * faces_[axis][face].velocity;
                });
                float& own = component(velocities_ws[i], axis);
                const double kept = static_cast<double>(own);
                own = static_cast<float>((1.0 - pic) * (kept + change) + pic * velocity);
            }
        }
    });
    return report;
}

std::size_t HairFlow::bytes() const {
    return sizeof(HairFlow) +
           4 * (masses_.size() + restDensities_.size() + smoothRest_.size() + unknowns_.size()) +
           cells_.size() * (sizeof(Cell) + 3 * sizeof(Face)) + rows_.size() * sizeof(Row);
}

}  // namespace hairloom::runtime
