// Vertex extraction (Section 5.2).
#include <algorithm>

#include <propeller/hex_vertices.hpp>

namespace hexhex::propeller {

namespace {

constexpr std::size_t kHexVerticesGrain = 512;

/// Lists generators, and the tets that see them.
class GeneratorLister {
 public:
  GeneratorLister(const igm::PreparedMap& map, HexVertices& result)
      : map_(map), numbers_(result.tables.numbers()), result_(result) {}

  void run(Stage& stage) {
    const std::size_t tets = map_.topology.tetCount();
    begin_.resize(tets + 1);
    begin_[tets] = 0;
    result_.incidenceBegin.resize(tets + 1);
    result_.incidenceBegin[tets] = 0;
    parallelFor(stage, tets, kHexVerticesGrain,
                [&](std::size_t t) { count(static_cast<Index>(t)); });
    result_.generators.resize(exclusiveScan(std::span(begin_)));
    result_.incidences.resize(exclusiveScan(std::span(result_.incidenceBegin)));
    result_.generatorOf.resize(numbers_.count());
    parallelFor(stage, tets, kHexVerticesGrain,
                [&](std::size_t t) { list(static_cast<Index>(t)); });
    parallelFor(stage, tets, kHexVerticesGrain,
                [&](std::size_t t) { listIncidences(static_cast<Index>(t)); });
  }

 private:
  /// Hex vertices in the interior of a tet are numbered after those of its boundary.
  [[nodiscard]] std::uint64_t firstInside(Index tet) const {
    return numbers_.firstOf(tet, lattice::kWholeTet);
  }
  /// The generators of a tet's boundary, owned or not, as a set of simplices.
  [[nodiscard]] unsigned boundaryGenerators(Index tet) const {
    return result_.tables.occupiedSimplices(tet) & ~(1U << lattice::kWholeTet);
  }

  void count(Index tet) {
    const bool hasInside = firstInside(tet) != numbers_.begin[tet + 1];
    begin_[tet] =
        numbers_.generatorBegin[tet + 1] - numbers_.generatorBegin[tet] + (hasInside ? 1U : 0U);
    result_.incidenceBegin[tet] = static_cast<Index>(std::popcount(boundaryGenerators(tet)));
  }

  /// Lists the generators that the tet owns.
  void list(Index tet) {
    Index place = begin_[tet];
    auto vertex = static_cast<Index>(numbers_.begin[tet]);
    const auto add = [&](lattice::CornerMask simplex, Index vertices) {
      result_.generators[place] = {tet, vertex, vertices, simplex};
      std::fill_n(result_.generatorOf.begin() + vertex, vertices, place++);
      vertex += vertices;
    };
    for (Index g = numbers_.generatorBegin[tet]; g < numbers_.generatorBegin[tet + 1]; ++g) {
      add(numbers_.generators[g].simplex, numbers_.generators[g].count);
    }
    if (place < begin_[tet + 1]) {
      add(lattice::kWholeTet, static_cast<Index>(numbers_.begin[tet + 1]) - vertex);
    }
  }

  void listIncidences(Index tet) {
    Index place = result_.incidenceBegin[tet];
    for (unsigned rest = boundaryGenerators(tet); rest != 0; rest &= rest - 1) {
      const auto simplex = static_cast<lattice::CornerMask>(std::countr_zero(rest));
      const Index owner = adjacency::ownerTet(map_.topology, tet, simplex);
      GeneratorIncidence& entry = result_.incidences[place++];
      entry.generator = find(owner, map_.topology.translated(simplex, tet, owner));
      entry.simplex = simplex;
      entry.propeller.fill(kNoPropeller);
    }
  }

  [[nodiscard]] Index find(Index owner, lattice::CornerMask simplex) const {
    for (Index g = begin_[owner]; g < begin_[owner + 1]; ++g) {
      if (result_.generators[g].simplex == simplex) return g;
    }
    failForMissingVertex(owner);
  }

  const igm::PreparedMap& map_;
  const sweep::VertexNumbers& numbers_;
  HexVertices& result_;
  Array<Index> begin_;  ///< per tet (+1): the generators that it owns
};

}  // namespace

HexVertices::HexVertices(const igm::PreparedMap& map, double epsilon, Stage& stage)
    : tables(map, sweep::sweepVertices(map, stage, nullptr, epsilon), stage) {
  GeneratorLister(map, *this).run(stage);
}

void failForMissingVertex(std::optional<Index> tet) {
  throw Error(ErrorCode::Internal,
              "The map passed all checks, but a hex vertex is missing. This is a bug; please "
              "report it with the map.",
              tet ? Place{PlaceKind::Tet, *tet} : Place{});
}

}  // namespace hexhex::propeller
