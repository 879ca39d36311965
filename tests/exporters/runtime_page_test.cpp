// SPDX-License-Identifier: GPL-3.0-or-later
// A reader of runtime assets that knows nothing but the tables of docs/formats/runtime.md.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "core/groom/poses.h"
#include "tests/exporters/asset_samples.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {
namespace {

struct PageField {
    std::size_t byte;
    std::string type;
    std::size_t count;
};
/// Of the header, the table and each kind of section: its fields by name.
using Page = std::map<std::string, std::map<std::string, PageField>>;

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" `"), last = text.find_last_not_of(" `");
    return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

Page readPage() {
    std::ifstream file(sourceDir() / "docs/formats/runtime.md");
    Page page;
    std::string heading;
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("## ", 0) == 0) heading = line.substr(3);
        std::vector<std::string> columns;
        std::stringstream cells(line);
        for (std::string cell; std::getline(cells, cell, '|');) columns.push_back(trimmed(cell));
        if (columns.size() < 5 || columns[1].find_first_not_of("0123456789") != std::string::npos ||
            columns[1].empty())
            continue;
        PageField field{std::stoul(columns[1]), columns[2], 1};
        if (const std::size_t bracket = field.type.find('['); bracket != std::string::npos) {
            field.count = std::stoul(field.type.substr(bracket + 1));
            field.type.resize(bracket);
        }
        page[heading][columns[3]] = field;
    }
    return page;
}

std::size_t sizeOfType(const std::string& type) {
    return std::stoul(type.substr(1)) / 8;
}

double valueAt(const std::byte* at, const std::string& type) {
    const auto as = [&]<class T>(T value) {
        std::memcpy(&value, at, sizeof value);
        return static_cast<double>(value);
    };
    if (type == "u8") return as(std::uint8_t{});
    if (type == "u16") return as(std::uint16_t{});
    if (type == "i16") return as(std::int16_t{});
    if (type == "u32") return as(std::uint32_t{});
    if (type == "i32") return as(std::int32_t{});
    if (type == "u64") return as(std::uint64_t{});
    if (type == "f32") return as(float{});
    ADD_FAILURE() << "the page has the type " << type;
    return 0;
}

class PageReader {
  public:
    PageReader(const Page& page, std::span<const std::byte> bytes) : page_(page), bytes_(bytes) {
        const std::size_t first = static_cast<std::size_t>(header("headerBytes"));
        for (std::size_t s = 0; s < static_cast<std::size_t>(header("sections")); ++s) {
            const std::size_t record = first + s * recordBytes("table");
            std::string kind;
            for (std::size_t c = 0; c < 4; ++c) kind += static_cast<char>(value(record, "table", "kind", c));
            sections_[kind] = record;
        }
    }
    double header(const std::string& name, std::size_t i = 0) const { return value(0, "header", name, i); }
    std::size_t count(const std::string& kind) const { return table(kind, "count"); }
    std::size_t table(const std::string& kind, const std::string& name) const {
        const auto found = sections_.find(kind);
        return found == sections_.end() ? 0 : static_cast<std::size_t>(value(found->second, "table", name));
    }
    double record(const std::string& kind, std::size_t r, const std::string& name, std::size_t i = 0) const {
        return value(table(kind, "offset") + r * recordBytes(kind), kind, name, i);
    }
    const std::byte* at(const std::string& kind) const { return bytes_.data() + table(kind, "offset"); }
    /// As the tables of the page have it.
    std::size_t recordBytes(const std::string& kind) const {
        std::size_t end = 0;
        for (const auto& [name, field] : page_.at(kind))
            end = std::max(end, field.byte + field.count * sizeOfType(field.type));
        return end;
    }
    std::string text(double at, double bytes) const {
        return {reinterpret_cast<const char*>(this->at("TEXT")) + static_cast<std::size_t>(at),
                static_cast<std::size_t>(bytes)};
    }

  private:
    double value(std::size_t record, const std::string& kind, const std::string& name,
                 std::size_t i = 0) const {
        const PageField& field = page_.at(kind).at(name);
        EXPECT_LT(i, field.count);
        return valueAt(bytes_.data() + record + field.byte + i * sizeOfType(field.type), field.type);
    }

    const Page& page_;
    std::span<const std::byte> bytes_;
    std::map<std::string, std::size_t> sections_;
};

