// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/handle_tool.h"

#include <algorithm>
#include <cmath>

#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/operations/found_vectors.h"
#include "core/operations/head_places.h"
#include "core/operations/script.h"
#include "editor/document/words.h"

namespace hairloom::editor {
namespace {

constexpr double kReach_px = 12;
constexpr float kArrow_px = 90;     ///< of a direction of length 1
constexpr float kOffSkin = 0.03f;   ///< metres from the skin within which a point is dragged along it
constexpr float kShortest = 0.02f;  ///< of a direction that was dragged onto its beginning
const QColor kPoint(255, 200, 60), kDirection(90, 190, 255), kHeld(255, 255, 255);

std::vector<HandleTool::Handle> handlesOf(const Operator& one) {
    std::vector<HandleTool::Handle> handles;
    const StackOperator* const known = findStackOperator(one.op);
    if (!known) return handles;
    const auto add = [&](const std::vector<FieldRow>& rows, SettingsPart part) {
        std::optional<std::size_t> anchor;
        for (const FieldRow& row : rows) {
            if (row.info.kind != FieldKind::Vector) continue;
            const bool isPoint = std::string_view(row.info.unit) == "m";
            if (isPoint) anchor = handles.size();
            handles.push_back({row.info, part, isPoint, isPoint ? std::nullopt : anchor});
        }
    };
    add(known->fields, SettingsPart::own);
    // A region without a side reaches everything: nothing to show.
    if (known->hasRegion) {
        const auto& region = scriptRegionFields();
        const auto normal = std::ranges::find_if(
            region, [](const FieldRow& row) { return std::string_view(row.info.name) == "normal"; });
        bool isUsed = false;
        for (std::uint32_t c = 0; c < 3; ++c)
            isUsed = isUsed || settingOf(one, normal->info, c, SettingsPart::region) != 0;
        if (isUsed) add(region, SettingsPart::region);
    }
    return handles;
}

}  // namespace

HandleTool::HandleTool(const ToolParts& parts)
    : document_(parts.document),
      messages_(parts.messages),
      player_(parts.player),
      viewport_(parts.viewport),
      info_{"handles",
            QString("Handles"),
            "frame",
            QString("Drag the points, planes and directions of the selected operator"),
            QKeySequence("Shift+H"),
            242} {
    connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
        if (contains(changed, editing::Part::Operators)) Q_EMIT updated();
    });
    connect(&document_, &QtDocument::replaced, this, [this] {
        held_.reset();
        picking_.reset();
    });
}

QString HandleTool::name(const Handle& handle) const {
    return labelOf(QString::fromUtf8(handle.field.name));
}

QString HandleTool::hint() const {
    if (picking_) return QString("Click the head to place “%1”").arg(name(*picking_));
    if (handles().empty())
        return QString("Select an operator with a point or a direction in the Operators panel");
    return info_.tip;
}

void HandleTool::setOperator(std::size_t index) {
    if (index == index_) return;
    index_ = index;
    held_.reset();
    picking_.reset();
    Q_EMIT updated();
}

void HandleTool::pickOnHead(std::size_t index, const FieldInfo& field, SettingsPart part) {
    setOperator(index);
    picking_ = Handle{field, part, true, std::nullopt};
    Q_EMIT updated();
}

void HandleTool::activate() {
    player_.reset();  // operators act on the head at rest
}

const Operator* HandleTool::shown() const {
    const auto& operators = document_.groom().operators;
    return index_ < operators.size() ? &operators[index_] : nullptr;
}

std::vector<HandleTool::Handle> HandleTool::handles() const {
    const Operator* one = shown();
    return one ? handlesOf(*one) : std::vector<Handle>();
}

Vec3f HandleTool::value(const Handle& handle) const {
    const Operator* one = shown();
    Vec3f value = Vec3f::Zero();
    for (std::uint32_t c = 0; one && c < 3; ++c)
        value[c] = static_cast<float>(settingOf(*one, handle.field, c, handle.part));
    // What nobody has placed yet is shown where the operator finds it.
    return one ? vectorFound(document_.groom(), *one, handle.field, handle.part).value_or(value) : value;
}

Vec3f HandleTool::anchor_ss(const Handle& handle) const {
    const auto all = handles();
    if (handle.anchor && *handle.anchor < all.size()) return place_ss(all[*handle.anchor]);
    return topOfHead(document_.groom());
}

float HandleTool::arrow() const {
    return kArrow_px *
           viewport_.camera().metresPerPixel(topOfHead(document_.groom()), viewport_.viewSize_px());
}

Vec3f HandleTool::place_ss(const Handle& handle) const {
    const Vec3f now = value(handle);
    if (handle.isPoint) return now;
    const bool weighs = handle.field.max < 100;  // its length counts
    const Vec3f from = anchor_ss(handle);
    if (now.isZero(0)) return from + Vec3f(0, 0, kShortest);
    return from + arrow() * (weighs ? now : Vec3f(now.normalized()));
}

