// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/style/icons.h"

#include <QApplication>
#include <QFile>
#include <QIconEngine>
#include <QImageReader>
#include <QPainter>
#include <QPalette>
#include <QPixmapCache>

namespace hairloom::editor {
namespace {

class TintedEngine : public QIconEngine {
  public:
    explicit TintedEngine(QString file) : file_(std::move(file)) {}

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
        const qreal ratio = painter->device()->devicePixelRatioF();
        painter->drawPixmap(rect, scaledPixmap(rect.size() * ratio, mode, state, 1));
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        return scaledPixmap(size, mode, state, 1);
    }
    QPixmap scaledPixmap(const QSize& size, QIcon::Mode mode, QIcon::State state, qreal) override {
        const QColor colour = colourOf(mode, state);
        const QString key =
            QStringLiteral("%1|%2x%3|%4").arg(file_).arg(size.width()).arg(size.height()).arg(colour.rgba());
        QPixmap pixmap;
        if (QPixmapCache::find(key, &pixmap)) return pixmap;
        QImageReader reader(file_);
        reader.setScaledSize(size);
        QImage image = reader.read().convertToFormat(QImage::Format_ARGB32_Premultiplied);
        if (image.isNull()) return {};
        QPainter painter(&image);
        painter.setCompositionMode(QPainter::CompositionMode_SourceIn);
        painter.fillRect(image.rect(), colour);
        painter.end();
        pixmap = QPixmap::fromImage(image);
        QPixmapCache::insert(key, pixmap);
        return pixmap;
    }
    QIconEngine* clone() const override { return new TintedEngine(file_); }

  private:
    static QColor colourOf(QIcon::Mode mode, QIcon::State state) {
        const QPalette palette = QApplication::palette();
        if (mode == QIcon::Disabled) return palette.color(QPalette::Disabled, QPalette::ButtonText);
        if (state == QIcon::On || mode == QIcon::Selected) return palette.color(QPalette::HighlightedText);
        return palette.color(QPalette::ButtonText);
    }

    QString file_;
};

}  // namespace

const QString& iconEnding() {
    static const QString ending = QFile::exists(":/icons/open.png") ? "png" : "svg";
    return ending;
}

bool hasIcon(const QString& name) {
    return QFile::exists(QStringLiteral(":/icons/%1.%2").arg(name, iconEnding()));
}

QIcon icon(const QString& name) {
    return QIcon(new TintedEngine(QStringLiteral(":/icons/%1.%2").arg(name, iconEnding())));
}

}  // namespace hairloom::editor
