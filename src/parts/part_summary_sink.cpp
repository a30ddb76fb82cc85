#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <string>
#include <utility>

#include <adjacency/cell_faces.hpp>
#include <parts/number_hash.hpp>

#include <hexhex/parts.hpp>
#include <hexhex/team.hpp>

namespace hexhex::parts {

namespace {

/// Hash of what a part shares with a neighbour; the same from both sides.
std::uint64_t borderOf(const MeshPart& part, const PartNeighbour& neighbour) {
  NumberHash hash;
  hash.add(std::min(part.part, neighbour.part));
  hash.add(std::max(part.part, neighbour.part));
  hash.add(neighbour.vertices.size());
  for (const Index v : neighbour.vertices) hash.add(part.globalPoints[v]);
  for (const PartFace& face : neighbour.faces) {
    Quad quad = adjacency::faceVertices(part.mesh.cells[face.cell], face.side);
    std::sort(quad.begin(), quad.end());
    for (const Index v : quad) hash.add(part.globalPoints[v]);
  }
  return hash.value();
}

/// 0 + 1 + ... + (count - 1), modulo 2^64.
std::uint64_t sumBelow(std::uint64_t count) {
  return count % 2 == 0 ? count / 2 * (count - 1) : (count - 1) / 2 * count;
}

}  // namespace

}  // namespace hexhex::parts

namespace hexhex {

void PartSummarySink::begin(const PartsInfo& info) {
  info_ = info;
  sums_ = {};
  sums_.summary.smallest = info.cellCount;
  sink_.begin(info);
}

void PartSummarySink::part(MeshPart&& part) {
  const Sums ofPart = sumsOf(part);
  {
    const std::lock_guard lock(mutex_);
    sums_.add(ofPart);
  }
  sink_.part(std::move(part));
}

PartSummarySink::Sums PartSummarySink::sumsOf(const MeshPart& part) {
  Sums sums;
  PartsSummary& summary = sums.summary;
  summary.cells = summary.largest = summary.smallest = part.ownCells;
  summary.empty = part.ownCells == 0 ? 1 : 0;
  summary.mostNeighbours = part.neighbours.size();
  for (std::size_t c = 0; c < part.ownCells; ++c) sums.cells += part.globalCells[c];
  for (std::size_t v = 0; v < part.ownPoints; ++v) {
    if (part.pointOwners[v] != part.part) continue;
    ++summary.vertices;
    sums.vertices += part.globalPoints[v];
  }
  std::vector<bool> shared(part.ownPoints, false);
  for (const PartNeighbour& neighbour : part.neighbours) {
    sums.borders ^= parts::borderOf(part, neighbour);
    for (const Index v : neighbour.vertices) shared[v] = true;
    if (part.part < neighbour.part) summary.sharedFaces += neighbour.faces.size();
  }
  summary.sharedVertices =
      static_cast<std::uint64_t>(std::count(shared.begin(), shared.end(), true));
  return sums;
}

void PartSummarySink::Sums::add(const Sums& others) {
  const PartsSummary& other = others.summary;
  summary.cells += other.cells;
  summary.vertices += other.vertices;
  summary.largest = std::max(summary.largest, other.largest);
  summary.smallest = std::min(summary.smallest, other.smallest);
  summary.empty += other.empty;
  summary.sharedVertices += other.sharedVertices;
  summary.sharedFaces += other.sharedFaces;
  summary.mostNeighbours = std::max(summary.mostNeighbours, other.mostNeighbours);
  cells += others.cells;
  vertices += others.vertices;
  borders ^= others.borders;
}

void PartSummarySink::end() {
  if (team_ != nullptr) {
    using Numbers = std::array<std::uint64_t, sizeof(Sums) / sizeof(std::uint64_t)>;
    const GatheredNumbers all = team_->gather(std::bit_cast<Numbers>(sums_));
    for (std::uint32_t r = 0; r < team_->size(); ++r) {
      if (r == team_->rank()) continue;
      Numbers numbers{};
      std::copy_n(all.of(r).begin(), numbers.size(), numbers.begin());
      sums_.add(std::bit_cast<Sums>(numbers));
    }
  }
  const bool complete = sums_.summary.cells == info_.cellCount &&
                        sums_.summary.vertices == info_.pointCount &&
                        sums_.cells == parts::sumBelow(info_.cellCount) &&
                        sums_.vertices == parts::sumBelow(info_.pointCount);
  if (!complete || sums_.borders != 0) {
    throw Error(ErrorCode::VerificationFailed,
                std::string("The parts do not make up one mesh: ") +
                    (complete ? "neighbours disagree on what they share"
                              : "cells or vertices are missing, or in two parts") +
                    ". Nothing was written. Please report this with the map.");
  }
  sink_.end();
}

}  // namespace hexhex