/// As the page says of residualBytes.
std::int64_t residual(const std::byte* at, int bytes, int axis) {
    if (bytes == 4) {
        const auto bits = (static_cast<std::uint32_t>(valueAt(at, "u32")) >> (10 * axis)) & 1023u;
        return bits < 512 ? static_cast<std::int64_t>(bits) : static_cast<std::int64_t>(bits) - 1024;
    }
    return static_cast<std::int64_t>(bytes == 6 ? valueAt(at + 2 * axis, "i16")
                                                : valueAt(at + 4 * axis, "i32"));
}

std::vector<Vec3f> positionsBy(const PageReader& reader) {
    std::vector<Vec3f> positions;
    const std::byte* next = reader.at("PNTS");
    for (std::size_t s = 0; s < reader.count("STRD"); ++s) {
        const int bytes = static_cast<int>(reader.record("STRD", s, "residualBytes"));
        const double step = std::ldexp(1.0, -static_cast<int>(reader.record("STRD", s, "gridBits")));
        const auto points = static_cast<std::size_t>(reader.record("STRD", s, "points"));
        std::vector<std::array<double, 3>> q(points);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            q[0][axis] = reader.record("STRD", s, "root", axis);
            q[1][axis] = q[0][axis] + reader.record("STRD", s, "first", axis);
            for (std::size_t i = 2; i < points; ++i)
                q[i][axis] = 2 * q[i - 1][axis] - q[i - 2][axis] +
                             static_cast<double>(residual(next + (i - 2) * static_cast<std::size_t>(bytes),
                                                          bytes, static_cast<int>(axis)));
        }
        next += (points - 2) * static_cast<std::size_t>(bytes);
        for (const auto& [x, y, z] : q)
            positions.emplace_back(static_cast<float>(x * step), static_cast<float>(y * step),
                                   static_cast<float>(z * step));
    }
    return positions;
}

class RuntimePage : public AssetTest {};

