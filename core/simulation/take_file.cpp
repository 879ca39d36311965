// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/take_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <optional>

#include "core/base/checksum.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/regular_file.h"
#include "core/base/write_rules.h"
#include "core/simulation/frame_vectors.h"
#include "core/simulation/take_codec.h"

namespace hairloom {
namespace {

constexpr std::array<char, 8> kTakeMagic{'H', 'L', 'T', 'A', 'K', 'E', '\r', '\n'};
constexpr std::array<char, 4> kBlockMagic{'B', 'L', 'C', 'K'};
constexpr std::uint32_t kTakeVersion = 1;
constexpr std::uint32_t kMostNotes = 1u << 20u;  ///< bytes
/// In a frame. A block of so many has less than the 4 GiB that zlib counts on every machine.
constexpr float kSlowest = 0.01f, kFastest = 10'000;  // frames a second
constexpr std::uint64_t kMostVectors = std::uint64_t{1} << 24u;

struct TakeHead {
    std::array<char, 8> magic = kTakeMagic;
    std::uint32_t version = kTakeVersion;
    float framesPerSecond = 0;
    std::uint64_t frames = 0;  ///< 0 until it is finished
    FrameCounts counts;
    std::uint64_t shapeHash = 0;
    float grid = take::kGrid;
    float largestError = 0;
    std::uint32_t noteBytes = 0;
    std::uint32_t reserved = 0;
    std::uint64_t hash = 0;  ///< of what is before, then of the notes behind it
};
static_assert(sizeof(TakeHead) == 88);

struct BlockHead {
    std::array<char, 4> magic = kBlockMagic;
    std::uint32_t frames = 0;
    std::uint64_t first = 0;   ///< frame
    std::uint64_t packed = 0;  ///< bytes behind this head
    std::uint64_t raw = 0;     ///< bytes that they unpack to
    std::uint64_t hash = 0;    ///< of what is before, then of the packed bytes
};
static_assert(sizeof(BlockHead) == 40);

template <class Head>
std::uint64_t hashWith(const Head& head, std::span<const std::byte> behind) {
    const auto bytes = std::as_bytes(std::span(&head, 1)).first(offsetof(Head, hash));
    return hashBytes(behind, hashBytes(bytes));
}

std::span<const std::byte> textBytes(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

constexpr std::uint8_t kRigid = 1, kHasBody = 2;
constexpr std::size_t kMatrixFloats = 12;

std::uint64_t mostBytesOfFrame(const FrameCounts& counts) {
    return 1 + kMatrixFloats * sizeof(float) + counts.bones * kVectorsPerBone * sizeof(Vec3f) +
           take::Predictor::mostBytes(static_cast<std::size_t>(counts.points)) +
           take::Predictor::mostBytes(static_cast<std::size_t>(counts.vertices + counts.spheres));
}

/// The roots of strands, and the first of what they are not.
std::vector<std::uint32_t> rootsOf(const Groom& groom) {
    const auto offsets = groom.offsets.view();
    return {offsets.begin(), offsets.end() - (offsets.empty() ? 0 : 1)};
}

/// What both sides know of a groom.
struct TakeCoder {
    explicit TakeCoder(const Groom& groom)
        : counts(frameCounts(groom)),
          vectors(groom),
          points(rootsOf(groom), groom.pointCount()),
          head({0}, static_cast<std::size_t>(counts.vertices + counts.spheres)) {}
    void beginBlock() {
        points.beginBlock();
        head.beginBlock();
    }

    FrameCounts counts;
    FrameVectors vectors;
    take::Predictor points, head;
};

}  // namespace

std::uint64_t takeShapeHash(const Groom& groom) {
    std::uint64_t hash = hashOf(groom.offsets.view());
    hash = hashOf(groom.positions(), hash);
    if (groom.scalp) hash = hashOf(std::span<const Vec3f>(groom.scalp->positions()), hash);
    return hash;
}

// --- Writing ---

struct TakeWriter::Impl {
    Impl(OutputFile opened, const Groom& groom) : file(std::move(opened)), coder(groom) {}

    OutputFile file;
    TakeCoder coder;
    TakeHead header;
    std::string notes;
    std::uint64_t bytes = 0;
    std::vector<std::byte> block;
    std::uint32_t framesInBlock = 0;
    bool isFull = false;  ///< the disk has taken half of a block

