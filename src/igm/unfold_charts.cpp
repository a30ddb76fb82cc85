// Searches the dual graph for gauges, and rewrites the map in common charts (not in the paper).
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <base/parallel.hpp>
#include <base/vector3.hpp>
#include <igm/transition_fit.hpp>
#include <igm/unfold_charts.hpp>
#include <lattice/charts_along_trees.hpp>

namespace hexhex::igm {

namespace {

constexpr std::size_t kUnfoldChartsGrain = 1024;

/// Tets between prefetching parameters and looking at them: the memory's latency.
constexpr Index kAhead = 8;

/// A *piece* is a set of tets that are connected within a block of consecutive tets. Pieces are
/// numbered from 0 in each block, and then block by block.
struct Block {
  std::vector<adjacency::HalfFace>
      exits;                      ///< half-faces of other blocks whose mates are in this one
  std::vector<std::size_t> ends;  ///< per piece: where its exits end
};

/// Searches the dual graph: within blocks of tets, then the graph of their pieces.
class GaugeSearch {
 public:
  GaugeSearch(const adjacency::TetTopology& topology, const LocalParameters& parameters,
              std::size_t blockSize)
      : topology_(topology),
        parameters_(parameters),
        blockSize_(blockSize),
        gauges_(topology.tetCount()),
        pieces_(topology.tetCount(), kNone) {}

  Array<lattice::Gauge> run(Stage& stage) {
    const std::size_t tets = topology_.tetCount();
    std::vector<Block> blocks(blockCount(tets, blockSize_));
    parallelBlocks(stage, tets, blockSize_,
                   [&](std::size_t begin, std::size_t end, std::size_t block) {
                     searchBlock(static_cast<Index>(begin), static_cast<Index>(end), blocks[block]);
                   });
    const std::vector<lattice::Gauge> gaugesOfPieces = joinPieces(blocks);
    parallelFor(stage, tets, kUnfoldChartsGrain, [&](std::size_t t) {
      gauges_[t] = gaugesOfPieces[pieceOf(static_cast<Index>(t))] * gauges_[t];
    });
    return std::move(gauges_);
  }

 private:
  /// Computes the gauges of a block's tets relative to the first tets of their pieces. The search
  /// comes first, then transitions, tet by tet, as they need far more memory. (With branches and
  /// without prefetching, extractions of cylinder_random_low take 5 % longer.)
  void searchBlock(Index begin, Index end, Block& block) {
    Array<adjacency::HalfFace> entry(end - begin, kNone);  // per tet: through which it was found
    std::vector<Index> queue(end - begin + 1);             // tets in the order of the search
    std::size_t count = 0;
    for (Index root = begin; root < end; ++root) {
      if (pieces_[root] != kNone) continue;
      const auto piece = static_cast<Index>(block.ends.size());
      pieces_[root] = piece;
      std::size_t head = count;
      queue[count++] = root;
      for (; head < count; ++head) {
        for (const adjacency::HalfFace mate : sortedMates(queue[head])) {
          if (mate == kNone) continue;
          const Index neighbour = adjacency::tetOf(mate);
          if (neighbour < begin || neighbour >= end) {
            block.exits.push_back(mate);
            continue;
          }
          const bool isNew = pieces_[neighbour] == kNone;
          pieces_[neighbour] = piece;
          adjacency::HalfFace& entryThere = entry[neighbour - begin];
          entryThere = isNew ? mate : entryThere;
          queue[count] = neighbour;  // wasted unless it is new, which cannot be predicted
          count += static_cast<std::size_t>(isNew);
        }
      }
      block.ends.push_back(block.exits.size());
    }
    composeInBlock(begin, end, entry, std::span(queue).first(count));
  }

