// Combines findings about single cells into findings about a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <mesh/cell_validity.hpp>

namespace hexhex::mesh {

/// Findings of one block of cells. Left open for later: cells that may be worse than the worst
/// value so far, and refuted ones.
class BlockFindings {
 public:
  /// @param scaled  the scaled Jacobian reported for the cell
  void add(std::uint64_t cell, double scaled, const CellCertificate& known) {
    ++counts_[static_cast<std::size_t>(known.validity)];
    if (known.validity == Validity::Refuted) {
      scaled = std::min(scaled, known.scaledJacobian);
      refuted_.push_back({scaled, cell});
    }
    smallest_ = std::min(smallest_, scaled);
    keep({known.minimum, cell});
  }

  /// Unites all blocks, and examines the cells left open more closely.
  /// @param nodesOf  (cell, list): fills a list with the nodes of a cell
  template <class NodesOf>
  static void finish(const std::vector<BlockFindings>& blocks, const CellValidity& cells,
                     const NodesOf& nodesOf, Stage& stage, Certificate& certificate) {
    BlockFindings all;
    for (const BlockFindings& block : blocks) {
      all.smallest_ = std::min(all.smallest_, block.smallest_);
    }
    for (const BlockFindings& block : blocks) {
      for (std::size_t i = 0; i < 3; ++i) all.counts_[i] += block.counts_[i];
      all.settled_ = std::min(all.settled_, block.settled_);
      all.refuted_.insert(all.refuted_.end(), block.refuted_.begin(), block.refuted_.end());
      for (const Entry& entry : block.open_) all.keep(entry);
    }
    certificate.positive = all.counts_[static_cast<std::size_t>(Validity::Positive)];
    certificate.refuted = all.counts_[static_cast<std::size_t>(Validity::Refuted)];
    certificate.undecided = all.counts_[static_cast<std::size_t>(Validity::Undecided)];

    std::sort(all.open_.begin(), all.open_.end());
    const std::size_t most = std::min(all.open_.size(), std::max(kMostWorst, cells.looks()));
    // The others remain as they are; cells that are no worse are not worth examining.
    const double rest = most < all.open_.size() ? all.open_[most].value : 1;
    const auto end = std::partition_point(all.open_.begin(), all.open_.end(),
                                          [&](const Entry& e) { return e.value < rest; });
    const auto looked = static_cast<std::size_t>(end - all.open_.begin());
    parallelFor(stage, looked, 1, [&](std::size_t i) {
      std::vector<Vec3> nodes;
      nodesOf(all.open_[i].cell, nodes);
      all.open_[i].value = cells.findLeast(nodes, all.smallest_).minimum;
    });
    certificate.minimum = all.settled_;
    for (const Entry& entry : all.open_) {
      certificate.minimum = std::min(certificate.minimum, entry.value);
    }

    keepWorst(all.refuted_);
    for (const Entry& entry : all.refuted_) {
      std::vector<Vec3> nodes;
      nodesOf(entry.cell, nodes);
      const CellCertificate found = cells.findLeast(nodes, 1);
      certificate.worst.push_back(
          {entry.cell, found.place, cells.pointAt(nodes, found.place), found.scaledJacobian});
    }
  }

 private:
  struct Entry {
    double value;
    std::uint64_t cell;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };
  static constexpr std::size_t kMostWorst = 10;

  static void keepWorst(std::vector<Entry>& list) {
    std::sort(list.begin(), list.end());
    if (list.size() > kMostWorst) list.resize(kMostWorst);
  }
  void keep(const Entry& entry) {
    if (entry.value < smallest_ - kMinimumTolerance) {
      open_.push_back(entry);
    } else {
      settled_ = std::min(settled_, entry.value);
    }
  }

  std::array<std::uint64_t, 3> counts_{};
  double smallest_ = 1;
  double settled_ = 1;          ///< bound of all cells that are not open
  std::vector<Entry> open_;     ///< by bound
  std::vector<Entry> refuted_;  ///< by value
};

}  // namespace hexhex::mesh
