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
        addScattering();
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

    void addEdges() {
        addPower("samples", "Samples",
                 "MSAA samples per pixel. More samples give smoother edges and cost more. Your device may "
                 "support fewer.",
                 1, 4, "%1 per pixel", &PictureQuality::samples);
        addPower("frames", "Frames",
                 "Number of frames averaged while nothing moves, each with a sub-pixel offset. More "
                 "frames resolve finer hair",
                 1, 7, "%1 averaged", &PictureQuality::frames);
        addBool(
            "joinsFrames", "Temporal anti-aliasing",
            "While hair moves, reprojects and accumulates earlier frames. Thin hair looks smooth instead "
            "of grainy, at a small cost",
            [this] { return viewport_.quality().joinsFrames; },
            [this](bool on) {
                PictureQuality quality = viewport_.quality();
                quality.joinsFrames = on;
                viewport_.setQuality(quality);
            });
        addEnum("filter", "Filter", "Filters the remaining edges in the finished image",
                {QString("None"), QString("FXAA"), QString("FXAA, long search")}, &PictureQuality::filter);
        addEnum("transparency", "Transparency",
                "How hair thinner than a sample shows what is behind it. Automatic picks the most "
                "accurate method for your device. Sorted blends the nearest hairs of a pixel in order. "
                "Stochastic covers a random part of the samples. Weighted blends in any order",
                {QString("Automatic"), QString("Sorted"), QString("Stochastic"), QString("Weighted")},
                &PictureQuality::transparency);
        addEnum("ribbons", "Curves",
                "How curves become ribbons. Automatic picks the fastest method for your device. "
                "Tessellated curves are finer close up and need device support",
                {QString("Automatic"), QString("Strips"), QString("Tessellated")}, &PictureQuality::ribbons);
        addNumber(
            "subdivisions", "Subdivisions",
            "Segments drawn for each segment of a strand. More segments give rounder curves", "", 1, 8, true,
            [this] { return static_cast<double>(viewport_.quality().subdivisions); },
            [this](double value) {
                PictureQuality quality = viewport_.quality();
                quality.subdivisions = static_cast<std::uint32_t>(value);
                viewport_.setQuality(quality);
            });
    }

    void addScattering() {
        addEnum("scattering", "Scattered light",
                "Light scattered by other hairs: ignored (single), added as in an even layer (dual), or "
                "followed from hair to hair and skin (volume). For Marschner and Sadeghi",
                {QString("Single"), QString("Dual"), QString("Volume")}, &PictureQuality::scattering);
    }

    Viewport& viewport_;
};

}  // namespace

QWidget* makePictureForm(const Preferences& preferences, const Prices& prices, Viewport& viewport) {
    return new PictureForm(preferences, prices, viewport);
}

}  // namespace hairloom::editor
