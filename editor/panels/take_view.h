// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A take in the view: any frame at once, or played at a speed, with the distance to another take on its
// strands.

#include <QElapsedTimer>
#include <QTimer>
#include <memory>
#include <optional>

#include "core/simulation/frame_record.h"
#include "core/simulation/take_file.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {

inline constexpr float kRedDistance = 0.02f;  ///< metres of distance at which strands are red

class TakeView : public QObject {
    Q_OBJECT

  public:
    explicit TakeView(const PanelParts& parts, QObject* parent = nullptr);

    /// In place of what was shown, from its first frame on. Errors: those of reading; it shows nothing then.
    Status show(const std::filesystem::path& take);
    /// Colours strands by their distance from those of the other take; empty: none. Errors: as show().
    Status compareWith(const std::filesystem::path& other);
    /// The view shows the document again.
    void stop();
    bool isShown() const { return take_.has_value(); }

    /// Errors: those of reading, in failed(). Where there is no such frame it is the nearest one.
    void showFrame(std::uint64_t number);
    /// Null where none is shown.
    const RecordedFrame* frame() const { return frame_ ? &*frame_ : nullptr; }
    std::uint64_t number() const { return number_; }
    /// Of the points of the frame that is shown from those of the other take, metres.
    struct Distance {
        double mean = 0, largest = 0;
    };
    /// Nothing where none is compared.
    std::optional<Distance> distance() const;
    const TakeInfo& info() const { return take_->info(); }

    /// Over and over.
    void setPlaying(bool on);
    bool isPlaying() const { return timer_.isActive(); }
    /// 1: as it was recorded.
    void setSpeed(double factor);

  Q_SIGNALS:
    void frameShown(quint64 number);
    void playingChanged();
    /// By stop(), or because the document has changed or plays.
    void stopped();
    void failed(const QString& problem);

  private:
    void advance();
    /// Two frames of the document's points.
    bool isCompared() const;
    void draw(Marks& marks) const;
    void startClock();
    /// The frame at the time line's play head.
    void followPlayHead();

    QtDocument& document_;
    Player& player_;
    Viewport& viewport_;
    QTimer timer_;
    QElapsedTimer clock_;
    std::uint64_t from_ = 0;  ///< frame at the start of the clock
    double speed_ = 1;
    std::optional<TakeReader> take_, other_;
    std::optional<RecordedFrame> frame_, otherFrame_;
    std::uint64_t number_ = 0;
};

}  // namespace hairloom::editor