std::optional<std::size_t> HandleTool::handleAt(const QPointF& at_px) const {
    std::optional<std::size_t> nearest;
    double least = kReach_px;
    const auto all = handles();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto shown = viewport_.camera().project(place_ss(all[i]), viewport_.viewSize_px());
        if (!shown) continue;
        const QPointF away = at_px - *shown;
        const double distance = std::hypot(away.x(), away.y());
        if (distance >= least) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

void HandleTool::press(const Pointer& pointer) {
    step_ = QtDocument::nextMergeKey();
    if (picking_) {
        const BrushPlace place = skinUnder(document_, viewport_, pointer.at_px);
        if (!place.skin) {
            messages_.warn("The pointer is not on the head: click on it");
            return;
        }
        store(*std::exchange(picking_, std::nullopt), place.position_ss);
        return;
    }
    held_ = handleAt(pointer.at_px);
    if (held_) before_ = *shown();
}

void HandleTool::drag(const Pointer& pointer) {
    const auto all = handles();
    if (!held_ || *held_ >= all.size()) return;
    const Handle& handle = all[*held_];
    const Vec3f from = place_ss(handle);
    if (handle.isPoint) {
        const BrushPlace skin = skinUnder(document_, viewport_, pointer.at_px);
        const bool alongSkin = skin.skin && document_.editing().skin() &&
                               std::abs(document_.editing().skin()->distanceAt(from).distance) < kOffSkin;
        store(handle,
              alongSkin ? skin.position_ss : placeAtDepthOf(viewport_, from, pointer.at_px).position_ss);
        return;
    }
    const Vec3f to = placeAtDepthOf(viewport_, from, pointer.at_px).position_ss - anchor_ss(handle);
    const bool weighs = handle.field.max < 100;
    const float length = to.norm();
    if (length < kShortest * arrow()) {
        if (weighs) store(handle, Vec3f::Zero());
        return;
    }
    store(handle, weighs ? Vec3f(to / arrow()) : Vec3f(to / length));
}

void HandleTool::release(const Pointer&) {
    held_.reset();
    before_.reset();
    Q_EMIT updated();
}

void HandleTool::cancel() {
    if (held_ && before_ && shown()) {
        document_.performMerged(step_, [&](const editing::Model& model) -> std::unique_ptr<editing::Command> {
            auto made = editing::setOperator(model, index_, *before_, "Handles");
            return made ? std::move(*made) : nullptr;
        });
    }
    held_.reset();
    before_.reset();
    picking_.reset();
    Q_EMIT updated();
}

void HandleTool::store(const Handle& handle, const Vec3f& value) {
    const Operator* one = shown();
    if (!one) return;
    Operator changed = *one;
    for (std::uint32_t c = 0; c < 3; ++c) {
        if (setSettingOf(changed, handle.field, static_cast<double>(value[c]), c, handle.part)) continue;
        messages_.warn(QString("%1: %2 is beyond what it takes, %3 to %4")
                           .arg(name(handle))
                           .arg(static_cast<double>(value[c]))
                           .arg(handle.field.min)
                           .arg(handle.field.max));
        return;
    }
    const std::string step =
        (labelOf(QString::fromStdString(one->op)).replace('_', ' ') + ": " + name(handle)).toStdString();
    document_.performMerged(step_, [&](const editing::Model& model) -> std::unique_ptr<editing::Command> {
        auto made = editing::setOperator(model, index_, changed, step);
        if (made) return std::move(*made);
        messages_.warn(errorText(made.error()));
        return nullptr;
    });
}

void HandleTool::draw(Marks& marks) const {
    const auto all = handles();
    const float ring = 0.5f * arrow();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Handle& handle = all[i];
        const Vec3f at = place_ss(handle);
        const bool held = held_ == i;
        if (handle.isPoint) {
            marks.point(at, held ? kHeld : kPoint, 11, Marks::Depth::OnTop);
            continue;
        }
        const Vec3f from = anchor_ss(handle), now = value(handle);
        const bool isPlane = QString::fromUtf8(handle.field.name).endsWith("ormal");
        if (isPlane && !now.isZero(0)) marks.circle(from, now, ring, kDirection, 1.5f, Marks::Depth::OnTop);
        marks.line(from, at, held ? kHeld : kDirection, 2, Marks::Depth::OnTop);
        marks.point(at, held ? kHeld : kDirection, 9, Marks::Depth::OnTop);
    }
}

ToolMaker handleTool() {
    return [](const ToolParts& parts) {
        Tools tools;
        tools.push_back(std::make_unique<HandleTool>(parts));
        return tools;
    };
}

}  // namespace hairloom::editor
