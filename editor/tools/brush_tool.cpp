// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/tools/brush_tool.h"

#include <QComboBox>
#include <algorithm>
#include <cmath>

#include "core/editing/document.h"
#include "editor/document/words.h"
#include "editor/fields/field.h"
#include "editor/fields/mask_name_edit.h"
#include "editor/style/icons.h"

namespace hairloom::editor {
namespace {

constexpr float kSmallest = 0.001f, kLargest = 0.2f;  // metres
constexpr float kStep = 1.15f;
constexpr float kSpacing = 0.25f;  // of the radius, between dabs

QString text(std::string_view words) {
    return QString::fromUtf8(words.data(), static_cast<qsizetype>(words.size()));
}

/// The brush's own icon, or that of brushes.
QString iconOf(const editing::BrushInfo& brush) {
    const QString name = text(brush.name).replace('_', '-');
    return hasIcon(name) ? name : QStringLiteral("brush");
}

/// The brush's own parameter makes it smooth what it does; others leave that to the brush `smooth`.
bool smoothsItself(const editing::BrushInfo& brush) {
    return std::ranges::any_of(brush.parameters, [](const editing::BrushParameter& p) {
        return std::string_view(p.name) == "smooth";
    });
}

}  // namespace

BrushTool::BrushTool(const ToolParts& parts, std::string_view brush, std::shared_ptr<BrushHand> hand)
    : document_(parts.document),
      preferences_(parts.preferences),
      messages_(parts.messages),
      player_(parts.player),
      viewport_(parts.viewport),
      brush_(editing::brushInfo(brush)),
      info_{text(brush_.name),
            text(brush_.label),
            iconOf(brush_),
            text(brush_.tip),
            QKeySequence(text(brush_.key)),
            brush_.order},
      hand_(std::move(hand)) {
    for (const editing::BrushParameter& parameter : brush_.parameters) {
        settings_.parameters.emplace(parameter.name, parameter.defaultValue);
    }
}

QString BrushTool::hint() const {
    QString hint = info_.tip;
    if (!brush_.inverse.empty()) hint += QString(". Ctrl: %1").arg(text(brush_.inverse));
    return hint + QString(". Shift smooths, F and [ ] set the size, Esc cancels");
}

void BrushTool::activate() {
    // Brushes work on the hair as it is authored; while it plays, that is where it comes to rest.
    if (player_.hasFrame() && !player_.isPlaying()) player_.reset();
    if (!hand_->same || hand_->radius <= 0) return;
    settings_.radius = hand_->radius;
    settings_.strength = hand_->strength;
    radius_px_ = hand_->radius_px;
    Q_EMIT settingsChanged();
}

void BrushTool::fitRadius(const BrushPlace& place) {
    if (!hand_->inPixels) return;
    const float metres = viewport_.camera().metresPerPixel(place.position_ss, viewport_.viewSize_px());
    if (radius_px_ <= 0) radius_px_ = settings_.radius / metres;
    hand_->radius_px = radius_px_;
    const float radius = std::clamp(radius_px_ * metres, kSmallest, kLargest);
    if (radius == settings_.radius) return;
    settings_.radius = radius;
    Q_EMIT settingsChanged();
}

float BrushTool::depthAt(const BrushPlace& place) const {
    if (!hand_->throughHair) return settings_.depth;
    constexpr float kThick = 0.12f;  // metres of hair where no head is behind it
    if (!place.skin) return std::max(settings_.depth, kThick);
    const Vec3f skin = document_.groom().scalp->pointAt(place.skin->triangle, place.skin->barycentric);
    return std::max(settings_.depth, (skin - place.position_ss).norm());
}

void BrushTool::handChanged() {
    radius_px_ = 0;
    changed();
}

void BrushTool::hover(const Pointer& pointer) {
    pointer_px_ = pointer.at_px;
    if (resizing_ != Resizing::None) {
        resize(pointer.at_px);
        return;
    }
    place_ = underPointer(pointer);
    fitRadius(*place_);
    Q_EMIT updated();
}

void BrushTool::leave() {
    place_.reset();
    Q_EMIT updated();
}

void BrushTool::press(const Pointer& pointer) {
    if (resizing_ != Resizing::None) {
        resizing_ = Resizing::None;
        return;
    }
    if (begin(pointer)) putDown(*place_, pointer.pressure);
}

BrushPlace BrushTool::underPointer(const Pointer& pointer) const {
    return brush_.worksOnSkin ? skinUnder(document_, viewport_, pointer.at_px)
                              : placeUnder(document_, viewport_, pointer.at_px);
}

bool BrushTool::begin(const Pointer& pointer) {
    place_ = underPointer(pointer);
    if (brush_.worksOnSkin && !place_->skin) return false;
    fitRadius(*place_);
    editing::Stroke header;
    const bool smooths = pointer.modifiers & Qt::ShiftModifier;
    header.tool = smooths && !smoothsItself(brush_) ? "smooth" : brush_.name;
    header.settings = settings_;
    if (!brush_.worksOnSkin) header.settings.depth = depthAt(*place_);
    if (header.tool != brush_.name) header.settings.parameters.clear();
    if (smooths && header.tool == brush_.name) header.settings.parameters["smooth"] = 1;
    if (pointer.modifiers & Qt::ControlModifier) header.settings.invert = !settings_.invert;
    if (auto begun = document_.beginStroke(std::move(header)); !begun) {
        messages_.warn(errorText(begun.error()));
        return false;
    }
    return true;
}

bool BrushTool::putDown(const BrushPlace& place, double pressure) {
    // A brush on the head is a ball; one on the hair reaches along the view.
    const Vec3f direction = brush_.worksOnSkin ? Vec3f(Vec3f::Zero()) : place.direction_ss;
    const auto dab = editing::dabAt(settings_, place.position_ss, direction, static_cast<float>(pressure));
    if (auto done = document_.editing().dab(dab); !done) {
        messages_.warn(errorText(done.error()));
        cancel();
        return false;
    }
    last_ = place;
    return true;
}

void BrushTool::drag(const Pointer& pointer) {
    pointer_px_ = pointer.at_px;
    if (!last_) return;
    // On hair it stays at the depth where the stroke began, so that hair that moves does not pull it in and
    // out.
    const BrushPlace to = brush_.worksOnSkin ? underPointer(pointer)
                                             : placeAtDepthOf(viewport_, last_->position_ss, pointer.at_px);
    place_ = to;
    if (brush_.worksOnSkin && !to.skin) return;
    const BrushPlace from = *last_;
    const float length = (to.position_ss - from.position_ss).norm();
    const int dabs = static_cast<int>(length / (kSpacing * settings_.radius));
    for (int i = 1; i <= dabs; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(dabs);
        BrushPlace at = to;
        at.position_ss = from.position_ss + share * (to.position_ss - from.position_ss);
        if (!putDown(at, pointer.pressure)) return;
    }
    Q_EMIT updated();
}

void BrushTool::release(const Pointer&) {
    if (!last_) return;
    last_.reset();
    document_.editing().endStroke();
}

void BrushTool::cancel() {
    resizing_ = Resizing::None;
    if (document_.editing().stroke()) document_.editing().cancelStroke();
    last_.reset();
}

void BrushTool::setRadius(float metres) {
    settings_.radius = std::clamp(metres, kSmallest, kLargest);
    radius_px_ = 0;
    changed();
}

void BrushTool::setStrength(float strength) {
    settings_.strength = std::clamp(strength, 0.0f, 1.0f);
    changed();
}

void BrushTool::setParameter(const std::string& name, float value) {
    const auto parameters = brush_.parameters;
    const auto known =
        std::ranges::find_if(parameters, [&](const editing::BrushParameter& p) { return p.name == name; });
    if (known == parameters.end()) return;
    settings_.parameters[name] =
        std::clamp(value, static_cast<float>(known->min), static_cast<float>(known->max));
    changed();
}

bool BrushTool::key(int key, Qt::KeyboardModifiers modifiers) {
    const bool shift = modifiers & Qt::ShiftModifier;
    const auto scaleRadius = [this](float factor) { setRadius(settings_.radius * factor); };
    const auto addStrength = [this](float by) { setStrength(settings_.strength + by); };
    switch (key) {
        case Qt::Key_F:
            resizing_ = shift ? Resizing::Strength : Resizing::Radius;
            resizeFrom_px_ = pointer_px_;
            resizeFrom_ = shift ? settings_.strength : settings_.radius;
            return true;
        case Qt::Key_BracketLeft:
            shift ? addStrength(-0.05f) : scaleRadius(1 / kStep);
            return true;
        case Qt::Key_BracketRight:
            shift ? addStrength(0.05f) : scaleRadius(kStep);
            return true;
        case Qt::Key_BraceLeft:
            addStrength(-0.05f);
            return true;
        case Qt::Key_BraceRight:
            addStrength(0.05f);
            return true;
        default:
            return false;
    }
}

void BrushTool::resize(const QPointF& to_px) {
    const auto by_px = static_cast<float>(to_px.x() - resizeFrom_px_.x());
    if (resizing_ == Resizing::Strength) {
        setStrength(resizeFrom_ + 0.005f * by_px);
    } else {
        const Vec3f at = place_ ? place_->position_ss : viewport_.camera().target_ws();
        const float metres = viewport_.camera().metresPerPixel(at, viewport_.viewSize_px()) * by_px;
        setRadius(resizeFrom_ + metres);
    }
}

void BrushTool::changed() {
    hand_->radius = settings_.radius;
    hand_->radius_px = radius_px_;
    hand_->strength = settings_.strength;
    Q_EMIT settingsChanged();
    Q_EMIT updated();
}

void BrushTool::draw(Marks& marks) const {
    if (!place_) return;
    const bool paints = brush_.worksOnSkin;
    const Vec3f normal = paints ? place_->normal_ss : Vec3f(-viewport_.camera().forward_ws());
    const QColor outer(255, 255, 255, 230);
    const QColor inner(255, 255, 255, 110);
    marks.circle(place_->position_ss, normal, settings_.radius, QColor(0, 0, 0, 120), 3.5f,
                 Marks::Depth::OnTop);
    marks.circle(place_->position_ss, normal, settings_.radius, outer, 1.5f, Marks::Depth::OnTop);
    if (settings_.strength > 0) {
        marks.circle(place_->position_ss, normal, settings_.radius * settings_.strength, inner, 1,
                     Marks::Depth::OnTop);
    }
    if (settings_.symmetric) {
        const editing::Dab mirror =
            editing::mirrored(editing::dabAt(settings_, place_->position_ss), settings_);
        marks.circle(mirror.position_ss, normal, settings_.radius, inner, 1.5f, Marks::Depth::OnTop);
    }
}

OptionForm* BrushTool::makeBasicOptions() {
    auto* form = new OptionForm(preferences_);
    const auto number = [&](const char* name, const QString& label, const QString& tip, const char* unit,
                            float min, float max, float editing::BrushSettings::*member) {
        form->addNumber(
            name, label, tip, unit, static_cast<double>(min), static_cast<double>(max), false,
            [this, member] { return static_cast<double>(settings_.*member); },
            [this, member](double value) {
                settings_.*member = static_cast<float>(value);
                radius_px_ = 0;
                changed();
            });
    };
    number("brushRadius", "Radius", "Brush radius. Press F and move, or press [ and ]", "m", kSmallest,
           kLargest, &editing::BrushSettings::radius);
    number("brushStrength", "Strength", "Strength of one dab. Press Shift+F and move, or press { and }", "",
           0, 1, &editing::BrushSettings::strength);
    QStringList falloffs;
    for (const std::string_view name : editing::BrushCurve::falloffNames())
        falloffs.append(labelOf(text(name)));
    form->addChoice(
        "brushFalloff", "Falloff", "How the effect fades from the centre of the brush to its edge", falloffs,
        [this] {
            const auto names = editing::BrushCurve::falloffNames();
            return static_cast<int>(std::ranges::find(names, falloff_) - names.begin());
        },
        [this](int index) {
            falloff_ = editing::BrushCurve::falloffNames()[static_cast<std::size_t>(index)];
            settings_.falloff = editing::BrushCurve::falloff(falloff_);
        });
    if (!brush_.worksOnSkin) {
        form->addChoice(
            "brushProfile", "Root to tip", "Which part of the strand the brush affects most",
            {QString("Uniform"), QString("More at the tip"), QString("More at the root")},
            [this] {
                const auto& values = settings_.profile.values();
                return values.empty() ? 0 : values.front() < values.back() ? 1 : 2;
            },
            [this](int index) {
                settings_.profile = index == 0   ? editing::BrushCurve()
                                    : index == 1 ? editing::BrushCurve({0.0f, 1.0f})
                                                 : editing::BrushCurve({1.0f, 0.0f});
            });
        number("brushDepth", "Depth", "Minimum depth of the brush in front of and behind its position", "m",
               0, 0.3f, &editing::BrushSettings::depth);
    }
    hand_->addOptions(*form, brush_.worksOnSkin, [this] { handChanged(); });
    if (brush_.movesHair) {
        number("brushClearance", "Clearance", "Minimum distance of hair from the skin", "m", 0, 0.01f,
               &editing::BrushSettings::clearance);
        form->addBool(
            "brushCollide", "Collide with head", "Prevents dabs from pushing hair into the head",
            [this] { return settings_.collide; }, [this](bool on) { settings_.collide = on; });
    }
    form->addBool(
        "brushSymmetric", "Symmetric", "Repeats each dab on the other side of the head",
        [this] { return settings_.symmetric; },
        [this](bool on) {
            settings_.symmetric = on;
            Q_EMIT updated();
        });
    if (!brush_.inverse.empty()) {
        form->addBool(
            "brushInvert", "Invert",
            QString("Does the opposite: %1. Hold Ctrl to invert a single stroke").arg(text(brush_.inverse)),
            [this] { return settings_.invert; }, [this](bool on) { settings_.invert = on; });
    }
    return form;
}

void BrushTool::addMask(OptionForm& form, const editing::BrushParameter& parameter) {
    const auto number = [this, name = std::string(parameter.name)] {
        return static_cast<std::uint32_t>(std::lround(settings_.parameters[name]));
    };
    auto* edit = new MaskNameEdit(document_, number);
    form.addChoice(
        "brush:" + text(parameter.name), labelOf(text(parameter.name)), text(parameter.meaning),
        [this] { return maskLabels(document_.groom()); }, [number] { return static_cast<int>(number()) - 1; },
        [this, name = std::string(parameter.name), edit](int index) {
            settings_.parameters[name] = static_cast<float>(index + 1);
            edit->refresh();
        });
    form.addWidget({}, edit);
    connect(&document_, &QtDocument::changed, &form, [&form](editing::Part parts) {
        if (contains(parts, editing::Part::MaskNames)) form.refresh();
    });
}

QWidget* BrushTool::makeOptions() {
    OptionForm* const form = makeBasicOptions();
    for (const editing::BrushParameter& parameter : brush_.parameters) {
        const std::string name(parameter.name);
        const QString label = labelOf(text(parameter.name));
        if (parameter.name == std::string_view(editing::kMaskParameter)) {
            addMask(*form, parameter);
            continue;
        }
        if (parameter.kind == FieldKind::Bool) {
            form->addBool(
                "brush:" + text(name), label, text(parameter.meaning),
                [this, name] { return settings_.parameters[name] != 0; },
                [this, name](bool on) { settings_.parameters[name] = on ? 1.0f : 0.0f; });
        } else {
            form->addNumber(
                "brush:" + text(name), label, text(parameter.meaning), text(parameter.unit), parameter.min,
                parameter.max, false,
                [this, name] { return static_cast<double>(settings_.parameters[name]); },
                [this, name](double value) { settings_.parameters[name] = static_cast<float>(value); });
        }
    }
    connect(this, &BrushTool::settingsChanged, form, &OptionForm::refresh);
    return form;
}

ToolMaker brushTool() {
    return [](const ToolParts& parts) {
        Tools tools;
        const auto hand = std::make_shared<BrushHand>();
        for (const std::string_view name : editing::brushNames())
            tools.push_back(std::make_unique<BrushTool>(parts, name, hand));
        return tools;
    };
}

}  // namespace hairloom::editor
