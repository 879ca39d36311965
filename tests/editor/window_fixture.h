// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A window as a person has it, and a person's hands.

#include <gtest/gtest.h>

#include <QApplication>
#include <QDialog>
#include <QElapsedTimer>
#include <QFileDialog>
#include <QGuiApplication>
#include <QLineEdit>
#include <QScreen>
#include <QSettings>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>
#include <QWindow>
#include <functional>
#include <map>
#include <memory>

#include "core/editing/document.h"
#include "core/editing/settings_commands.h"
#include "core/groom/groom_hash.h"
#include "core/groom/validate.h"
#include "editor/shell/files.h"
#include "editor/shell/main_window.h"

namespace hairloom::editor {

/// Milliseconds to wait for what a test checks: longer than a machine takes that is busy or compiles shaders.
constexpr int kPatience = 400'000;

class WindowTest : public testing::Test {
  protected:
    /// `pictures` are drawn: slow on a software device, and needed by few tests.
    explicit WindowTest(bool pictures = false) : pictures_(pictures) {}
    void SetUp() override {
        QSettings().clear();
        if (!pictures_) qputenv("HAIRLOOM_VIEWPORT", "none");
        ASSERT_TRUE(folder.isValid());
        QObject::connect(&unanswered_, &QTimer::timeout, [this] { leaveUnanswered(); });
        unanswered_.start(1000);
        open();
    }
    void TearDown() override {
        window->setUnsavedAnswer(MainWindow::Unsaved::Discard);
        window->close();
        window.reset();
        if (!pictures_)
            wished_.isEmpty() ? qunsetenv("HAIRLOOM_VIEWPORT") : qputenv("HAIRLOOM_VIEWPORT", wished_);
    }
    void open() {
        window = std::make_unique<MainWindow>();
        window->setUnsavedAnswer(MainWindow::Unsaved::Discard);
        window->resize(1280, 800);
        window->show();
        ASSERT_TRUE(QTest::qWaitForWindowExposed(window.get()));
    }

    PanelParts parts() { return window->parts(); }
    DocumentFiles& files() { return window->files(); }
    QtDocument& document() { return parts().document; }
    const Groom& groom() { return document().groom(); }
    Viewport& viewport() { return parts().viewport; }
    /// A step of that name which gives the document the settings and spheres of another groom.
    void change(const char* name, const Groom& to) {
        document().perform(editing::setSettings(document().editing().model(), to, name));
    }
    std::uint64_t hash() { return contentHash(groom()); }

    void trigger(const char* id) { window->actions().get(id).trigger(); }
    /// Pictures that a software device makes in seconds.
    void drawQuickly() {
        PictureQuality quality = viewport().quality();
        quality.samples = 1;
        quality.frames = 2;
        quality.subdivisions = 1;
        viewport().setQuality(quality);
        ShadowSettings shadows = groom().shadows;
        shadows.resolution = 256;
        document().perform(editing::setShadows(document().editing().model(), shadows, "Shadow resolution"));
    }
    /// Waits for work off the interface thread and what comes of it.
    void finishWork() {
        parts().tasks.finish();
        QCoreApplication::processEvents();
    }
    /// Made once for all tests; AnEmptyWindow… opens one as a person does.
    void openSampleHair(const QString& name) {
        static std::map<QString, std::pair<Groom, std::shared_ptr<const Actor>>> made;
        if (!made.contains(name)) {
            files().openSample(name);
            finishWork();
            ASSERT_GT(groom().strandCount(), 0u) << window->statusLine().message().toStdString();
            made[name] = {groom(), parts().player.actor()};
            return;
        }
        document().open(made[name].first, {}, name);
        parts().player.setActor(made[name].second);
    }
    /// Short hair, all of it seen from the front.
    void openHairFromTheFront() {
        openSampleHair("short");
        viewport().look(render::View::Front);
        viewport().frameAll();
    }
    /// The first strands of a groom alone: no head, no spheres, settings as by default.
    static Groom firstStrands(const Groom& all, std::size_t count) {
        const std::vector<std::uint32_t> offsets(
            all.offsets.view().begin(), all.offsets.view().begin() + static_cast<std::ptrdiff_t>(count) + 1);
        return makeGroom(offsets, {all.positions().begin(), all.positions().begin() + offsets.back()});
    }
    /// Those of the document, in its place: what takes minutes with all takes seconds.
    void openFirstStrands(std::size_t count) { document().open(firstStrands(groom(), count), {}, "few"); }
    void openBust() {
        files().openSample({});
        finishWork();
        ASSERT_TRUE(groom().scalp) << window->statusLine().message().toStdString();
    }
    QString inFolder(const char* name) const { return folder.filePath(name); }

