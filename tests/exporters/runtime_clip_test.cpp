// SPDX-License-Identifier: GPL-3.0-or-later
// Clips of runtime assets: what is recorded plays within the error that is stated, goes with the game's head,
// and a step goes on from it.

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/base/parallel.h"
#include "hairloom/gpu.h"
#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_bytes.h"
#include "tests/exporters/asset_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

namespace format = runtime::asset;
using game::Error;
using game::Frame;
using game::Instance;
using testing::HasSubstr;

constexpr float kRate = 30;
constexpr std::uint64_t kFrames = 40;

/// The head of a frame: turned and moved.
Eigen::Isometry3f headAt(std::uint64_t frame) {
    const float t = static_cast<float>(frame) / kRate;
    Eigen::Isometry3f head = Eigen::Isometry3f::Identity();
    head.linear() = Eigen::AngleAxisf(0.4f * std::sin(3 * t), Vec3f(0.6f, 0.8f, 0)).toRotationMatrix();
    head.translation() = Vec3f(0.2f * t, 0.1f * std::cos(2 * t), -0.3f * t);
    return head;
}

/// Where a point of the hair is on a head that stands: it sways, more towards the tip, each strand its own
/// way.
Vec3f swayed(const Groom& groom, std::size_t strand, std::size_t point, std::uint64_t frame) {
    const float t = static_cast<float>(frame) / kRate, share = static_cast<float>(point) / 11;
    const float phase = 0.7f * static_cast<float>(strand);
    const Vec3f away(0.05f * std::sin(5 * t + phase), 0.02f * std::sin(9 * t),
                     0.04f * std::cos(4 * t + phase));
    return groom.strand(strand)[point] + share * share * (away - Vec3f(0, 0, 0.04f * std::cos(phase)));
}

class RuntimeClip : public AssetTest {
  protected:
    RuntimeClip() {
        clip_.name = "sway";
        clip_.framesPerSecond = static_cast<double>(kRate);
        clip_.frames = kFrames;
        clip_.frame = [this](std::uint64_t number) -> Result<ClipToWrite::Frame> {
            ClipToWrite::Frame frame;
            frame.head_ws = headAt(number);
            for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
                for (std::size_t p = 0; p < groom_.strand(s).size(); ++p)
                    frame.positions_ws.push_back(frame.head_ws * swayed(groom_, s, p, number));
            }
            return frame;
        };
    }
    std::vector<std::byte> writtenWithClip(ExportReport* report = nullptr) {
        StrandExportOptions options;
        options.clip = std::make_shared<const ClipToWrite>(clip_);
        const auto path = folder / "clip.hairrt";
        const auto made = strandWriter("runtime").write(groom_, path, options);
        EXPECT_TRUE(made) << made.error().message();
        if (!made) return {};
        if (report) *report = *made;
        return readFile(path).value();
    }
    /// The first and the last point of each strand that is not a root, largest distance in metres.
    double error(const std::vector<float>& points, const Eigen::Isometry3f& head, double frame) const {
        double largest = 0;
        const auto before = static_cast<std::uint64_t>(frame);
        const auto share = static_cast<float>(frame - static_cast<double>(before));
        for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
            for (std::size_t p = 1; p < groom_.strand(s).size(); ++p) {
                const Vec3f at = (1 - share) * swayed(groom_, s, p, before) +
                                 share * swayed(groom_, s, p, (before + 1) % kFrames);
                const float* const is = &points[3 * (groom_.offsets[s] + p)];
                largest = std::max(largest, double{(Vec3f(is[0], is[1], is[2]) - head * at).norm()});
            }
        }
        return largest;
    }

    Groom groom_ = wholeGroom();
    ClipToWrite clip_;
};

