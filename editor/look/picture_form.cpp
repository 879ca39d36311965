// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>

#include "editor/fields/option_form.h"
#include "editor/look/parts.h"

namespace hairloom::editor {
namespace {

class PictureForm : public OptionForm {
  public:
    PictureForm(const Preferences& preferences, const Prices& prices, Viewport& viewport)
        : OptionForm(preferences, &prices), viewport_(viewport) {
        addEdges();
        addShadows();
        connect(&viewport_, &Viewport::lookChanged, this, &OptionForm::refresh);
    }

  private:
    template <class T>
    void addEnum(const char* name, const QString& label, const QString& tip, const QStringList& choices,
                 T PictureQuality::*member) {
        addChoice(
            name, label, tip, choices,
            [this, member] { return static_cast<int>(viewport_.quality().*member); },
            [this, member](int index) {
                PictureQuality quality = viewport_.quality();
                quality.*member = static_cast<T>(index);
                viewport_.setQuality(quality);
            });
    }

    /// A choice of powers of two, from `least` on.
    void addPower(const char* name, const QString& label, const QString& tip, std::uint32_t minimum,
                  int count, const QString& unit, std::uint32_t PictureQuality::*member) {
        QStringList choices;
        for (int i = 0; i < count; ++i) choices.append(unit.arg(minimum << static_cast<std::uint32_t>(i)));
        addChoice(
            name, label, tip, choices,
            [this, member, minimum] {
                return static_cast<int>(std::countr_zero(viewport_.quality().*member) -
                                        std::countr_zero(minimum));
            },
            [this, member, minimum](int index) {
                PictureQuality quality = viewport_.quality();
                quality.*member = minimum << static_cast<std::uint32_t>(index);
                viewport_.setQuality(quality);
            });
    }

    void addAmount(const char* name, const QString& label, const QString& tip, const char* unit,
                   float maximum, float PictureQuality::*member) {
        addNumber(
            name, label, tip, unit, 0, static_cast<double>(maximum), false,
            [this, member] { return static_cast<double>(viewport_.quality().*member); },
            [this, member](double value) {
                PictureQuality quality = viewport_.quality();
                quality.*member = static_cast<float>(value);
                viewport_.setQuality(quality);
            });
    }

    void addEdges() {
        addPower(
            "samples", tr("Samples"),
            tr("Samples a pixel (MSAA); more give smoother edges and cost more. The device may have fewer."),
            1, 4, tr("%1 a pixel"), &PictureQuality::samples);
        addPower("frames", tr("Frames"),
                 tr("Frames that are averaged while nothing moves, each moved by part of a pixel: more give "
                    "finer hair"),
                 1, 7, tr("%1 averaged"), &PictureQuality::frames);
        addBool(
            "joinsFrames", tr("Temporal anti-aliasing"),
            tr("While something moves, each frame joins those before it where their hair was: thin hair is "
               "smooth in place of grainy, and costs a little more"),
            [this] { return viewport_.quality().joinsFrames; },
            [this](bool on) {
                PictureQuality quality = viewport_.quality();
                quality.joinsFrames = on;
                viewport_.setQuality(quality);
            });
        addEnum("filter", tr("Filter"), tr("Softens the edges that are left in the finished picture"),
                {tr("None"), tr("FXAA"), tr("FXAA, long search")}, &PictureQuality::filter);
        addEnum("transparency", tr("Transparency"),
                tr("How hair that is thinner than a sample shows what lies behind it: as is nearest to the "
                   "truth on the device, by the nearest hairs of a pixel in their order, by a random part "
                   "of the samples, by a fixed part, or blended in any order"),
                {tr("Automatic"), tr("In their order"), tr("Random samples"), tr("Fixed samples"),
                 tr("Blended in any order")},
                &PictureQuality::transparency);
        addEnum(
            "ribbons", tr("Curves"),
            tr("How curves become ribbons: as is fastest on the device, as strips, or tessellated, which is "
               "finer near the eye and needs a device that can"),
            {tr("Automatic"), tr("Strips"), tr("Tessellated")}, &PictureQuality::ribbons);
        addNumber(
            "subdivisions", tr("Subdivisions"),
            tr("Pieces of curve for each segment of a strand: more are rounder"), "", 1, 8, true,
            [this] { return static_cast<double>(viewport_.quality().subdivisions); },
            [this](double value) {
                PictureQuality quality = viewport_.quality();
                quality.subdivisions = static_cast<std::uint32_t>(value);
                viewport_.setQuality(quality);
            });
    }

    void addShadows() {
        addEnum("shadows", tr("Shadows"),
                tr("How hair stands in the light of other hair: layers behind the first hair, depth alone, "
                   "layers at "
                   "fixed depths, or none"),
                {tr("None"), tr("Deep opacity"), tr("Absorption"), tr("Opacity maps")},
                &PictureQuality::shadows);
        addPower("shadowResolution", tr("Shadow map"),
                 tr("Pixels along the side of each light's shadow map: more are sharper"), 256, 5,
                 tr("%1 px"), &PictureQuality::shadowResolution);
        addAmount("headAbsorption", tr("Through the head"),
                  tr("Hair behind the head gets light that fades with its depth there, by this much a metre: "
                     "softer and without dots, but light comes through thin parts. 0: all or nothing"),
                  "1/m", render::kMaxHeadAbsorption, &PictureQuality::headAbsorption);
        addAmount(
            "shadowBlur", tr("Shadow blur"),
            tr("Pixels by which shadows are blurred in the picture while nothing moves. Hair looks out of "
               "focus, and shadows bleed over edges into what is lit"),
            "px", render::kMaxShadowBlur, &PictureQuality::shadowBlur);
        addEnum("scattering", tr("Scattered light"),
                tr("Light that other hairs have scattered: lost, or passed on (dual scattering); Marschner "
                   "and Sadeghi"),
                {tr("Single"), tr("Dual")}, &PictureQuality::scattering);
    }

    Viewport& viewport_;
};

}  // namespace

QWidget* makePictureForm(const Preferences& preferences, const Prices& prices, Viewport& viewport) {
    return new PictureForm(preferences, prices, viewport);
}

}  // namespace hairloom::editor
