// SPDX-License-Identifier: MIT
// hairloom/gpu.h: what a game's own GPU is given to step guides, to make follow hairs and to draw them.
#include "hairloom/gpu.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numeric>

#include "follow/follow_gpu.h"
#include "play/c_words.h"
#include "play/frame_values.h"
#include "play/gpu_guides.h"
#include "play/gpu_shading.h"
#include "shaders/ribbon_types.h"

namespace hairloom::runtime {
namespace {

static_assert(sizeof(hl_gpu_view) == sizeof(shaders::RibbonView));
static_assert(offsetof(hl_gpu_view, points) == offsetof(shaders::RibbonView, points));
static_assert(HL_GPU_PASS_COUNT == 9 && HL_GPU_BUFFER_COUNT == 38);

constexpr std::uint64_t kRowsOfPoint = 4;  // FOLLOW_ROWS of follow.hlsli
constexpr std::uint64_t kMostGroups = 65535;

/// Counts that buffers are measured by.
struct GpuCounts {
    std::uint64_t guides, guidePoints, hairs, points;
    // Of the pass GUIDES.
    std::uint64_t blocks, longest, spheres;
    // Of those that shade.
    std::uint64_t materials = 0, tables = 0;

    std::uint64_t slots() const { return blocks * kBlockLanes; }
    std::uint64_t slotPoints() const { return slots() * longest; }
};
GpuCounts gpuCountsOf(const Asset& asset) {
    const Map<std::uint32_t, std::size_t> strandsOf = strandsByPoints(asset);
    std::size_t capsules = 0;
    for (const asset::Sphere& sphere : asset.spheres) capsules += sphere.joined > 0 ? 1 : 0;
    return {asset.strandCount(),
            asset.pointCount(),
            asset.hairCount(),
            asset.recipe[0].pointsPerHair,
            gpuBlocksOf(strandsOf),
            strandsOf.empty() ? 0 : strandsOf.rbegin()->first,
            gpuSpheresOf(asset.spheres.size(), capsules),
            asset.materialCount(),
            asset.fibreTables().size()};
}

struct GpuBuffer {
    const char* name;
    std::uint32_t element;
    std::uint64_t (*count)(const GpuCounts&);
    std::uint32_t fill;
};
#define HAIRLOOM_GPU_COUNT(name, formula)                            \
    std::uint64_t count##name([[maybe_unused]] const GpuCounts& c) { \
        return formula;                                              \
    }
HAIRLOOM_GPU_COUNT(ONE, 1)
HAIRLOOM_GPU_COUNT(GUIDES, c.guides)
HAIRLOOM_GPU_COUNT(GUIDE_TURNS, 2 * c.guides)
HAIRLOOM_GPU_COUNT(GUIDE_POINTS, c.guidePoints)
HAIRLOOM_GPU_COUNT(GUIDE_SAMPLES, c.guides* c.points)
HAIRLOOM_GPU_COUNT(GUIDE_ROWS, kRowsOfPoint* c.guides* c.points)
HAIRLOOM_GPU_COUNT(HAIR_SAMPLES, c.points)
HAIRLOOM_GPU_COUNT(HAIRS, c.hairs)
HAIRLOOM_GPU_COUNT(HAIR_POINTS, c.hairs* c.points)
HAIRLOOM_GPU_COUNT(WORDS, 4)
HAIRLOOM_GPU_COUNT(SPHERES, c.spheres)
HAIRLOOM_GPU_COUNT(SPHERE_ENDS, kWakingOfSphere* c.spheres)
HAIRLOOM_GPU_COUNT(BLOCKS, c.blocks)
HAIRLOOM_GPU_COUNT(BLOCK_RESTS, kRestFloats* c.blocks)
HAIRLOOM_GPU_COUNT(SLOTS, c.slots())
HAIRLOOM_GPU_COUNT(SLOT_TURNS, 2 * c.slots())
HAIRLOOM_GPU_COUNT(SLOT_ROOTS, kRootRows* c.slots())
HAIRLOOM_GPU_COUNT(SLOT_POINTS, c.slotPoints())
HAIRLOOM_GPU_COUNT(SLOT_RESTS, 4 * c.slotPoints())
HAIRLOOM_GPU_COUNT(SLOT_STATE, (kStatePlanes + 1) * c.slotPoints())
HAIRLOOM_GPU_COUNT(SLOT_RODS, kRodStatePlanes* c.slotPoints() + kRodLaneRows * c.slots())
HAIRLOOM_GPU_COUNT(MATERIALS, c.materials)
HAIRLOOM_GPU_COUNT(TABLE_FLOATS, std::max<std::uint64_t>(c.tables, 1))
HAIRLOOM_GPU_COUNT(LAMP_CELLS, kLampCells)
HAIRLOOM_GPU_COUNT(SLOT_SCRATCH, (HAIRLOOM_ROD_WORK_PLANES + HAIRLOOM_ROD_CONTACT_PLANES) * c.slotPoints())
#undef HAIRLOOM_GPU_COUNT

#define HAIRLOOM_GPU_ROW(name, bytes, of, fill, words) {#name, bytes, count##of, HL_GPU_##fill},
constexpr GpuBuffer kGpuBuffers[] = {HL_GPU_BUFFERS(HAIRLOOM_GPU_ROW)};
#undef HAIRLOOM_GPU_ROW

struct GpuPass {
    const char* file;
    std::uint32_t kind;
    std::uint64_t threads;
};
#define HAIRLOOM_GPU_ROW(name, file, kind, threads, words) {file, HL_GPU_##kind, threads},
constexpr GpuPass kGpuPasses[] = {HL_GPU_PASSES(HAIRLOOM_GPU_ROW)};
#undef HAIRLOOM_GPU_ROW

template <class Value>
void writeGpu(void*& at, const Value& value) {
    std::memcpy(at, &value, sizeof value);
    at = static_cast<std::byte*>(at) + sizeof value;
}

/// Least share that leaves hair `rank` of a guide with `all` of them, as takenOf() rounds it.
float leastShare(std::uint32_t rank, std::uint32_t all) {
    if (rank == 0) return 0;
    float share = static_cast<float>(rank) / static_cast<float>(all);
    // Within two steps of the quotient.
    for (int step = 0; step < 2; ++step) share = std::nextafter(share, 0.0f);
    while (takenOf(all, share) <= rank) share = std::nextafter(share, 2.0f);
    return share;
}

/// Hairs in a GPU's order: whatever share is left, it is the first of them.
Vector<std::uint32_t> gpuOrder(const Asset& asset) {
    Vector<std::uint32_t> order(asset.hairCount());
    std::iota(order.begin(), order.end(), 0u);
    Vector<float> shares;
    shares.reserve(order.size());
    for (std::size_t guide = 0; guide < asset.guides.size(); ++guide) {
        const std::uint32_t all = asset.hairsOf(guide);
        for (std::uint32_t rank = 0; rank < all; ++rank) shares.push_back(leastShare(rank, all));
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return shares[a] != shares[b] ? shares[a] < shares[b] : a < b;
    });
    return order;
}

