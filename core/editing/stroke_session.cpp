// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/stroke_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/editing/brush_list.h"

namespace hairloom::editing {
namespace {

constexpr float kUnitSlack = 1e-3f;  ///< by which a direction's length may miss 1

std::vector<std::uint32_t> merged(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    std::vector<std::uint32_t> both;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
}

}  // namespace

Status checkDab(const Dab& dab) {
    const auto bad = [](std::string_view what, float value, std::string_view range) {
        return fail(fmt::format("a dab's {} is {}", what, value), fmt::format("expected {}", range));
    };
    if (!dab.position_ss.allFinite() || dab.position_ss.cwiseAbs().maxCoeff() > static_cast<float>(kAnywhere))
        return fail("a dab's position is not finite or far away", "expected coordinates within 1000 m");
    const float length = dab.direction_ss.norm();
    if (!dab.direction_ss.isZero(0) && !(std::abs(length - 1) <= kUnitSlack))
        return bad("direction", length, "a length of 1, or 0 for none");
    if (!(dab.radius >= 0.0001f && dab.radius <= 1)) return bad("radius", dab.radius, "0.0001 to 1 m");
    if (!(dab.strength >= 0 && dab.strength <= 1)) return bad("strength", dab.strength, "0 to 1");
    if (!(dab.pressure >= 0 && dab.pressure <= 1)) return bad("pressure", dab.pressure, "0 to 1");
    return {};
}

std::vector<std::uint8_t> editableStrands(const Groom& groom) {
    const auto flags = [&](std::string_view name) { return groom.strandAttributes.view<std::uint8_t>(name); };
    const auto isSet = [](std::span<const std::uint8_t> values, std::size_t s) {
        return s < values.size() && values[s] != 0;
    };
    const auto frozen = flags(attribute::kFrozen);
    const auto hidden = flags(attribute::kHidden);
    const auto selected = flags(attribute::kSelected);
    const bool anySelected =
        std::any_of(selected.begin(), selected.end(), [](std::uint8_t flag) { return flag != 0; });
    const auto layers = groom.strandAttributes.view<std::uint32_t>(attribute::kLayer);
    std::vector<std::uint8_t> editable(groom.strandCount(), 0);
    for (std::size_t s = 0; s < editable.size(); ++s) {
        const std::size_t layer = s < layers.size() ? layers[s] : 0;
        const bool open =
            layer >= groom.layers.size() || (groom.layers[layer].visible && !groom.layers[layer].locked);
        editable[s] =
            open && !isSet(frozen, s) && !isSet(hidden, s) && (!anySelected || isSet(selected, s)) ? 1 : 0;
    }
    return editable;
}

float StrokeTarget::parameter(const BrushInfo& info, std::string_view name) const {
    if (const auto found = settings.parameters.find(name); found != settings.parameters.end())
        return found->second;
    const auto known = std::find_if(info.parameters.begin(), info.parameters.end(),
                                    [&](const BrushParameter& p) { return p.name == name; });
    return known == info.parameters.end() ? 0 : known->defaultValue;
}

StrokeSession::StrokeSession(Model& model, StrandBounds& bounds, const Skin* skin, const SkinQuery* field,
                             Stroke header, std::unique_ptr<Brush> brush)
    : stroke_(std::move(header)),
      target_{model,
              bounds,
              field,
              skin ? &skin->tree() : nullptr,
              stroke_.settings,
              editableStrands(model.groom),
              {},
              {}},
      brush_(std::move(brush)) {}

Result<std::unique_ptr<StrokeSession>> StrokeSession::begin(Model& model, StrandBounds& bounds,
                                                            const Skin* skin, const SkinQuery* field,
                                                            Stroke header) {
    if (auto status = checkStroke(header); !status) return tl::unexpected(status.error());
    std::unique_ptr<Brush> brush = makeBrush(header.tool);
    if (brush->info().needsHead && !model.groom.scalp)
        return fail(fmt::format("{} needs a head", header.tool), "open or import one first");
    header.dabs.clear();
    // Whoever holds a copy of the hair makes this, and not the first dab, pay for parting from it.
    if (model.groom.pointCount() > 0) model.groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    std::unique_ptr<StrokeSession> session(
        new StrokeSession(model, bounds, skin, field, std::move(header), std::move(brush)));
    session->brush_->begin(session->target_);
    return session;
}

Change StrokeSession::run(const Dab& dab, bool isMirror) {
    const auto place = [&](const Dab& d) { return isMirror ? mirrored(d, stroke_.settings) : d; };
    DabContext context;
    context.dab = place(dab);
    context.isFirst = stroke_.dabs.empty();
    context.isMirror = isMirror;
    context.index = stroke_.dabs.size();
    context.previous = context.isFirst ? context.dab : place(stroke_.dabs.back());
    context.motion_ss = context.dab.position_ss - context.previous.position_ss;
    if (!context.isFirst)
        context.travel_ss = context.dab.position_ss - place(stroke_.dabs.front()).position_ss;
    context.sign = stroke_.settings.invert ? -1.0f : 1.0f;
    const bool isView = !dab.direction_ss.isZero(0);
    context.volume = {brush_->info().drags ? context.previous.position_ss : context.dab.position_ss,
                      isView ? Vec3f(context.dab.direction_ss.normalized()) : Vec3f(Vec3f::UnitZ()),
                      isView ? stroke_.settings.depth : 0.0f, dab.radius};
    return brush_->dab(target_, context);
}

Result<Change> StrokeSession::dab(const Dab& dab) {
    if (auto status = checkDab(dab); !status) return tl::unexpected(status.error());
    Change change = run(dab, false);
    touched_ = target_.touched;
    if (stroke_.settings.symmetric) {
        change.parts = change.parts | run(dab, true).parts;
        touched_ = merged(touched_, target_.touched);
    }
    stroke_.dabs.push_back(dab);
    change.strands = touched_;
    return change;
}

std::unique_ptr<Command> StrokeSession::finish(Change& change) {
    change = brush_->finish(target_);
    target_.changes.points.finish(target_.groom());
    target_.changes.dye.finish(target_.groom());
    target_.changes.mask.finish(target_.groom());
    target_.changes.widths.finish(target_.groom());
    target_.changes.roots.finish(target_.groom());
    return commandOf(std::string(brush_->info().label), std::move(target_.changes));
}

Change StrokeSession::cancel() {
    Change change;
    cancelled_ = finish(change);
    return cancelled_ ? cancelled_->exchange(target_.model) : Change{};
}

}  // namespace hairloom::editing