    Result<take::GridFrame> measuredOnGrid(std::span<const Vec3f> vectors);
    Status writeHeader(bool isFirst);
    Status writeBlock();
};

TakeWriter::TakeWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TakeWriter::TakeWriter(TakeWriter&&) noexcept = default;
TakeWriter& TakeWriter::operator=(TakeWriter&&) noexcept = default;
TakeWriter::~TakeWriter() = default;

Status TakeWriter::Impl::writeHeader(bool isFirst) {
    header.hash = hashWith(header, textBytes(notes));
    const auto head = std::as_bytes(std::span(&header, 1));
    if (!isFirst) return file.writeAt(0, head);
    if (auto status = file.write(head); !status) return status;
    bytes = head.size() + notes.size();
    return file.write(textBytes(notes));
}

Result<TakeWriter> TakeWriter::open(const std::filesystem::path& path, const Groom& groom,
                                    float framesPerSecond, std::string notes) {
    const FrameCounts counts = frameCounts(groom);
    if (counts.points + counts.vertices + counts.spheres > kMostVectors)
        return fail(
            fmt::format("the groom has {} points, and its head {} vertices", counts.points, counts.vertices),
            fmt::format("takes have at most {} of both", kMostVectors));
    if (notes.size() > kMostNotes)
        return fail(fmt::format("the notes have {} bytes", notes.size()),
                    fmt::format("expected {} at most", kMostNotes));
    auto file = OutputFile::open(path, content::kTake);
    if (!file) return tl::unexpected(file.error());
    auto impl = std::make_unique<Impl>(std::move(*file), groom);
    impl->header.framesPerSecond = framesPerSecond;
    impl->header.counts = counts;
    impl->header.shapeHash = takeShapeHash(groom);
    impl->header.noteBytes = static_cast<std::uint32_t>(notes.size());
    impl->notes = std::move(notes);
    if (auto status = impl->writeHeader(true); !status) return tl::unexpected(status.error());
    return TakeWriter(std::move(impl));
}

Result<take::GridFrame> TakeWriter::Impl::measuredOnGrid(std::span<const Vec3f> vectors) {
    auto grid = take::onGrid(vectors);
    if (!grid) return grid;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        const Vec3d was = vectors[i].cast<double>(), is = take::offGrid(&(*grid)[3 * i]).cast<double>();
        header.largestError = std::max(header.largestError, static_cast<float>((is - was).norm()));
    }
    return grid;
}

Status TakeWriter::add(std::span<const Vec3f> positions_ws, const HeadPose& pose) {
    Impl& impl = *impl_;
    const auto failed = [&](const Error& error) {
        return fail(fmt::format("frame {}: {}", frames(), error.problem), error.expected);
    };
    if (impl.isFull) return failed({{}, {}, "a block before it could not be written", {}});
    if (positions_ws.size() != impl.header.counts.points)
        return failed({{},
                       {},
                       fmt::format("has {} points", positions_ws.size()),
                       fmt::format("expected {}", impl.header.counts.points)});
    const bool isRigid = pose.scalpPositions_ws.empty() && pose.sphereCentres_ws.empty();
    std::vector<Vec3f> body, head;
    impl.coder.vectors.appendBody(body, pose);
    if (!isRigid) impl.coder.vectors.appendHead(head, pose);
    const bool hasBody = std::ranges::any_of(body, [](const Vec3f& v) { return v != Vec3f::Zero(); });
    const auto headGrid = impl.measuredOnGrid(head), points = impl.measuredOnGrid(positions_ws);
    const bool isFinite = std::ranges::all_of(body, [](const Vec3f& v) { return v.allFinite(); }) &&
                          pose.head_ws.matrix().allFinite();
    if (!headGrid) return failed(headGrid.error());
    if (!points) return failed(points.error());
    if (!isFinite) return failed({{}, {}, "the head's pose is not finite", {}});

    // Nothing fails from here on but the disk.
    if (impl.framesInBlock == 0) impl.coder.beginBlock();
    impl.block.push_back(static_cast<std::byte>((isRigid ? kRigid : 0) | (hasBody ? kHasBody : 0)));
    const auto append = [&](std::span<const std::byte> bytes) {
        impl.block.insert(impl.block.end(), bytes.begin(), bytes.end());
    };
    if (hasBody) append(std::as_bytes(std::span(body)));
    if (isRigid) {
        const Eigen::Matrix<float, 3, 4> matrix = pose.head_ws.matrix().topRows<3>();
        append(std::as_bytes(std::span(matrix.data(), kMatrixFloats)));
    } else {
        impl.coder.head.write(*headGrid, impl.block);
    }
    impl.coder.points.write(*points, impl.block);
    ++impl.framesInBlock;
    return impl.framesInBlock == kFramesPerBlock ? impl.writeBlock() : Status();
}

Status TakeWriter::Impl::writeBlock() {
    if (framesInBlock == 0) return {};
    const auto packed = take::packed(block);
    if (!packed) {
        isFull = true;
        return tl::unexpected(packed.error());
    }
    BlockHead head;
    head.frames = framesInBlock;
    head.first = header.frames;
    head.packed = packed->size();
    head.raw = block.size();
    head.hash = hashWith(head, *packed);
    for (const std::span<const std::byte> part : {std::as_bytes(std::span(&head, 1)), std::span(*packed)}) {
        if (auto status = file.write(part); !status) {
            isFull = true;
            return status;
        }
        bytes += part.size();
    }
    file.keepUnfinished();
    header.frames += framesInBlock;
    framesInBlock = 0;
    block.clear();
    return {};
}

Status TakeWriter::finish() {
    if (impl_->isFull) return fail("the disk was full", "its blocks before that are kept");
    if (auto status = impl_->writeBlock(); !status) return status;
    if (auto status = impl_->writeHeader(false); !status) return status;
    return impl_->file.finish();
}

std::uint64_t TakeWriter::frames() const {
    return impl_->header.frames + impl_->framesInBlock;
}
std::uint64_t TakeWriter::bytes() const {
    return impl_->bytes;
}

// --- Reading ---

struct TakeReader::Impl {
    std::string name;
    std::ifstream file;
    TakeHead header;
    TakeInfo info;
    struct Block {
        std::uint64_t at = 0;  ///< byte
        BlockHead head;
    };
    std::vector<Block> blocks;