  /// @param entry  per tet: the half-face through which the search found it, or kNone
  /// @param order  of the search
  void composeInBlock(Index begin, Index end, std::span<const adjacency::HalfFace> entry,
                      std::span<const Index> order) {
    for (Index t = begin; t < end; ++t) {
      const adjacency::HalfFace ahead = entry[std::min(t + kAhead, end - 1) - begin];
      if (ahead != kNone) parameters_.prefetch(adjacency::tetOf(topology_.mate[ahead]));
      const adjacency::HalfFace halfFace = entry[t - begin];
      gauges_[t] =
          halfFace == kNone ? lattice::Gauge{} : lattice::Gauge{} * transitionAcross(halfFace);
    }
    for (const Index t : order) {
      const adjacency::HalfFace halfFace = entry[t - begin];
      if (halfFace != kNone)
        gauges_[t] = gauges_[adjacency::tetOf(topology_.mate[halfFace])] * gauges_[t];
    }
  }

  /// In ascending order, which makes cuts smoother.
  [[nodiscard]] std::array<adjacency::HalfFace, 4> sortedMates(Index tet) const {
    const adjacency::HalfFace* m = &topology_.mate[4 * tet];
    const auto [low0, high0] = std::minmax(m[0], m[1]);
    const auto [low1, high1] = std::minmax(m[2], m[3]);
    const auto [middle0, middle1] = std::minmax(std::max(low0, low1), std::min(high0, high1));
    return {std::min(low0, low1), middle0, middle1, std::max(high0, high1)};
  }

  /// @return per piece: the gauge of its first tet
  std::vector<lattice::Gauge> joinPieces(const std::vector<Block>& blocks) {
    std::vector<adjacency::HalfFace> exits;
    std::vector<std::size_t> begin = {0};  // per piece (+1): in `exits`
    for (const Block& block : blocks) {
      firstPiece_.push_back(static_cast<Index>(begin.size() - 1));
      for (const std::size_t end : block.ends) begin.push_back(exits.size() + end);
      exits.insert(exits.end(), block.exits.begin(), block.exits.end());
    }
    const auto forEachNeighbour = [&](Index piece, const auto& visit) {
      for (std::size_t i = begin[piece]; i < begin[piece + 1]; ++i) {
        const Index there = adjacency::tetOf(exits[i]);
        visit(pieceOf(there), [&](const lattice::Gauge& gauge) {
          const lattice::Gauge& here = gauges_[adjacency::tetOf(topology_.mate[exits[i]])];
          return gauge * here * transitionAcross(exits[i]) * gauges_[there].inverse();
        });
      }
    };
    return lattice::chartsAlongTrees<lattice::Gauge>(begin.size() - 1, forEachNeighbour).motions;
  }

  [[nodiscard]] lattice::Transition transitionAcross(adjacency::HalfFace halfFace) const {
    return fitTransition(SharedTriangle(topology_, parameters_, halfFace)).transition;
  }
  [[nodiscard]] Index pieceOf(Index tet) const noexcept {
    return firstPiece_[tet / blockSize_] + pieces_[tet];
  }

  const adjacency::TetTopology& topology_;
  const LocalParameters& parameters_;
  std::size_t blockSize_;
  Array<lattice::Gauge> gauges_;
  Array<Index> pieces_;            ///< per tet: its piece, by number in the block
  std::vector<Index> firstPiece_;  ///< per block
};

Vec3 translationOf(const lattice::Gauge& gauge) {
  Vec3 translation{};
  for (std::size_t k = 0; k < 3; ++k) {
    translation[k] = static_cast<std::int32_t>(gauge.translation[k]);
  }
  return translation;
}

/// @return whether nothing is rounded
bool translateExactly(const TetParameters& rotated, const Vec3& by, TetParameters& image) {
  double rest = 0;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double sum = rotated[corner][k] + by[k];
      rest += restOfSum(sum, rotated[corner][k], by[k]);
      image[corner][k] = sum;
    }
  }
  return rest == 0;
}