TEST_F(RuntimeClip, PlaysWithinItsErrorOnAnyHead) {
    ExportReport report;
    const auto bytes = writtenWithClip(&report);
    EXPECT_EQ(report.frames, kFrames);
    game::Asset asset;
    Error error;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size(), &error)) << error.what();
    ASSERT_TRUE(asset.check(&error)) << error.what();
    const hl_clip clip = asset.clip(&error);
    EXPECT_EQ(std::string(clip.name, clip.name_bytes), "sway");
    EXPECT_EQ(clip.frames, kFrames);
    EXPECT_EQ(clip.frames_per_second, kRate);
    EXPECT_EQ(clip.loops, 0u);
    EXPECT_LE(clip.largest_error, 0.0001f);
    EXPECT_LE(static_cast<double>(clip.bytes) / static_cast<double>(kFrames * groom_.pointCount()), 4.0);
    EXPECT_EQ(asset.describe().minor, 3u);
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_HAIRS));
    std::vector<float> points;
    // Forwards, backwards, at random, between frames, and beyond the ends.
    std::vector<double> times{0, 1, 2, 3, 4.25, 5.5, 30, 29, 28.5, 15, 16, 31.75, 0.5, 38.9, 39};
    for (const double frame : times) {
        for (const std::uint64_t head : {std::uint64_t{0}, std::uint64_t{33}}) {
            const auto matrix = rows(headAt(head).matrix());
            Frame placed;
            placed.head = matrix.data();
            ASSERT_TRUE(hair.play(asset, placed, frame / static_cast<double>(kRate), &error)) << error.what();
            ASSERT_TRUE(hair.readGuides(points));
            EXPECT_LE(this->error(points, headAt(head), frame), double{clip.largest_error} + 1e-6) << frame;
        }
    }
    for (const double seconds : {-5.0, 1e9}) {
        ASSERT_TRUE(hair.play(asset, Frame(), seconds));
        ASSERT_TRUE(hair.readGuides(points));
        EXPECT_LE(this->error(points, Eigen::Isometry3f::Identity(), seconds < 0 ? 0 : kFrames - 1),
                  double{clip.largest_error} + 1e-6);
    }
    // Follow hairs go with the guides.
    std::vector<float> hairs, moved;
    ASSERT_TRUE(hair.readHairs(hairs));
    ASSERT_TRUE(hair.play(asset, Frame(), 0.5));
    ASSERT_TRUE(hair.readHairs(moved));
    EXPECT_NE(hairs, moved);
    EXPECT_TRUE(std::ranges::all_of(moved, [](float value) { return std::isfinite(value); }));
    EXPECT_LE(hair.describe().bytes,
              asset.describe().guides_memory + asset.describe().hairs_memory + clip.memory);
}

TEST_F(RuntimeClip, LoopsWhereItIsToldTo) {
    clip_.loops = true;
    const auto bytes = writtenWithClip();
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    const hl_clip clip = asset.clip();
    EXPECT_EQ(clip.loops, 1u);
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES));
    std::vector<float> points;
    const double frames = static_cast<double>(kFrames), rate = static_cast<double>(kRate);
    for (const double frame : {39.5, frames + 3.25, -0.5, -frames * 7 + 12, 1e6 * frames + 8}) {
        ASSERT_TRUE(hair.play(asset, Frame(), frame / rate));
        ASSERT_TRUE(hair.readGuides(points));
        const double within = std::fmod(std::fmod(frame, frames) + frames, frames);
        EXPECT_LE(error(points, Eigen::Isometry3f::Identity(), within), double{clip.largest_error} + 2e-6)
            << frame;
    }
    hl_play never;
    hl_play_init(&never);
    never.loop = HL_LOOP_NEVER;
    never.time = 100;
    ASSERT_TRUE(hair.play(asset, Frame(), never));
    ASSERT_TRUE(hair.readGuides(points));
    EXPECT_LE(error(points, Eigen::Isometry3f::Identity(), kFrames - 1), double{clip.largest_error} + 1e-6);
}