    std::optional<Groom> groom;
    std::optional<TakeCoder> coder;
    std::size_t openBlock = 0;   ///< that is unpacked
    std::vector<std::byte> raw;  ///< empty: none is
    std::span<const std::byte> left;
    std::uint64_t next = 0;  ///< frame at the front of `left`

    bool readAt(std::uint64_t at, std::span<std::byte> bytes) {
        file.clear();
        file.seekg(static_cast<std::streamoff>(at));
        return static_cast<bool>(
            file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())));
    }
    Status readHeader();
    void findBlocks();
    Status unpack(std::size_t index);
    Result<std::vector<Vec3f>> readNext();
};

TakeReader::TakeReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TakeReader::TakeReader(TakeReader&&) noexcept = default;
TakeReader& TakeReader::operator=(TakeReader&&) noexcept = default;
TakeReader::~TakeReader() = default;

const TakeInfo& TakeReader::info() const {
    return impl_->info;
}

bool isTake(const std::filesystem::path& path) {
    return contentKind(readBeginning(path, kTakeMagic.size())) == content::kTake;
}

Status TakeReader::Impl::readHeader() {
    if (!readAt(0, std::as_writable_bytes(std::span(&header, 1))) || header.magic != kTakeMagic)
        return failIn(name, Byte{0}, "is not a take", "expected a file written by takes --record");
    if (header.version != kTakeVersion)
        return failIn(name, Byte{8}, fmt::format("is version {}", header.version),
                      fmt::format("this program reads version {}", kTakeVersion));
    if (header.noteBytes > kMostNotes)
        return failIn(name, Byte{offsetof(TakeHead, noteBytes)},
                      fmt::format("has {} bytes of notes", header.noteBytes),
                      fmt::format("expected {} at most", kMostNotes));
    info.notes.resize(header.noteBytes);
    if (!readAt(sizeof(TakeHead), std::as_writable_bytes(std::span(info.notes))))
        return failIn(name, Byte{sizeof(TakeHead)}, "is cut short", "expected notes");
    if (!isChecksum(hashWith(header, textBytes(info.notes)), header.hash))
        return failIn(name, Byte{0}, "has a damaged head", "its checksum does not match");
    const bool isFinite = std::isfinite(header.framesPerSecond) && std::isfinite(header.largestError);
    const bool isRate = header.framesPerSecond >= kSlowest && header.framesPerSecond <= kFastest;
    if (!isRate || !isFinite || header.grid != take::kGrid)
        return failIn(
            name, Byte{offsetof(TakeHead, framesPerSecond)},
            fmt::format("has {} frames a second on a grid of {} m", header.framesPerSecond, header.grid),
            fmt::format("expected {} to {}, and {} m", kSlowest, kFastest, take::kGrid));
    const FrameCounts& counts = header.counts;
    if (counts.points > kMostVectors || counts.vertices > kMostVectors || counts.spheres > kMostVectors ||
        counts.bones > kMostBones)
        return failIn(name, Byte{offsetof(TakeHead, counts)},
                      fmt::format("has {} points, {} vertices, {} spheres and {} bones", counts.points,
                                  counts.vertices, counts.spheres, counts.bones),
                      fmt::format("expected {} at most, and {} bones", kMostVectors, kMostBones));
    return {};
}

