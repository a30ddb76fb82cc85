#include <algorithm>
#include <array>
#include <span>
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
  summary_ = {};
  summary_.smallest = info.cellCount;
  sink_.begin(info);
}

void PartSummarySink::part(MeshPart&& part) {
  add(part);
  sink_.part(std::move(part));
}

void PartSummarySink::parts(std::span<MeshPart> parts) {
  for (const MeshPart& part : parts) add(part);
  sink_.parts(parts);
}

void PartSummarySink::add(const MeshPart& part) {
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
    borders_ ^= parts::borderOf(part, neighbour);
    for (const Index v : neighbour.vertices) shared[v] = true;
    if (part.part < neighbour.part) summary_.sharedFaces += neighbour.faces.size();
  }
  summary_.sharedVertices +=
      static_cast<std::uint64_t>(std::count(shared.begin(), shared.end(), true));
  summary_.mostNeighbours =
      std::max<std::uint64_t>(summary_.mostNeighbours, part.neighbours.size());
}

/// Combines the results of all processes.
void PartSummarySink::addUp() {
  const PartsSummary& own = summary_;
  const std::array<std::uint64_t, 11> mine = {
      own.cells,       own.vertices,       own.largest, own.smallest, own.empty, own.sharedVertices,
      own.sharedFaces, own.mostNeighbours, cellSum_,    vertexSum_,   borders_};
  const GatheredNumbers all = team_->gather(mine);
  summary_ = {};
  summary_.smallest = info_.cellCount;
  cellSum_ = vertexSum_ = borders_ = 0;
  for (std::uint32_t r = 0; r < team_->size(); ++r) {
    const std::span<const std::uint64_t> numbers = all.of(r);
    summary_.cells += numbers[0];
    summary_.vertices += numbers[1];
    summary_.largest = std::max(summary_.largest, numbers[2]);
    summary_.smallest = std::min(summary_.smallest, numbers[3]);
    summary_.empty += numbers[4];
    summary_.sharedVertices += numbers[5];
    summary_.sharedFaces += numbers[6];
    summary_.mostNeighbours = std::max(summary_.mostNeighbours, numbers[7]);
    cellSum_ += numbers[8];
    vertexSum_ += numbers[9];
    borders_ ^= numbers[10];
  }
}

void PartSummarySink::end() {
  if (team_ != nullptr) addUp();
  const bool complete = summary_.cells == info_.cellCount &&
                        summary_.vertices == info_.pointCount &&
                        cellSum_ == parts::sumBelow(info_.cellCount) &&
                        vertexSum_ == parts::sumBelow(info_.pointCount);
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