TEST_F(RuntimePage, IsEnoughToReadAFileBy) {
    Groom groom = dome(4, 2, 12, 0.1f);
    groom.interpolation.followPerGuide = 6;
    groom.simulation.windSpeed = 3.5f;
    groom.spheres = {{"skull", Vec3f(0, 1.6f, 0.25f), 0.09f, ""}};
    groom.pointAttributes.edit<Vec3f>(attribute::kPosition)[5] +=
        Vec3f(0.03f, 0, 0);                                                         // residuals of six bytes
    groom.pointAttributes.edit<Vec3f>(attribute::kPosition)[15] += Vec3f(3, 0, 0);  // and of twelve
    groom.pointAttributes.set(attribute::kRadius, std::vector<float>(groom.pointCount(), 0x1p-14f));
    const std::size_t hairs = 6 * groom.strandCount();
    const auto bytes = written(groom, nullptr, withLooks(hairs));
    const auto opened = runtime::Asset::open(bytes);
    ASSERT_TRUE(opened.asset);
    const Page page = readPage();
    const PageReader reader(page, bytes);

    EXPECT_EQ(reader.header("magic", 0), 0x89);
    EXPECT_EQ(reader.header("major"), 1);
    EXPECT_EQ(reader.header("fileBytes"), static_cast<double>(bytes.size()));
    for (const auto& section : opened.asset->sections()) {
        const std::string kind(section.kind);
        EXPECT_EQ(reader.count(kind), section.count) << kind;
        EXPECT_EQ(reader.table(kind, "offset") % 16, 0u);
        if (page.contains(kind))
            EXPECT_EQ(reader.recordBytes(kind), reader.table(kind, "recordBytes")) << kind;
        else
            EXPECT_THAT(kind, testing::AnyOf("PNTS", "GHRS", "BODY", "SHFT", "RADI", "SLYR", "ATTV", "VALS",
                                             "TEXT", "FIBT"));
    }
    const auto positions = positionsBy(reader);
    const auto strands = opened.asset->strandsAtRest();
    ASSERT_EQ(positions.size(), strands.positions_ss.size());
    EXPECT_EQ(reader.header("points"), static_cast<double>(positions.size()));
    std::set<double> residualBytes;
    for (std::size_t s = 0; s < reader.count("STRD"); ++s)
        residualBytes.insert(reader.record("STRD", s, "residualBytes"));
    EXPECT_EQ(residualBytes, (std::set<double>{4, 6, 12}));
    for (std::size_t p = 0; p < positions.size(); ++p) {
        const auto& at = strands.positions_ss[p];
        ASSERT_EQ(positions[p], Vec3f(at.x, at.y, at.z)) << p;
        ASSERT_LT((positions[p] - groom.positions()[p]).norm(), 0.00005f);
        ASSERT_EQ(valueAt(reader.at("RADI") + 2 * p, "u16") * 0x1p-24, 0x1p-14);
    }
    for (std::size_t s = 0; s < reader.count("ROOT"); ++s) {
        const double b = reader.record("ROOT", s, "b") / 65535, c = reader.record("ROOT", s, "c") / 65535;
        const auto triangle = static_cast<std::size_t>(reader.record("ROOT", s, "triangle"));
        Vec3f root = Vec3f::Zero();
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto vertex = static_cast<std::size_t>(reader.record("STRI", triangle, "vertices", corner));
            const double share = corner == 0 ? 1 - b - c : corner == 1 ? b : c;
            for (std::size_t axis = 0; axis < 3; ++axis)
                root[static_cast<int>(axis)] +=
                    static_cast<float>(share * reader.record("SVTX", vertex, "position", axis));
        }
        EXPECT_LT((root - groom.strand(s).front()).norm(), 1e-5f);
    }
    EXPECT_EQ(reader.text(reader.record("SPHR", 0, "nameAt"), reader.record("SPHR", 0, "nameBytes")),
              "skull");
    EXPECT_EQ(reader.record("SPHR", 0, "centre", 2), 0.25);
    EXPECT_EQ(reader.record("SPHR", 0, "bone"), -1);
    EXPECT_EQ(reader.record("FLLW", 0, "hairsPerGuide"), 6);
    EXPECT_EQ(reader.record("FLLW", 0, "pointsPerHair"), 12);
    EXPECT_EQ(reader.header("minor"), 4);
    ASSERT_EQ(reader.count("MATL"), 1u);
    EXPECT_EQ(reader.record("MATL", 0, "root", 2), 0.125);
    EXPECT_EQ(reader.record("MATL", 0, "absorbs"), 1);
    EXPECT_EQ(static_cast<float>(reader.record("MATL", 0, "widths", 2)), 0.2f);
    EXPECT_EQ(reader.record("MATL", 0, "clumping"), 0.75);
    EXPECT_EQ(reader.record("MATL", 0, "model"), 1);
    EXPECT_EQ(reader.record("MATL", 0, "axisRatio"), 1);
    ASSERT_EQ(reader.count("HLOK"), hairs);
    EXPECT_EQ(reader.record("HLOK", 5, "streak"), 5);
    EXPECT_EQ(reader.record("HLOK", 5, "dye"), 10);
    EXPECT_EQ(reader.record("HLOK", 5, "pigment"), 4096);
    EXPECT_EQ(reader.record("HLOK", 5, "length"), 100);
    EXPECT_EQ(valueAt(reader.at("FIBT") + 2 * 1027, "u16"), 0x3003);
    std::map<std::string, double> settings;
    for (std::size_t s = 0; s < reader.count("SETT"); ++s) {
        const auto first = static_cast<std::size_t>(reader.record("SETT", s, "firstValue"));
        double value = 0;
        std::memcpy(&value, reader.at("VALS") + 8 * first, sizeof value);
        settings[reader.text(reader.record("SETT", s, "nameAt"), reader.record("SETT", s, "nameBytes"))] =
            value;
    }
    EXPECT_EQ(settings.at("simulation.windSpeed"), 3.5);
    EXPECT_EQ(settings.at("interpolation.followPerGuide"), 6);
}

