// SPDX-License-Identifier: GPL-3.0-or-later
// What damage does to a runtime asset: it is refused, or the hair stays hair.

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "hairloom/gpu.h"
#include "hairloom/hairloom.hpp"
#include "tests/exporters/asset_bytes.h"
#include "tests/exporters/asset_samples.h"
#include "tests/exporters/character_sample.h"

namespace hairloom::test {
namespace {

namespace format = runtime::asset;
using runtime::AssetError;

class RuntimeDamage : public AssetTest {};

TEST_F(RuntimeDamage, AnyChangedByteIsRefusedOrChangesNothing) {
    const auto bytes = written(wholeGroom());
    AssetBytes copy(bytes);
    const auto before = runtime::Asset::open(copy.span()).asset->strandsAtRest();
    std::size_t harmless = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        const std::byte was = copy.span()[at];
        copy.span()[at] ^= static_cast<std::byte>(1u << (at % 8));
        const auto opened = runtime::Asset::open(copy.span());
        const bool refused = !opened.asset || opened.asset->check();
        if (!refused) {
            ++harmless;
            const auto strands = opened.asset->strandsAtRest();
            ASSERT_TRUE(strands.positions_ss == before.positions_ss) << at;
        }
        copy.span()[at] = was;
    }
    EXPECT_LT(harmless, 15 * copy.table().size()) << "zeros between sections alone";
}

TEST_F(RuntimeDamage, DamageThatNoChecksumFindsIsRefusedOrHarmless) {
    const auto bytes = written(wholeGroom());
    std::mt19937 random(7);
    std::size_t refused = 0, used = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        for (const std::uint32_t value : {255u, 128u, static_cast<std::uint32_t>(random() % 255 + 1)}) {
            AssetBytes copy(bytes);
            copy.span()[at] ^= static_cast<std::byte>(value);
            // Bytes of the header and the table are taken as they are; counts of sections among them.
            if (copy.header().sections == bytes.size() || copy.header().sections > 64) continue;
            bool lies = true;
            for (const format::Section& section : copy.table())
                lies =
                    lies && section.offset <= bytes.size() && section.bytes <= bytes.size() - section.offset;
            if (lies) copy.seal();
            const auto opened = runtime::Asset::open(copy.span());
            if (!opened.asset || opened.asset->check()) {
                ++refused;
            } else if (at % 7 == 0) {
                used += useAll(*opened.asset) > 0 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(used, 100u);
}

TEST_F(RuntimeDamage, LooksThatNoChecksumFindsAreRefusedOrHarmless) {
    const auto plain = written(wholeGroom());
    const std::size_t hairs = runtime::Asset::open(plain).asset->hairCount();
    const auto bytes = written(wholeGroom(), nullptr, withLooks(hairs));
    AssetBytes copy(bytes);
    ASSERT_FALSE(runtime::Asset::open(copy.span()).asset->check());
    std::mt19937 random(11);
    std::vector<float> room(1u << 20);
    std::size_t refused = 0, used = 0;
    for (const format::Section& section : copy.table()) {
        const std::string_view kind(section.kind.data(), 4);
        if (kind != "MATL" && kind != "FIBT" && kind != "HLOK") continue;
        const std::size_t step = kind == "FIBT" ? 997 : 1;
        for (std::size_t at = section.offset; at < section.offset + section.bytes; at += step) {
            const std::byte was = copy.span()[at];
            copy.span()[at] ^= static_cast<std::byte>(random() % 255 + 1);
            copy.seal();
            hl_asset opened;
            ASSERT_EQ(hl_asset_open(&opened, copy.span().data(), copy.span().size(), nullptr), HL_OK);
            hl_error error{};
            if (hl_asset_check(&opened, &error) != HL_OK) {
                ++refused;
                EXPECT_STRNE(error.words, "");
            } else {
                for (const std::uint32_t buffer :
                     {HL_GPU_BUFFER_MATERIALS, HL_GPU_BUFFER_TABLES, HL_GPU_BUFFER_SHADES}) {
                    hl_gpu_buffer_info info{};
                    info.size = sizeof info;
                    ASSERT_EQ(hl_gpu_buffer(&opened, buffer, &info, &error), HL_OK);
                    ASSERT_EQ(hl_gpu_fill(&opened, buffer, room.data(), info.bytes, &error), HL_OK);
                    ++used;
                }
            }
            copy.span()[at] = was;
        }
    }
    EXPECT_GT(refused, 10u);
    EXPECT_GT(used, 100u);
}

TEST_F(RuntimeDamage, MaterialsThatDoNotFitAreRefusedWithWords) {
    const auto plain = written(wholeGroom());
    const std::size_t hairs = runtime::Asset::open(plain).asset->hairCount();
    const auto refused = [&](const auto& change, const char* words) {
        StrandExportOptions options = withLooks(hairs);
        auto looks = std::make_shared<HairLooks>(*options.looks);
        change(*looks);
        options.looks = looks;
        const auto path = folder / "wrong.hairrt";
        const auto made = strandWriter("runtime").write(wholeGroom(), path, options);
        // The writer reads its file back: what it cannot play it does not write.
        ASSERT_FALSE(made) << words;
        EXPECT_THAT(made.error().message(), testing::HasSubstr(words));
    };
    refused([](HairLooks& l) { l.materials.push_back(l.materials[0]); }, "2 materials; the layers have 1");
    refused([](HairLooks& l) { l.materials[0].table = 1; }, "whose tables are not in the file");
    refused([](HairLooks& l) { l.materials[0].model = 2; }, "of a kind that there is not");
    refused([](HairLooks& l) { l.materials[0].widths[1] = 0; }, "without widths");
    refused([](HairLooks& l) { l.materials[0].dye[2] = std::numeric_limits<float>::infinity(); },
            "with a number beyond 1e6");
    refused([](HairLooks& l) { l.tables.pop_back(); }, "numbers of tables; expected");
    refused([](HairLooks& l) { l.tables[77] = 0x7e00; }, "a table of what is no number");
    refused([](HairLooks& l) { l.hairs.pop_back(); }, "looks of");
}

TEST_F(RuntimeDamage, AnyEarlierEndIsRefusedWithItsPlace) {
    const auto bytes = written(helices({5, 6}));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        AssetBytes copy({bytes.data(), size});
        const auto opened = runtime::Asset::open(copy.span());
        ASSERT_FALSE(opened.asset) << size;
        EXPECT_FALSE(opened.error.words.empty());
    }
    AssetBytes copy(bytes);
    EXPECT_EQ(runtime::Asset::open(copy.span().subspan(8)).error.kind, AssetError::Kind::misaligned);
}

template <class T>
void store(std::span<std::byte> bytes, std::size_t at, T value) {
    at -= at % sizeof value;
    if (at + sizeof value <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// One to three bytes or numbers behind the table, or rarely before it: at random, or such as break sums.
void damage(AssetBytes& asset, std::mt19937& random) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    constexpr float kFloats[] = {
        kNone, std::numeric_limits<float>::infinity(), 3e38f, -3e38f, 1e20f, 1e6f, -1, 0, 1e-42f, 1000};
    constexpr double kDoubles[] = {static_cast<double>(kNone), 1e300, -1e300, 1e39, 4294967295.0, -1, 0, 0.5};
    const std::span<std::byte> bytes = asset.span();
    const std::size_t content = sizeof(format::Header) + asset.table().size_bytes();
    const auto draw = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
    for (std::size_t more = 1 + draw(3); more > 0; --more) {
        const std::size_t at = draw(10) == 0 ? draw(content) : content + draw(bytes.size() - content);
        switch (draw(4)) {
            case 0:
                bytes[at] ^= static_cast<std::byte>(1 + draw(255));
                break;
            case 1:
                store(bytes, at, kFloats[draw(std::size(kFloats))]);
                break;
            case 2:
                store(bytes, at, kDoubles[draw(std::size(kDoubles))]);
                break;
            default:
                store(bytes, at, static_cast<std::uint32_t>(random()));
                break;
        }
    }
}

/// Whether the table leads to places in the file, so that there is something to take checksums of.
bool liesWithin(AssetBytes& asset) {
    const std::size_t size = asset.span().size();
    if ((size - sizeof(format::Header)) / sizeof(format::Section) < asset.header().sections) return false;
    return std::ranges::all_of(asset.table(), [&](const format::Section& section) {
        return section.offset <= size && section.bytes <= size - section.offset;
    });
}

using Matrix = Eigen::Affine3f;

Matrix inverseBind(const game::Asset& asset, std::uint32_t number) {
    hl_bone bone{};
    EXPECT_EQ(hl_asset_bone(asset.get(), number, &bone, nullptr), HL_OK);
    Matrix matrix = Matrix::Identity();
    for (int i = 0; i < 12; ++i) matrix(i / 4, i % 4) = bone.inverse_bind[i];
    return matrix;
}

/// Positions, tangents and radii of guides and of follow hairs.
std::vector<float> readAll(game::Instance& hair) {
    const hl_instance_info info = hair.describe();
    std::vector<float> all;
    const auto read = [&](std::size_t points, const auto& call) {
        std::vector<float> values(7 * points);
        const auto out = [&](std::size_t first) {
            return hl_out{values.data() + first, (values.size() - first) * sizeof(float), 7 * sizeof(float)};
        };
        if (points == 0) return;
        EXPECT_EQ(call(hair.get(), out(0), out(3), out(6), nullptr), HL_OK);
        all.insert(all.end(), values.begin(), values.end());
    };
    read(info.guide_points, hl_instance_read_guides);
    read(std::size_t{info.hairs} * info.points_per_hair, hl_instance_read_hairs);
    return all;
}

/// What a game does with an asset whose checksums are right. `bindPoses` are those of the whole one. False
/// where the asset is refused; the test fails where a number comes out that is none.
bool plays(const game::Asset& asset, const std::vector<Matrix>& bindPoses, std::uint32_t what,
           const std::string& which) {
    game::Error error;
    game::Instance hair;
    if (!asset.check(&error)) {
        EXPECT_EQ(error.code == HL_DAMAGED || error.code == HL_NEWER, true) << which;
        return false;
    }
    if (!hair.make(asset, what, nullptr, &error)) return false;
    const hl_asset_info info = asset.describe();
    for (const float bound : {info.bounds_min[0], info.bounds_max[2], info.greatest_error})
        EXPECT_TRUE(std::isfinite(bound)) << which;
    for (int f = 1; f <= 6; ++f) {
        const Matrix head = Matrix(Eigen::AngleAxisf(0.05f * static_cast<float>(f), Vec3f::UnitX()));
        const std::array<float, 12> matrix = rows(head);
        std::vector<float> bones;
        for (std::uint32_t b = 0; b < bindPoses.size() && bindPoses.size() == info.bones; ++b) {
            const auto skinning = rows(head * bindPoses[b] * inverseBind(asset, b));
            bones.insert(bones.end(), skinning.begin(), skinning.end());
        }
        game::Frame frame;
        frame.time = f / 60.0;
        frame.head = matrix.data();
        if (f > 3) {
            frame.bones = bones.empty() ? nullptr : bones.data();
            frame.bone_count = bones.size() / 12;
        }
        EXPECT_TRUE(hair.step(frame, &error)) << which << ": " << error.what();
        if (what & HL_LEVELS) {
            EXPECT_TRUE(hair.setLevel(static_cast<std::uint32_t>(f) % HL_LEVEL_COUNT)) << which;
        }
        const std::vector<float> values = readAll(hair);
        const auto bad = std::ranges::find_if(values, [](float value) { return !std::isfinite(value); });
        if (bad == values.end()) continue;
        ADD_FAILURE() << which << ", frame " << f << ": value " << (bad - values.begin()) % 7 << " of point "
                      << (bad - values.begin()) / 7 << " of " << info.guide_points << " and hairs is "
                      << *bad;
        break;
    }
    return true;
}

TEST_F(RuntimeDamage, HairOfDamageWithRightChecksumsIsRefusedOrFinite) {
    Groom groom = character().groom;
    groom.interpolation.followPerGuide = 3;
    groom.interpolation.blend = 0.7f;
    groom.simulation.windSpeed = 3;
    for (const auto model : {runtime::StrandModel::rods, runtime::StrandModel::springs}) {
        groom.simulation.strandModel = model;
        const auto bytes = written(groom);
        game::Asset sound;
        ASSERT_TRUE(sound.open(bytes.data(), bytes.size()));
        std::vector<Matrix> bindPoses;
        for (std::uint32_t b = 0; b < sound.describe().bones; ++b)
            bindPoses.push_back(inverseBind(sound, b).inverse());
        ASSERT_FALSE(bindPoses.empty());
        ASSERT_TRUE(plays(sound, bindPoses, HL_HAIRS | HL_LEVELS, "the whole asset"));
        std::size_t refused = 0, played = 0;
        for (std::uint32_t seed = 0; seed < 600; ++seed) {
            std::mt19937 random(seed);
            AssetBytes copy(bytes);
            damage(copy, random);
            if (!liesWithin(copy)) continue;
            copy.seal();
            game::Asset asset;
            const bool opened = asset.open(copy.span().data(), copy.span().size());
            const std::uint32_t what = seed % 10 == 0 ? HL_HAIRS | HL_LEVELS : HL_HAIRS;
            const bool used = opened && plays(asset, bindPoses, what, "seed " + std::to_string(seed));
            ++(used ? played : refused);
        }
        EXPECT_GT(refused, 100u);
        EXPECT_GT(played, 100u);
    }
}

}  // namespace
}  // namespace hairloom::test
