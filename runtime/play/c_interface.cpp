// SPDX-License-Identifier: MIT
// hairloom.h: instances and crowds. Hands over to Instance, and lets nothing be thrown across.
#include <limits>
#include <memory>

#include "follow/follow_kernels.h"
#include "play/c_words.h"
#include "play/crowd.h"

// The plain names are macros that tell sizes: in parentheses they are the functions of older programs.
using namespace hairloom::runtime;

namespace {

Host hostOf(const hl_jobs* jobs) {
    Host host;
    if (!jobs || !jobs->parallel_for) return host;
    host.parallelFor = [lent = *jobs](std::size_t count, std::size_t grain, const Host::Body& body) {
        const auto call = [](void* context, std::size_t begin, std::size_t end) {
            (*static_cast<const Host::Body*>(context))(begin, end);
        };
        lent.parallel_for(lent.user, count, grain, call, const_cast<Host::Body*>(&body));
    };
    return host;
}

Host hostOf(const hl_host& given) {
    Host host = hostOf(given.jobs);
    if (given.log)
        host.log = [log = given.log, user = given.user](std::string_view words) {
            log(user, words.data(), words.size());
        };
    if (given.nanoseconds)
        host.nanoseconds = [clock = given.nanoseconds, user = given.user] { return clock(user); };
    return host;
}

hl_code makeInstance(const hl_asset* opened, uint32_t what, const Host& host, hl_instance** out,
                     hl_error* error) {
    if (what > (HL_HAIRS | HL_LEVELS))
        return nullRefused(error, "neither HL_GUIDES nor a sum of HL_HAIRS and HL_LEVELS");
    return withContent(opened, error, [&](const Asset& asset) {
        Instance::Result made = Instance::make(asset, (what & HL_HAIRS) != 0, (what & HL_LEVELS) != 0, host);
        if (!made.instance) return say(error, HL_DAMAGED, HL_NO_PLACE, made.error);
        *out = new hl_instance(std::move(*made.instance));
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code readPlain(hl_instance* instance, bool hairs, hl_out positions, hl_out tangents, hl_out radii,
                  hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] {
        hl_read read{};
        read.hairs = hairs ? 1 : 0;
        read.positions = positions;
        read.tangents = tangents;
        read.radii = radii;
        return say(error, instance->instance.read(read, false));
    });
}

}  // namespace

uint32_t hl_version(void) {
    return HL_VERSION;
}

hl_code hl_build_info(hl_build* out, hl_error* error) {
    if (!out) return nullRefused(error, "no place for what was built");
    if (const Outcome refused = checkSize<hl_build>("hl_build", out->size, sizeof(hl_build)))
        return say(error, refused);
    hl_build build{};
    build.size = out->size;
    build.version = HL_VERSION;
    build.lanes = static_cast<std::uint32_t>(followKernels().width);
    build.instruction_set = Engine::instructionSet();
#if defined(__VERSION__)
    build.compiler = __VERSION__;
#else
    build.compiler = "";
#endif
    build.fused = followKernels().fused ? 1 : 0;
#if defined(HAIRLOOM_IMPLEMENTATION)
    build.single_header = 1;
#endif
    giveBack(build, out, out->size);
    return say(error, HL_OK, HL_NO_PLACE, "");
}

void hl_allocator_init(hl_allocator* allocator) {
    if (!allocator) return;
    *allocator = {};
    allocator->size = sizeof(hl_allocator);
}

hl_code hl_set_allocator(const hl_allocator* given, hl_error* error) {
    return guarded(error, [&] {
        hl_allocator allocator{};
        if (given) {
            if (const Outcome refused = takeIn(given, "hl_allocator", sizeof(hl_allocator), allocator))
                return say(error, refused);
            if (!allocator.allocate || !allocator.release)
                return nullRefused(error, "an allocator that lacks allocate or release");
        }
        if (!lendMemory({allocator.user, allocator.allocate, allocator.release}))
            return nullRefused(error, "an allocator while there are instances with memory of the former");
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_make(const hl_asset* opened, uint32_t what, const hl_jobs* jobs, hl_instance** out,
                         hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the instance");
    return guarded(error, [&] { return makeInstance(opened, what, hostOf(jobs), out, error); });
}

void hl_host_init(hl_host* host) {
    if (!host) return;
    *host = {};
    host->size = sizeof(hl_host);
}

hl_code hl_instance_make_hosted(const hl_asset* opened, uint32_t what, const hl_host* given,
                                hl_instance** out, hl_error* error) {
    if (!opened || !given || !out)
        return nullRefused(error, "no asset, no host or no place for the instance");
    return guarded(error, [&] {
        hl_host host{};
        if (const Outcome refused = takeIn(given, "hl_host", sizeof(hl_host), host))
            return say(error, refused);
        return makeInstance(opened, what, hostOf(host), out, error);
    });
}

hl_code hl_instance_copy(const hl_instance* instance, hl_instance** out, hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for its copy");
    return guarded(error, [&] {
        *out = new hl_instance(*instance);
        (*out)->instance.beCopy();
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

void hl_instance_free(hl_instance* instance) {
    delete instance;
}

void hl_frame_init(hl_frame* frame) {
    if (!frame) return;
    *frame = {};
    frame->size = sizeof(hl_frame);
    frame->dt = 1.0f / 60.0f;
}

void hl_pose_init(hl_pose* pose) {
    if (!pose) return;
    *pose = {};
    pose->size = sizeof(hl_pose);
}

hl_code hl_instance_reset(hl_instance* instance, const hl_frame* frame, hl_error* error) {
    return withFrame(instance, frame, error,
                     [](Instance& hair, const hl_frame& known) { return hair.reset(known); });
}

hl_code hl_instance_step(hl_instance* instance, const hl_frame* frame, hl_error* error) {
    return withFrame(instance, frame, error,
                     [](Instance& hair, const hl_frame& known) { return hair.step(known); });
}

void hl_play_init(hl_play* play) {
    if (!play) return;
    *play = {sizeof(hl_play), 0, 1, HL_LOOP_AS_AUTHORED};
}

hl_code hl_instance_play(hl_instance* instance, const hl_asset* asset, const hl_frame* frame,
                         const hl_play* given, hl_error* error) {
    if (!asset || !given) return nullRefused(error, "no asset or nothing to play");
    return withFrame(instance, frame, error, [&](Instance& hair, const hl_frame& known) -> Outcome {
        hl_play how{};
        if (Outcome refused = takeIn(given, "hl_play", kFirstPlay, how)) return refused;
        return hair.play(assetOf(asset), known, how);
    });
}

hl_code hl_instance_set(hl_instance* instance, const char* name, const double* values, size_t count,
                        hl_error* error) {
    if (!instance || !name || (!values && count > 0))
        return nullRefused(error, "no instance, name or values");
    return guarded(error, [&] { return say(error, instance->instance.set(name, {values, count})); });
}

hl_code hl_instance_choose(hl_instance* instance, const char* name, const char* choice, hl_error* error) {
    if (!instance || !name || !choice) return nullRefused(error, "no instance, name or choice");
    return guarded(error, [&] { return say(error, instance->instance.choose(name, choice)); });
}

hl_code hl_instance_set_pose(hl_instance* instance, uint32_t pose, float amount, hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] { return say(error, instance->instance.setPose(pose, amount)); });
}

hl_code hl_instance_pose(const hl_instance* instance, uint32_t pose, float* amount, hl_error* error) {
    if (!instance || !amount) return nullRefused(error, "no instance or no place for the amount");
    return guarded(error, [&] {
        if (const Outcome refused = instance->instance.checkPose(pose)) return say(error, refused);
        *amount = instance->instance.poseAmount(pose);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

void hl_reserve_init(hl_reserve* reserve) {
    if (!reserve) return;
    *reserve = {};
    reserve->size = sizeof(hl_reserve);
}

hl_code hl_instance_reserve(hl_instance* instance, const hl_reserve* given, hl_error* error) {
    if (!instance || !given) return nullRefused(error, "no instance or nothing to reserve");
    return guarded(error, [&] {
        hl_reserve wanted{};
        if (const Outcome refused = takeIn(given, "hl_reserve", kFirstReserve, wanted))
            return say(error, refused);
        return say(error, instance->instance.reserve(wanted));
    });
}

hl_code hl_instance_describe_sized(const hl_instance* instance, hl_instance_info* out, size_t size,
                                   hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for its description");
    if (const Outcome refused = checkSize<hl_instance_info>("hl_instance_info", size, kFirstInstanceInfo))
        return say(error, refused);
    return guarded(error, [&] {
        hl_instance_info info = instance->instance.describe();
        info.bytes += sizeof(hl_instance) - sizeof(Instance);
        giveBack(info, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code(hl_instance_describe)(const hl_instance* instance, hl_instance_info* info, hl_error* error) {
    return hl_instance_describe_sized(instance, info, kFirstInstanceInfo, error);
}

hl_code hl_instance_save(const hl_instance* instance, void* data, size_t bytes, size_t* written,
                         hl_error* error) {
    if (!instance || !written || (!data && bytes > 0))
        return nullRefused(error, "no instance or no place for it");
    return guarded(error, [&] {
        const Vector<std::byte> saved = instance->instance.save();
        *written = saved.size();
        if (!data) return say(error, HL_OK, HL_NO_PLACE, "");
        if (bytes < saved.size())
            return say(error, HL_WRONG_SIZE, HL_NO_PLACE,
                       "space for " + std::to_string(bytes) + " bytes of " + std::to_string(saved.size()));
        std::memcpy(data, saved.data(), saved.size());
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_load(hl_instance* instance, const void* data, size_t bytes, hl_error* error) {
    if (!instance || !data) return nullRefused(error, "no instance or no bytes");
    return guarded(error, [&] {
        return say(error, instance->instance.load({static_cast<const std::byte*>(data), bytes}));
    });
}

hl_code hl_instance_time(hl_instance* instance, uint64_t (*nanoseconds)(void* user), void* user,
                         hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] {
        std::function<std::uint64_t()> clock;
        if (nanoseconds) clock = [nanoseconds, user] { return nanoseconds(user); };
        instance->instance.setClock(clock);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_effect_sized(const hl_instance* instance, uint32_t effect, hl_effect* out, size_t size,
                                 hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for the effect");
    if (const Outcome refused = checkSize<hl_effect>("hl_effect", size, kFirstEffect))
        return say(error, refused);
    if (effect > kEffectCount) return nullRefused(error, "an effect that there is not");
    return guarded(error, [&] {
        giveBack(instance->instance.describeEffect(effect), out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code(hl_instance_effect)(const hl_instance* instance, uint32_t effect, hl_effect* out, hl_error* error) {
    return hl_instance_effect_sized(instance, effect, out, kFirstEffect, error);
}

hl_code hl_instance_offsets(const hl_instance* instance, uint32_t* offsets, size_t count, hl_error* error) {
    if (!instance || !offsets) return nullRefused(error, "no instance or no place for offsets");
    return guarded(error, [&] { return say(error, instance->instance.readOffsets({offsets, count})); });
}

uint64_t hl_instance_hash(const hl_instance* instance) {
    return instance ? instance->instance.hash() : 0;
}

hl_code hl_instance_read_guides(hl_instance* instance, hl_out positions, hl_out tangents, hl_out radii,
                                hl_error* error) {
    return readPlain(instance, false, positions, tangents, radii, error);
}

hl_code hl_instance_read_hairs(hl_instance* instance, hl_out positions, hl_out tangents, hl_out radii,
                               hl_error* error) {
    return readPlain(instance, true, positions, tangents, radii, error);
}

hl_code hl_instance_hair_numbers(const hl_instance* instance, uint32_t* numbers, size_t count,
                                 hl_error* error) {
    if (!instance || (!numbers && count > 0))
        return nullRefused(error, "no instance or no place for numbers");
    return guarded(error, [&] { return say(error, instance->instance.readHairNumbers({numbers, count})); });
}

void hl_read_init(hl_read* read) {
    if (!read) return;
    *read = {};
    read->size = sizeof(hl_read);
}

hl_code hl_instance_read(hl_instance* instance, hl_read* given, hl_error* error) {
    if (!instance || !given) return nullRefused(error, "no instance or nothing to read");
    return guarded(error, [&] {
        const std::size_t size = given->size;
        hl_read read{};
        if (const Outcome refused = takeIn(given, "hl_read", sizeof(hl_read), read))
            return say(error, refused);
        if (const Outcome refused = instance->instance.read(read)) return say(error, refused);
        read.size = size;
        giveBack(read, given, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_level_sized(const hl_instance* instance, uint32_t level, hl_level* out, size_t size,
                                hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for the level");
    if (const Outcome refused = checkSize<hl_level>("hl_level", size, kFirstLevel))
        return say(error, refused);
    if (!instance->instance.hasLevels()) return nullRefused(error, "the instance was made without HL_LEVELS");
    if (level >= HL_LEVEL_COUNT) return nullRefused(error, "a level that there is not");
    giveBack(instance->instance.describeLevel(level), out, size);
    return say(error, HL_OK, HL_NO_PLACE, "");
}

hl_code(hl_instance_level)(const hl_instance* instance, uint32_t level, hl_level* out, hl_error* error) {
    return hl_instance_level_sized(instance, level, out, kFirstLevel, error);
}

hl_code hl_instance_set_level(hl_instance* instance, uint32_t level, float hair_share, hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] { return say(error, instance->instance.setLevel(level, hair_share)); });
}

hl_code hl_rate(const hl_instance* instance, uint64_t (*nanoseconds)(void* user), void* user, float* speed,
                hl_error* error) {
    if (!instance || !nanoseconds || !speed) return nullRefused(error, "no instance, clock or place");
    return guarded(error, [&] {
        return say(error, instance->instance.measureSpeed([&] { return nanoseconds(user); }, *speed));
    });
}

void hl_crowd_limits_init(hl_crowd_limits* limits) {
    if (!limits) return;
    *limits = {sizeof(hl_crowd_limits), 2, 0.7f, std::numeric_limits<float>::infinity(), 1, 0, 0};
}

hl_code hl_crowd_plan_sized(const hl_crowd_limits* given, hl_viewed* characters, size_t viewed_size,
                            size_t count, hl_crowd_report* report, size_t report_size, hl_error* error) {
    if (!given || (!characters && count > 0)) return nullRefused(error, "no limits or no characters");
    return guarded(error, [&] {
        hl_crowd_limits limits{};
        hl_crowd_report made{};
        Outcome refused = takeIn(given, "hl_crowd_limits", kFirstLimits, limits);
        if (!refused) refused = checkSize<hl_viewed>("hl_viewed", viewed_size, kFirstViewed);
        if (!refused && viewed_size % alignof(hl_viewed) != 0)
            refused = Refusal{HL_WRONG_SIZE, "characters that are not at multiples of 8 bytes"};
        if (!refused && report)
            refused = checkSize<hl_crowd_report>("hl_crowd_report", report_size, kFirstReport);
        if (!refused) refused = planCrowd(limits, {characters, viewed_size, count}, made);
        if (!refused && report) giveBack(made, report, report_size);
        return say(error, refused);
    });
}

hl_code(hl_crowd_plan)(const hl_crowd_limits* limits, hl_viewed* characters, size_t count,
                       hl_crowd_report* report, hl_error* error) {
    return hl_crowd_plan_sized(limits, characters, kFirstViewed, count, report, kFirstReport, error);
}