/// Version 1.3 brought clips. Three strands in wind, in 20 frames that loop, beside the frames that the take
/// had.
TEST_F(RuntimeClip, FilesOfTheFirstVersionWithAClipStillPlay) {
    const auto files = sourceDir() / "tests/exporters/files";
    const Groom three = helices({12, 12, 12});
    const auto bytes = readFile(files / "version_1_3.hairrt").value();
    game::Asset asset;
    Error error;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size(), &error)) << error.what();
    ASSERT_TRUE(asset.check(&error)) << error.what();
    EXPECT_EQ(asset.describe().minor, 3u);
    const hl_clip clip = asset.clip(&error);
    EXPECT_EQ(std::string(clip.name, clip.name_bytes), "sway");
    EXPECT_EQ(clip.frames, 20u);
    EXPECT_EQ(clip.loops, 1u);
    EXPECT_LE(clip.largest_error, 0.0001f);
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES, nullptr, &error)) << error.what();
    std::vector<float> points;
    // docs/formats/frames.md: version 1, of 36 points and nothing else.
    const auto record = readFile(files / "version_1_3.frames").value();
    const std::size_t frameBytes = 8 + three.pointCount() * sizeof(Vec3f);
    ASSERT_EQ(record.size(), 48 + clip.frames * frameBytes);
    const auto frameOf = [&](std::size_t number) {
        std::vector<Vec3f> taken(three.pointCount());
        std::memcpy(static_cast<void*>(taken.data()), record.data() + 48 + number * frameBytes + 8,
                    taken.size() * sizeof(Vec3f));
        return taken;
    };
    for (const std::size_t number : {std::size_t{0}, std::size_t{17}, std::size_t{3}, std::size_t{19}}) {
        const std::vector<Vec3f> taken = frameOf(number);
        ASSERT_TRUE(hair.play(asset, Frame(), static_cast<double>(number + 20) / 60, &error)) << error.what();
        ASSERT_TRUE(hair.readGuides(points));
        ASSERT_EQ(points.size(), 3 * three.pointCount());
        for (std::size_t p = 0; p < three.pointCount(); ++p) {
            if (p % 12 == 0) continue;  // roots stay on the skin
            const Vec3f at(points[3 * p], points[3 * p + 1], points[3 * p + 2]);
            EXPECT_LE((at - taken[p]).norm(), clip.largest_error + 2e-6f) << number << " " << p;
        }
    }
    EXPECT_GT((frameOf(19)[35] - frameOf(0)[35]).norm(), 0.01f) << "it moves";
}

/// x, y, z and 0 of each point of the guides, m/s, as kernels of hairs are given them.
std::vector<float> velocitiesOf(const Instance& hair, std::size_t points) {
    std::vector<float> velocities(4 * points);
    EXPECT_EQ(hl_gpu_fill_frame(hair.get(), HL_GPU_BUFFER_VELOCITIES, velocities.data(),
                                velocities.size() * sizeof(float), nullptr),
              HL_OK);
    return velocities;
}

TEST_F(RuntimeClip, PointsHaveTheSpeedOfTheClipAndOfTheHead) {
    const auto bytes = writtenWithClip();
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    const Eigen::AngleAxisf turn(0.02f, Vec3f::UnitY());
    Eigen::Isometry3f before = headAt(7), after = turn * before;
    after.translation() += Vec3f(0.004f, 0.001f, 0);
    for (const float speed : {0.0f, 1.0f, -2.0f}) {
        // The head jumps far, or is told to; or goes on.
        for (const int way : {0, 1, 2}) {
            const bool jumps = way > 0;
            Instance hair;
            ASSERT_TRUE(hair.make(asset, HL_GUIDES));
            hl_play play;
            hl_play_init(&play);
            play.speed = speed;
            play.time = 9.25 / static_cast<double>(kRate);
            auto head = rows(before.matrix());
            if (way == 1) head[3] += 30;
            Frame frame(1 / 50.0f);
            frame.head = head.data();
            ASSERT_TRUE(hair.play(asset, frame, play));
            head = rows(after.matrix());
            frame.origin[0] = 2;  // what was there before is now measured from elsewhere
            head[3] -= 2;
            frame.cut = way == 2 ? 1 : 0;
            ASSERT_TRUE(hair.play(asset, frame, play));
            const auto velocities = velocitiesOf(hair, groom_.pointCount());
            for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
                for (std::size_t p = 0; p < 12; ++p) {
                    const Vec3f from = swayed(groom_, s, p, 9), to = swayed(groom_, s, p, 10);
                    const Vec3f at = from + 0.25f * (to - from);
                    Vec3f expected = after.linear() * (to - from) * kRate * speed;
                    if (!jumps) expected += (after * at - before * at) * 50;
                    const float* const is = &velocities[4 * (groom_.offsets[s] + p)];
                    ASSERT_LT((Vec3f(is[0], is[1], is[2]) - expected).norm(), 0.01f)
                        << "strand " << s << ", point " << p << ", speed " << speed << ", way " << way;
                }
            }
        }
    }
}