hl_code fillLooks(const hl_asset* asset, std::span<const std::uint32_t> order, void* out, hl_error* error) {
    Vector<hl_hair> hairs(order.size());
    if (const hl_code code = hl_asset_hairs(asset, hairs.data(), sizeof(hl_hair), hairs.size(), error))
        return code;
    for (const std::uint32_t number : order) {
        const hl_hair& hair = hairs[number];
        writeGpu(out, shaders::RibbonLook{{hair.colour[0], hair.colour[1], hair.colour[2], hair.random},
                                          {hair.root_radius, hair.tip_radius, 0, 0}});
    }
    return HL_OK;
}

hl_code fillOnce(const hl_asset* opened, const Asset& asset, std::uint32_t buffer, void* out,
                 hl_error* error) {
    if (buffer == HL_GPU_BUFFER_LOOKS) return fillLooks(opened, gpuOrder(asset), out, error);
    if (buffer == HL_GPU_BUFFER_NUMBERS) {
        for (const std::uint32_t hair : gpuOrder(asset)) writeGpu(out, hair);
        return HL_OK;
    }
    if (fillsShading(buffer)) {
        const Vector<std::uint32_t> order =
            buffer == HL_GPU_BUFFER_SHADES ? gpuOrder(asset) : Vector<std::uint32_t>();
        fillShading(asset, buffer, order, out);
        return HL_OK;
    }
    const Asset::Strands rest = asset.strandsAtRest();
    const Asset::FollowArrays arrays = asset.followArrays(rest);
    const FollowView view = asset.followView(rest, arrays);
    if (buffer == HL_GPU_BUFFER_PLANES) {
        for (const RootPlane& plane : view.rootPlanes_ss) writeGpu(out, followPlane(plane));
    } else if (buffer == HL_GPU_BUFFER_SAMPLES) {
        for (const auto& sample : followSamples(view)) writeGpu(out, sample);
    } else if (buffer == HL_GPU_BUFFER_RADII) {
        for (const float radius : view.radii) writeGpu(out, radius);
    } else {
        for (const std::uint32_t hair : gpuOrder(asset)) writeGpu(out, followBinding(view, hair));
    }
    return HL_OK;
}

