#include <algorithm>
#include <string>
#include <utility>

#include <adjacency/cell_faces.hpp>

#include <hexhex/parts.hpp>

namespace hexhex {

namespace {

/// A hash of numbers in their order: the finalizer of SplitMix64 (Steele, Lea, Flood, "Fast
/// splittable pseudorandom number generators", 2014) after each.
class Hash {
 public:
  void add(std::uint64_t number) noexcept {
    value_ += number + 0x9e3779b97f4a7c15U;
    value_ = (value_ ^ (value_ >> 30U)) * 0xbf58476d1ce4e5b9U;
    value_ = (value_ ^ (value_ >> 27U)) * 0x94d049bb133111ebU;
    value_ ^= value_ >> 31U;
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0;
};

/// Of what a part shares with a neighbour; the same from both sides.
std::uint64_t borderOf(const MeshPart& part, const PartNeighbour& neighbour) {
  Hash hash;
  hash.add(std::min(part.part, neighbour.part));
  hash.add(std::max(part.part, neighbour.part));
  hash.add(neighbour.vertices.size());
  for (const Index v : neighbour.vertices) hash.add(part.globalPoints[v]);
  for (const PartFace& face : neighbour.faces) {
    Quad quad = faceVertices(part.mesh.cells[face.cell], face.side);
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

void PartSurvey::begin(const PartsInfo& info) {
  info_ = info;
  summary_ = {};
  summary_.smallest = info.cellCount;
  sink_.begin(info);
}

void PartSurvey::part(MeshPart&& part) {
  summary_.cells += part.ownCells;
  summary_.largest = std::max(summary_.largest, part.ownCells);
  summary_.smallest = std::min(summary_.smallest, part.ownCells);
  if (part.ownCells == 0) ++summary_.empty;
  for (std::size_t c = 0; c < part.ownCells; ++c) cellSum_ += part.globalCells[c];
  for (std::size_t v = 0; v < part.ownPoints; ++v) {
    if (part.pointOwners[v] != part.part) continue;
    ++summary_.vertices;
    vertexSum_ += part.globalPoints[v];
  }
  std::vector<bool> shared(part.ownPoints, false);
  for (const PartNeighbour& neighbour : part.neighbours) {
    borders_ ^= borderOf(part, neighbour);
    for (const Index v : neighbour.vertices) shared[v] = true;
    if (part.part < neighbour.part) summary_.sharedFaces += neighbour.faces.size();
  }
  summary_.sharedVertices +=
      static_cast<std::uint64_t>(std::count(shared.begin(), shared.end(), true));
  summary_.mostNeighbours =
      std::max<std::uint64_t>(summary_.mostNeighbours, part.neighbours.size());
  sink_.part(std::move(part));
}

void PartSurvey::end() {
  const bool complete =
      summary_.cells == info_.cellCount && summary_.vertices == info_.pointCount &&
      cellSum_ == sumBelow(info_.cellCount) && vertexSum_ == sumBelow(info_.pointCount);
  if (!complete || borders_ != 0) {
    throw Error(ErrorCode::VerificationFailed,
                std::string("The parts do not make up one mesh: ") +
                    (complete ? "neighbours disagree on what they share"
                              : "cells or vertices are missing, or in two parts") +
                    ". Nothing was written. Please report this with the map.");
  }
  sink_.end();
}

}  // namespace hexhex