TEST_F(RuntimeClip, AStepGoesOnFromThePoseWithItsSpeed) {
    groom_.simulation.windSpeed = 0;
    groom_.spheres.clear();
    const auto bytes = writtenWithClip();
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    const auto tipsAfterAStep = [&](float speed) {
        Instance hair;
        EXPECT_TRUE(hair.make(asset, HL_GUIDES));
        hl_play play;
        hl_play_init(&play);
        play.speed = speed;
        play.time = 0.31;
        for (int f = 0; f < 2; ++f) EXPECT_TRUE(hair.play(asset, Frame(), play));
        EXPECT_TRUE(hair.step(Frame()));
        std::vector<float> points;
        EXPECT_TRUE(hair.readGuides(points));
        std::vector<Vec3f> tips;
        for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
            const float* const tip = &points[3 * (groom_.offsets[s + 1] - 1)];
            tips.emplace_back(tip[0], tip[1], tip[2]);
        }
        return tips;
    };
    const auto still = tipsAfterAStep(0), moving = tipsAfterAStep(1), back = tipsAfterAStep(-1);
    for (std::size_t s = 0; s < still.size(); ++s) {
        // Frame 9.3. Lengths, which the clip does not keep, take some of the speed.
        const Vec3f expected = (swayed(groom_, s, 11, 10) - swayed(groom_, s, 11, 9)) * kRate / 60;
        const float ahead = (moving[s] - still[s]).dot(expected) / expected.squaredNorm();
        const float behind = (back[s] - still[s]).dot(expected) / expected.squaredNorm();
        EXPECT_GT(ahead, 0.3f) << s;
        EXPECT_LT(ahead, 1.1f) << s;
        EXPECT_LT(behind, -0.3f) << s;
        EXPECT_GT(behind, -1.1f) << s;
    }
}

// The engine is put where a clip has the points once something needs it, and nobody can tell when that was.
TEST_F(RuntimeClip, WhatPlaysIsSavedCopiedAndSteppedFromWhereItIs) {
    const auto bytes = writtenWithClip();
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    const auto played = [&](Instance& hair) {
        EXPECT_TRUE(hair.make(asset, HL_GUIDES));
        for (int f = 0; f < 5; ++f) EXPECT_TRUE(hair.step(Frame(1 / 60.0f)));
        for (int f = 1; f < 4; ++f) EXPECT_TRUE(hair.play(asset, Frame(), 0.1 * f));
    };
    Instance stepped, hashed, saved, copied, set;
    for (Instance* hair : {&stepped, &hashed, &set}) played(*hair);
    EXPECT_EQ(stepped.describeEffect(0).on, 0u);
    EXPECT_THAT(stepped.describeEffect(0).why, HasSubstr("a clip plays"));
    EXPECT_EQ(stepped.describe().asleep, 0u);
    std::size_t size = 0;
    ASSERT_EQ(hl_instance_save(stepped.get(), nullptr, 0, &size, nullptr), HL_OK);
    std::vector<std::byte> file(size);
    ASSERT_EQ(hl_instance_save(stepped.get(), file.data(), size, &size, nullptr), HL_OK);
    ASSERT_TRUE(saved.make(asset, HL_GUIDES));
    ASSERT_EQ(hl_instance_load(saved.get(), file.data(), size, nullptr), HL_OK);
    ASSERT_TRUE(copied.copy(stepped));
    ASSERT_TRUE(set.set("airDrag", groom_.simulation.airDrag));
    EXPECT_EQ(hashed.hash(), stepped.hash());
    EXPECT_EQ(saved.hash(), stepped.hash());
    std::vector<float> before, after;
    ASSERT_TRUE(stepped.readGuides(before));
    ASSERT_TRUE(set.readGuides(after));
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(before[i], after[i], 2e-6f);
    for (Instance* hair : {&stepped, &hashed, &saved, &copied, &set}) ASSERT_TRUE(hair->step(Frame()));
    for (Instance* hair : {&hashed, &saved, &copied, &set}) EXPECT_EQ(hair->hash(), stepped.hash());
    // A reset forgets the clip.
    ASSERT_TRUE(copied.play(asset, Frame(), 0.2));
    for (Instance* hair : {&copied, &hashed}) ASSERT_TRUE(hair->reset(Frame()));
    EXPECT_EQ(copied.hash(), hashed.hash());
}

