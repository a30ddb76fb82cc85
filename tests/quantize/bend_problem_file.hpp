// Problems of bending as text files, so that those of real maps can be kept.
//
//     bend POINTS TETS
//     x y z                                     per point
//     v0 v1 v2 v3                               per tet, then in the same block of lines:
//     u v w  u v w  u v w  u v w                its reference parameters, corner by corner
//     r tx ty tz  r tx ty tz  r tx ty tz  r tx ty tz    per half-face: Rotation::index(),
//     translation axis c  axis c  axis c  axis c            per half-face: BoundaryPlane (axis -1:
//     none)
//     irregular COUNT, then v w quarters        per edge with other than 4 inside, 2 on the
//     boundary
//
// Doubles have 17 digits. What is unused (transitions on the boundary) is 0 0 0 0.
#pragma once

#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <string>

#include <quantize/bend/bend.hpp>

namespace hexhex::quantization {

inline void writeBendProblem(const std::string& path, const BendProblem& problem) {
  std::ofstream out(path);
  out << std::setprecision(17) << "bend " << problem.points.size() << ' ' << problem.tets.size()
      << '\n';
  const auto vector = [&out](const auto& v) { out << v[0] << ' ' << v[1] << ' ' << v[2] << ' '; };
  for (const Vec3& p : problem.points) {
    vector(p);
    out << '\n';
  }
  for (std::size_t t = 0; t < problem.tets.size(); ++t) {
    for (const Index v : problem.tets[t]) out << v << ' ';
    out << '\n';
    for (const Vec3& u : problem.reference[t]) vector(u);
    out << '\n';
    for (std::size_t h = 4 * t; h < 4 * t + 4; ++h) {
      out << problem.transitions[h].rotation.index() << ' ';
      vector(problem.transitions[h].translation);
    }
    out << '\n';
    for (std::size_t h = 4 * t; h < 4 * t + 4; ++h) {
      out << int{problem.planes[h].axis} << ' ' << problem.planes[h].coordinate << ' ';
    }
    out << '\n';
  }
  out << "irregular " << problem.irregularEdges.size() << '\n';
  for (const auto& [edge, quarters] : problem.irregularEdges) {
    out << edge[0] << ' ' << edge[1] << ' ' << quarters << '\n';
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

inline BendProblem readBendProblem(const std::string& path) {
  std::ifstream in(path);
  std::string word;
  std::size_t points = 0;
  std::size_t tets = 0;
  in >> word >> points >> tets;
  if (!in || word != "bend") throw std::runtime_error(path + " is no problem of bending");
  BendProblem problem;
  problem.points.resize(points);
  problem.tets.resize(tets);
  problem.reference.resize(tets);
  problem.transitions.resize(4 * tets);
  problem.planes.resize(4 * tets);
  const auto vector = [&in](auto& v) { in >> v[0] >> v[1] >> v[2]; };
  for (Vec3& p : problem.points) vector(p);
  for (std::size_t t = 0; t < tets; ++t) {
    for (Index& v : problem.tets[t]) in >> v;
    for (Vec3& u : problem.reference[t]) vector(u);
    for (std::size_t h = 4 * t; h < 4 * t + 4; ++h) {
      int rotation = 0;
      in >> rotation;
      problem.transitions[h].rotation = lattice::Rotation(rotation);
      vector(problem.transitions[h].translation);
    }
    for (std::size_t h = 4 * t; h < 4 * t + 4; ++h) {
      int axis = 0;
      in >> axis >> problem.planes[h].coordinate;
      problem.planes[h].axis = static_cast<std::int8_t>(axis);
    }
  }
  std::size_t edges = 0;
  in >> word >> edges;
  for (std::array<Index, 2> edge{}; edges > 0; --edges) {
    in >> edge[0] >> edge[1];
    in >> problem.irregularEdges[edge];
  }
  if (!in || word != "irregular") throw std::runtime_error(path + " ends too early");
  return problem;
}

}  // namespace hexhex::quantization
