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
    std::span<const Move> moves;
    Range saved{0, 0};
    std::vector<std::byte> copy;

    std::size_t begin() const { return moves.front().from; }
    std::size_t end() const { return moves.back().from + moves.back().count; }
    std::size_t newBegin() const { return moves.front().to; }
    std::size_t newEnd() const { return moves.back().to + moves.back().count; }
};

enum class Gaps { close, open };

/// What lies behind each gap, cut into pieces of about equal size, one for each thread. `length` is that of
/// the array with the gaps, in bytes.
class Moves {
  public:
    Moves(std::size_t length, std::size_t size, std::span<const Range> gaps, Gaps change) : change_(change) {
        if (gaps.empty()) return;
        constexpr std::size_t kMinPiece = std::size_t{1} << 17u;  // bytes
        const std::size_t all = length - (gaps.front().begin + total(gaps)) * size;
        const std::size_t count =
            std::clamp<std::size_t>(all / kMinPiece, 1, std::max<std::size_t>(threadCount(), 1));
        each_ = (all + count - 1) / count;
        moves_.reserve(gaps.size() + count);
        firsts_.reserve(count);
        std::size_t closed = 0;
        for (std::size_t k = 0; k < gaps.size(); ++k) {
            const std::size_t begin = (gaps[k].begin + gaps[k].count) * size;
            const std::size_t end = k + 1 < gaps.size() ? gaps[k + 1].begin * size : length;
            closed += gaps[k].count * size;
            add(begin, begin - closed, end - begin);
        }
    }

    std::vector<Piece> pieces() const {
        std::vector<Piece> pieces(firsts_.size());
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const std::size_t end = i + 1 < firsts_.size() ? firsts_[i + 1] : moves_.size();
            pieces[i].moves = std::span(moves_).subspan(firsts_[i], end - firsts_[i]);
        }
        return pieces;
    }

  private:
    void add(std::size_t open, std::size_t closed, std::size_t count) {
        while (count > 0) {
            if (room_ == 0) {
                firsts_.push_back(moves_.size());
                room_ = each_;
            }
            const std::size_t part = std::min(count, room_);
            moves_.push_back(change_ == Gaps::close ? Move{open, closed, part} : Move{closed, open, part});
            room_ -= part;
            open += part;
            closed += part;
            count -= part;
        }
    }

    Gaps change_;
    std::size_t each_ = 0;
    std::size_t room_ = 0;
    std::vector<Move> moves_;
    std::vector<std::size_t> firsts_;  ///< of each piece
};

/// What others write over: bytes come in over the end that they come from, the farther along the array the
/// farther, so that those of the next piece reach at least as far as any others'.
void findSaved(std::span<Piece> pieces, Gaps change) {
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        Piece &before = pieces[i - 1], &behind = pieces[i];
        if (change == Gaps::open) {
            const std::size_t reached = std::clamp(before.newEnd(), behind.begin(), behind.end());
            behind.saved = {behind.begin(), reached - behind.begin()};
        } else {
            const std::size_t reached = std::clamp(behind.newBegin(), before.begin(), before.end());
            before.saved = {reached, before.end() - reached};
        }
    }
}

/// The part of the move that lies in [begin, end), of its source.
Move clipped(const Move& move, std::size_t begin, std::size_t end) {
    const std::size_t from = std::clamp(begin, move.from, move.from + move.count);
    const std::size_t until = std::clamp(end, from, move.from + move.count);
    return {from, move.to + (from - move.from), until - from};
}

void carryOut(std::byte* bytes, const Piece& piece, const Move& move) {
    const std::size_t savedEnd = piece.saved.begin + piece.saved.count;
    if (move.from >= savedEnd || move.from + move.count <= piece.saved.begin) {
        std::memmove(bytes + move.to, bytes + move.from, move.count);
        return;
    }
    // One of the two is empty where the other is whole, or they lie side by side.
    const Move before = clipped(move, 0, piece.saved.begin),
               behind = clipped(move, savedEnd, ~std::size_t{0});
    for (const Move& stays : {before, behind}) {
        if (stays.count > 0) std::memmove(bytes + stays.to, bytes + stays.from, stays.count);
    }
    const Move saved = clipped(move, piece.saved.begin, savedEnd);
    std::memcpy(bytes + saved.to, piece.copy.data() + (saved.from - piece.saved.begin), saved.count);
}

void carryOut(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps, Gaps change) {
    const Moves moves(bytes.size(), size, gaps, change);
    std::vector<Piece> pieces = moves.pieces();
    findSaved(pieces, change);
    parallelFor(pieces.size() > 1 ? pieces.size() : 0, 1, [&](std::size_t first, std::size_t) {
        Piece& piece = pieces[first];
        const auto from = bytes.subspan(piece.saved.begin, piece.saved.count);
        piece.copy.assign(from.begin(), from.end());
    });
    parallelFor(pieces.size(), 1, [&](std::size_t first, std::size_t) {
        const Piece& piece = pieces[first];
        if (change == Gaps::close) {
            for (const Move& move : piece.moves) carryOut(bytes.data(), piece, move);
        } else {
            for (std::size_t m = piece.moves.size(); m-- > 0;) carryOut(bytes.data(), piece, piece.moves[m]);
        }
    });
}

}  // namespace

std::size_t total(std::span<const Range> ranges) {
    std::size_t sum = 0;
    for (const Range& range : ranges) sum += range.count;
    return sum;
}

void closeGaps(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps) {
    carryOut(bytes, size, gaps, Gaps::close);
}

void openGaps(std::span<std::byte> bytes, std::size_t size, std::span<const Range> gaps) {
    carryOut(bytes, size, gaps, Gaps::open);
}

}  // namespace hairloom::editing
