// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/head_options.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/sphere_report.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/log.h"
#include "core/base/stopwatch.h"
#include "core/documents/head_import.h"
#include "core/documents/mask_image.h"
#include "core/editing/document.h"
#include "core/editing/sphere_parts.h"
#include "core/editing/stack_commands.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/groom/file/project_file.h"
#include "core/groom/groom.h"
#include "core/operations/curl_class.h"
#include "importers/mesh_format.h"
#include "importers/scene.h"

namespace hairloom::cli {
namespace {

struct CreateOptions {
    std::string mesh;
    std::string scalp = "all";
    std::size_t count = 0;
    double density = 0;
    std::string placement = "poissonDisk";
    float length = 0.15f;
    std::optional<std::uint32_t> points;
    std::string curl;
    std::uint64_t seed = 0;
    HeadOptions head;
    std::string scalpMesh;
    std::vector<std::string> collideWith;
    std::uint32_t colliderSpheres = HeadImportOptions().colliderSpheres;
    std::string mask;
    std::string output;
};

/// As many as its curls need, where none are given.
std::uint32_t pointsOf(const CreateOptions& options) {
    const CurlClass* const curl = findCurlClass(options.curl);
    const std::uint32_t needed = curl ? pointsForCurl(*curl, options.length) : 0;
    return options.points.value_or(std::max(PlacementSettings().points, needed));
}

/// The settings as a project keeps them, so that an editor goes on from them.
PlacementSettings settingsOf(const CreateOptions& options, std::size_t placed) {
    PlacementSettings settings;
    settings.placement =
        options.placement == "random" ? PlacementMethod::random : PlacementMethod::poissonDisk;
    settings.count = static_cast<std::uint32_t>(placed);
    settings.densityPerCm2 = static_cast<float>(options.density);
    settings.length = options.length;
    settings.points = pointsOf(options);
    settings.seed = options.seed;
    return settings;
}

Result<Placement> place(const ScalpMesh& mesh, const FaceSet& faces, const CreateOptions& options,
                        std::span<const float> mask) {
    PlacementRequest request;
    request.count = options.count;
    request.densityPerCm2 = options.density;
    request.seed = options.seed;
    request.mask = mask;
    return options.placement == "random" ? placeRandom(mesh, faces, request)
                                         : placeDarts(mesh, faces, request);
}

/// Faces of the head that carry hair.
Result<FaceSet> scalpOf(const ScalpMesh& mesh, const CreateOptions& options, const HeadImportOptions& taken) {
    auto faces = selectFaces(mesh, options.scalp);
    if (!faces) return tl::unexpected(inFile(faces.error(), options.mesh));
    if (options.scalpMesh.empty()) return faces;
    HeadImportOptions likewise = taken;
    likewise.leaveOut.clear();
    likewise.collideWith.clear();
    likewise.guessUnit = likewise.guessUp = false;
    const auto scalp = importHead(options.scalpMesh, likewise);
    if (!scalp) return tl::unexpected(scalp.error());
    auto onIt = facesOnSurface(mesh, *faces, scalp->scene.mesh);
    if (!onIt) return tl::unexpected(inFile(onIt.error(), options.scalpMesh));
    return onIt;
}

bool isPng(const std::string& path) {
    return contentKind(readBeginning(path, kContentKindBytes)) == content::kPng;
}
Result<std::vector<float>> imageMask(const std::string& path, const ScalpMesh& mesh) {
    const auto image = MaskImage::read(path);
    if (!image) return tl::unexpected(image.error());
    auto values = valuesAtVertices(*image, mesh);
    if (!values) return tl::unexpected(inFile(values.error(), path));
    return values;
}

Result<Report> create(const CreateOptions& options) {
    const Stopwatch watch;
    orWrongUsage(checkSelection(options.scalp));
    HeadImportOptions wanted = headImportOptions(options.head);
    wanted.collideWith = options.collideWith;
    wanted.colliderSpheres = options.colliderSpheres;
    auto head = importHead(options.mesh, wanted);
    if (!head) return tl::unexpected(head.error());
    const auto mesh = std::make_shared<const ScalpMesh>(std::move(head->scene.mesh));
    auto faces = scalpOf(*mesh, options, head->taken);
    if (!faces) return tl::unexpected(faces.error());
    const double areaCm2 = selectionArea(*mesh, *faces) * 1e4;
    std::vector<float> mask;
    if (!options.mask.empty()) {
        auto read =
            isPng(options.mask) ? imageMask(options.mask, *mesh) : readVertexMask(options.mask, *mesh);
        if (!read) return tl::unexpected(read.error());
        mask = std::move(*read);
    }
    const double maskedM2 = maskedArea(*mesh, *faces, mask);
    const auto placement = place(*mesh, *faces, options, mask);
    if (!placement) return tl::unexpected(placement.error());
    auto groom = growStraight(mesh, std::move(*faces), placement->roots, options.length, pointsOf(options));
    if (!groom) return tl::unexpected(groom.error());
    groom->scalpExpression = options.scalp;
    groom->spheres = head->colliders.spheres;
    // Skeleton and clips fit no head that was turned.
    if (!head->taken.isTurned()) groom->characterFile = options.mesh;
    groom->characterMetresPerUnit = head->taken.metresPerUnit;
    groom->interpolation.seed = options.seed;
    groom->placement = settingsOf(options, placement->roots.size());
    groom->scalpDensity = std::move(mask);
    if (const CurlClass* curl = findCurlClass(options.curl)) {
        editing::Document document(std::move(*groom));
        auto curled = editing::setOperators(document.model(), operatorsOf(*curl), "Curl");
        if (!curled) return tl::unexpected(curled.error());
        if (*curled) document.perform(std::move(*curled));
        *groom = document.groom();
    }
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());