TEST_F(RuntimeClip, TheBitsAreThoseOfAnyThreadsAndAnyWayThere) {
    const auto bytes = writtenWithClip();
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    const hl_jobs jobs{
        nullptr, [](void*, std::size_t count, std::size_t grain,
                    void (*body)(void*, std::size_t, std::size_t), void* context) {
            parallelFor(count, grain, [&](std::size_t begin, std::size_t end) { body(context, begin, end); });
        }};
    Instance one, many, jumps, copy;
    ASSERT_TRUE(one.make(asset, HL_GUIDES));
    ASSERT_TRUE(many.make(asset, HL_GUIDES, &jobs));
    for (int f = 0; f < 60; ++f) {
        const double seconds = 0.02 * f;
        ASSERT_TRUE(one.play(asset, Frame(), seconds));
        ASSERT_TRUE(many.play(asset, Frame(), seconds));
        ASSERT_EQ(one.hash(), many.hash()) << f;
        if (f == 30) {
            ASSERT_TRUE(copy.copy(one));
        }
    }
    for (int f = 31; f < 60; ++f) ASSERT_TRUE(copy.play(asset, Frame(), 0.02 * f));
    EXPECT_EQ(copy.hash(), one.hash());
    ASSERT_TRUE(jumps.make(asset, HL_GUIDES));
    for (const int f : {58, 3, 59, 58, 59}) ASSERT_TRUE(jumps.play(asset, Frame(), 0.02 * f));
    EXPECT_EQ(jumps.hash(), one.hash());
    EXPECT_EQ(writtenWithClip(), bytes);
}

TEST_F(RuntimeClip, LevelsPlayAsTheySimulate) {
    const auto bytes = writtenWithClip();
    game::Asset asset;
    ASSERT_TRUE(asset.open(bytes.data(), bytes.size()));
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_HAIRS | HL_LEVELS));
    std::vector<float> points;
    for (std::uint32_t level = 0; level < HL_LEVEL_COUNT; ++level) {
        ASSERT_TRUE(hair.setLevel(level));
        // What levels differ by fades.
        for (int f = 0; f < 120; ++f) ASSERT_TRUE(hair.play(asset, Frame(), 0.3));
        ASSERT_TRUE(hair.readGuides(points));
        std::uint32_t played = 0, resting = 0;
        for (std::size_t s = 0; s < groom_.strandCount(); ++s) {
            const float* const tip = &points[3 * (groom_.offsets[s + 1] - 1)];
            const Vec3f at(tip[0], tip[1], tip[2]);
            played += (at - swayed(groom_, s, 11, 9)).norm() < 1.2e-4f ? 1 : 0;
            resting += (at - groom_.strand(s)[11]).norm() < 1.2e-4f ? 1 : 0;
        }
        EXPECT_GE(played, hair.describeLevel(level).guides) << level;
        EXPECT_EQ(resting, level == HL_LEVEL_RIGID ? groom_.strandCount() : 0) << level;
    }
    ASSERT_TRUE(hair.setLevel(0));
    for (int f = 0; f < 120; ++f) ASSERT_TRUE(hair.play(asset, Frame(), 0.3));
    ASSERT_TRUE(hair.readGuides(points));
    EXPECT_LE(error(points, Eigen::Isometry3f::Identity(), 9), double{asset.clip().largest_error} + 1.2e-5);
}

TEST_F(RuntimeClip, OtherClipsOfTheHairstylePlayAndOthersAreRefused) {
    const auto first = writtenWithClip();
    clip_.frames = 7;
    clip_.name = "short";
    const auto second = writtenWithClip();
    const auto plain = written(groom_);
    groom_ = helices({12, 12});
    const auto other = writtenWithClip();
    game::Asset sway, brief, none, foreign;
    ASSERT_TRUE(sway.open(first.data(), first.size()));
    ASSERT_TRUE(brief.open(second.data(), second.size()));
    ASSERT_TRUE(none.open(plain.data(), plain.size()));
    ASSERT_TRUE(foreign.open(other.data(), other.size()));
    EXPECT_EQ(none.clip().frames, 0u);
    EXPECT_EQ(none.describe().minor, 2u) << "files without a clip are as before";
    Instance hair;
    Error error;
    ASSERT_TRUE(hair.make(none, HL_GUIDES));
    EXPECT_TRUE(hair.play(sway, Frame(), 0.4));
    EXPECT_TRUE(hair.play(brief, Frame(), 0.4));
    const std::uint64_t before = hair.hash();
    EXPECT_FALSE(hair.play(none, Frame(), 0, &error));
    EXPECT_THAT(std::string(error.what()), HasSubstr("no clip"));
    EXPECT_FALSE(hair.play(foreign, Frame(), 0, &error));
    EXPECT_THAT(std::string(error.what()), HasSubstr("another hairstyle"));
    EXPECT_FALSE(hair.play(sway, Frame(), std::numeric_limits<double>::quiet_NaN(), &error));
    EXPECT_THAT(std::string(error.what()), HasSubstr("play.time"));
    EXPECT_FALSE(hair.play(sway, Frame(-1), 0, &error));
    hl_play wrong;
    hl_play_init(&wrong);
    wrong.loop = 3;
    EXPECT_FALSE(hair.play(sway, Frame(), wrong, &error));
    EXPECT_TRUE(hair.play(sway, Frame(0), 0)) << "a paused game: nothing moves";
    EXPECT_EQ(hair.hash(), before);
}