TEST_F(RuntimePage, IsEnoughToReadPosesBy) {
    Groom groom = helices({3, 7, 12});
    std::vector<Vec3f> shape(groom.positions().begin(), groom.positions().end());
    for (Vec3f& at : shape) at = Vec3f(at.y(), -at.z(), 0.4f * at.x());
    ASSERT_TRUE(putPose(groom, "Wet", groom.positions()));
    ASSERT_TRUE(putPose(groom, "Swept", shape));
    groom.poses[1].amount = 0.625f;
    groom.poses[1].ramp = runtime::Ramp::straight(1, 0);
    const auto bytes = written(groom);
    const Page page = readPage();
    const PageReader reader(page, bytes);
    EXPECT_EQ(reader.header("minor"), 5);
    ASSERT_EQ(reader.count("POSE"), 2u);
    for (const char* kind : {"POSE", "POSD"})
        EXPECT_EQ(reader.recordBytes(kind), reader.table(kind, "recordBytes")) << kind;
    EXPECT_EQ(reader.text(reader.record("POSE", 0, "nameAt"), reader.record("POSE", 0, "nameBytes")), "Wet");
    EXPECT_EQ(reader.text(reader.record("POSE", 1, "nameAt"), reader.record("POSE", 1, "nameBytes")),
              "Swept");
    EXPECT_EQ(reader.record("POSE", 1, "amount"), 0.625);
    EXPECT_EQ(reader.record("POSE", 0, "weights"), 0);
    ASSERT_EQ(reader.record("POSE", 1, "weights"), 1);
    const std::size_t points = groom.pointCount(), segments = points - groom.strandCount();
    ASSERT_EQ(reader.count("POSD"), 2 * segments);
    ASSERT_EQ(reader.count("POSW"), points);
    const std::vector<float> weights = poseWeights(groom, groom.poses[1]);
    std::size_t record = segments;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (std::size_t p = groom.offsets[s]; p < groom.offsets[s + 1]; ++p) {
            EXPECT_NEAR(valueAt(reader.at("POSW") + p, "u8") / 255, double{weights[p]}, 0.00201) << p;
            if (p == groom.offsets[s]) continue;
            double x = std::max(-1.0, reader.record("POSD", record, "direction", 0) / 32767);
            double y = std::max(-1.0, reader.record("POSD", record, "direction", 1) / 32767);
            const double z = 1 - std::abs(x) - std::abs(y);
            if (z < 0) {
                const double flat = x;
                x = (1 - std::abs(y)) * (flat < 0 ? -1 : 1);
                y = (1 - std::abs(flat)) * (y < 0 ? -1 : 1);
            }
            const Vec3d expected = (shape[p] - shape[p - 1]).cast<double>().normalized();
            EXPECT_LT((Vec3d(x, y, z).normalized() - expected).norm(), 5e-5) << p;
            ++record;
        }
    }
    EXPECT_EQ(record, 2 * segments);
}

/// Bits of CLPD, as the page has them.
class PageBits {
  public:
    PageBits(const std::byte* at, std::size_t bytes) : at_(at), bits_(8 * bytes) {}
    std::uint64_t take(std::size_t count) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < count; ++i, ++next_) {
            EXPECT_LT(next_, bits_);
            if (next_ >= bits_) return 0;
            const auto byte = static_cast<unsigned>(at_[next_ / 8]);
            value |= std::uint64_t{(byte >> (next_ % 8)) & 1u} << i;
        }
        return value;
    }
    double residual(std::size_t k) {
        std::uint64_t ones = 0;
        while (ones < 20 && take(1) == 1) ++ones;
        const std::uint64_t u = ones == 20 ? take(32) : (ones << k) + take(k);
        return u % 2 == 0 ? static_cast<double>(u / 2) : -static_cast<double>((u + 1) / 2);
    }
    std::size_t left() const { return bits_ - next_; }

  private:
    const std::byte* at_;
    std::size_t bits_, next_ = 0;
};

