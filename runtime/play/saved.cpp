// SPDX-License-Identifier: MIT
// What steps change of an instance, as bytes and back. The bytes are of one version of the library and one
// asset: a saved game, a rollback, a replay that begins in the middle.
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "engine/strand_model.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

constexpr std::uint32_t kSavedMagic = 0x53494c48;  // "HLIS"
constexpr std::uint32_t kSavedVersion = 6;
constexpr std::size_t kMostBodyBones = 255;

struct Head {
    std::uint32_t magic, version;
    std::uint64_t asset, bytes;
    std::uint32_t hasLevels, checksum;  ///< of all that follows
};

class Writer {
  public:
    template <class T>
    void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* const from = reinterpret_cast<const std::byte*>(&value);
        bytes.insert(bytes.end(), from, from + sizeof value);
    }
    template <class T>
    void all(std::span<const T> values) {
        value(std::uint64_t{values.size()});
        const auto of = std::as_bytes(values);
        bytes.insert(bytes.end(), of.begin(), of.end());
    }
    Vector<std::byte> bytes;
};

/// Stays at its end, with `good` false, where there is too little.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes) : left_(bytes) {}
    template <class T>
    T value() {
        T value{};
        take(&value, sizeof value);
        return value;
    }
    /// As many as there are said to be, which have to be `count`.
    template <class Values>
    void all(Values& values, std::size_t count) {
        using T = typename Values::value_type;
        if (value<std::uint64_t>() != count || count > left_.size() / sizeof(T)) {
            good = false;
            return;
        }
        values.resize(count);
        if (count > 0) take(values.data(), count * sizeof(T));
    }
    std::uint64_t peekCount() const {
        std::uint64_t count = 0;
        if (left_.size() >= sizeof count) std::memcpy(&count, left_.data(), sizeof count);
        return count;
    }
    bool atEnd() const { return left_.empty(); }
    bool good = true;

  private:
    void take(void* to, std::size_t size) {
        if (!good || size > left_.size()) {
            good = false;
            return;
        }
        std::memcpy(to, left_.data(), size);
        left_ = left_.subspan(size);
    }
    std::span<const std::byte> left_;
};

void writeState(Writer& writer, const State& state) {
    writer.all<float>(state.planes);
    writer.all<float>(state.roots);
    writer.value(static_cast<std::uint32_t>(state.model));
    for (const Floats& own : state.own) writer.all<float>(own);
    writer.value(std::uint64_t{state.rests.size()});
    for (const Rest& rest : state.rests) {
        writer.value(rest.time);
        writer.value(std::uint32_t{rest.asleep});
        writer.value(rest.stayed);
        writer.value(rest.anchors);
    }
    writer.all<Sphere>(state.spheres);
    writer.all<Capsule>(state.capsules);
    writer.all<BonePose>(state.body);
    writer.value(state.rootsMin_ws);
    writer.value(state.rootsMax_ws);
    writer.value(state.substep);
    writer.value(state.fastest);
    writer.value(std::uint32_t{state.origin_ws.has_value()});
    writer.value(state.origin_ws.value_or(std::array<double, 3>{}));
}

/// Of an engine whose state has the sizes of `like`.
State readState(Reader& reader, const State& like) {
    State state;
    reader.all(state.planes, like.planes.size());
    reader.all(state.roots, like.roots.size());
    state.model = like.model;
    if (reader.value<std::uint32_t>() != static_cast<std::uint32_t>(like.model)) reader.good = false;
    const std::size_t planeFloats = like.planes.size() / kStatePlanes;
    for (std::size_t i = 0; i < kOwnArrays; ++i) {
        const OwnArray& own = modelOf(like.model).own[i];
        const bool none = own.isOptional && reader.peekCount() == 0;
        reader.all(state.own[i], none ? 0 : own.floats(planeFloats, like.rests.size()));
    }
    if (reader.value<std::uint64_t>() != like.rests.size()) reader.good = false;
    for (std::size_t b = 0; b < like.rests.size() && reader.good; ++b) {
        Rest& rest = state.rests.emplace_back();
        rest.time = reader.value<float>();
        rest.asleep = reader.value<std::uint32_t>() != 0;
        rest.stayed = reader.value<float>();
        rest.anchors = reader.value<decltype(rest.anchors)>();
    }
    const std::uint64_t spheres = reader.peekCount();
    if (spheres > kMaxGivenSpheres) reader.good = false;
    reader.all(state.spheres, static_cast<std::size_t>(std::min<std::uint64_t>(spheres, kMaxGivenSpheres)));
    const std::uint64_t capsules = reader.peekCount();
    if (capsules > kMaxCapsules) reader.good = false;
    reader.all(state.capsules, static_cast<std::size_t>(std::min<std::uint64_t>(capsules, kMaxCapsules)));
    const std::uint64_t bones = reader.peekCount();
    if (bones > kMostBodyBones) reader.good = false;
    reader.all(state.body, static_cast<std::size_t>(std::min<std::uint64_t>(bones, kMostBodyBones)));
    state.rootsMin_ws = reader.value<Float3>();
    state.rootsMax_ws = reader.value<Float3>();
    state.substep = reader.value<float>();
    state.fastest = reader.value<float>();
    const bool hasOrigin = reader.value<std::uint32_t>() != 0;
    const auto origin = reader.value<std::array<double, 3>>();
    if (hasOrigin) state.origin_ws = origin;
    return state;
}

Refusal damaged(const char* words) {
    return {HL_DAMAGED, std::string("a saved instance that ") + words};
}

}  // namespace

