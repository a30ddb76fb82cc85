// Homology of a solid, modulo 2: which closed walks along edges bound a sum of triangles.
#pragma once

#include <map>
#include <vector>

#include <tetmap/cut.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// A sum of generators: the ascending numbers of those that do not cancel.
using HomologyClass = std::vector<Index>;

[[nodiscard]] HomologyClass sumOf(const HomologyClass& a, const HomologyClass& b);

/// Independent classes in echelon form.
class ClassBasis {
 public:
  /// @return the same for all classes that differ by a sum of those added; empty for such a sum
  [[nodiscard]] HomologyClass reduced(HomologyClass sum) const;
  /// @return whether the class is no sum of those added before
  bool add(const HomologyClass& sum);

 private:
  std::map<Index, HomologyClass> rows_;  ///< by their last generators
};

/// A class per edge: those of a closed walk add up to nothing if and only if it bounds.
///
/// Edges of a spanning forest have none, and those around a triangle add up to nothing. An edge
/// whose class does not follow is a generator; triangles may tell later that some are the same.
class EdgeClasses {
 public:
  EdgeClasses(const std::vector<Tet>& tets, std::size_t pointCount, Stage& stage);

  [[nodiscard]] const HomologyClass& operator()(Index a, Index b) const {
    return classes_[numberOf(a, b)];
  }

 private:
  [[nodiscard]] Index numberOf(Index a, Index b) const;

  std::vector<tetmap::VertexPair> edges_;  ///< ascending
  std::vector<HomologyClass> classes_;     ///< per edge
};

}  // namespace hexhex::shape