TEST_F(RuntimeClip, DamageIsRefusedWithItsPlaceAndChangesNothing) {
    clip_.frames = 20;
    const auto bytes = writtenWithClip();
    const auto damaged = [&](std::string_view kind, std::size_t byte, std::uint32_t value, std::size_t size) {
        AssetBytes copy(bytes);
        std::uint64_t place = 0;
        for (const format::Section& section : copy.table()) {
            if (std::string_view(section.kind.data(), 4) == kind) place = section.offset;
        }
        std::memcpy(copy.span().data() + place + byte, &value, size);
        copy.seal();
        game::Asset asset;
        Error error;
        EXPECT_TRUE(asset.open(copy.span().data(), copy.span().size(), &error)) << error.what();
        EXPECT_FALSE(asset.check(&error)) << kind << " " << byte;
        EXPECT_EQ(error.code, HL_DAMAGED);
        EXPECT_GE(error.byte, place);
        EXPECT_LT(error.byte, bytes.size());
        return std::string(error.what());
    };
    const auto bits = [](float value) {
        std::uint32_t word = 0;
        std::memcpy(&word, &value, sizeof word);
        return word;
    };
    EXPECT_THAT(damaged("CLIP", 0, 0xffffff, 4), HasSubstr("no name"));
    EXPECT_THAT(damaged("CLIP", 8, bits(0), 4), HasSubstr("a rate"));
    EXPECT_THAT(damaged("CLIP", 8, bits(std::numeric_limits<float>::quiet_NaN()), 4), HasSubstr("a rate"));
    EXPECT_THAT(damaged("CLIP", 12, 0, 4), HasSubstr("0 frames; expected 1 to"));
    EXPECT_THAT(damaged("CLIP", 12, 0xffffffff, 4), HasSubstr("4294967295 frames"));
    EXPECT_THAT(damaged("CLIP", 12, 200, 4), HasSubstr("places of bits; expected"));
    EXPECT_THAT(damaged("CLIP", 16, 0, 2), HasSubstr("blocks of 0 frames"));
    EXPECT_THAT(damaged("CLIP", 16, 65, 2), HasSubstr("blocks of 65 frames"));
    EXPECT_THAT(damaged("CLIP", 18, 30, 1), HasSubstr("a grid of 30 bits"));
    EXPECT_THAT(damaged("CLIP", 19, 2, 1), HasSubstr("loops"));
    EXPECT_THAT(damaged("CLIP", 20, bits(-1), 4), HasSubstr("an error"));
    EXPECT_THAT(damaged("CLPI", 0, 1, 4), HasSubstr("not all of their section"));
    EXPECT_THAT(damaged("CLPI", 8, 0xfffffff0, 4), HasSubstr("end before they begin"));
    EXPECT_THAT(damaged("CLPD", 0, 0xff, 1), HasSubstr("bits of strand 0 from frame 0 on are no motion"));

    // Damage that an asset has which was not checked: the call that meets it says so.
    AssetBytes copy(bytes);
    for (const format::Section& section : copy.table()) {
        if (std::string_view(section.kind.data(), 4) == "CLPD")
            std::memset(copy.span().data() + section.offset + section.bytes / 2, 0xff, 40);
    }
    copy.seal();
    game::Asset asset;
    Error error;
    ASSERT_TRUE(asset.open(copy.span().data(), copy.span().size()));
    Instance hair;
    ASSERT_TRUE(hair.make(asset, HL_GUIDES, nullptr, &error)) << error.what();
    ASSERT_TRUE(hair.step(Frame()));
    std::size_t refused = 0;
    for (int f = 0; f < 20; ++f) {
        const std::uint64_t before = hair.hash();
        if (hair.play(asset, Frame(), f / static_cast<double>(kRate), &error)) continue;
        ++refused;
        EXPECT_EQ(error.code, HL_DAMAGED);
        EXPECT_THAT(std::string(error.what()), HasSubstr("of strand"));
        EXPECT_LT(error.byte, bytes.size());
        EXPECT_EQ(hair.hash(), before);
        EXPECT_TRUE(hair.step(Frame()));
    }
    EXPECT_GT(refused, 0u);
}

