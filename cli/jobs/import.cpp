// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/geometry/selection.h"
#include "core/groom/file/project_file.h"
#include "core/simulation/frame_record.h"
#include "importers/strands.h"

namespace hairloom::cli {
namespace {

struct ImportOptions {
    std::string file;
    std::string mesh;
    std::string scalp = "all";
    std::string unit;
    std::string meshUnit;
    std::string up = "y";
    std::uint32_t segments = 0;
    std::string order = "auto";
    std::string particle = "edge";
    std::string record;
    float framesPerSecond = 0;
    std::string output;
};

const std::map<std::string, RibbonOrder> kOrders{{"auto", RibbonOrder::Detect},
                                                 {"interleaved", RibbonOrder::Interleaved},
                                                 {"edges", RibbonOrder::EdgeAfterEdge},
                                                 {"around", RibbonOrder::Around}};

StrandImportOptions strandOptions(const ImportOptions& options) {
    StrandImportOptions strands;
    if (!options.unit.empty()) strands.metresPerUnit = metresPerUnit(options.unit);
    strands.up = options.up == "z" ? UpAxis::Z : UpAxis::Y;
    strands.frames = !options.record.empty();
    strands.ribbonSegments = options.segments;
    strands.ribbonOrder = kOrders.at(options.order);
    strands.ribbonParticle =
        options.particle == "centre" ? RibbonParticle::Centre : RibbonParticle::FirstEdge;
    return strands;
}

/// Distances of roots to the scalp they were bound to, in the words of a report.
Report bindingReport(std::vector<float> distances) {
    std::sort(distances.begin(), distances.end());
    return Report{{"median_mm", distances[distances.size() / 2] * 1e3}, {"max_mm", distances.back() * 1e3}};
}

/// The positions of every time of the file as frames of a record, which render and simulate --against read.
Status recordFrames(const ImportOptions& options, const ImportedStrands& imported) {
    if (imported.frames.empty())
        return failIn(options.file, {}, "has only one time sample", "expected animated strands for --record");
    constexpr float kUsualRate = 24;
    const float rate = options.framesPerSecond > 0    ? options.framesPerSecond
                       : imported.framesPerSecond > 0 ? imported.framesPerSecond
                                                      : kUsualRate;
    auto recorder = FrameRecorder::open(options.record, imported.groom, rate);
    if (!recorder) return tl::unexpected(recorder.error());
    for (const auto& frame : imported.frames) {
        if (auto status = recorder->add(frame, {}); !status) return status;
    }
    return recorder->finish();
}

Result<Report> import(const ImportOptions& options) {
    StrandImportOptions strandsAs = strandOptions(options);
    std::shared_ptr<const ScalpMesh> mesh;
    FaceSet faces;
    if (!options.mesh.empty()) {
        auto scene = importSceneWithUnit(options.mesh, options.meshUnit);
        if (!scene) return tl::unexpected(scene.error());
        mesh = std::make_shared<const ScalpMesh>(std::move(scene->mesh));
        auto selected = selectFaces(*mesh, options.scalp);
        if (!selected) return tl::unexpected(selected.error());
        faces = std::move(*selected);
        strandsAs.scalp = mesh.get();
    }
    auto imported = importStrands(options.file, strandsAs);
    if (!imported) return tl::unexpected(imported.error());
    Groom& groom = imported->groom;
    logFindings(options.file, imported->warnings);

    Report report;
    report["strands"] = groom.strandCount();
    report["points"] = groom.pointCount();
    report["dropped"] = Report::array();
    for (const auto& dropped : imported->dropped) {
        report["dropped"].push_back(
            Report{{"strand", dropped.strand}, {"reason", dropReasonName(dropped.reason)}});
    }
    report["format"] = imported->format;
    report["warnings"] = toReport(imported->warnings);
    if (mesh && groom.strandCount() > 0) {
        report["root_distance"] = bindingReport(bindToScalp(groom, mesh, std::move(faces)));
        groom.scalpExpression = options.scalp;
        groom.characterFile = options.mesh;
        if (!options.meshUnit.empty()) groom.characterMetresPerUnit = metresPerUnit(options.meshUnit);
        if (auto triangulation = triangulateRoots(*mesh, groom.scalpSelection, groom.rootBindings())) {
            groom.triangulation = std::move(*triangulation);
            if (groom.triangulation.triangles.empty())
                log::warning("{}: no three roots form a triangle", options.file);
        } else {
            log::warning("{}: the roots were not triangulated: {}", options.file,
                         triangulation.error().message());
        }
    }
    if (!options.record.empty()) {
        if (auto recorded = recordFrames(options, *imported); !recorded)
            return tl::unexpected(recorded.error());
        report["record"] = options.record;
        report["frames"] = imported->frames.size();
    }
    if (auto saved = saveProject(groom, options.output); !saved) return tl::unexpected(saved.error());
    report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<ImportOptions>();
    job.add_option("file", options->file,
                   labelsOf(strandFormats()) + "; or an OBJ of lines or of Cinema 4D ribbons")
        ->required();
    job.add_option("--mesh", options->mesh, "Head mesh to bind the roots to");
    job.add_option("--scalp", options->scalp, "Faces of the mesh where hair grows, as for create");
    addUnitOption(job, options->unit);
    addUnitOption(job, options->meshUnit, "--mesh-unit", "the head mesh");
    job.add_option("--up", options->up, "Up axis of the hair file")->check(CLI::IsMember({"y", "z"}));
    job.add_option("--segments", options->segments,
                   "Segments per strand of a Cinema 4D OBJ. 0 detects them from its faces")
        ->check(CLI::Range(0, 65535));
    job.add_option("--order", options->order, "Vertex order of a Cinema 4D OBJ")
        ->check(CLI::IsMember({"auto", "interleaved", "edges", "around"}));
    job.add_option("--particle", options->particle, "Position of the particles within a Cinema 4D ribbon")
        ->check(CLI::IsMember({"edge", "centre"}));
    auto* record = job.add_option("--record", options->record,
                                  "Also store animated strands (Alembic, USD) as a record of frames");
    job.add_option("--fps", options->framesPerSecond,
                   "Frames per second of the record. 0 uses those of the file")
        ->check(CLI::Range(0.0, 1000.0))
        ->needs(record);
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}, {options->record, content::kFrames}},
                           [&] { return import(*options); });
    };
}

}  // namespace

Job importJob() {
    return {"import", "Import strands from another program. The format is detected from the content",
            "hair.tfx --mesh head.obj -o hair.hairloom", declare};
}

}  // namespace hairloom::cli
