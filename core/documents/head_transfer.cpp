// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/head_transfer.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/log.h"
#include "core/groom/file/json_reader.h"
#include "core/operations/head_turn.h"
#include "importers/length_unit.h"

namespace hairloom {
namespace {

constexpr double kMaxMetresPerUnit = 1e6;

constexpr std::string_view kUpAxes[] = {"y", "z"};

RunOperation readTransfer(JsonReader& reader) {
    const std::string path = reader.string("file");
    HeadImportOptions options;
    options.metresPerUnit = static_cast<float>(reader.number("metresPerUnit", 0, kMaxMetresPerUnit, "m"));
    // Scripts of before have none of these.
    if (reader.has("up")) options.zUp = reader.choice("up", kUpAxes) == 1;
    if (reader.has("turnDegrees"))
        options.turnDegrees = static_cast<float>(reader.number("turnDegrees", -360, 360, "°"));
    if (reader.has("leaveOut")) options.leaveOut = reader.strings("leaveOut");
    return [path, options](Groom& groom) -> Result<std::size_t> {
        const auto transfer = transferToFile(groom, path, options);
        if (!transfer) return tl::unexpected(transfer.error());
        return groom.strandCount();
    };
}

Result<Transfer> putOn(Groom& groom, const ScalpMesh& head, const WorkWatch& watch) {
    return transferTo(groom, std::make_shared<const ScalpMesh>(head), watch);
}

/// Whether the new head lies plainly nearer to the old one with its Z axis up. Says so in `done`.
Result<bool> layingFits(const Groom& groom, const std::string& path, FileTransfer& done,
                        const ScalpMesh& head, const WorkWatch& watch) {
    constexpr float kPlainly = 0.6f;
    const HeadTurn asItIs = nearestTurn(groom, head);
    if (asItIs.distance < kAlikeHeads_m) return false;
    HeadImportOptions options = done.taken;
    options.zUp = true;
    options.guessUnit = options.guessUp = false;
    const auto other = importHead(path, options);
    if (!other) return tl::unexpected(other.error());
    Groom moved = groom;
    const auto laid = putOn(moved, other->scene.mesh, watch);
    if (watch.isCancelled()) return tl::unexpected(watch.at(1).error());
    if (!laid || isBeyondScale(laid->fit)) return false;
    const HeadTurn turned = nearestTurn(groom, other->scene.mesh);
    if (turned.distance >= kPlainly * asItIs.distance) return false;
    done.taken = options;
    done.words.push_back(
        fmt::format("fits the old head better with its Z axis up, to {:.3g} instead of {:.3g} mm (mean). "
                    "--up y leaves it as it is",
                    1e3f * turned.distance, 1e3f * asItIs.distance));
    log::warning("{}: {}", path, done.words.back());
    return true;
}

/// Of a head beside another one: a child's or a giant's, or in another unit than it was read in.
bool isOddScale(float scale) {
    constexpr float kOdd = 2.5f;
    return scale > kOdd || scale < 1 / kOdd;
}

/// Takes the unit in which the new head is plainly more like the old one, where as it was read it is of an
/// odd size, or far from it in shape. Says so in `done`.
Result<bool> otherUnitFits(const Groom& groom, const std::string& path, FileTransfer& done,
                           const ImportedScene& scene, const Transfer& asItIs, const WorkWatch& watch) {
    constexpr float kPlainly = 0.6f, kFar_m = 10 * kAlikeHeads_m;
    const HeadTurn before = nearestTurn(groom, scene.mesh);
    const bool isOdd = isOddScale(asItIs.fit.scale) || isBeyondScale(asItIs.fit);
    if (!isOdd && before.distance < kFar_m) return false;
    const auto now = static_cast<double>(scene.metresPerUnit);
    const double size = static_cast<double>(scene.mesh.bounds().sizes().maxCoeff()) / now;
    const LengthUnit* best = nullptr;
    float nearest = isOdd ? std::numeric_limits<float>::infinity() : kPlainly * before.distance;
    for (const LengthUnit& unit : lengthUnits()) {
        if (std::abs(unit.metres / now - 1) < 1e-4 || implausibleSize(size, unit.metres)) continue;
        if (watch.isCancelled()) return tl::unexpected(watch.at(1).error());
        HeadImportOptions options = done.taken;
        options.metresPerUnit = static_cast<float>(unit.metres);
        options.guessUnit = options.guessUp = false;
        const auto other = importHead(path, options);
        if (!other) return tl::unexpected(other.error());
        Groom moved = groom;
        const auto fitted = putOn(moved, other->scene.mesh, watch.part(0, 1));
        if (!fitted || isBeyondScale(fitted->fit) || isOddScale(fitted->fit.scale)) continue;
        const HeadTurn turn = nearestTurn(groom, other->scene.mesh);
        if (turn.distance >= nearest) continue;
        nearest = turn.distance;
        best = &unit;
    }
    if (best == nullptr) return false;
    done.taken.metresPerUnit = static_cast<float>(best->metres);
    done.words.push_back(fmt::format(
        "states no unit; {} were taken, in which it is like the head that the hair grows on. --unit says "
        "another one",
        best->name));
    log::warning("{}: {}", path, done.words.back());
    return true;
}

}  // namespace

Result<FileTransfer> transferToFile(Groom& groom, const std::string& path, const HeadImportOptions& options,
                                    const WorkWatch& watch) {
    auto head = importHead(path, options);
    if (!head) return tl::unexpected(head.error());
    FileTransfer done{{}, head->taken, std::move(head->words)};
    Groom moved = groom;
    auto transfer = putOn(moved, head->scene.mesh, watch.part(0.05, 0.4));
    if (!transfer) return tl::unexpected(transfer.error());
    const auto again = [&](const WorkWatch& part) -> Status {
        head = importHead(path, done.taken);
        if (!head) return tl::unexpected(head.error());
        moved = groom;
        transfer = putOn(moved, head->scene.mesh, part);
        return transfer ? Status() : tl::unexpected(transfer.error());
    };
    if (options.guessUnit && done.taken.metresPerUnit == 0 && !head->scene.statesUnit) {
        const auto other =
            otherUnitFits(groom, path, done, head->scene, *transfer, WorkWatch{{}, watch.cancelled});
        if (!other) return tl::unexpected(other.error());
        if (*other) {
            done.taken.guessUnit = done.taken.guessUp = false;
            if (auto status = again(watch.part(0.3, 0.4)); !status) return tl::unexpected(status.error());
        }
    }
    if (options.guessUp && !done.taken.zUp && !head->scene.statesUp) {
        auto laid = layingFits(groom, path, done, head->scene.mesh, watch.part(0.4, 0.6));
        if (!laid) return tl::unexpected(laid.error());
        if (*laid) {
            if (auto status = again(watch.part(0.6, 0.75)); !status) return tl::unexpected(status.error());
        }
    }
    if (options.guessTurn && options.turnDegrees == 0) {
        const HeadTurn turn = nearestTurn(groom, head->scene.mesh);
        if (turn.degrees != 0) {
            done.taken.turnDegrees = static_cast<float>(turn.degrees);
            done.taken.guessUnit = done.taken.guessUp = false;
            done.words.push_back(
                fmt::format("looks another way than the head that the hair grows on: it was turned by {}°, "
                            "which brings it from "
                            "{:.3g} to {:.3g} mm (mean); --turn 0 leaves it as it is",
                            turn.degrees, 1e3f * turn.unturned, 1e3f * turn.distance));
            log::warning("{}: {}", path, done.words.back());
            if (auto status = again(watch.part(0.75, 1)); !status) return tl::unexpected(status.error());
        }
    }
    if (isBeyondScale(transfer->fit)) {
        const float old = groom.scalp->bounds().sizes().maxCoeff(),
                    now = head->scene.mesh.bounds().sizes().maxCoeff();
        return failIn(
            path, {},
            fmt::format("is {:.3g} m large, where the head that the hair grows on has {:.3g} m", now, old),
            head->scene.statesUnit
                ? "expected heads that differ by no more than five times: the file states its unit, so scale "
                  "it where it was made"
                : "expected heads that differ by no more than five times: say its unit (--unit m, dm, cm, mm "
                  "or inch)");
    }
    if (isOddScale(transfer->fit.scale)) {
        done.words.push_back(
            fmt::format("is {:.3g} times as large as the head that the hair grows on, and so the hair is",
                        transfer->fit.scale));
        log::warning("{}: {}", path, done.words.back());
    }
    done.transfer = std::move(*transfer);
    if (groom.body) {
        done.words.push_back(
            "The skin collider was of the old head and is gone. Fit it to the new one (colliders --fit "
            "field)");
        log::warning("{}: {}", path, done.words.back());
    }
    // Skeleton and clips fit no head that was turned.
    if (!done.taken.isTurned()) moved.characterFile = path;
    moved.characterMetresPerUnit = done.taken.metresPerUnit;
    groom = std::move(moved);
    return done;
}

std::string transferRecord(const std::string& path, const HeadImportOptions& taken) {
    const nlohmann::ordered_json record{{"op", "transfer"},
                                        {"file", std::filesystem::absolute(path).string()},
                                        {"metresPerUnit", readableDecimal(taken.metresPerUnit)},
                                        {"up", kUpAxes[taken.zUp ? 1 : 0]},
                                        {"turnDegrees", readableDecimal(taken.turnDegrees)},
                                        {"leaveOut", taken.leaveOut}};
    return record.dump();
}

ScriptExtension transferExtension() {
    return {"transfer", readTransfer};
}

}  // namespace hairloom