/// Of a sound asset that has follow hairs.
template <class Body>
hl_code withHairs(const hl_asset* opened, hl_error* error, const Body& body) {
    return withContent(opened, error, [&](const Asset& asset) {
        if (asset.hairCount() == 0) return nullRefused(error, "an asset without follow hairs");
        return body(asset, gpuCountsOf(asset));
    });
}

Outcome checkGpuBytes(std::uint32_t buffer, std::uint64_t given, std::uint64_t wanted) {
    if (given == wanted) return std::nullopt;
    return Refusal{HL_WRONG_SIZE, std::to_string(given) + " bytes of buffer " + kGpuBuffers[buffer].name +
                                      "; expected " + std::to_string(wanted)};
}

bool isOfFrame(std::uint32_t fill) {
    return fill == HL_GPU_FRAME || fill == HL_GPU_GUIDES || fill == HL_GPU_BEGIN || fill == HL_GPU_STEP;
}

Outcome checkGpuFill(std::uint32_t buffer, bool (*fills)(std::uint32_t), const char* call) {
    if (buffer < HL_GPU_BUFFER_COUNT && fills(kGpuBuffers[buffer].fill)) return std::nullopt;
    return Refusal{HL_BAD_VALUE, "buffer " +
                                     (buffer < HL_GPU_BUFFER_COUNT ? std::string(kGpuBuffers[buffer].name)
                                                                   : std::to_string(buffer)) +
                                     " is none of those that " + call + " fills"};
}

}  // namespace

std::size_t Instance::gpuBytes(std::uint32_t buffer) const {
    // What a frame has is measured by guides alone.
    const GpuCounts counts{roots_.size(),
                           positions_.size(),
                           0,
                           0,
                           gpuBlocks_,
                           gpuLongest_,
                           gpuSpheresOf(restSpheres_.size(), restCapsules_.size())};
    return static_cast<std::size_t>(kGpuBuffers[buffer].count(counts)) * kGpuBuffers[buffer].element;
}

namespace {

Refusal refusedPoses() {
    return {HL_BAD_VALUE, "hair follows poses, and the kernel of guides follows none: step on the CPU"};
}

}  // namespace

Outcome Instance::beginGpu() {
    if (level() != HL_LEVEL_FINEST)
        return Refusal{HL_BAD_VALUE, "level " + std::to_string(level()) + "; the GPU steps the finest alone"};
    if (std::string why = gpuGuidesRefused(engine_.settings()); !why.empty())
        return Refusal{HL_BAD_VALUE, std::move(why)};
    if (isPosed()) return refusedPoses();
    settlePlayed();
    // What there was stays where memory is missing.
    GpuGuides guides(engine_.restShape(), engine_.settings(), engine_.state(),
                     gpuSpheresOf(restSpheres_.size(), restCapsules_.size()));
    gpuGuides_ = std::move(guides);
    return std::nullopt;
}

