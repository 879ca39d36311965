// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The live view of the document. Shows the pictures of the render thread: by a swap chain on a window of its
// own where the device can, else read back into a widget. Moves its camera, or hands the pointer to a tool.

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>
#include <QWindow>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "editor/document/preferences.h"
#include "editor/document/qt_document.h"
#include "editor/viewport/canvas.h"
#include "editor/viewport/mark_sheet.h"
#include "editor/viewport/orbit_camera.h"
#include "editor/viewport/render_thread.h"
#include "editor/viewport/tool.h"

namespace hairloom::editor {

class Viewport : public QWidget {
    Q_OBJECT

  public:
    Viewport(QtDocument& document, const Preferences& preferences, QWidget* parent = nullptr);
    ~Viewport() override;

    OrbitCamera& camera() { return camera_; }
    const OrbitCamera& camera() const { return camera_; }
    QSizeF viewSize_px() const { return size(); }

    /// Null: every drag moves the camera.
    void setTool(Tool* tool);
    Tool* tool() const { return tool_; }

    /// How finely it draws.
    const PictureQuality& quality() const { return quality_; }
    void setQuality(const PictureQuality& quality);

    /// Another look of the hair, to compare with.
    struct Comparison {
        HairMaterial material;
        InterpolationSettings interpolation;
        ShadowSettings shadows;
        PictureQuality quality;
    };
    /// Shows that look left of a line that can be dragged; nothing: only the document's.
    void setComparison(std::optional<Comparison> look);
    const std::optional<Comparison>& comparison() const { return comparison_; }
    /// Where the line is, as a part of the width.
    void setSplit(float share);
    float split() const { return split_; }
    /// A picture behind the head, to groom after; null: none. `opacity` 0…1.
    void setReference(const QImage& image, double opacity);
    const QImage& reference() const { return reference_; }

    /// For who simulates on the device that draws.
    const std::shared_ptr<RenderJobs>& renderJobs() const { return renderer_.jobs(); }
    /// Called while marks are drawn, by those on strands.
    void wantPositions() const { positionsWanted_ = true; }

    /// A picture of something else, made when nothing else is to be drawn; sidePictureReady() brings it.
    void requestSidePicture(const QString& name, PictureRequest request) {
        renderer_.postSide(name, std::move(request));
    }

    /// What is shown, without marks: for pictures and films.
    PictureRequest requestOfView() const;
    /// Draws a picture of it and waits; not on the interface thread. As RenderThread::drawAside().
    Result<QImage> drawAside(PictureRequest request, const std::function<bool()>& isCancelled) {
        return renderer_.drawAside(std::move(request), isCancelled);
    }
    /// While true nothing is drawn anew, so that other pictures come.
    void setHeld(bool on);

    // What is shown. Each redraws.
    void setPose(std::shared_ptr<const HairPose> pose);
    const std::shared_ptr<const HairPose>& pose() const { return pose_; }
    void setHairShown(bool on);
    /// Share of the follow hairs that is drawn, 0…1, so that much hair stays quick. Pictures and exports have
    /// all, and so has hair that the device simulates.
    void setPreviewDensity(float share);
    float previewDensity() const { return previewDensity_; }
    void setHeadShown(bool on);
    void setLightTurn(float degrees);
    float lightTurn() const { return lightTurn_; }
    void setExposure(float factor);
    float exposure() const { return exposure_; }
    /// A view of a colour config instead of the tone curve and sRGB; null: none.
    void setColours(std::shared_ptr<const render::ColourTransform> toDisplay);
    const std::shared_ptr<const render::ColourTransform>& colours() const { return toDisplay_; }
    /// Factors on the lights and on the light from around; 1 as they come.
    void setLight(float lights, float environment);
    float lightScale() const { return lightScale_; }
    float environment() const { return environment_; }
    void setTurntable(bool on);
    void look(render::View view);
    void setOrthographic(bool on);
    void frameAll();

    /// Draws over the picture, each time anew; called in the order in which they were added. The interface
    /// draws them over the last picture, unless the device shows pictures by itself.
    void addMarks(std::function<void(Marks&)> draw);
    /// Takes everything anew. `moving` asks for speed.
    void redraw(bool moving = false);

