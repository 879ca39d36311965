// SPDX-License-Identifier: GPL-3.0-or-later
// Takes: how near what is read comes to what was written, and what is left of one that was ended or damaged.

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/base/output_file.h"
#include "core/simulation/frame_record.h"
#include "core/simulation/take_codec.h"
#include "core/simulation/take_file.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::size_t kStrands = 20, kPoints = 8;

/// Strands from roots that stand 1 cm apart, each of another number of points.
Groom grooms() {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::size_t s = 0; s < kStrands; ++s) {
        const std::size_t points = s == 3 ? 1 : s == 5 ? 2 : kPoints;
        for (std::size_t i = 0; i < points; ++i)
            positions.emplace_back(0.01f * static_cast<float>(s), 1.7f - 0.02f * static_cast<float>(i), 0.f);
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    return makeGroom(std::move(offsets), std::move(positions));
}

/// Where points are in a frame: swinging, with a jump at frame 13.
std::vector<Vec3f> moved(const Groom& groom, std::uint64_t frame) {
    std::vector<Vec3f> positions(groom.positions().begin(), groom.positions().end());
    const float t = static_cast<float>(frame) / 60, jump = frame >= 13 ? 3.f : 0.f;
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] += Vec3f(0.1f * std::sin(7 * t + static_cast<float>(i)) + jump, 0.05f * std::cos(9 * t),
                              t * static_cast<float>(i % 7));
    return positions;
}

