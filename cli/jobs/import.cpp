// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <memory>

#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/head_options.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/documents/hair_cleaning.h"
#include "core/documents/hair_import.h"
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
    HeadOptions head;
    std::string up = "y";
    std::string guides;
    bool clean = false;
    HairCleaning cleaning;
    std::uint32_t pointsPerStrand = 0;
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
    strands.isUnitAsked = !options.unit.empty();
    if (strands.isUnitAsked) strands.metresPerUnit = metresPerUnit(options.unit);
    strands.up = options.up == "z" ? UpAxis::Z : UpAxis::Y;
    strands.frames = !options.record.empty();
    strands.framesPerSecond = options.framesPerSecond;
    strands.pointsPerStrand = options.pointsPerStrand;
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
    const float rate = imported.framesPerSecond > 0  ? imported.framesPerSecond
                       : options.framesPerSecond > 0 ? options.framesPerSecond
                                                     : kUsualRate;
    auto recorder = FrameRecorder::open(options.record, imported.groom, rate);
    if (!recorder) return tl::unexpected(recorder.error());
    for (const auto& frame : imported.frames) {
        if (auto status = recorder->add(frame, {}); !status) return status;
    }
    return recorder->finish();
}

constexpr const char* orderName(RibbonOrder order) {
    constexpr const char* kNames[] = {"mixed", "interleaved", "edges", "around"};
    return kNames[static_cast<std::size_t>(order)];
}

Report ribbonReport(const RibbonsFound& found) {
    return Report{{"order", orderName(found.order)},
                  {"sides", found.sides},
                  {"fewest_sides", found.fewestSides},
                  {"segments", found.mostSegments},
                  {"fewest_segments", found.fewestSegments}};
}

Report cleanReport(const CleanedHair& cleaned) {
    return Report{{"repeated", cleaned.repeated}, {"short", cleaned.shorter},
                  {"outliers", cleaned.outliers}, {"loops", cleaned.loops},
                  {"broken", cleaned.broken},     {"turned", cleaned.turned},
                  {"snapped", cleaned.snapped},   {"farthest_snap_mm", 1e3f * cleaned.farthestSnap},
                  {"pushed_out", cleaned.pushed}};
}

/// The triangles between roots of hair that has just been bound.
void triangulate(const ImportOptions& options, Groom& groom) {
    auto triangulation = triangulateRoots(*groom.scalp, groom.scalpSelection, groom.rootBindings());
    if (!triangulation) {
        log::warning("{}: the roots were not triangulated: {}", options.file,
                     triangulation.error().message());
        return;
    }
    groom.triangulation = std::move(*triangulation);
    if (groom.triangulation.triangles.empty())
        log::warning("{}: no three roots form a triangle", options.file);
}

/// Guides of a file of their own, behind the hairs.
Status addGuides(const ImportOptions& options, const StrandImportOptions& strandsAs, Groom& groom,
                 Report& report) {
    StrandImportOptions still = strandsAs;
    still.frames = false;
    auto guides = importStrands(options.guides, still);
    if (!guides) return tl::unexpected(guides.error());
    logFindings(options.guides, guides->warnings);
    const std::size_t hairs = groom.strandCount();
    appendGuides(groom, guides->groom);
    report["strands"] = groom.strandCount();
    report["points"] = groom.pointCount();
    report["guides"] = groom.strandCount() - hairs;
    return {};
}

/// Whether hair lies on a head as the two were read.
bool liesOn(const ImportOptions& options, StrandImportOptions strandsAs, const ScalpMesh& mesh) {
    strandsAs.scalp = &mesh;
    strandsAs.frames = false;
    const auto imported = importStrands(options.file, strandsAs);
    return imported &&
           std::ranges::find(imported->warnings, "roots", &Finding::where) == imported->warnings.end();
}

/// Takes the head's Z axis for the one that is up where the hair lies on it so, and not as it is.
void layHeadToHair(const ImportOptions& options, const StrandImportOptions& strandsAs,
                   std::shared_ptr<const ScalpMesh>& mesh, HeadImportOptions& taken, Report& head) {
    if (liesOn(options, strandsAs, *mesh)) return;
    HeadImportOptions laid = taken;
    laid.zUp = true;
    laid.guessUnit = laid.guessUp = false;
    auto other = importHead(options.mesh, laid);
    if (!other || !liesOn(options, strandsAs, other->scene.mesh)) return;
    other->words.emplace_back(
        "has its Z axis taken as up, because the hair lies on it so. --mesh-up y leaves it as it is");
    log::warning("{}: {}", options.mesh, other->words.back());
    mesh = std::make_shared<const ScalpMesh>(std::move(other->scene.mesh));
    taken = other->taken;
    head = headReport(taken, other->words);
}

