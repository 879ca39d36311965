// SPDX-License-Identifier: GPL-3.0-or-later
// How long a person waits for the window: its start, a file, a move of the pointer with a brush down on
// combedHair(), which is picking, one dab and all that listens to the document; undo of the stroke; and what
// the renderer's thread then takes into the scene on the device. A brush has a radius of 2 cm. Nothing is
// drawn but where the name says so. Writes what `bench window` reports.

#include <QApplication>
#include <QTemporaryDir>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string_view>
#include <vector>

#include "benchmarks/combed_hair.h"
#include "benchmarks/measurement.h"
#include "core/documents/sample.h"
#include "core/editing/brush_list.h"
#include "core/editing/document.h"
#include "editor/shell/files.h"
#include "editor/shell/main_window.h"
#include "editor/tools/brush_tool.h"
#include "editor/viewport/render_work.h"
#include "importers/child_process.h"

namespace hairloom::editor {
namespace {

using benchmarks::combedHair;
using benchmarks::onCombedHair;
using benchmarks::Rounds;
using benchmarks::Timings;

constexpr int kMoves = 24;
constexpr float kFirstDegrees = -60, kDegreesPerMove = 5;  // 9 mm, for one dab a move

/// The window with the hair in it, seen from the front.
class Desk {
  public:
    Desk() {
        window_.setUnsavedAnswer(MainWindow::Unsaved::Discard);
        window_.resize(1280, 800);
        window_.show();
        document().open(combedHair(), {}, "bench");
        viewport().look(render::View::Front);
        viewport().frameAll();
        QCoreApplication::processEvents();
    }
    PanelParts parts() { return window_.parts(); }
    QtDocument& document() { return window_.parts().document; }
    Viewport& viewport() { return window_.parts().viewport; }

    BrushTool& take(const char* name) {
        window_.actions().get(QString("tool.") + name).trigger();
        auto& tool = dynamic_cast<BrushTool&>(*parts().tools.find(name));
        tool.setRadius(0.02f);
        return tool;
    }
    Pointer pointer(int move) {
        const Vec3f place = onCombedHair(kFirstDegrees + kDegreesPerMove * static_cast<float>(move));
        const auto at = viewport().camera().project(place, viewport().viewSize_px());
        return {at.value_or(QPointF()), Qt::LeftButton, {}, 1};
    }
    void stroke(BrushTool& tool) {
        tool.press(pointer(0));
        for (int move = 1; move < kMoves; ++move) tool.drag(pointer(move));
        tool.release(pointer(kMoves));
        QCoreApplication::processEvents();
    }

