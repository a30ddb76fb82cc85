#include <algorithm>
#include <array>
#include <vector>

#include <base/branchless.hpp>
#include <base/prefetch.hpp>
#include <igm/gauges.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex {

namespace {

/// Tets between asking for something and looking at it: the memory's delay.
constexpr std::size_t kAhead = 8;

/// Part of a mesh that is connected without leaving a block is a *piece*; pieces are numbered block
/// by block. A link leads from one to a piece in another block, through a half-face of the former.
struct Link {
  Index here;
  Index there;
  HalfFace halfFace;
};

struct Block {
  Index pieces = 0;             ///< how many
  Index firstPiece = 0;         ///< number of the first one
  std::vector<HalfFace> exits;  ///< half-faces of other blocks whose mates are in this one
  std::vector<Link> links;      ///< by piece; at least one for each neighbour of a piece
};

/// Transitions that have been computed.
class KnownTransitions {
 public:
  explicit KnownTransitions(const Transitions& transitions) : transitions_(transitions) {}

  [[nodiscard]] const Transition& across(HalfFace halfFace) const noexcept {
    return transitions_.across(halfFace);
  }
  /// Asks for what is needed to cross a half-face soon.
  void fetch(HalfFace halfFace) const noexcept { prefetch(&transitions_.across(halfFace)); }

 private:
  const Transitions& transitions_;
};

/// Transitions that are computed from parameters where they are needed.
class FittedTransitions {
 public:
  FittedTransitions(const TetTopology& topology, const LocalParameters& parameters)
      : topology_(topology), parameters_(parameters) {}

  [[nodiscard]] Transition across(HalfFace halfFace) const {
    return fitTransition(SharedTriangle(topology_, parameters_, halfFace)).transition;
  }
  void fetch(HalfFace halfFace) const noexcept {
    const Index neighbour = tetOf(topology_.mate[halfFace]);
    parameters_.prefetch(neighbour);
    prefetch(&topology_.tets[neighbour]);
  }

 private:
  const TetTopology& topology_;
  const LocalParameters& parameters_;
};

/// Searches one block of tets, and gives them gauges relative to the first tets of their pieces.
/// In three passes, as each waits for memory in an order of its own: the search itself, which looks
/// at neighbours only; transitions, tet by tet; and their composition, in the order of the search.
/// Branches are avoided: which neighbours are new, or in the block, cannot be predicted.
template <class Source>
class PieceSearch {
 public:
  /// @param[out] result  gauges, and pieces in the place of components, numbered from 0 in each
  /// block
  PieceSearch(const TetTopology& topology, const Source& transitions, std::size_t begin,
              std::size_t end, Gauges& result)
      : mates_(topology.mate.data()),
        transitions_(transitions),
        result_(result),
        begin_(static_cast<Index>(begin)),
        size_(static_cast<Index>(end - begin)),
        seen_(size_ + 1, 0),
        entries_(size_ + 1),
        entryOf_(size_, kNone),
        toParent_(size_),
        exits_(4 * size_ + 1) {
    seen_[size_] = 1;
  }

  void run(Block& block) {
    for (Index i = 0; i < size_; ++i) {
      if (seen_[i] == 0) searchFrom(begin_ + i, block.pieces++);
    }
    block.exits.assign(exits_.data(), exits_.data() + exitCount_);
    lookUpTransitions();
    composeGauges();
  }

 private:
  void searchFrom(Index root, Index piece) {
    seen_[root - begin_] = 1;
    result_.of[root] = {};
    result_.component[root] = piece;
    std::size_t head = entryCount_;
    look(root);
    for (; head < entryCount_; ++head) {
      prefetch(&mates_[entries_[std::min(head + kAhead, entryCount_ - 1)]]);
      const HalfFace entry = entries_[head];
      entryOf_[tetOf(entry) - begin_] = entry;
      result_.component[tetOf(entry)] = piece;
      look(tetOf(entry));
    }
  }

  /// Queues neighbours that were not seen, by their sides of the faces, in ascending order, which
  /// makes cuts smoother. What is outside of the block counts as seen.
  void look(Index tet) {
    for (const HalfFace mate : sortedMates(tet)) {
      const Index place = tetOf(mate) - begin_;
      const Index slot = std::min(place, size_);
      entries_[entryCount_] = mate;
      entryCount_ += seen_[slot] ^ 1U;
      seen_[slot] = 1;
      exits_[exitCount_] = mate;
      exitCount_ += allOf(slot == size_, mate != kNone) ? 1 : 0;
    }
  }

  [[nodiscard]] std::array<HalfFace, 4> sortedMates(Index tet) const {
    const HalfFace* m = mates_ + 4 * std::size_t{tet};
    const HalfFace low0 = std::min(m[0], m[1]);
    const HalfFace high0 = std::max(m[0], m[1]);
    const HalfFace low1 = std::min(m[2], m[3]);
    const HalfFace high1 = std::max(m[2], m[3]);
    const HalfFace middle0 = std::max(low0, low1);
    const HalfFace middle1 = std::min(high0, high1);
    return {std::min(low0, low1), std::min(middle0, middle1), std::max(middle0, middle1),
            std::max(high0, high1)};
  }

  void lookUpTransitions() {
    for (Index i = 0; i < size_; ++i) {
      const HalfFace ahead = entryOf_[std::min<Index>(i + kAhead, size_ - 1)];
      if (ahead != kNone) transitions_.fetch(ahead);
      if (entryOf_[i] != kNone) toParent_[i] = transitions_.across(entryOf_[i]);
    }
  }

  void composeGauges() {
    for (std::size_t i = 0; i < entryCount_; ++i) {
      prefetch(&mates_[entries_[std::min(i + kAhead, entryCount_ - 1)]]);
      const HalfFace entry = entries_[i];
      const Index tet = tetOf(entry);
      result_.of[tet] = result_.of[tetOf(mates_[entry])] * toParent_[tet - begin_];
    }
  }