Result<Report> import(const ImportOptions& options) {
    orWrongUsage(checkSelection(options.scalp));
    StrandImportOptions strandsAs = strandOptions(options);
    std::shared_ptr<const ScalpMesh> mesh;
    FaceSet faces;
    HeadImportOptions taken;
    Report head;
    if (!options.mesh.empty()) {
        auto read = importHead(options.mesh, headImportOptions(options.head));
        if (!read) return tl::unexpected(read.error());
        taken = read->taken;
        mesh = std::make_shared<const ScalpMesh>(std::move(read->scene.mesh));
        head = headReport(taken, read->words);
        if (taken.guessUp && !taken.zUp && !read->scene.statesUp)
            layHeadToHair(options, strandsAs, mesh, taken, head);
        auto selected = selectFaces(*mesh, options.scalp);
        if (!selected) return tl::unexpected(inFile(selected.error(), options.mesh));
        faces = std::move(*selected);
        strandsAs.scalp = mesh.get();
    }
    auto imported = importStrands(options.file, strandsAs);
    if (!imported) return tl::unexpected(imported.error());
    checkOperators(options.file, *imported);
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
    report["layers"] = Report::array();
    for (const Layer& layer : groom.layers) report["layers"].push_back(layer.name);
    report["groups"] = groom.groupNames;
    if (imported->ribbons) report["ribbons"] = ribbonReport(*imported->ribbons);
    if (!options.guides.empty()) {
        if (auto added = addGuides(options, strandsAs, groom, report); !added)
            return tl::unexpected(added.error());
    }
    if (mesh && groom.strandCount() > 0) {
        report["head"] = std::move(head);
        report["root_distance"] = bindingReport(bindToScalp(groom, mesh, std::move(faces)));
        groom.scalpExpression = options.scalp;
        // Skeleton and clips fit no head that was turned.
        if (!taken.isTurned()) groom.characterFile = options.mesh;
        groom.characterMetresPerUnit = taken.metresPerUnit;
    }
    if (options.clean) {
        const auto cleaned = cleanHair(groom, options.cleaning);
        if (!cleaned) return tl::unexpected(inFile(cleaned.error(), options.file));
        report["cleaned"] = cleanReport(*cleaned);
        report["strands"] = groom.strandCount();
        report["points"] = groom.pointCount();
    }
    if (groom.scalp) triangulate(options, groom);
    report["resampled_fps"] = nullptr;
    if (!options.record.empty()) {
        if (auto recorded = recordFrames(options, *imported); !recorded)
            return tl::unexpected(recorded.error());
        report["record"] = options.record;
        report["frames"] = imported->frames.size();
        report["fps"] = imported->framesPerSecond;
        if (imported->isResampled) report["resampled_fps"] = imported->framesPerSecond;
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
    auto* mesh = job.add_option("--mesh", options->mesh, "Head mesh to bind the roots to");
    job.add_option("--scalp", options->scalp, "Faces of the mesh where hair grows, as for create");
    addUnitOption(job, options->unit);
    addHeadOptions(job, options->head, "mesh-");
    for (const char* ofMesh : {"--scalp", "--mesh-unit", "--mesh-up", "--turn", "--leave-out"})
        job.get_option(ofMesh)->needs(mesh);
    job.add_option("--up", options->up, "Up axis of the hair file")->check(CLI::IsMember({"y", "z"}));
    job.add_option("--segments", options->segments,
                   "Segments per strand of a Cinema 4D OBJ. 0 detects them from its faces, or from the "
                   "distances between its vertices if it has none")
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
    job.add_option("--points-per-strand", options->pointsPerStrand,
                   "Points per strand, for files that only have points. 0 detects them from the distances "
                   "between the points")
        ->check(CLI::Range(0, 65536));
    auto* guides = job.add_option(
        "--guides", options->guides,
        "File with guides of the same hair. They are added after its strands, which then follow them");
    auto* clean = job.add_flag("--clean", options->clean,
                               "Clean reconstructed hair: removes outliers, loops and jumps, reverses "
                               "strands, snaps roots to the scalp, keeps hair out of the head, resamples");
    clean->excludes(record);
    guides->excludes(record);
    job.add_option("--points", options->cleaning.points, "Points per strand after --clean")
        ->check(CLI::Range(2, 1024))
        ->needs(clean);
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}, {options->record, content::kFrames}},
                           [&] { return import(*options); });
    };
}

}  // namespace

Job importJob() {
    return {"import", "Import strands from another program, in any format that is recognised",
            "hair.tfx --mesh head.obj -o hair.hairloom", declare};
}

}  // namespace hairloom::cli