    /// Where pointer and keys go: a QWindow where the device presents, else a QWidget; for tests.
    QObject* input() const;
    bool presents() const { return window_ != nullptr; }
    /// Waits until what was asked for is drawn; false after `milliseconds`.
    bool waitForPicture(int milliseconds = 20'000);
    /// The last picture that was read back; without marks, which grab() has.
    const QImage& picture() const { return picture_; }

  Q_SIGNALS:
    /// `note`: why the software renderer draws; empty: it does not.
    void deviceReady(const QString& name, const QString& note);
    void drawn(const hairloom::editor::PictureReport& report);
    void failed(const QString& problem);
    void poseChanged();
    /// Quality or comparison.
    void lookChanged();
    void lightTurned(float degrees);
    void sidePictureReady(const QString& name, const QImage& picture);
    /// The pointer's tool has something else to say.
    void hintChanged();
    /// A key that neither camera nor tool took.
    void keyPressed(int key, Qt::KeyboardModifiers modifiers);

  protected:
    bool eventFilter(QObject* object, QEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

  private:
    enum class Move { None, Turn, Pan, Zoom, Split };

    void waitFor(const QString& what);
    /// Pictures that are blended with others are read back.
    void chooseSurface();
    void useWindow();
    /// The window system has made or is about to take away what the device draws to.
    void surfaceChanged(bool exists);
    void useCanvas();
    void showOnCanvas();
    void placeApart();
    void post();
    /// Marks as they are now, of all who add some.
    render::Overlay marksNow();
    /// Lays the last marks over the picture that is shown, as its camera sees them.
    void layMarks();
    /// The head of a document that has just been opened: its hair may take a while.
    void postHead();
    void finishRequest(PictureRequest& request) const;
    /// The next picture takes all of the groom.
    void handOverAll();
    std::uint32_t previewedPerGuide() const;
    void noteMoved(std::span<const std::uint32_t> strands);
    std::shared_ptr<const StrandMoves> movesSinceHandedOver();
    void dragView(const QPointF& to_px);
    Move viewMove(Qt::MouseButton button, Qt::KeyboardModifiers modifiers) const;
    bool mousePress(const QMouseEvent& event);
    bool mouseMove(const QMouseEvent& event);
    bool mouseRelease(const QMouseEvent& event);
    bool keyPress(const QKeyEvent& event);
    bool overSplit(const QPointF& at_px) const;
    bool tablet(const QTabletEvent& event);
    Pointer pointerAt(const QPointF& at_px, Qt::MouseButton button, Qt::KeyboardModifiers modifiers) const;
    void documentChanged(editing::Part parts);

    QtDocument& document_;
    const Preferences& preferences_;
    OrbitCamera camera_;
    RenderThread renderer_;
    Canvas* canvas_ = nullptr;
    QWindow* window_ = nullptr;
    bool apart_ = false;        ///< the window lies over the viewport instead of within it
    QWidget* shown_ = nullptr;  ///< canvas or the window's container
    Tool* tool_ = nullptr;
    std::shared_ptr<const Groom> groom_;  ///< as the renderer was handed it; null: it shall be anew
    std::vector<std::uint32_t> moved_;    ///< strands that have moved since and that it has not been told
    std::vector<std::uint8_t> isMoved_;   ///< per strand, 1 for those
    std::shared_ptr<const HairPose> pose_;
    std::vector<std::function<void(Marks&)>> marks_;
    render::Overlay overlay_;  ///< marks that lie over the picture
    MarkSheet sheet_;
    QImage picture_;
    render::Camera pictureCamera_;          ///< of picture_
    std::optional<PictureRequest> posted_;  ///< the last, without marks and moves; nothing: post the next
    QTimer settle_;                         ///< from fast pictures to fine ones
    QTimer turntable_;
    QTimer postSoon_;
    bool moving_ = false;
    bool isHeld_ = false;
    bool showHair_ = true, showHead_ = true;
    float previewDensity_ = 1;
    float lightTurn_ = 0;
    float exposure_ = 1.6f;
    std::shared_ptr<const render::ColourTransform> toDisplay_;
    float lightScale_ = 1, environment_ = 1;
    bool presentsByItself_ = false;  ///< the device can and shall
    PictureQuality quality_;
    std::optional<Comparison> comparison_;
    std::shared_ptr<const Groom> other_;  ///< with the look of comparison_
    float split_ = 0.5f;
    QImage reference_;
    double referenceOpacity_ = 1;
    Move move_ = Move::None;
    bool toolPressed_ = false;
    QPointF last_px_;
    double pressure_ = 1;
    bool framed_ = false;
    std::uint32_t documents_ = 0;  ///< opened so far
    bool headFirst_ = false;       ///< nothing of this document was drawn yet
    mutable bool positionsWanted_ = false;
};

}  // namespace hairloom::editor