  const HalfFace* mates_;
  const Source& transitions_;
  Gauges& result_;
  Index begin_;
  Index size_;
  Array<std::uint8_t> seen_;    ///< by place in the block; and 1 for what is outside
  Array<HalfFace> entries_;     ///< in the order of the search, for all tets but the first of each
                                ///< piece; one more, which is written in vain
  Array<HalfFace> entryOf_;     ///< by place: the same; kNone for the first of a piece
  Array<Transition> toParent_;  ///< by place: across the entry
  Array<HalfFace> exits_;
  std::size_t entryCount_ = 0;
  std::size_t exitCount_ = 0;
};

/// All pieces of a mesh, and how they are joined.
template <class Source>
class Pieces {
 public:
  Pieces(const TetTopology& topology, const Source& transitions, std::size_t blockSize,
         Gauges& result, Stage& stage)
      : topology_(topology),
        transitions_(transitions),
        result_(result),
        stage_(stage),
        blockSize_(blockSize),
        blocks_(blockCount(topology.tetCount(), blockSize)) {}

  void find() {
    parallelBlocks(stage_, topology_.tetCount(), blockSize_,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     PieceSearch(topology_, transitions_, begin, end, result_).run(blocks_[block]);
                   });
    for (Block& block : blocks_) {
      block.firstPiece = count_;
      count_ += block.pieces;
    }
  }

  /// Finds the gauges of pieces.
  void join() {
    parallelFor(stage_, blocks_.size(), 1, [&](std::size_t block) { link(blocks_[block]); });
    std::vector<Link> links;
    std::vector<std::size_t> begin(std::size_t{count_} + 1, 0);
    for (Block& block : blocks_) {
      links.insert(links.end(), block.links.begin(), block.links.end());
      for (const Link& l : block.links) ++begin[l.here];
      block = {block.pieces, block.firstPiece, {}, {}};
    }
    exclusiveScan(std::span(begin));
    gauges_.resize(count_);
    components_.assign(count_, kNone);
    std::vector<Index> queue;
    for (Index root = 0; root < count_; ++root) {
      if (components_[root] != kNone) continue;
      components_[root] = result_.components;
      queue.assign(1, root);
      for (std::size_t head = 0; head < queue.size(); ++head) {
        const Index piece = queue[head];
        for (std::size_t i = begin[piece]; i < begin[piece + 1]; ++i) {
          if (components_[links[i].there] != kNone) continue;
          gauges_[links[i].there] = gaugeBehind(links[i]);
          components_[links[i].there] = result_.components;
          queue.push_back(links[i].there);
        }
      }
      ++result_.components;
    }
  }

  /// Replaces gauges and pieces of tets by what they are in all.
  void compose() {
    parallelBlocks(stage_, topology_.tetCount(), blockSize_,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     for (std::size_t t = begin; t < end; ++t) {
                       const Index piece = blocks_[block].firstPiece + result_.component[t];
                       result_.of[t] = gauges_[piece] * result_.of[t];
                       result_.component[t] = components_[piece];
                     }
                   });
  }

 private:
  /// The number of a tet's piece.
  [[nodiscard]] Index pieceOf(Index tet) const noexcept {
    return blocks_[tet / blockSize_].firstPiece + result_.component[tet];
  }

  /// Lists the links of a block, without most of those that join the same pieces again.
  void link(Block& block) const {
    std::array<Link, 64> recent{};
    recent.fill({kNone, kNone, kNone});
    for (const HalfFace exit : block.exits) {
      const HalfFace halfFace = topology_.mate[exit];
      const Link link = {pieceOf(tetOf(halfFace)), pieceOf(tetOf(exit)), halfFace};
      Link& last = recent[(7 * link.here + link.there) % recent.size()];
      if (last.here == link.here && last.there == link.there) continue;
      last = link;
      block.links.push_back(link);
    }
    std::stable_sort(block.links.begin(), block.links.end(),
                     [](const Link& a, const Link& b) { return a.here < b.here; });
  }

  /// The gauge of the piece to which a link leads.
  [[nodiscard]] Gauge gaugeBehind(const Link& link) const noexcept {
    const HalfFace mate = topology_.mate[link.halfFace];
    const Gauge tet = result_.of[tetOf(link.halfFace)] * transitions_.across(mate);
    return gauges_[link.here] * tet / result_.of[tetOf(mate)];
  }

  const TetTopology& topology_;
  const Source& transitions_;
  Gauges& result_;
  Stage& stage_;
  std::size_t blockSize_;
  std::vector<Block> blocks_;
  Index count_ = 0;
  std::vector<Gauge> gauges_;      ///< per piece
  std::vector<Index> components_;  ///< per piece
};

template <class Source>
Gauges gaugesBy(const TetTopology& topology, const Source& transitions, Stage& stage,
                std::size_t blockSize) {
  Gauges result;
  result.of.resize(topology.tetCount());
  result.component.resize(topology.tetCount());
  Pieces pieces(topology, transitions, blockSize, result, stage);
  pieces.find();
  pieces.join();
  pieces.compose();
  return result;
}

}  // namespace

Gauges computeGauges(const TetTopology& topology, const Transitions& transitions, Stage& stage,
                     std::size_t blockSize) {
  return gaugesBy(topology, KnownTransitions(transitions), stage, blockSize);
}

Gauges computeGauges(const TetTopology& topology, const LocalParameters& parameters, Stage& stage,
                     std::size_t blockSize) {
  return gaugesBy(topology, FittedTransitions(topology, parameters), stage, blockSize);
}

}  // namespace hexhex
