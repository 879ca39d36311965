// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/curve_tool.h"

#include <algorithm>
#include <cmath>

#include "core/editing/document.h"
#include "core/editing/stack_commands.h"
#include "core/geometry/curve.h"
#include "core/operations/stack.h"
#include "editor/document/words.h"

namespace hairloom::editor {
namespace {

constexpr float kHeight = 0.003f;     ///< metres over the skin that the curve lies
constexpr float kApart = 0.002f;      ///< metres between points while it is drawn
constexpr float kPointEvery = 0.02f;  ///< metres between those that are kept
constexpr std::size_t kMostPoints = 24;
constexpr double kClick_px = 4;

bool hasCurve(const Operator& one) {
    const StackOperator* known = findStackOperator(one.op);
    return known && known->hasCurve;
}

}  // namespace

CurveTool::CurveTool(const ToolParts& parts)
    : document_(parts.document),
      messages_(parts.messages),
      player_(parts.player),
      viewport_(parts.viewport),
      info_{"curve",
            QString("Draw curve"),
            "curve",
            QString("Draw the curve of an operator over the head, such as a parting or a braid. Click to add "
                    "points"),
            QKeySequence("Shift+C"),
            240} {
    connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
        if (contains(changed, editing::Part::Operators)) Q_EMIT updated();
    });
}

QString CurveTool::hint() const {
    const Operator* one = shown();
    if (!one) return QString("Add a Part, Attract or Braid operator in the Operators panel first");
    return QString("%1. Now for operator %2, %3")
        .arg(info_.tip)
        .arg(shownIndex() + 1)
        .arg(QString::fromStdString(one->op));
}

void CurveTool::setOperator(std::size_t index) {
    index_ = index;
    Q_EMIT updated();
}

std::size_t CurveTool::shownIndex() const {
    const auto& operators = document_.groom().operators;
    if (index_ < operators.size() && hasCurve(operators[index_])) return index_;
    std::size_t last = operators.size();
    while (last > 0 && !hasCurve(operators[last - 1])) --last;
    return last == 0 ? operators.size() : last - 1;
}

const Operator* CurveTool::shown() const {
    const std::size_t index = shownIndex();
    return index < document_.groom().operators.size() ? &document_.groom().operators[index] : nullptr;
}

void CurveTool::activate() {
    player_.reset();  // curves are drawn on the head at rest
}

void CurveTool::press(const Pointer& pointer) {
    path_ss_.clear();
    begin_px_ = pointer.at_px;
    if (!shown()) {
        messages_.warn(hint());
        return;
    }
    take(pointer);
}

void CurveTool::take(const Pointer& pointer) {
    const BrushPlace place = skinUnder(document_, viewport_, pointer.at_px);
    Vec3f at = place.position_ss + (place.skin ? kHeight : 0.0f) * place.normal_ss;
    // Beside the head it goes on as deep in the view as it left it.
    const std::vector<Vec3f> drawn = shown() ? curveOf(*shown()).points : std::vector<Vec3f>();
    const Vec3f* last = !path_ss_.empty() ? &path_ss_.back() : drawn.empty() ? nullptr : &drawn.back();
    if (!place.skin && last) at = placeAtDepthOf(viewport_, *last, pointer.at_px).position_ss;
    if (!path_ss_.empty() && (at - path_ss_.back()).norm() < kApart) return;
    path_ss_.push_back(at);
    Q_EMIT updated();
}

void CurveTool::drag(const Pointer& pointer) {
    if (!path_ss_.empty()) take(pointer);
}

void CurveTool::release(const Pointer& pointer) {
    const Operator* one = shown();
    const std::vector<Vec3f> path = std::exchange(path_ss_, {});
    if (!one || path.empty()) return;
    const QPointF moved = pointer.at_px - begin_px_;
    if (std::hypot(moved.x(), moved.y()) < kClick_px) {
        std::vector<Vec3f> points = curveOf(*one).points;
        points.push_back(path[0]);
        // The first click of a curve is the beginning of a very short one.
        if (points.size() == 1) points.push_back(path[0] + Vec3f(0, -kApart, 0));
        if (points.size() == 3 && (points[1] - points[0]).norm() <= kApart * 1.01f)
            points.erase(points.begin() + 1);
        if (points.size() <= kMaxCurvePoints) store(points);
    } else if (path.size() >= 2) {
        const auto count = static_cast<std::size_t>(polylineLength(path) / kPointEvery) + 2;
        store(resampleEvenly(path, std::min(count, kMostPoints)));
    }
    Q_EMIT updated();
}

void CurveTool::store(const std::vector<Vec3f>& points) {
    Operator changed = *shown();
    setCurveOf(changed, {points});
    auto command = editing::setOperator(document_.editing().model(), shownIndex(), changed, "Draw curve");
    if (!command) {
        messages_.warn(errorText(command.error()));
        return;
    }
    document_.perform(std::move(*command));
}

void CurveTool::cancel() {
    path_ss_.clear();
    Q_EMIT updated();
}

void CurveTool::draw(Marks& marks) const {
    const QColor colour(255, 200, 60);
    const auto line = [&](std::span<const Vec3f> points) {
        for (std::size_t i = 1; i < points.size(); ++i) marks.line(points[i - 1], points[i], colour, 2);
    };
    line(path_ss_);
    const Operator* one = shown();
    if (!one || !path_ss_.empty()) return;
    const DrawnCurve curve = curveOf(*one);
    if (!CurveLine::isDrawn(curve)) return;
    line(CurveLine(curve).points());
    for (const Vec3f& point : curve.points) marks.point(point, colour, 5);
}

ToolMaker curveTool() {
    return [](const ToolParts& parts) {
        Tools tools;
        tools.push_back(std::make_unique<CurveTool>(parts));
        return tools;
    };
}

}  // namespace hairloom::editor