TEST_F(RuntimePage, IsEnoughToReadAClipBy) {
    Groom groom = helices({2, 5, 12, 40});
    ClipToWrite clip;
    clip.name = "wave";
    clip.framesPerSecond = 24;
    clip.frames = 37;
    clip.frame = [&](std::uint64_t frame) -> Result<ClipToWrite::Frame> {
        ClipToWrite::Frame made;
        for (std::size_t p = 0; p < groom.pointCount(); ++p) {
            Vec3f at = groom.positions()[p];
            const float t = static_cast<float>(frame), drop = 1.7f - at.y();
            at += drop * Vec3f(0.3f * std::sin(0.3f * t), 0, 0.1f * std::cos(0.8f * t + at.x()));
            if (p == 30 && frame == 20) at.z() += 90;  // a number of 32 bits
            made.positions_ws.push_back(at);
        }
        return made;
    };
    StrandExportOptions options;
    options.clip = std::make_shared<const ClipToWrite>(clip);
    const auto path = folder / "clip.hairrt";
    const auto report = strandWriter("runtime").write(groom, path, options);
    ASSERT_TRUE(report) << report.error().message();
    const auto bytes = readFile(path).value();
    const Page page = readPage();
    const PageReader reader(page, bytes);
    EXPECT_EQ(reader.header("minor"), 3);
    ASSERT_EQ(reader.count("CLIP"), 1u);
    EXPECT_EQ(reader.recordBytes("CLIP"), reader.table("CLIP", "recordBytes"));
    EXPECT_EQ(reader.text(reader.record("CLIP", 0, "nameAt"), reader.record("CLIP", 0, "nameBytes")), "wave");
    EXPECT_EQ(reader.record("CLIP", 0, "framesPerSecond"), 24);
    EXPECT_EQ(reader.record("CLIP", 0, "loops"), 0);
    const auto frames = static_cast<std::size_t>(reader.record("CLIP", 0, "frames"));
    const auto perBlock = static_cast<std::size_t>(reader.record("CLIP", 0, "framesPerBlock"));
    const double cell = std::ldexp(1.0, -static_cast<int>(reader.record("CLIP", 0, "gridBits")));
    const double stated = reader.record("CLIP", 0, "largestError");
    EXPECT_EQ(frames, 37u);
    EXPECT_LE(stated, 0.0001);
    const std::size_t strands = reader.count("STRD"), blocks = (frames + perBlock - 1) / perBlock;
    ASSERT_EQ(reader.count("CLPI"), blocks * strands + 1);
    const auto placeAt = [&](std::size_t record) {
        return static_cast<std::size_t>(valueAt(reader.at("CLPI") + 4 * record, "u32"));
    };
    EXPECT_EQ(placeAt(blocks * strands), reader.table("CLPD", "bytes"));
    const auto rest = positionsBy(reader);
    double largest = 0;
    for (std::size_t s = 0, first = 0; s < strands; ++s) {
        const auto points = static_cast<std::size_t>(reader.record("STRD", s, "points"));
        // By frame of the block, axis and point; the root has zeros.
        using Cells = std::array<std::vector<double>, 3>;
        Cells none;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t p = 0; p < points; ++p)
                none[axis].push_back(std::round((double{rest[first + p][static_cast<int>(axis)]} -
                                                 double{rest[first][static_cast<int>(axis)]}) /
                                                cell));
        }
        for (std::size_t b = 0; b < blocks; ++b) {
            const std::size_t from = placeAt(b * strands + s), to = placeAt(b * strands + s + 1);
            PageBits bits(reader.at("CLPD") + from, to - from);
            std::vector<Cells> block;
            for (std::size_t f = 0; f < std::min(perBlock, frames - b * perBlock); ++f) {
                const auto way = static_cast<std::size_t>(bits.take(4));
                const std::size_t time = way / 3, along = way % 3;
                ASSERT_LE(time, std::min<std::size_t>(f, 2));
                std::array<std::size_t, 3> k{};
                for (std::size_t& low : k) low = static_cast<std::size_t>(bits.take(4));
                Cells now;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    now[axis].assign(points, 0);
                    std::vector<double> d(points, 0);
                    for (std::size_t p = 1; p < points; ++p) {
                        d[p] = k[axis] == 15 ? 0 : bits.residual(k[axis]);
                        if (along == 1) d[p] += d[p - 1];
                        if (along == 2) d[p] += 2 * d[p - 1] - (p > 1 ? d[p - 2] : 0);
                        now[axis][p] =
                            d[p] + (time == 0   ? none[axis][p]
                                    : time == 1 ? block[f - 1][axis][p]
                                                : 2 * block[f - 1][axis][p] - block[f - 2][axis][p]);
                    }
                }
                const auto given = clip.frame(b * perBlock + f)->positions_ws;
                for (std::size_t p = 1; p < points; ++p) {
                    // The head stands.
                    const Vec3d at =
                        rest[first].cast<double>() + cell * Vec3d(now[0][p], now[1][p], now[2][p]);
                    largest = std::max(largest, (at - given[first + p].cast<double>()).norm());
                }
                block.push_back(std::move(now));
            }
            EXPECT_LT(bits.left(), 8u);
            EXPECT_EQ(bits.take(bits.left()), 0u);
        }
        first += points;
    }
    EXPECT_LE(largest, stated);
    EXPECT_GT(largest, 0.2 * stated) << "the stated error is that of the file";
}

}  // namespace
}  // namespace hairloom::test
