// SPDX-License-Identifier: GPL-3.0-or-later
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "core/editing/document.h"
#include "core/live/picture_cost.h"
#include "editor/document/words.h"
#include "editor/look/parts.h"

namespace hairloom::editor {
namespace {

/// Of the longer side: enough to tell looks apart, and small enough for software devices.
constexpr double kMeasured_px = 640, kMeasuredSoftware_px = 256;
constexpr std::uint32_t kRepeats = 5, kExactFrames = 64, kExactFramesSoftware = 16;

class PicturePrices : public QWidget {
  public:
    PicturePrices(QtDocument& document, Tasks& tasks, Viewport& viewport, Prices& prices)
        : document_(document), tasks_(tasks), viewport_(viewport), prices_(prices), note_(new QLabel) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(6);
        auto* measure = new QPushButton("Measure costs");
        measure->setObjectName("pictureMeasure");
        measure->setToolTip(
            "Renders this view with other values of each setting, and shows their frame time and their "
            "difference from the best image (FLIP)");
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        note_->setObjectName("pictureMeasured");
        layout->addWidget(measure);
        layout->addWidget(note_);
        note_->hide();
        connect(measure, &QPushButton::clicked, this, &PicturePrices::measure);
        connect(&viewport_, &Viewport::lookChanged, this, &PicturePrices::outdate);
        connect(&document_, &QtDocument::changed, this, [this](editing::Part parts) {
            if (contains(parts, editing::kHairParts | editing::Part::Material | editing::Part::Interpolation |
                                    editing::Part::Dye | editing::Part::Widths | editing::Part::Shadows))
                outdate();
        });
        connect(&document_, &QtDocument::replaced, this, [this] {
            ++documents_;
            note_->hide();
        });
    }

  private:
    void outdate() {
        ++changes_;
        prices_.outdate(Prices::Of::Picture);
    }

    void measure() {
        const auto groom = std::make_shared<const Groom>(document_.groom());
        const PictureQuality quality = viewport_.quality();
        const QSizeF size_px = viewport_.viewSize_px();
        PictureCostOptions options;
        options.view.camera = viewport_.camera().camera();
        options.view.fibre.scattering = quality.scattering;
        options.picture.exposure = viewport_.exposure();
        tasks_.measure<PictureCost>(
            "Measuring render settings",
            [groom, quality, size_px, options](TaskControl& control) mutable -> Result<PictureCost> {
                const auto device = gpu::createDevice();
                if (!device) return tl::unexpected(device.error());
                const bool software = (*device)->info().type == gpu::DeviceType::Cpu;
                const float exposure = options.picture.exposure;
                options.picture = stillOptions(quality, groom->shadows, (*device)->info());
                options.picture.exposure = exposure;
                const double scale = (software ? kMeasuredSoftware_px : kMeasured_px) /
                                     std::max({1.0, size_px.width(), size_px.height()});
                const auto side = [scale](double side_px) {
                    return static_cast<std::uint32_t>(std::max(16.0, side_px * std::min(1.0, scale)));
                };
                options.picture.width = side(size_px.width());
                options.picture.height = side(size_px.height());
                options.mostHairs = mostHairsOn(**device);
                options.repeats = software ? 1 : kRepeats;
                options.exactFrames = software ? kExactFramesSoftware : kExactFrames;
                options.progress = [&](std::size_t done, std::size_t total) {
                    control.setProgress(static_cast<float>(done) / static_cast<float>(total));
                };
                options.cancelled = [&] { return control.isCancelled(); };
                return measurePictureCost(**device, *groom, options);
            },
            [this, document = documents_, change = changes_](const PictureCost& cost) {
                if (document != documents_) return;
                show(cost);
                if (change != changes_) prices_.outdate(Prices::Of::Picture);
            });
    }

    void show(const PictureCost& cost) {
        QHash<QString, SettingPrices> prices;
        for (const PictureCostRun& run : cost.runs) {
            SettingPrices& setting = prices[QString::fromStdString(run.setting)];
            setting.unit = QString("FLIP");
            setting.values.push_back({labelOf(QString::fromStdString(run.value)).toLower(),
                                      run.milliseconds.median, run.flip, run.now});
        }
        prices_.set(Prices::Of::Picture, prices);
        note_->setText(
            QString(
                "Columns up: frame time while hair moves, at %1×%2 pixels on %3. Columns down: difference "
                "from the best image. Highlighted: the current value. Drew %L4 of %L5 hairs.")
                .arg(cost.width)
                .arg(cost.height)
                .arg(QString::fromStdString(cost.device))
                .arg(cost.hairs)
                .arg(cost.allHairs));
        note_->show();
    }

    QtDocument& document_;
    Tasks& tasks_;
    Viewport& viewport_;
    Prices& prices_;
    QLabel* note_;
    std::uint32_t documents_ = 0;  ///< replaced so far
    std::uint32_t changes_ = 0;    ///< of what prices hang on
};

}  // namespace

QWidget* makePicturePrices(QtDocument& document, Tasks& tasks, Viewport& viewport, Prices& prices) {
    return new PicturePrices(document, tasks, viewport, prices);
}

}  // namespace hairloom::editor