Outcome Instance::stepGpu(const hl_frame& frame) {
    if (!gpuGuides_) return Refusal{HL_BAD_VALUE, "hl_gpu_begin() comes before the first hl_gpu_step()"};
    if (isPosed()) return refusedPoses();
    if (frame.dt == 0) return std::nullopt;
    if (Outcome refused = checkStep(frame)) return refused;
    // A capsule has both of its ends to itself.
    const std::size_t capsules =
        frame.spheres && frame.capsules ? std::min(frame.capsule_count, kMaxCapsules) : 0;
    std::size_t spheres = frame.sphere_count + 2 * capsules;
    std::bitset<kMaxGivenSpheres> isEnd;
    for (std::size_t c = 0; c < 2 * capsules; ++c) {
        if (frame.capsules[c] < std::min(frame.sphere_count, isEnd.size())) isEnd.set(frame.capsules[c]);
    }
    spheres -= isEnd.count();
    if (frame.spheres && spheres > gpuGuides_->mostSpheres())
        return Refusal{HL_WRONG_SIZE, std::to_string(spheres) + " spheres" +
                                          (capsules > 0 ? " with the ends of each capsule" : "") +
                                          "; expected at most " + std::to_string(gpuGuides_->mostSpheres())};
    if (Outcome refused = checkInner(frame)) return refused;
    FrameInput input;
    if (Outcome refused = place(withoutInner(frame), input)) return refused;
    takeTurns();
    played_ = false;
    if (frame.inner_count > 0 && host_.log && !saidInnerOnGpu_) {
        host_.log("hl_gpu_step goes straight to the end of each frame: poses inside are left out");
        saidInnerOnGpu_ = true;
    }
    gpuGuides_->take(input);
    takeOrigin(frame);
    asleep_ = last_.known = false;
    return std::nullopt;
}

/// What the pass GUIDES asks for in vain.
Outcome Instance::checkGpuGuides(std::uint32_t buffer) const {
    const std::uint32_t fill = kGpuBuffers[buffer].fill;
    const char* why = nullptr;
    if (fill == HL_GPU_BEGIN && !(gpuGuides_ && gpuGuides_->atBegin()))
        why = " is filled between hl_gpu_begin() and hl_gpu_step()";
    if (fill == HL_GPU_STEP && !(gpuGuides_ && gpuGuides_->hasFrame()))
        why = " is filled after hl_gpu_step()";
    if (fill == HL_GPU_GUIDES && gpuGuides_ && !gpuGuides_->atBegin()) why = " is what the pass GUIDES makes";
    if (!why) return std::nullopt;
    return Refusal{HL_BAD_VALUE, std::string("buffer ") + kGpuBuffers[buffer].name + why};
}

void Instance::fillGpu(std::uint32_t buffer, void* out) {
    const std::uint32_t fill = kGpuBuffers[buffer].fill;
    if (fill == HL_GPU_BEGIN || fill == HL_GPU_STEP) {
        gpuGuides_->fill(buffer, {static_cast<std::byte*>(out), gpuBytes(buffer)});
    } else if (buffer == HL_GPU_BUFFER_CONSTANTS) {
        writeGpu(out, shaders::FollowConstants{static_cast<std::uint32_t>(roots_.size()), gpuHairsShown(),
                                               gpuPoints_, gpuWisps_.spread, 1, gpuWisps_.limit, 0, 0});
    } else if (buffer == HL_GPU_BUFFER_TURNS) {
        const bool onGpu = gpuGuides_ && !gpuGuides_->atBegin();
        if (!onGpu) showPositions();
        for (std::size_t s = 0; s < turns_.size(); ++s) {
            Quat turn = turns_[s];
            if (!normalize(turn)) turn = {};
            const Float3 root = onGpu ? gpuGuides_->roots()[s].position : positions_[offsets_[s]];
            writeGpu(out, shaders::float4{root.x, root.y, root.z, 1});
            writeGpu(out, shaders::float4{turn.x, turn.y, turn.z, turn.w});
        }
    } else if (buffer == HL_GPU_BUFFER_POSITIONS) {
        showPositions();
        for (const Float3& at : positions_) writeGpu(out, shaders::float4{at.x, at.y, at.z, 1});
    } else {
        velocities_.resize(positions_.size());
        showVelocities();
        for (const Float3& v : velocities_) writeGpu(out, shaders::float4{v.x, v.y, v.z, 0});
    }
}

}  // namespace hairloom::runtime

