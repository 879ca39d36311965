// SPDX-License-Identifier: GPL-3.0-or-later
// How long a person waits for the window: its start, a file, a move of the pointer with a brush down on
// combedHair(), which is picking, one dab and all that listens to the document; undo of the stroke; and what
// the renderer's thread then takes into the scene on the device. A brush has a radius of 2 cm. Nothing is
// drawn but where the name says so.
#include <benchmark/benchmark.h>

#include <QApplication>
#include <QTemporaryDir>
#include <array>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string_view>
#include <vector>

#include "benchmarks/combed_hair.h"
#include "core/editing/document.h"
#include "editor/document/files.h"
#include "editor/shell/main_window.h"
#include "editor/tools/brush_tool.h"
#include "editor/viewport/render_work.h"

namespace hairloom::editor {
namespace {

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
    Session& session() { return window_.session(); }
    Document& document() { return window_.session().document; }
    Viewport& viewport() { return *window_.session().viewport; }

    BrushTool& take(const char* name) {
        window_.actions().get(QString("tool.") + name).trigger();
        auto& tool = dynamic_cast<BrushTool&>(*session().tools.find(name));
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

void pointerMove(benchmark::State& state, const char* name) {
    BrushTool& tool = desk().take(name);
    // What skin there is to measure is measured before.
    desk().stroke(tool);
    desk().document().undo();
    const editing::Document& editing = desk().document().editing();
    double strands = 0;
    const editing::Subscription counting = desk().document().editing().observe(
        [&](const editing::Change& change) { strands += static_cast<double>(change.strands.size()); });
    double dabs = 0;
    int move = 0;
    std::size_t before = 0;
    for (auto _ : state) {
        if (move == 0) {
            state.PauseTiming();
            tool.press(desk().pointer(0));
            QCoreApplication::processEvents();
            before = editing.stroke()->stroke().dabs.size();
            state.ResumeTiming();
        }
        tool.drag(desk().pointer(++move));
        QCoreApplication::processEvents();
        if (move < kMoves) continue;
        state.PauseTiming();
        dabs += static_cast<double>(editing.stroke()->stroke().dabs.size() - before);
        move = 0;
        tool.cancel();
        QCoreApplication::processEvents();
        state.ResumeTiming();
    }
    if (editing.stroke()) {
        dabs += static_cast<double>(editing.stroke()->stroke().dabs.size() - before);
        tool.cancel();
    }
    state.counters["dabs"] = dabs / static_cast<double>(state.iterations());
    state.counters["strands_per_dab"] = strands / std::max(1.0, dabs);
}

void undo(benchmark::State& state, const char* name) {
    BrushTool& tool = desk().take(name);
    desk().stroke(tool);
    state.counters["megabytes"] = static_cast<double>(desk().document().historyBytes()) / 1e6;
    for (auto _ : state) {
        desk().document().undo();
        QCoreApplication::processEvents();
        state.PauseTiming();
        desk().document().redo();
        QCoreApplication::processEvents();
        state.ResumeTiming();
    }
    desk().document().undo();
    QCoreApplication::processEvents();
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
void sceneTakes(benchmark::State& state, bool whole) {
    auto device = gpu::createDevice();
    if (!device) {
        state.SkipWithError(device.error().message().c_str());
        return;
    }
    RenderWork work(**device);
    auto groom = std::make_shared<const Groom>(desk().document().groom());
    auto moves = std::make_shared<StrandMoves>();
    for (std::uint32_t s = 0; s < groom->strandCount(); s += 20) {
        moves->strands.push_back(s);
        const auto points = groom->strand(s);
        moves->points_ws.insert(moves->points_ws.end(), points.begin(), points.end());
    }
    static_cast<void>(work.take(smallPicture(groom)));
    for (auto _ : state) {
        state.PauseTiming();
        if (whole) {
            Groom other = *groom;
            other.pointAttributes.edit<Vec3f>(attribute::kPosition).front() += Vec3f(1e-6f, 0, 0);
            groom = std::make_shared<const Groom>(std::move(other));
        }
        PictureRequest request = smallPicture(groom);
        if (!whole) request.moves = moves;
        state.ResumeTiming();
        if (const auto taken = work.take(std::move(request)); !taken) {
            state.SkipWithError(taken.error().message().c_str());
        }
    }
}

void windowStands(benchmark::State& state) {
    for (auto _ : state) {
        auto window = std::make_unique<MainWindow>();
        window->show();
        QCoreApplication::processEvents();
        state.PauseTiming();
        window->close();
        window.reset();
        state.ResumeTiming();
    }
}

/// Head and strands of Sintel (11,400 × 16), where these lie beside the checkout.
void sintelOpens(benchmark::State& state) {
    const std::filesystem::path data = std::filesystem::path(HAIRLOOM_SOURCE_DIR) / "../shared/data";
    const auto head = data / "heads/sintel.obj", hair = data / "strands/sintel_16pt.tfx";
    if (!std::filesystem::exists(head) || !std::filesystem::exists(hair)) {
        state.SkipWithError("no data beside this checkout");
        return;
    }
    for (auto _ : state) {
        state.PauseTiming();
        MainWindow window;
        window.setUnsavedAnswer(MainWindow::Unsaved::Discard);
        window.show();
        QCoreApplication::processEvents();
        state.ResumeTiming();
        window.open(QString::fromStdString(head.string()));
        window.session().tasks.finish();
        QCoreApplication::processEvents();
        importStrandsInto(window.session(), QString::fromStdString(hair.string()), {});
        window.session().tasks.finish();
        QCoreApplication::processEvents();
        state.counters["strands"] = static_cast<double>(window.session().document.groom().strandCount());
        state.PauseTiming();
        window.close();
        state.ResumeTiming();
    }
}

constexpr auto kMs = benchmark::kMillisecond;
constexpr std::array kHairBrushes{"comb",   "brush", "grab",     "smooth", "puff",   "pinch",
                                  "length", "cut",   "cut_line", "add",    "delete", "freeze"};

void addAll() {
    benchmark::RegisterBenchmark("windowStands", windowStands)->Unit(kMs)->MeasureProcessCPUTime();
    benchmark::RegisterBenchmark("sintelOpens", sintelOpens)
        ->Unit(kMs)
        ->Iterations(3)
        ->MeasureProcessCPUTime();
    // Hair is added on skin, and there is none under this pointer.
    std::vector<const char*> brushes(std::begin(kHairBrushes), std::end(kHairBrushes));
    std::erase_if(brushes, [](std::string_view name) { return name == "add"; });
    for (const char* name : brushes) {
        benchmark::RegisterBenchmark((std::string("pointerMove/") + name).c_str(),
                                     [name](benchmark::State& state) { pointerMove(state, name); })
            ->Unit(kMs)
            ->MinTime(0.2)
            ->MeasureProcessCPUTime();
    }
    for (const char* name : brushes) {
        benchmark::RegisterBenchmark((std::string("undo/") + name).c_str(),
                                     [name](benchmark::State& state) { undo(state, name); })
            ->Unit(kMs)
            ->MinTime(0.2)
            ->MeasureProcessCPUTime();
    }
    for (const bool whole : {false, true}) {
        benchmark::RegisterBenchmark(whole ? "sceneTakes/whole" : "sceneTakes/moves",
                                     [whole](benchmark::State& state) { sceneTakes(state, whole); })
            ->Unit(kMs)
            ->MinTime(0.2)
            ->MeasureProcessCPUTime();
    }
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
    benchmark::Initialize(&argc, argv);
    hairloom::editor::addAll();
    benchmark::RunSpecifiedBenchmarks();
    hairloom::editor::sharedDesk.reset();
    return 0;
}