/// As far as they follow one another. Of a take whose writer was ended the last one must be whole, too.
void TakeReader::Impl::findBlocks() {
    const std::uint64_t most = mostBytesOfFrame(header.counts);
    std::uint64_t at = sizeof(TakeHead) + header.noteBytes;
    while (true) {
        Block block{at, {}};
        BlockHead& head = block.head;
        if (at > info.bytes || info.bytes - at < sizeof(BlockHead) ||
            !readAt(at, std::as_writable_bytes(std::span(&head, 1))))
            break;
        const std::uint64_t behind = info.bytes - at - sizeof(BlockHead);
        if (head.magic != kBlockMagic || head.frames == 0 || head.frames > kFramesPerBlock ||
            head.first != info.frames || head.packed > behind || head.raw > most * head.frames ||
            head.packed > head.raw + head.raw / 100 + 1024)
            break;
        blocks.push_back(block);
        info.frames += head.frames;
        at += sizeof(BlockHead) + head.packed;
    }
    if (header.frames > 0) return;
    while (!blocks.empty()) {
        const Block& last = blocks.back();
        std::vector<std::byte> packed(static_cast<std::size_t>(last.head.packed));
        if (readAt(last.at + sizeof(BlockHead), packed) &&
            isChecksum(hashWith(last.head, packed), last.head.hash))
            return;
        info.frames -= last.head.frames;
        blocks.pop_back();
    }
}

Result<TakeReader> TakeReader::open(const std::filesystem::path& path) {
    auto impl = std::make_unique<Impl>();
    impl->name = path.string();
    if (auto status = checkIsFile(path); !status) return tl::unexpected(status.error());
    impl->file.open(path, std::ios::binary);
    if (!impl->file) return failIn(impl->name, {}, "cannot be read", "expected a take");
    noteInput(path);
    impl->file.seekg(0, std::ios::end);
    impl->info.bytes = static_cast<std::uint64_t>(std::max<std::streamoff>(impl->file.tellg(), 0));
    if (auto status = impl->readHeader(); !status) return tl::unexpected(status.error());
    impl->findBlocks();
    const TakeHead& header = impl->header;
    TakeInfo& info = impl->info;
    info.framesPerSecond = header.framesPerSecond;
    info.points = header.counts.points;
    info.shapeHash = header.shapeHash;
    info.isFinished = header.frames > 0 && header.frames == info.frames;
    info.largestError = header.frames > 0 ? header.largestError : take::kLargestError;
    return TakeReader(std::move(impl));
}

Status TakeReader::use(const Groom& groom) {
    Impl& impl = *impl_;
    if (auto status = checkCounts(impl.header.counts, groom, impl.name, Byte{offsetof(TakeHead, counts)});
        !status)
        return status;
    impl.groom = groom;
    impl.coder.emplace(groom);
    impl.raw.clear();
    return {};
}