using namespace hairloom::runtime;

hl_code hl_gpu_buffer(const hl_asset* asset, uint32_t buffer, hl_gpu_buffer_info* out, hl_error* error) {
    if (!asset || !out) return nullRefused(error, "no asset or no place for the buffer");
    if (const Outcome refused =
            checkSize<hl_gpu_buffer_info>("hl_gpu_buffer_info", out->size, sizeof(hl_gpu_buffer_info)))
        return say(error, refused);
    if (buffer >= HL_GPU_BUFFER_COUNT) return pastTheLast(error, "buffer", buffer, HL_GPU_BUFFER_COUNT);
    return withHairs(asset, error, [&](const Asset&, const GpuCounts& counts) {
        const GpuBuffer& known = kGpuBuffers[buffer];
        const hl_gpu_buffer_info info{out->size, known.name,
                                      static_cast<std::size_t>(known.count(counts)) * known.element,
                                      known.element, known.fill};
        giveBack(info, out, out->size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_gpu_fill(const hl_asset* opened, uint32_t buffer, void* data, size_t bytes, hl_error* error) {
    if (!opened || !data) return nullRefused(error, "no asset or no place for its numbers");
    if (const Outcome refused = checkGpuFill(
            buffer, [](std::uint32_t fill) { return fill == HL_GPU_ONCE; }, "hl_gpu_fill"))
        return say(error, refused);
    return withHairs(opened, error, [&](const Asset& asset, const GpuCounts& counts) {
        const std::uint64_t wanted = kGpuBuffers[buffer].count(counts) * kGpuBuffers[buffer].element;
        if (const Outcome refused = checkGpuBytes(buffer, bytes, wanted)) return say(error, refused);
        if (const hl_code code = fillOnce(opened, asset, buffer, data, error)) return code;
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_gpu_fill_frame(hl_instance* instance, uint32_t buffer, void* data, size_t bytes, hl_error* error) {
    if (!instance || !data) return nullRefused(error, "no instance or no place for its numbers");
    return guarded(error, [&] {
        if (!instance->instance.hasGpuHairs()) return nullRefused(error, "an asset without follow hairs");
        if (const Outcome refused = checkGpuFill(buffer, isOfFrame, "hl_gpu_fill_frame"))
            return say(error, refused);
        if (const Outcome refused = checkGpuBytes(buffer, bytes, instance->instance.gpuBytes(buffer)))
            return say(error, refused);
        if (const Outcome refused = instance->instance.checkGpuGuides(buffer)) return say(error, refused);
        instance->instance.fillGpu(buffer, data);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_gpu_begin(hl_instance* instance, hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] {
        if (!instance->instance.hasGpuHairs()) return nullRefused(error, "an asset without follow hairs");
        return say(error, instance->instance.beginGpu());
    });
}

hl_code hl_gpu_step(hl_instance* instance, const hl_frame* frame, hl_error* error) {
    return withFrame(instance, frame, error,
                     [](Instance& hair, const hl_frame& known) { return hair.stepGpu(known); });
}

namespace hairloom::runtime {
namespace {

/// Threads and groups of a pass by what it works on.
hl_code sayGpuPass(std::uint32_t pass, const GpuCounts& counts, hl_gpu_pass_info* out, hl_error* error) {
    hl_gpu_pass_info info{out->size, kGpuPasses[pass].file, kGpuPasses[pass].kind, {0, 0, 0}, 0, 0};
    if (info.kind == HL_GPU_DRAW) {
        info.vertices = static_cast<std::uint32_t>(2 * counts.points);
        info.instances = static_cast<std::uint32_t>(counts.hairs);
    } else {
        const std::uint64_t threads = pass == HL_GPU_PASS_GUIDES     ? counts.slots()
                                      : pass == HL_GPU_PASS_WISPS    ? counts.guides
                                      : pass == HL_GPU_PASS_LAMP_SUM ? kLampColumns
                                                                     : counts.hairs * counts.points;
        const std::uint64_t groups = (threads + kGpuPasses[pass].threads - 1) / kGpuPasses[pass].threads;
        info.groups[0] = static_cast<std::uint32_t>(std::min(groups, kMostGroups));
        info.groups[1] = static_cast<std::uint32_t>((groups + kMostGroups - 1) / kMostGroups);
        info.groups[2] = 1;
    }
    giveBack(info, out, out->size);
    return say(error, HL_OK, HL_NO_PLACE, "");
}

/// Of a pass that there is, into a struct of a size that there was.
hl_code checkGpuPass(std::uint32_t pass, const hl_gpu_pass_info& out, hl_error* error) {
    if (const Outcome refused =
            checkSize<hl_gpu_pass_info>("hl_gpu_pass_info", out.size, sizeof(hl_gpu_pass_info)))
        return say(error, refused);
    return pass < HL_GPU_PASS_COUNT ? HL_OK : pastTheLast(error, "pass", pass, HL_GPU_PASS_COUNT);
}

}  // namespace
}  // namespace hairloom::runtime

hl_code hl_gpu_pass(const hl_asset* asset, uint32_t pass, hl_gpu_pass_info* out, hl_error* error) {
    if (!asset || !out) return nullRefused(error, "no asset or no place for the pass");
    if (const hl_code code = checkGpuPass(pass, *out, error)) return code;
    return withHairs(asset, error, [&](const Asset&, const GpuCounts& counts) {
        return sayGpuPass(pass, counts, out, error);
    });
}

hl_code hl_gpu_frame_pass(const hl_instance* instance, uint32_t pass, hl_gpu_pass_info* out,
                          hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for the pass");
    return guarded(error, [&] {
        if (const hl_code code = checkGpuPass(pass, *out, error)) return code;
        if (!instance->instance.hasGpuHairs()) return nullRefused(error, "an asset without follow hairs");
        const Instance& hair = instance->instance;
        // What takes time to count is of one pass alone.
        constexpr auto kBlocks = HL_GPU_BUFFER_BLOCKS;
        const std::size_t blocks =
            pass == HL_GPU_PASS_GUIDES ? hair.gpuBytes(kBlocks) / kGpuBuffers[kBlocks].element : 0;
        const std::uint32_t guides = pass == HL_GPU_PASS_WISPS ? hair.describe().guides : 0;
        const GpuCounts counts{guides, 0, hair.gpuHairsShown(), hair.gpuPointsOfHair(), blocks, 0, 0};
        return sayGpuPass(pass, counts, out, error);
    });
}

hl_code hl_gpu_view_init_sized(const hl_asset* asset, hl_gpu_view* view, size_t size, hl_error* error) {
    if (!asset || !view) return nullRefused(error, "no asset or no view");
    if (const Outcome refused = checkSize<hl_gpu_view>("hl_gpu_view", size, kFirstView))
        return say(error, refused);
    return withHairs(asset, error, [&](const Asset&, const GpuCounts& counts) {
        const hl_gpu_view made{{},
                               {},
                               {0.5f, 0.70710678f, 0.5f, 40},
                               {1, 1, 1, 0.15f},
                               {0.25f, 0.25f, 0.25f, 0},
                               0,
                               1,
                               static_cast<std::uint32_t>(counts.points),
                               static_cast<std::uint32_t>(counts.hairs)};
        giveBack(made, view, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_gpu_frame_view_sized(const hl_instance* instance, hl_gpu_view* view, size_t size,
                                hl_error* error) {
    if (!instance || !view) return nullRefused(error, "no instance or no view");
    if (const Outcome refused = checkSize<hl_gpu_view>("hl_gpu_view", size, kFirstView))
        return say(error, refused);
    return guarded(error, [&] {
        const Instance& hair = instance->instance;
        if (!hair.hasGpuHairs()) return nullRefused(error, "an asset without follow hairs");
        view->hairs = hair.gpuHairsShown();
        view->specular[3] = static_cast<float>(hair.gpuHairs()) / static_cast<float>(view->hairs);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}