Vector<std::byte> Instance::save() const {
    settlePlayed();
    Writer writer;
    writer.value(Head{});
    writer.value(origin_);
    writer.all<Quat>(turns_);
    // What is asked for, and what the last step had: a change wakes hair.
    writer.all<float>(hairPoses_.amounts);
    const Engine* const stepped = engineOfLevel();
    writer.all<float>(stepped ? stepped->poseAmounts() : std::span<const float>(hairPoses_.amounts));
    const std::uint32_t number = level();
    writer.value(number);
    if (levels_) {
        const Levels& levels = *levels_;
        writer.value(levels.share);
        writer.all<RootFrame>(levels.placed);
        writer.value(std::uint32_t{levels.origin.has_value()});
        writer.value(levels.origin.value_or(std::array<double, 3>{}));
        writer.value(levels.velocity);
        writer.value(levels.motion);
        writer.value(levels.wind);
        writer.value(std::uint32_t{levels.fading});
        writer.all<Float3>(levels.fade);
    }
    if (const Engine* const engine = engineOfLevel()) writeState(writer, *engine->state());
    const std::span<const std::byte> content = std::span(writer.bytes).subspan(sizeof(Head));
    const Head head{kSavedMagic,         kSavedVersion,     asset_,
                    writer.bytes.size(), levels_ ? 1u : 0u, asset::checksum(content)};
    std::memcpy(writer.bytes.data(), &head, sizeof head);
    return std::move(writer.bytes);
}

Outcome Instance::load(std::span<const std::byte> bytes) {
    Head head{};
    if (bytes.size() < sizeof head) return damaged("ends early");
    std::memcpy(&head, bytes.data(), sizeof head);
    if (head.magic != kSavedMagic) return damaged("is none");
    if (head.version != kSavedVersion)
        return Refusal{HL_NEWER, "a saved instance of version " + std::to_string(head.version) +
                                     "; expected " + std::to_string(kSavedVersion)};
    if (head.bytes != bytes.size()) return damaged("is of another size than it says");
    if (head.asset != asset_) return damaged("is of another asset");
    if (head.hasLevels != (levels_ ? 1u : 0u)) return damaged("has levels where this has none, or none");
    if (head.checksum != asset::checksum(bytes.subspan(sizeof head))) return damaged("has another checksum");

    Reader reader(bytes.subspan(sizeof head));
    const auto origin = reader.value<std::array<double, 3>>();
    Vector<Quat> turns;
    reader.all(turns, turns_.size());
    Vector<float> amounts, followed;
    reader.all(amounts, hairPoses_.amounts.size());
    reader.all(followed, hairPoses_.amounts.size());
    const auto areAmounts = [](const Vector<float>& all) {
        return std::all_of(all.begin(), all.end(), [](float amount) { return amount >= 0 && amount <= 1; });
    };
    if (reader.good && !(areAmounts(amounts) && areAmounts(followed)))
        return damaged("follows a pose by an amount that is not from 0 to 1");
    const auto number = reader.value<std::uint32_t>();
    if (number > (levels_ ? std::uint32_t{HL_LEVEL_RIGID} : 0u))
        return damaged("is at a level that there is not");
    Levels read;
    if (levels_) {
        read.share = reader.value<float>();
        reader.all(read.placed, levels_->placed.size());
        const bool hasOrigin = reader.value<std::uint32_t>() != 0;
        const auto from = reader.value<std::array<double, 3>>();
        if (hasOrigin) read.origin = from;
        read.velocity = reader.value<Float3>();
        read.motion = reader.value<float>();
        read.wind = reader.value<float>();
        read.fading = reader.value<std::uint32_t>() != 0;
        reader.all(read.fade, levels_->fade.size());
        if (reader.good && !(read.share > 0 && read.share <= 1))
            return damaged("reads no share of its hairs");
    }
    Engine* const engine = engineAt(number);
    std::optional<State> state;
    if (engine && reader.good) state = readState(reader, *engine->state());
    if (!reader.good || !reader.atEnd()) return damaged("has other strands or settings");

    // Takes memory, so it comes first; in copies where engines follow poses otherwise.
    const std::span<const float> follows = (engine ? engine : &engine_)->poseAmounts();
    if (std::equal(followed.begin(), followed.end(), follows.begin())) {
        if (engine && !engine->setState(*state)) return damaged("has other strands");
    } else {
        Engine finest(engine_);
        Vector<Engine> coarser;
        if (levels_) coarser = levels_->engines;
        giveAmounts(followed, finest, coarser);
        Engine* const other = number == HL_LEVEL_FINEST ? &finest : engine ? &coarser[number - 1] : nullptr;
        if (other && !other->setState(*state)) return damaged("has other strands");
        engine_ = std::move(finest);
        if (levels_) levels_->engines = std::move(coarser);
        hairPoses_.isReserved = false;
    }
    hairPoses_.amounts.swap(amounts);
    hairPoses_.isStanding = false;
    if (levels_) {
        takeHairs(read.share);
        levels_->level = number;
        levels_->placed.swap(read.placed);
        levels_->origin = read.origin;
        levels_->velocity = read.velocity;
        levels_->motion = read.motion;
        levels_->wind = read.wind;
        levels_->fading = read.fading;
        levels_->fade.swap(read.fade);
        placeRootsOfLevels();
    }
    leaveGpu();
    played_ = playedWaits_ = false;
    origin_ = origin;
    turns_.swap(turns);
    asleep_ = last_.known = rootsKnown_ = false;
    ++changes_;
    for (Shown& shown : shown_) shown.state = 0;
    return std::nullopt;
}

}  // namespace hairloom::runtime
