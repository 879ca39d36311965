// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A measured setting played in the view, over and over: all hair moves as it would, and over it lie the
// compared strands, coloured by their error, beside those of the reference or of another setting.

#include <QTimer>
#include <memory>
#include <optional>

#include "core/accuracy/run_preview.h"
#include "editor/panels/panel.h"

namespace hairloom::editor {

class RunView : public QObject {
    Q_OBJECT

  public:
    explicit RunView(const PanelParts& parts, QObject* parent = nullptr);
    /// From when it is simulated on; in place of what is shown. While another is simulated the last one asked
    /// for waits. The measurement has kept trajectories. The other strands, in blue, are the reference's
    /// where `beside` names no run.
    void show(std::shared_ptr<const WorkPrecision> measured, std::size_t run,
              std::optional<std::size_t> beside);
    /// The view shows the document again.
    void stop();

  Q_SIGNALS:
    /// By stop(), because the document has changed or plays, or because simulating was cancelled.
    void stopped();

  private:
    struct Wish {
        std::shared_ptr<const WorkPrecision> measured;
        std::size_t run;
        std::optional<std::size_t> beside;
    };

    void begin(RunPreview preview);
    void showFrame();
    void draw(Marks& marks) const;

    QtDocument& document_;
    Player& player_;
    Tasks& tasks_;
    Messages& messages_;
    Viewport& viewport_;
    QTimer timer_;
    std::shared_ptr<const WorkPrecision> measured_;
    std::size_t run_ = 0;
    std::optional<std::size_t> beside_;
    std::optional<RunPreview> preview_;  ///< while it is shown
    std::size_t frame_ = 0;
    quint64 asked_ = 0;  ///< previews asked for so far; only the last one is shown
    bool simulating_ = false;
    std::optional<Wish> next_;  ///< once that is done
};

}  // namespace hairloom::editor
