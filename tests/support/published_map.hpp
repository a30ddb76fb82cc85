// Maps as programs publish them that trace motorcycle complexes: beside the tets, a `.hexex` file
// lists walls, which are triangles between blocks and all of the boundary; and then corners,
// curves, and once more all of the boundary as features.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <hexhex/types.hpp>

#include "support/sampled_distance.hpp"

namespace hexhex::test {

struct PublishedMap {
  std::string text;                              ///< of the file
  std::vector<std::array<Index, 3>> innerWalls;  ///< each ascending, sorted
};

/// @param map  with a region per block, and features: what generateSample() makes if asked for
///             features
/// @param withFeatures  otherwise the file ends after the walls
inline PublishedMap published(const TetMap& map, bool withFeatures = true) {
  PublishedMap result;
  std::map<std::array<Index, 3>, std::vector<std::size_t>> tetsOf;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (const auto& [a, b, c] : sampled::kFacesOfTet) {
      std::array<Index, 3> face = {map.tets[t][a], map.tets[t][b], map.tets[t][c]};
      std::sort(face.begin(), face.end());
      tetsOf[face].push_back(t);
    }
  }
  std::vector<std::array<Index, 3>> boundary;
  for (const auto& [face, tets] : tetsOf) {
    if (tets.size() == 1) boundary.push_back(face);
    if (tets.size() == 2 && map.regions[tets[0]] != map.regions[tets[1]]) {
      result.innerWalls.push_back(face);
    }
  }
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  const auto write = [&out](const auto& values) {
    for (const auto value : values) out << value << ' ';
  };
  const auto line = [&](const auto& values, const char* end = "") {
    write(values);
    out << end << '\n';
  };
  out << map.points.size() << '\n';
  for (const Vec3& point : map.points) line(point);
  out << map.tets.size() << '\n';
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    write(map.tets[t]);
    for (const Vec3& corner : map.parameters[t]) write(corner);
    out << '\n';
  }
  out << boundary.size() + result.innerWalls.size() << '\n';
  for (const auto& wall : result.innerWalls) line(wall, "1.5");
  for (const auto& wall : boundary) line(wall, "0");
  if (withFeatures) {
    out << map.features.vertices.size() << ' ' << map.features.edges.size() << ' '
        << boundary.size() << '\n';
    for (const FeatureVertex& vertex : map.features.vertices) out << vertex.vertex << '\n';
    for (const FeatureEdge& edge : map.features.edges) line(edge.vertices);
    for (const auto& face : boundary) line(face);
  }
  result.text = out.str();
  return result;
}

}  // namespace hexhex::test