class Takes : public testing::Test {
  protected:
    TakeWriter writer(const std::string& notes = "{}") {
        auto made = TakeWriter::open(file, groom, 60, notes);
        EXPECT_TRUE(made) << made.error().message();
        return std::move(*made);
    }
    void write(std::uint64_t frames) {
        TakeWriter take = writer();
        for (std::uint64_t f = 0; f < frames; ++f) ASSERT_TRUE(take.add(moved(groom, f), {}));
        ASSERT_TRUE(take.finish());
    }
    std::string bytes() const {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    void setBytes(const std::string& content) const {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
    }
    double farthest(const RecordedFrame& frame, std::uint64_t number) const {
        const auto wanted = moved(groom, number);
        double largest = 0;
        for (std::size_t i = 0; i < wanted.size(); ++i)
            largest = std::max<double>(largest, (frame.positions_ws[i] - wanted[i]).norm());
        return largest;
    }

    const TemporaryFolder own;
    const fs::path file = own.path() / "swing.hltake";
    const Groom groom = grooms();
};

TEST_F(Takes, FramesComeBackInAnyOrderWithinTheErrorThatIsStated) {
    constexpr std::uint64_t kFrames = 21;  // two blocks and a part
    write(kFrames);
    auto take = TakeReader::open(file);
    ASSERT_TRUE(take) << take.error().message();
    EXPECT_EQ(take->info().frames, kFrames);
    EXPECT_TRUE(take->info().isFinished);
    EXPECT_EQ(take->info().shapeHash, takeShapeHash(groom));
    ASSERT_TRUE(take->use(groom));
    double largest = 0;
    for (std::uint64_t i = 0; i < kFrames; ++i) {
        const std::uint64_t number = (i * 8) % kFrames;
        const auto frame = take->frame(number);
        ASSERT_TRUE(frame) << frame.error().message();
        EXPECT_EQ(frame->framesInRecord, kFrames);
        largest = std::max(largest, farthest(*frame, number));
    }
    EXPECT_LE(largest, static_cast<double>(take->info().largestError) * 1.0001);
    EXPECT_LE(take->info().largestError, take::kLargestError);
    EXPECT_GT(largest, 0.5 * static_cast<double>(take->info().largestError)) << "the error is measured";
}

TEST_F(Takes, TheSameFramesAreTheSameBytes) {
    write(30);
    const std::string first = bytes();
    fs::remove(file);
    write(30);
    EXPECT_EQ(first, bytes());
    EXPECT_LT(first.size(), 12 * 30 * groom.pointCount());
}

TEST_F(Takes, RecordsAndTakesAreReadAlike) {
    write(3);
    const auto frame = readFrame(file, groom, 2);
    ASSERT_TRUE(frame) << frame.error().message();
    EXPECT_LT(farthest(*frame, 2), 1e-4);
    EXPECT_THAT(readFrame(file, groom, 3).error().message(), HasSubstr("has no frame 3; it has 3 frames"));
    EXPECT_THAT(readFrame(file, makeGroom({0, 2}, {{0, 0, 0}, {0, 1, 0}}), 0).error().message(),
                HasSubstr("this groom has 2, 0 and 0"));
}

TEST_F(Takes, PosesOfHeadsComeBack) {
    Groom withSphere = groom;
    withSphere.spheres.push_back({"skull", {0, 1.7f, 0}, 0.1f, {}});
    auto take = TakeWriter::open(file, withSphere, 24, "{\"motion\": \"nod\"}");
    ASSERT_TRUE(take);
    HeadPose rigid, posed;
    rigid.head_ws.translation() = Vec3f(0.5f, 0, 0);
    posed.sphereCentres_ws = {Vec3f(1, 2, 3)};
    ASSERT_TRUE(take->add(moved(groom, 0), rigid));
    ASSERT_TRUE(take->add(moved(groom, 1), posed));
    ASSERT_TRUE(take->add(moved(groom, 2), rigid));
    ASSERT_TRUE(take->finish());
    EXPECT_LT((readFrame(file, withSphere, 0)->pose.sphereCentres_ws[0] - Vec3f(0.5f, 1.7f, 0)).norm(),
              1e-6f);
    EXPECT_LT((readFrame(file, withSphere, 1)->pose.sphereCentres_ws[0] - Vec3f(1, 2, 3)).norm(), 1e-4f);
    EXPECT_LT((readFrame(file, withSphere, 2)->pose.sphereCentres_ws[0] - Vec3f(0.5f, 1.7f, 0)).norm(),
              1e-6f);
    EXPECT_EQ(TakeReader::open(file)->info().notes, "{\"motion\": \"nod\"}");
    EXPECT_EQ(readFrame(file, withSphere, 0)->framesPerSecond, 24);
}

TEST_F(Takes, OneThatWasEndedIsReadUpToItsLastWholeBlock) {
    {
        TakeWriter take = writer();
        for (std::uint64_t f = 0; f < 2 * kFramesPerBlock + 3; ++f)
            ASSERT_TRUE(take.add(moved(groom, f), {}));
    }
    EXPECT_FALSE(fs::exists(file));
    const auto leftOvers = findLeftOvers(own.path());
    ASSERT_EQ(leftOvers.size(), 1u);
    EXPECT_EQ(leftOvers[0].target, "swing.hltake");
    fs::rename(leftOvers[0].file, file);
    const std::string whole = bytes();
    for (const std::size_t torn : {std::size_t{0}, std::size_t{1}, std::size_t{100}}) {
        setBytes(whole.substr(0, whole.size() - torn));
        auto take = TakeReader::open(file);
        ASSERT_TRUE(take) << take.error().message();
        const std::uint64_t frames = torn == 0 ? 2 * kFramesPerBlock : kFramesPerBlock;
        EXPECT_EQ(take->info().frames, frames);
        EXPECT_FALSE(take->info().isFinished);
        ASSERT_TRUE(take->use(groom));
        EXPECT_LT(farthest(*take->frame(frames - 1), frames - 1), 1e-4);
        EXPECT_FALSE(take->frame(frames));
    }
    // As a system that lost its power may leave it: long enough, and empty.
    setBytes(whole.substr(0, whole.size() - 50) + std::string(50, '\0'));
    EXPECT_EQ(TakeReader::open(file)->info().frames, kFramesPerBlock);
}

TEST_F(Takes, OneWithoutAWholeBlockLeavesNothing) {
    {
        TakeWriter take = writer();
        ASSERT_TRUE(take.add(moved(groom, 0), {}));
    }
    EXPECT_TRUE(fs::is_empty(own.path()));
}

TEST_F(Takes, PositionsThatCannotBeKeptEndItWithTheFrame) {
    TakeWriter take = writer();
    ASSERT_TRUE(take.add(moved(groom, 0), {}));
    auto broken = moved(groom, 1);
    broken[7].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(take.add(broken, {}).error().message(), HasSubstr("frame 1: position 7 is at"));
    broken[7].y() = 2e5f;
    EXPECT_THAT(take.add(broken, {}).error().message(), HasSubstr("within 100 km"));
    EXPECT_THAT(take.add({}, {}).error().message(), HasSubstr("has 0 points; expected"));
    ASSERT_TRUE(take.add(moved(groom, 1), {}));
    ASSERT_TRUE(take.finish());
    EXPECT_LT(farthest(*readFrame(file, groom, 1), 1), 1e-4);
}

TEST_F(Takes, DamageIsToldAndOtherBlocksAreRead) {
    write(20);
    std::string content = bytes();
    content[content.size() - 10] ^= 1;  // in the third block
    setBytes(content);
    auto take = TakeReader::open(file);
    ASSERT_TRUE(take);
    ASSERT_TRUE(take->use(groom));
    EXPECT_LT(farthest(*take->frame(15), 15), 1e-4);
    EXPECT_THAT(take->frame(16).error().message(), HasSubstr("frames 16 to 19 are damaged"));
    EXPECT_LT(farthest(*take->frame(3), 3), 1e-4) << "and it goes on";
}

TEST_F(Takes, NoChangedByteAndNoCutDoesHarm) {
    write(10);
    const std::string whole = bytes();
    const auto tryIt = [&](const std::string& content) {
        setBytes(content);
        auto take = TakeReader::open(file);
        if (!take) {
            EXPECT_FALSE(take.error().problem.empty());
            return;
        }
        if (!take->use(groom)) return;
        for (std::uint64_t f = 0; f < take->info().frames; ++f) {
            const auto frame = take->frame(f);
            EXPECT_TRUE(!frame || farthest(*frame, f) < 1e-4) << "a checksum holds";
        }
    };
    for (std::size_t i = 0; i < whole.size(); i += i < 200 ? 1 : 17) {
        std::string content = whole;
        content[i] = static_cast<char>(content[i] ^ 0x55);
        tryIt(content);
        tryIt(whole.substr(0, i));
    }
}

TEST(TakeCodec, EveryWayComesBackExactly) {
    take::Predictor writes({0, 4, 5}, 12), reads({0, 4, 5}, 12);
    std::vector<std::byte> bytes;
    std::vector<take::GridFrame> frames;
    std::uint32_t random = 1;
    for (int f = 0; f < 12; ++f) {
        take::GridFrame frame;
        for (int i = 0; i < 36; ++i) {
            random = random * 1664525u + 1013904223u;
            const auto noise = static_cast<std::int32_t>(random >> 20u);
            const bool isWild = f == 5 || f == 9;
            frame.push_back(isWild ? (i % 2 == 0 ? take::kFarthest : -take::kFarthest) : f * i + noise % 3);
        }
        frames.push_back(frame);
        writes.write(frame, bytes);
        EXPECT_LE(bytes.size(), static_cast<std::size_t>(f + 1) * take::Predictor::mostBytes(12));
    }
    std::span<const std::byte> left = bytes;
    for (const take::GridFrame& frame : frames) EXPECT_EQ(*reads.read(left), frame);
    EXPECT_TRUE(left.empty());
    EXPECT_FALSE(reads.read(left));
}

}  // namespace
}  // namespace hairloom::test
