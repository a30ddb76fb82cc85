// A team of processes that are threads of this one.
#pragma once

#include <algorithm>
#include <barrier>
#include <cstring>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include <hexhex/team.hpp>

namespace hexhex::test {

class ThreadTeam {
 public:
  explicit ThreadTeam(std::uint32_t size) : barrier_(size), said_(size), given_(size) {}

  /// Runs work(member) in each. @return per member what it threw, if anything
  std::vector<std::optional<Error>> run(const std::function<void(ProcessTeam&)>& work) {
    std::vector<std::optional<Error>> errors(said_.size());
    std::vector<std::thread> threads;
    for (std::uint32_t rank = 0; rank < said_.size(); ++rank) {
      threads.emplace_back([&, rank] {
        Member member(*this, rank);
        try {
          member.run([&] { work(member); });
        } catch (const Error& error) {
          errors[rank].emplace(error);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    return errors;
  }

 private:
  class Member final : public ProcessTeam {
   public:
    Member(ThreadTeam& team, std::uint32_t rank) : team_(team), rank_(rank) {}
    [[nodiscard]] std::uint32_t rank() const noexcept override { return rank_; }
    [[nodiscard]] std::uint32_t size() const noexcept override {
      return static_cast<std::uint32_t>(team_.said_.size());
    }

   protected:
    bool doAllSay(bool yes) override {
      team_.said_[rank_] = yes ? 1 : 0;
      wait();
      const bool all =
          std::all_of(team_.said_.begin(), team_.said_.end(), [](char each) { return each == 1; });
      wait();
      return all;
    }
    void doShare(std::uint32_t from, std::span<std::byte> bytes) override {
      if (rank_ == from) team_.shared_ = bytes;
      wait();
      if (rank_ != from) std::memcpy(bytes.data(), team_.shared_.data(), bytes.size());
      wait();
    }
    void doGather(std::span<const std::uint64_t> mine, std::span<const std::uint64_t> /*counts*/,
                  std::span<std::uint64_t> all) override {
      team_.given_[rank_] = mine;
      wait();
      auto place = all.begin();
      for (const auto& given : team_.given_) place = std::copy(given.begin(), given.end(), place);
      wait();
    }

   private:
    void wait() { team_.barrier_.arrive_and_wait(); }
    ThreadTeam& team_;
    std::uint32_t rank_;
  };

  std::barrier<> barrier_;
  std::vector<char> said_;
  std::vector<std::span<const std::uint64_t>> given_;
  std::span<std::byte> shared_;
};

/// Whether two parts have the same bytes.
inline bool isSamePart(const MeshPart& a, const MeshPart& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::equal(x.begin(), x.end(), y.begin());
  };
  const auto sameNeighbour = [&](const PartNeighbour& x, const PartNeighbour& y) {
    return x.part == y.part && same(x.vertices, y.vertices) && same(x.faces, y.faces);
  };
  // Bits of positions, not values.
  const std::size_t bytes = a.mesh.points.size() * sizeof(Vec3);
  return a.part == b.part && a.parts == b.parts && a.ownPoints == b.ownPoints &&
         a.ownCells == b.ownCells && a.mesh.points.size() == b.mesh.points.size() &&
         (bytes == 0 || std::memcmp(a.mesh.points.data(), b.mesh.points.data(), bytes) == 0) &&
         same(a.mesh.cells, b.mesh.cells) && same(a.mesh.generatorTet, b.mesh.generatorTet) &&
         same(a.mesh.generatorCorners, b.mesh.generatorCorners) &&
         a.mesh.features == b.mesh.features && same(a.mesh.regions, b.mesh.regions) &&
         same(a.globalPoints, b.globalPoints) && same(a.globalCells, b.globalCells) &&
         same(a.pointOwners, b.pointOwners) && same(a.ghostParts, b.ghostParts) &&
         same(a.ghostLayers, b.ghostLayers) &&
         std::equal(a.neighbours.begin(), a.neighbours.end(), b.neighbours.begin(),
                    b.neighbours.end(), sameNeighbour);
}

}  // namespace hexhex::test