/// The parameters of a tet in the chart of its gauge, moved to the origin as LocalParameters would
/// do it. If that rounds, they stay unchanged, and the gauge becomes the identity.
TetParameters rewritten(const LocalParameters& given, Index t, lattice::Gauge& gauge) {
  const TetParameters u = given(t);
  const lattice::Rotation rotation = gauge.rotation;
  const TetParameters rotated = {rotation(u[0]), rotation(u[1]), rotation(u[2]), rotation(u[3])};
  const Vec3 by = translationOf(gauge);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto back = static_cast<std::int64_t>(given.roundedToGrid(rotated[0][k] + by[k]));
    gauge.translation[k] -= static_cast<std::uint32_t>(back);
  }
  TetParameters image;
  if (translateExactly(rotated, translationOf(gauge), image)) return image;
  gauge = {};
  return u;
}

double largestMagnitude(const TetParameters& u) {
  double largest = 0;
  for (const Vec3& corner : u) {
    for (const double x : corner) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

}  // namespace

Array<lattice::Gauge> computeGauges(const adjacency::TetTopology& topology,
                                    const LocalParameters& parameters, Stage& stage,
                                    std::size_t blockSize) {
  return GaugeSearch(topology, parameters, blockSize).run(stage);
}

bool needsUnfolding(const adjacency::TetTopology& topology, const OrientedMap& map) {
  const LocalParameters given(map);
  if (!map.view.rotations.empty() || given.tooLarge()) return false;
  constexpr std::size_t kSample = 32;  // tets
  // If one in this many triangles is between different charts, that costs as much as unfolding.
  constexpr std::size_t kBreakEven = 3;
  const std::size_t step = std::max(topology.tetCount() / kSample, std::size_t{1});
  std::size_t faces = 0;
  std::size_t nonTrivial = 0;
  for (std::size_t t = 0; t < topology.tetCount(); t += step) {
    for (int f = 0; f < 4; ++f) {
      const adjacency::HalfFace here = adjacency::halfFaceOf(static_cast<Index>(t), f);
      if (topology.isBoundary(here)) continue;
      ++faces;
      if (agree(topology, given, here)) continue;
      const FittedTransition fitted = fitTransition(SharedTriangle(topology, given, here));
      nonTrivial += fitted.isExact && !fitted.transition.isIdentity() ? 1 : 0;
    }
  }
  return kBreakEven * nonTrivial > faces;
}

Array<lattice::Gauge> unfoldCharts(const adjacency::TetTopology& topology, OrientedMap& map,
                                   Stage& stage) {
  const LocalParameters given(map);
  Array<lattice::Gauge> gauges = computeGauges(topology, given, stage);
  const std::size_t tets = topology.tetCount();
  if (map.parameters.empty()) map.parameters.resize(tets);
  std::vector<double> largest(blockCount(tets, kUnfoldChartsGrain), 0);
  parallelBlocks(stage, tets, kUnfoldChartsGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (std::size_t t = begin; t < end; ++t) {
                     map.parameters[t] = rewritten(given, static_cast<Index>(t), gauges[t]);
                     largest[block] = std::max(largest[block], largestMagnitude(map.parameters[t]));
                   }
                 });
  map.view.parameters = map.parameters;
  map.largestCoordinate = *std::max_element(largest.begin(), largest.end());
  return gauges;
}

std::uint64_t countGivenTransitions(const adjacency::TetTopology& topology,
                                    const Transitions& transitions,
                                    const Array<lattice::Gauge>& gauges, Stage& stage) {
  if (gauges.empty()) return transitions.nonTrivial;
  const std::size_t halfFaces = topology.mate.size();
  std::vector<std::uint64_t> blocks(blockCount(halfFaces, kUnfoldChartsGrain), 0);
  parallelBlocks(stage, halfFaces, kUnfoldChartsGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   for (auto here = static_cast<adjacency::HalfFace>(begin); here < end; ++here) {
                     const adjacency::HalfFace there = topology.mate[here];
                     if (there == kNone || there < here) continue;
                     lattice::Gauge image = gauges[adjacency::tetOf(here)];
                     if (transitions.isNonTrivial(here)) {
                       image = lattice::Gauge{} * transitions.across(here) * image;
                     }
                     blocks[block] += image == gauges[adjacency::tetOf(there)] ? 0 : 1;
                   }
                 });
  return std::accumulate(blocks.begin(), blocks.end(), std::uint64_t{0});
}

}  // namespace hexhex::igm