Status TakeReader::Impl::unpack(std::size_t index) {
    const Block& wanted = blocks[index];
    const auto damaged = [&](std::string_view how) {
        return failIn(name, Byte{wanted.at},
                      fmt::format("frames {} to {} are damaged: {}", wanted.head.first,
                                  wanted.head.first + wanted.head.frames - 1, how),
                      "other frames can still be read");
    };
    raw.clear();
    std::vector<std::byte> packed(static_cast<std::size_t>(wanted.head.packed));
    if (!readAt(wanted.at + sizeof(BlockHead), packed)) return damaged("the file ends in them");
    if (!isChecksum(hashWith(wanted.head, packed), wanted.head.hash))
        return damaged("their checksum does not match");
    auto bytes = take::unpacked(packed, static_cast<std::size_t>(wanted.head.raw));
    if (!bytes) return damaged(bytes.error().problem);
    raw = std::move(*bytes);
    left = raw;
    openBlock = index;
    next = wanted.head.first;
    coder->beginBlock();
    return {};
}

/// As frameFrom() takes it.
Result<std::vector<Vec3f>> TakeReader::Impl::readNext() {
    const auto take = [&](std::span<std::byte> into) {
        if (left.size() < into.size()) return false;
        std::copy_n(left.begin(), into.size(), into.begin());
        left = left.subspan(into.size());
        return true;
    };
    const auto append = [](std::vector<Vec3f>& values, const take::GridFrame& grid) {
        for (std::size_t i = 0; i < grid.size(); i += 3) values.push_back(take::offGrid(&grid[i]));
    };
    std::byte flags{};
    if (!take({&flags, 1})) return fail("ends before a frame");
    std::vector<Vec3f> body(static_cast<std::size_t>(header.counts.bones * kVectorsPerBone), Vec3f::Zero());
    if ((flags & std::byte{kHasBody}) != std::byte{} && !take(std::as_writable_bytes(std::span(body))))
        return fail("ends in a pose");
    std::vector<Vec3f> head;
    if ((flags & std::byte{kRigid}) != std::byte{}) {
        Eigen::Matrix<float, 3, 4> matrix;
        if (!take(std::as_writable_bytes(std::span(matrix.data(), kMatrixFloats))))
            return fail("ends in a pose");
        HeadPose pose;
        pose.head_ws.matrix().topRows<3>() = matrix;
        coder->vectors.appendHead(head, pose);
    } else {
        const auto grid = coder->head.read(left);
        if (!grid) return tl::unexpected(grid.error());
        append(head, *grid);
    }
    const auto grid = coder->points.read(left);
    if (!grid) return tl::unexpected(grid.error());
    std::vector<Vec3f> values;
    values.reserve(grid->size() / 3 + head.size() + body.size());
    append(values, *grid);
    values.insert(values.end(), head.begin(), head.end());
    values.insert(values.end(), body.begin(), body.end());
    const bool isFinite = std::ranges::all_of(values, [](const Vec3f& v) { return v.allFinite(); });
    if (!isFinite) return fail("has positions that are not finite");
    return values;
}

Result<RecordedFrame> TakeReader::frame(std::uint64_t index) {
    Impl& impl = *impl_;
    if (!impl.coder)
        return failIn(impl.name, {}, "is read without its groom",
                      "expected the groom that it was recorded of");
    if (index >= impl.info.frames)
        return failIn(impl.name, {}, fmt::format("has no frame {}", index),
                      fmt::format("it has {} frames, counted from 0", impl.info.frames));
    const auto behind = std::ranges::upper_bound(impl.blocks, index, {},
                                                 [](const Impl::Block& block) { return block.head.first; });
    const auto wanted = static_cast<std::size_t>(behind - impl.blocks.begin()) - 1;
    if (impl.raw.empty() || impl.openBlock != wanted || impl.next > index) {
        if (auto status = impl.unpack(wanted); !status) return tl::unexpected(status.error());
    }
    while (true) {
        auto values = impl.readNext();
        if (!values) {
            impl.raw.clear();
            return failIn(impl.name, Byte{impl.blocks[wanted].at},
                          fmt::format("frame {} is damaged: {}", impl.next, values.error().problem),
                          "expected a whole take: record it again");
        }
        if (impl.next++ < index) continue;
        RecordedFrame frame = frameFrom(*values, impl.header.counts, *impl.groom);
        frame.framesPerSecond = impl.header.framesPerSecond;
        frame.framesInRecord = impl.info.frames;
        return frame;
    }
}

}  // namespace hairloom