TEST_F(RuntimeClip, RandomBitsPlayAsHairOrNotAtAll) {
    clip_.frames = 20;
    const auto bytes = writtenWithClip();
    std::size_t refused = 0, played = 0;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
        std::mt19937 random(seed);
        AssetBytes copy(bytes);
        for (const format::Section& section : copy.table()) {
            if (std::string_view(section.kind.data(), 3) != "CLP" &&
                section.kind != std::array{'C', 'L', 'I', 'P'})
                continue;
            if (random() % 3 == 0) continue;
            for (std::uint32_t change = 0; change < 1 + random() % 3; ++change)
                copy.span()[section.offset + random() % section.bytes] ^=
                    static_cast<std::byte>(1u << random() % 8);
        }
        copy.seal();
        game::Asset asset;
        Instance hair;
        ASSERT_TRUE(asset.open(copy.span().data(), copy.span().size()));
        if (!hair.make(asset, HL_HAIRS)) {
            ++refused;
            continue;
        }
        std::vector<float> guides, hairs;
        for (const double seconds : {0.0, 0.1, 0.55, 0.3}) {
            if (!hair.play(asset, Frame(), seconds)) {
                ++refused;
                continue;
            }
            ++played;
            ASSERT_TRUE(hair.readGuides(guides) && hair.readHairs(hairs));
            const auto isNumber = [](float value) { return std::isfinite(value); };
            ASSERT_TRUE(std::ranges::all_of(guides, isNumber) && std::ranges::all_of(hairs, isNumber))
                << seed;
        }
    }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(played, 100u);
}

TEST_F(RuntimeClip, FramesThatCannotBeHadEndTheExport) {
    const auto path = folder / "none.hairrt";
    const auto refusal = [&](const StrandExportOptions& options) {
        const auto made = strandWriter("runtime").write(groom_, path, options);
        EXPECT_FALSE(made);
        EXPECT_FALSE(std::filesystem::exists(path));
        return made ? std::string() : made.error().message();
    };
    StrandExportOptions options;
    const auto with = [&](const auto& change) {
        ClipToWrite clip = clip_;
        change(clip);
        options.clip = std::make_shared<const ClipToWrite>(std::move(clip));
        return refusal(options);
    };
    EXPECT_THAT(with([](ClipToWrite& clip) { clip.frames = 0; }), HasSubstr("0 frames"));
    EXPECT_THAT(with([](ClipToWrite& clip) { clip.framesPerSecond = 0; }), HasSubstr("frames a second"));
    EXPECT_THAT(with([](ClipToWrite& clip) {
                    clip.frame = [](std::uint64_t) -> Result<ClipToWrite::Frame> { return fail("is torn"); };
                }),
                HasSubstr("is torn"));
    EXPECT_THAT(with([this](ClipToWrite& clip) {
                    clip.frame = [this](std::uint64_t number) {
                        auto frame = clip_.frame(number);
                        frame->positions_ws[5].x() = std::numeric_limits<float>::quiet_NaN();
                        return frame;
                    };
                }),
                HasSubstr("far from its root"));
    EXPECT_THAT(with([this](ClipToWrite& clip) {
                    clip.frame = [this](std::uint64_t number) {
                        auto frame = clip_.frame(number);
                        frame->positions_ws.pop_back();
                        return frame;
                    };
                }),
                HasSubstr("points"));
    options.pointsPerStrand = 5;
    EXPECT_THAT(with([](ClipToWrite&) {}), HasSubstr("--points"));
}

}  // namespace
}  // namespace hairloom::test