    /// Once a dialog of that kind asks, gives it to `answer`.
    template <class Dialog>
    void onceAsked(std::function<void(Dialog&)> answer) {
        auto* timer = new QTimer(window.get());
        QObject::connect(timer, &QTimer::timeout, window.get(), [timer, answer = std::move(answer)] {
            auto* asks = qobject_cast<Dialog*>(QApplication::activeModalWidget());
            if (!asks || !asks->isVisible()) return;
            timer->stop();
            timer->deleteLater();
            answer(*asks);
        });
        timer->start(50);
    }
    /// Once a dialog of files asks, answers with that file. Its name is typed: what selectFile() selects
    /// is lost when the dialog has listed its folder only afterwards.
    void onceAskedForAFile(const QString& path) {
        onceAsked<QFileDialog>([path](QFileDialog& dialog) {
            dialog.findChild<QLineEdit*>("fileNameEdit")->setText(path);
            QMetaObject::invokeMethod(&dialog, "accept");
        });
    }

    // The pointer over the viewport, in its pixels.
    void press(const QPoint& at, Qt::KeyboardModifiers modifiers = {},
               Qt::MouseButton button = Qt::LeftButton) {
        send([&](auto* target) { QTest::mousePress(target, button, modifiers, at); });
    }
    void moveTo(const QPoint& at) {
        send([&](auto* target) { QTest::mouseMove(target, at); });
        // On a display the pointer itself is moved, and the X server says so in its own time.
        QTest::qWait(20);
    }
    void release(const QPoint& at, Qt::KeyboardModifiers modifiers = {},
                 Qt::MouseButton button = Qt::LeftButton) {
        send([&](auto* target) { QTest::mouseRelease(target, button, modifiers, at); });
    }
    /// Presses at the first point, moves over the others, releases at the last.
    void drag(std::initializer_list<QPoint> points, Qt::KeyboardModifiers modifiers = {},
              Qt::MouseButton button = Qt::LeftButton) {
        press(*points.begin(), modifiers, button);
        for (const QPoint& point : points) moveTo(point);
        release(*(points.end() - 1), modifiers, button);
    }
    void key(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
        send([&](auto* target) { QTest::keyClick(target, key, modifiers); });
    }
    /// Where a point of the world is in the viewport.
    QPoint at(const Vec3f& point_ws) {
        const auto px = viewport().camera().project(point_ws, viewport().viewSize_px());
        EXPECT_TRUE(px);
        return px.value_or(QPointF()).toPoint();
    }

    /// What people see: the window system's view, with what devices present by themselves.
    static QImage onScreen() { return QGuiApplication::primaryScreen()->grabWindow(0).toImage(); }
    QImage viewportOnScreen() {
        return onScreen().copy(QRect(viewport().mapToGlobal(QPoint(0, 0)), viewport().size()));
    }
    /// Waits until the hair has played to that time.
    bool played(double seconds) {
        return QTest::qWaitFor(
            [&] {
                const auto& frame = parts().player.frame();
                return frame && frame->time > seconds;
            },
            kPatience);
    }
    /// Keeps a picture of docs/manual.md in the folder that HAIRLOOM_MANUAL names.
    static void keepForManual(const QImage& picture, const QString& name) {
        const QString file = qEnvironmentVariable("HAIRLOOM_MANUAL") + "/editor-" + name + ".png";
        EXPECT_TRUE(picture.convertToFormat(QImage::Format_RGB888).save(file)) << name.toStdString();
    }
    /// Pixels, every fourth each way, that are redder than blue.
    static int skinPixels(const QImage& picture) {
        int count = 0;
        for (int y = 0; y < picture.height(); y += 4) {
            for (int x = 0; x < picture.width(); x += 4) {
                const QColor colour = picture.pixelColor(x, y);
                count += colour.red() > colour.blue() + 20 ? 1 : 0;
            }
        }
        return count;
    }

    template <class Widget>
    Widget* find(const char* name) {
        auto* widget = window->findChild<Widget*>(name);
        EXPECT_TRUE(widget) << "no control named " << name;
        return widget;
    }

    void expectSound() {
        for (const Finding& finding : validate(groom())) {
            EXPECT_NE(finding.severity, Severity::Error) << finding.what << " at " << finding.where;
        }
    }

    QTemporaryDir folder;
    std::unique_ptr<MainWindow> window;

  private:
    /// A dialog that nobody answers fails the test instead of holding up all others.
    void leaveUnanswered() {
        auto* asks = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        if (asks != stands_) asking_.start();
        stands_ = asks;
        if (!asks || asking_.elapsed() < 120'000) return;
        ADD_FAILURE() << "nobody answers " << asks->metaObject()->className() << " '"
                      << asks->windowTitle().toStdString() << "'";
        asks->reject();
    }

    bool pictures_;
    QTimer unanswered_;
    const QDialog* stands_ = nullptr;
    QElapsedTimer asking_;
    QByteArray wished_ = qgetenv("HAIRLOOM_VIEWPORT");

    template <class Act>
    void send(Act act) {
        QObject* const target = viewport().input();
        if (auto* native = qobject_cast<QWindow*>(target)) {
            act(native);
        } else {
            act(static_cast<QWidget*>(target));
        }
        QCoreApplication::processEvents();
    }
};

}  // namespace hairloom::editor
