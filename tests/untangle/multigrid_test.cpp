// Memory of multigrid where one unknown is that of many vertices: the plane of a thin plate.
#include <cmath>
#include <sys/resource.h>
#include <vector>

#include <gtest/gtest.h>
#include <untangle/multigrid.hpp>

#include <hexhex/context.hpp>

namespace hexhex::untangle {
namespace {

/// A chain of unknowns, each of which is connected to a last one, too.
SparseMatrix chainAtPlane(int links) {
  constexpr double kToPlane = 0.01;
  std::vector<Eigen::Triplet<double>> entries;
  const auto connect = [&](int a, int b, double weight) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(a, b, -weight);
    entries.emplace_back(b, a, -weight);
  };
  for (int i = 0; i < links; ++i) {
    if (i > 0) connect(i - 1, i, 1);
    connect(i, links, kToPlane);
  }
  entries.emplace_back(0, 0, 1);  // held there
  SparseMatrix matrix(links + 1, links + 1);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(Multigrid, TakesLittleMemoryWhereOneUnknownIsThatOfMany) {
  constexpr int kLinks = 20'000;
  [[maybe_unused]] constexpr long kMostKilobytes =
      100'000;  // all entries of a coarse level would be 1 GB
  const auto peak = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const SparseMatrix matrix = chainAtPlane(kLinks);
  Vector expected(kLinks + 1);
  for (int i = 0; i <= kLinks; ++i) expected[i] = 1 + 0.5 * std::sin(0.01 * i);
  [[maybe_unused]] const long before = peak();
  const Multigrid levels(matrix, 300, Context());
  const Vector found = levels.solve(matrix * expected);
  EXPECT_LT((found - expected).norm(), 1e-3 * expected.norm());
#if !defined(HEXHEX_SANITIZED)
  EXPECT_LT(peak() - before, kMostKilobytes);
#endif
}

}  // namespace
}  // namespace hexhex::untangle
