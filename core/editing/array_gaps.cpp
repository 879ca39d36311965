// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/array_gaps.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/base/parallel.h"

namespace hairloom::editing {
namespace {

/// A run of bytes that stays together.
struct Move {
    std::size_t from;
    std::size_t to;
    std::size_t count;
};

/// One thread's share: moves that follow each other, and a copy of those of its bytes that a neighbour writes
/// over.
struct Piece {
    std::vector<Move> moves;
    Range saved{0, 0};
    std::vector<std::byte> copy;

    std::size_t begin() const { return moves.front().from; }
    std::size_t end() const { return moves.back().from + moves.back().count; }
};

constexpr std::size_t kLeastPiece = std::size_t{1} << 19u;  ///< bytes
constexpr std::size_t kMostPieces = 16;

/// Of about equal size. Few threads gain nothing from pieces that need a copy of more than a part of them.
std::vector<Piece> piecesOf(std::span<const Move> moves, std::size_t farthest) {
    std::size_t all = 0;
    for (const Move& move : moves) all += move.count;
    constexpr std::size_t kFewThreads = 4;
    const std::size_t share = threadCount() < kFewThreads ? 4 : 0;  // the part is one in this
    const std::size_t count =
        std::clamp<std::size_t>(all / std::max(kLeastPiece, share * farthest), 1, kMostPieces);
    const std::size_t each = (all + count - 1) / count;
    std::vector<Piece> pieces(1);
    std::size_t room = each;
    for (Move rest : moves) {
        while (rest.count > 0) {
            if (room == 0) {
                pieces.emplace_back();
                room = each;
            }
            const std::size_t part = std::min(rest.count, room);
            pieces.back().moves.push_back({rest.from, rest.to, part});
            room -= part;
            rest = {rest.from + part, rest.to + part, rest.count - part};
        }
    }
    if (pieces.back().moves.empty()) pieces.pop_back();
    return pieces;
}

/// The part of the move that lies in `range`, of its source.
Move clipped(const Move& move, std::size_t begin, std::size_t end) {
    const std::size_t from = std::clamp(begin, move.from, move.from + move.count);
    const std::size_t until = std::clamp(end, from, move.from + move.count);
    return {from, move.to + (from - move.from), until - from};
}

void carryOut(std::byte* bytes, const Piece& piece, const Move& move) {
    const std::size_t savedEnd = piece.saved.begin + piece.saved.count;
    // One of the two is empty where the other is whole, or they lie side by side.
    const Move before = clipped(move, 0, piece.saved.begin),
               behind = clipped(move, savedEnd, ~std::size_t{0});
    for (const Move& stays : {before, behind}) {
        if (stays.count > 0) std::memmove(bytes + stays.to, bytes + stays.from, stays.count);
    }
    const Move saved = clipped(move, piece.saved.begin, savedEnd);
    if (saved.count > 0)
        std::memcpy(bytes + saved.to, piece.copy.data() + (saved.from - piece.saved.begin), saved.count);
}

/// Moves by up to `farthest` bytes, all towards the end or all towards the beginning.
void carryOut(std::span<std::byte> bytes, std::span<const Move> moves, std::size_t farthest,
              bool towardsEnd) {
    std::vector<Piece> pieces = piecesOf(moves, farthest);
    // The neighbour's bytes come in over the end that they come from.
    parallelFor(pieces.size() > 1 ? pieces.size() : 0, 1, [&](std::size_t first, std::size_t) {
        Piece& piece = pieces[first];
        const std::size_t count = std::min(farthest, piece.end() - piece.begin());
        piece.saved = {towardsEnd ? piece.begin() : piece.end() - count, count};
        const auto from = bytes.subspan(piece.saved.begin, count);
        piece.copy.assign(from.begin(), from.end());
    });
    parallelFor(pieces.size(), 1, [&](std::size_t first, std::size_t) {
        Piece& piece = pieces[first];
        if (towardsEnd) std::ranges::reverse(piece.moves);
        for (const Move& move : piece.moves) carryOut(bytes.data(), piece, move);
    });
}

/// What lies behind each gap, in an array of `length` bytes with the gaps: to where it is without them.
std::vector<Move> movesOf(std::size_t length, std::size_t size, std::span<const Range> gaps) {
    std::vector<Move> moves;
    std::size_t closed = 0;
    for (std::size_t k = 0; k < gaps.size(); ++k) {
        const std::size_t begin = (gaps[k].begin + gaps[k].count) * size;
        const std::size_t end = k + 1 < gaps.size() ? gaps[k + 1].begin * size : length;
        closed += gaps[k].count * size;
        if (end > begin) moves.push_back({begin, begin - closed, end - begin});
    }
    return moves;
}

}  // namespace

std::size_t total(std::span<const Range> ranges) {
    std::size_t sum = 0;
    for (const Range& range : ranges) sum += range.count;
    return sum;
}

void closeGaps(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps) {
    carryOut(bytes, movesOf(bytes.size(), size, gaps), total(gaps) * size, false);
}

void openGaps(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps) {
    std::vector<Move> moves = movesOf(bytes.size(), size, gaps);
    for (Move& move : moves) std::swap(move.from, move.to);
    carryOut(bytes, moves, total(gaps) * size, true);
}

}  // namespace hairloom::editing