    Report report;
    report["strands"] = groom->strandCount();
    report["points"] = groom->pointCount();
    report["scalp_area_cm2"] = areaCm2;
    const double apart = minimumRootDistance(*mesh, placement->roots);
    report["min_root_distance"] = finiteOrNull(apart);
    report["relative_radius"] = relativeRadius(apart, placement->roots.size(), maskedM2);
    report["triangles"] = groom->triangulation.triangles.size();
    report["alone"] = groom->triangulation.alone.size();
    report["spheres"] = groom->spheres.size();
    if (!groom->spheres.empty()) addFit(report, head->colliders);
    report["repairs"] = Report::array();
    for (const MeshRepair& repair : mesh->repairs()) {
        report["repairs"].push_back(Report{{"what", repair.what}, {"count", repair.count}});
    }
    report["head"] = headReport(head->taken, head->words);
    report["seconds"] = watch.seconds();
    report["output"] = options.output;
    return report;
}

std::string curlHelp() {
    std::string help = "Curl of the strands, by operators that stay in the stack.";
    for (const CurlClass& curl : curlClasses()) help += fmt::format(" {}: {}.", curl.name, curl.description);
    return help;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<CreateOptions>();
    job.add_option("--mesh", options->mesh, "Head mesh: " + labelsOf(meshFormats()))->required();
    job.add_option("--scalp", options->scalp,
                   "Faces where hair grows: all, group:NAME, material:NAME, cap:DEGREES, above:F, "
                   "faces:FILE, grow:N, shrink:N, invert, connected. A comma combines terms");
    auto* count =
        job.add_option("--count", options->count, "Number of roots")->check(CLI::Range(1, 10'000'000));
    auto* density =
        job.add_option("--density", options->density, "Roots per cm²")->check(CLI::PositiveNumber);
    count->excludes(density);
    job.add_option("--placement", options->placement,
                   "Placement of roots: random, or poissonDisk (evenly spaced by dart throwing; short: dart)")
        ->check(CLI::IsMember({"random", "poissonDisk", "dart"}));
    job.add_option("--mask", options->mask,
                   "Root density: a PNG at the UVs of the mesh, or a text file with a number in [0, 1] per "
                   "vertex of the mesh file");
    job.add_option("--length", options->length, "Strand length, metres")->check(CLI::Range(1e-4, 10.0));
    job.add_option("--points", options->points, "Points per strand (default: 16, or as many as --curl needs)")
        ->check(CLI::Range(2, 1024));
    job.add_option("--curl", options->curl, curlHelp())->check(CLI::IsMember(curlNames()));
    job.add_option("--seed", options->seed, "Random seed");
    addHeadOptions(job, options->head);
    job.add_option("--scalp-mesh", options->scalpMesh,
                   "Mesh of the scalp alone, in the unit and place of the head. Hair grows on the faces of "
                   "the head that are on it, among those of --scalp");
    auto* collide = job.add_option("--collide-with", options->collideWith,
                                   "Groups that are not part of the head but that hair collides with, "
                                   "through spheres fitted to them. NAME or PREFIX*, separated by commas")
                        ->delimiter(',');
    job.add_option("--collide-spheres", options->colliderSpheres,
                   "Number of these spheres, shared by area. Each group gets 1 to 64")
        ->check(CLI::Range(1u, editing::kMaxPartSpheres))
        ->needs(collide);
    job.add_option("-o,--output", options->output, "Project to write")->required();
    job.final_callback([count, density] {
        if (count->count() + density->count() == 0) throw CLI::RequiredError("--count or --density");
    });
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return create(*options); });
    };
}

}  // namespace

Job createJob() {
    return {"create", "Select a scalp on a head, place roots and grow straight strands",
            "--mesh head.obj --scalp group:scalp --count 3000 --length 0.2 -o hair.hairloom", declare};
}

}  // namespace hairloom::cli
