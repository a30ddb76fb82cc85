// The numbers that faces of parts have in the mesh in one piece, from the parts alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <hexhex/team.hpp>

namespace hexhex::io {

/// Faces of a part, in the order that they have in the mesh in one piece. They follow one another
/// there, too, as long as their cells do, which are a run then: there are about as many runs as
/// tets, however many cells.
class FaceRuns {
 public:
  struct Run {
    std::uint64_t cell;    ///< its first one
    std::uint64_t before;  ///< faces of the part
  };

  /// Adds a face. @param run  the first cell of that of its cell
  void add(std::uint64_t run) {
    if (runs_.empty() || runs_.back().cell != run) runs_.push_back({run, count_});
    ++count_;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] const std::vector<Run>& runs() const noexcept { return runs_; }
  /// Where a run ends, by faces of the part.
  [[nodiscard]] std::uint64_t endOf(std::size_t run) const {
    return run + 1 < runs_.size() ? runs_[run + 1].before : count_;
  }

 private:
  std::vector<Run> runs_;
  std::uint64_t count_ = 0;
};

/// The numbers of faces of one kind in the mesh in one piece, as writeOpenFoam() lists them: inner
/// ones by the smaller of their cells, then by the larger; boundary ones of a tag by cell and side.
class FaceNumbers {
 public:
  void add(const FaceRuns& faces) {
    for (std::size_t i = 0; i < faces.runs().size(); ++i) {
      const FaceRuns::Run& run = faces.runs()[i];
      table_.insert(table_.end(), {run.cell, faces.endOf(i) - run.before});
    }
  }
  /// When all are there. @param first  the number of the first. @return  that behind the last
  std::uint64_t finish(std::uint64_t first, ProcessTeam* team) {
    if (team != nullptr) table_ = team->gather(table_).numbers;
    begins_.resize(table_.size() / 2);
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      begins_[i] = {table_[2 * i], table_[2 * i + 1]};
    }
    std::vector<std::uint64_t>().swap(table_);
    std::sort(begins_.begin(), begins_.end());
    std::uint64_t next = first;
    for (auto& [cell, number] : begins_) {
      const std::uint64_t faces = number;
      number = next;
      next += faces;
    }
    return next;
  }
  [[nodiscard]] bool empty() const noexcept { return begins_.empty(); }

  /// Calls use(number) for all faces of a part, in order.
  template <class Use>
  void forEach(const FaceRuns& faces, const Use& use) const {
    for (std::size_t i = 0; i < faces.runs().size(); ++i) {
      const FaceRuns::Run& run = faces.runs()[i];
      const std::uint64_t first = beginOf(run.cell);
      for (std::uint64_t f = run.before; f < faces.endOf(i); ++f) use(first + f - run.before);
    }
  }
  /// That of one face of a part.
  [[nodiscard]] std::uint64_t of(const FaceRuns& faces, std::uint64_t face) const {
    const auto run = std::prev(std::upper_bound(
        faces.runs().begin(), faces.runs().end(), face,
        [](std::uint64_t f, const FaceRuns::Run& each) { return f < each.before; }));
    return beginOf(run->cell) + face - run->before;
  }

 private:
  [[nodiscard]] std::uint64_t beginOf(std::uint64_t run) const {
    return std::lower_bound(begins_.begin(), begins_.end(), std::pair(run, std::uint64_t{0}))
        ->second;
  }

  std::vector<std::uint64_t> table_;                             ///< cells and numbers of faces
  std::vector<std::pair<std::uint64_t, std::uint64_t>> begins_;  ///< per run, by its first cell
};

}  // namespace hexhex::io