  private:
    MainWindow window_;
};

/// Made when first asked for; gone before the application is.
std::unique_ptr<Desk> sharedDesk;

Desk& desk() {
    if (!sharedDesk) sharedDesk = std::make_unique<Desk>();
    return *sharedDesk;
}

Status pointerMove(Rounds& rounds, const char* name) {
    BrushTool& tool = desk().take(name);
    // What skin there is to measure is measured before.
    desk().stroke(tool);
    desk().document().undo();
    int move = 0;
    while (rounds.next()) {
        if (move == 0) {
            rounds.pause();
            tool.press(desk().pointer(0));
            QCoreApplication::processEvents();
            rounds.resume();
        }
        tool.drag(desk().pointer(++move));
        QCoreApplication::processEvents();
        if (move < kMoves) continue;
        rounds.pause();
        move = 0;
        tool.cancel();
        QCoreApplication::processEvents();
        rounds.resume();
    }
    if (desk().document().editing().stroke()) tool.cancel();
    return {};
}

Status undo(Rounds& rounds, const char* name) {
    BrushTool& tool = desk().take(name);
    desk().stroke(tool);
    while (rounds.next()) {
        desk().document().undo();
        QCoreApplication::processEvents();
        rounds.pause();
        desk().document().redo();
        QCoreApplication::processEvents();
        rounds.resume();
    }
    desk().document().undo();
    QCoreApplication::processEvents();
    return {};
}

PictureRequest smallPicture(const std::shared_ptr<const Groom>& groom) {
    PictureRequest request;
    request.groom = groom;
    request.camera = desk().viewport().camera().camera();
    request.width = request.height = 16;
    request.moving = true;
    return request;
}

/// One strand in twenty moves, as under a brush. `whole`: the groom is handed over instead of what moved.
Status sceneTakes(Rounds& rounds, const Groom& hair, bool whole) {
    auto device = gpu::createDevice();
    if (!device) return tl::unexpected(device.error());
    RenderWork work(**device, nullptr);
    auto groom = std::make_shared<const Groom>(hair);
    auto moves = std::make_shared<StrandMoves>();
    for (std::uint32_t s = 0; s < groom->strandCount(); s += 20) {
        moves->strands.push_back(s);
        const auto points = groom->strand(s);
        moves->points_ws.insert(moves->points_ws.end(), points.begin(), points.end());
    }
    static_cast<void>(work.take(smallPicture(groom)));
    while (rounds.next()) {
        rounds.pause();
        if (whole) {
            Groom other = *groom;
            other.pointAttributes.edit<Vec3f>(attribute::kPosition).front() += Vec3f(1e-6f, 0, 0);
            groom = std::make_shared<const Groom>(std::move(other));
        }
        PictureRequest request = smallPicture(groom);
        if (!whole) request.moves = moves;
        rounds.resume();
        if (const auto taken = work.take(std::move(request)); !taken) return tl::unexpected(taken.error());
    }
    return {};
}

Status windowStands(Rounds& rounds) {
    while (rounds.next()) {
        auto window = std::make_unique<MainWindow>();
        window->show();
        QCoreApplication::processEvents();
        rounds.pause();
        window->close();
        window.reset();
        rounds.resume();
    }
    return {};
}

Status sampleOpens(Rounds& rounds, const QString& name) {
    while (rounds.next()) {
        rounds.pause();
        MainWindow window;
        window.setUnsavedAnswer(MainWindow::Unsaved::Discard);
        window.show();
        QCoreApplication::processEvents();
        rounds.resume();
        window.files().openSample(name);
        window.parts().tasks.finish();
        QCoreApplication::processEvents();
        rounds.pause();
        window.close();
        rounds.resume();
    }
    return {};
}

/// Hair is added on skin, and there is none under this pointer; nor is anything painted on it.
std::vector<std::string> hairBrushes() {
    std::vector<std::string> names;
    for (const std::string_view name : editing::brushNames()) {
        if (name != "add" && !name.ends_with("paint")) names.emplace_back(name);
    }
    return names;
}

void measureAll(Timings& timings) {
    timings.measure("the window opens", windowStands);
    for (const char* name : {"short", "shoulder", "long"}) {
        timings.measure(std::string("opening the ") + name + " sample",
                        [name](Rounds& rounds) { return sampleOpens(rounds, name); });
    }
    for (const std::string& name : hairBrushes()) {
        timings.measure("a move of the pointer, " + name,
                        [&](Rounds& rounds) { return pointerMove(rounds, name.c_str()); });
    }
    for (const std::string& name : hairBrushes()) {
        timings.measure("undo of a stroke, " + name,
                        [&](Rounds& rounds) { return undo(rounds, name.c_str()); });
    }
    const auto hair = [] { return desk().document().groom(); };
    timings.measure("the scene updates moved strands",
                    [&](Rounds& rounds) { return sceneTakes(rounds, hair(), false); });
    timings.measure("the scene takes the groom",
                    [&](Rounds& rounds) { return sceneTakes(rounds, hair(), true); });
    const auto sample = makeSample(findSamples(programFolder()), "shoulder");
    if (!sample) return;
    timings.measure("the scene updates moved guides, shoulder sample",
                    [&](Rounds& rounds) { return sceneTakes(rounds, *sample, false); });
    timings.measure("the scene takes the groom, shoulder sample",
                    [&](Rounds& rounds) { return sceneTakes(rounds, *sample, true); });
}

}  // namespace
}  // namespace hairloom::editor

int main(int argc, char** argv) {
    // Settings of whoever measures stay as they are.
    const QTemporaryDir home;
    qputenv("XDG_CONFIG_HOME", home.path().toUtf8());
    qputenv("XDG_DATA_HOME", home.path().toUtf8());
    if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
    if (qEnvironmentVariableIsEmpty("HAIRLOOM_VIEWPORT")) qputenv("HAIRLOOM_VIEWPORT", "none");
    QApplication application(argc, argv);
    QCoreApplication::setApplicationName("Hairloom");
    QCoreApplication::setOrganizationName("Hairloom");
    hairloom::benchmarks::Options options;
    for (const QString& argument : QCoreApplication::arguments().mid(1)) {
        if (argument == "--quick") options.quick = true;
        if (argument.startsWith("--repeat=")) options.repetitions = std::max(1, argument.mid(9).toInt());
    }
    hairloom::benchmarks::Timings timings(options);
    hairloom::editor::measureAll(timings);
    hairloom::editor::sharedDesk.reset();
    const auto outcome = timings.outcome("window");
    if (!outcome) {
        std::cerr << "error: " << outcome.error().message() << '\n';
        return 1;
    }
    std::cout << outcome->report.dump(2) << '\n';
    return 0;
}
