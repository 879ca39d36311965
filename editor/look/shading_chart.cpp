// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QImage>
#include <QLabel>
#include <QPainter>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "core/editing/document.h"
#include "core/live/picture_shadows.h"
#include "core/live/shown.h"
#include "editor/fields/number_spin.h"
#include "editor/look/parts.h"

namespace hairloom::editor {
namespace {

constexpr double kShape = 0.8;             // of a chart's height to its width
constexpr double kLeastWidth = 320;        // pixels that text and legend need
constexpr std::uint32_t kMapTexels = 128;  // along a side of a shadow map that is drawn again and again

/// Light for dark and the reverse, with the same hues.
void turnLightness(ChartImage& image) {
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        std::uint8_t* const p = &image.rgba[i];
        const int sum = std::max({p[0], p[1], p[2]}) + std::min({p[0], p[1], p[2]});
        for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(p[c] + 255 - sum);
    }
}

/// Charts under one another, as wide as there is room.
class ChartView : public QWidget {
  public:
    explicit ChartView(const Preferences& preferences) : preferences_(preferences) {
        setObjectName("shadingChartImage");
        QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        policy.setHeightForWidth(true);
        setSizePolicy(policy);
    }

    void setShown(Shown shown) {
        const bool grows = shown.plots.size() != shown_.plots.size();
        shown_ = std::move(shown);
        if (grows) updateGeometry();
        redraw();
    }
    /// Draws the charts anew: what repaints for any other reason shows them as they are.
    void redraw() {
        drawn_ = {};
        update();
    }

    bool hasHeightForWidth() const override { return true; }
    int heightForWidth(int width) const override {
        const int count = std::max(static_cast<int>(shown_.plots.size()), 1);
        return count * static_cast<int>(kShape * width);
    }
    QSize sizeHint() const override { return {320, heightForWidth(320)}; }

  protected:
    void paintEvent(QPaintEvent*) override {
        if (shown_.plots.empty()) return;
        const QSize wanted = (QSizeF(size()) * devicePixelRatioF()).toSize();
        if (drawn_.size() != wanted) drawn_ = charts(wanted);
        QPainter(this).drawImage(QRectF(rect()), drawn_);
    }

  private:
    QImage charts(QSize pixels) const {
        QImage all(pixels, QImage::Format_ARGB32_Premultiplied);
        all.fill(Qt::transparent);
        QPainter painter(&all);
        painter.scale(static_cast<double>(pixels.width()) / width(),
                      static_cast<double>(pixels.height()) / height());
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        const int high = height() / static_cast<int>(shown_.plots.size());
        for (std::size_t i = 0; i < shown_.plots.size(); ++i) {
            Plot plot = shown_.plots[i];
            plot.width = std::max<double>(width(), kLeastWidth);
            plot.height = plot.width * high / std::max(width(), 1);
            const double scale = std::clamp(devicePixelRatioF() * width() / plot.width, 0.5, 8.0);
            ChartImage chart = hairloom::image(plot, scale);
            if (preferences_.theme() == Theme::Dark && !plot.map) turnLightness(chart);
            const QImage image(chart.rgba.data(), static_cast<int>(chart.width),
                               static_cast<int>(chart.height), QImage::Format_RGBA8888);
            painter.drawImage(QRectF(0, static_cast<double>(i) * high, width(), high), image);
        }
        painter.end();
        return all;
    }

    const Preferences& preferences_;
    Shown shown_;
    QImage drawn_;  ///< pixels of the device; empty where it is to be drawn
};

class ShadingChart : public QWidget {
  public:
    ShadingChart(QtDocument& document, const Preferences& preferences)
        : document_(document),
          kinds_(new QComboBox),
          light_(new NumberSpin),
          note_(new QLabel),
          view_(new ChartView(preferences)) {
        kinds_->setObjectName("shadingChart");
        kinds_->setToolTip("Curve or look-up table to draw. Charts follow the controls of this panel");
        for (const ShownKind& kind : shownKinds()) kinds_->addItem(kind.label, QString(kind.name));
        light_->setObjectName("shadingChartLight");
        light_->setRange(-85, 85);
        light_->setDecimals(0);
        light_->setSuffix(" °");
        light_->setToolTip("Inclination of the light against the plane across the hair, for curves");
        note_->setProperty("role", "dim");
        note_->setWordWrap(true);
        soon_.setSingleShot(true);
        soon_.setInterval(0);

        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(6);
        auto* row = new QHBoxLayout;
        row->setSpacing(6);
        row->addWidget(kinds_, 1);
        row->addWidget(light_);
        layout->addLayout(row);
        layout->addWidget(note_);
        layout->addWidget(view_);

        connect(kinds_, &QComboBox::currentIndexChanged, this, [this] { redraw(); });
        connect(light_, &NumberSpin::valueChanged, this, [this] { redraw(); });
        connect(&preferences, &Preferences::changed, view_, &ChartView::redraw);
        // A control that moves says so more often than charts can be drawn.
        connect(&soon_, &QTimer::timeout, this, [this] { redraw(); });
        connect(&document_, &QtDocument::changed, this, [this](editing::Part changed) {
            const bool shows = shownKind(kinds_->currentData().toString().toStdString())->ofGroom
                                   ? contains(changed, editing::Part::Shadows | editing::kHairParts)
                                   : contains(changed, editing::Part::Material);
            if (shows && isVisible()) soon_.start();
        });
    }

  protected:
    void showEvent(QShowEvent* event) override {
        redraw();
        QWidget::showEvent(event);
    }

  private:
    void redraw() {
        const ShownKind* const kind = shownKind(kinds_->currentData().toString().toStdString());
        ShownHair hair;
        hair.material = document_.groom().material;
        if (kind->ofGroom) {
            // Without follow hairs, which would take as long as the picture itself.
            Groom strands = document_.groom();
            strands.interpolation.followPerGuide = 0;
            takeShadows(strands.shadows, hair.shadows);
            hair.shadows.shadowResolution = std::min(hair.shadows.shadowResolution, kMapTexels);
            hair.groom = std::make_shared<const Groom>(std::move(strands));
        }
        hair.inclinationDegrees = light_->value();
        auto shown = hairloom::show(*kind, hair);
        note_->setVisible(!shown);
        view_->setVisible(shown.has_value());
        if (shown) {
            view_->setShown(std::move(*shown));
        } else {
            note_->setText(QString::fromStdString(shown.error().problem));
        }
    }

    QtDocument& document_;
    QComboBox* kinds_;
    NumberSpin* light_;
    QLabel* note_;
    ChartView* view_;
    QTimer soon_;
};

}  // namespace

QWidget* makeShadingChart(QtDocument& document, const Preferences& preferences) {
    return new ShadingChart(document, preferences);
}

}  // namespace hairloom::editor
