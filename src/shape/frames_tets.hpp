// The tets of a frame field, split where a frame would have to meet two conditions; frames and
// rotations are carried along.
#pragma once

#include <cstddef>
#include <vector>

#include <adjacency/edge_fan.hpp>
#include <quantize/seamless/cut_graph.hpp>
#include <shape/frames_tensor.hpp>
#include <tetmap/boundary_curves.hpp>
#include <tetmap/carried_tags.hpp>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <lattice/rotation.hpp>

namespace hexhex::shape {

using tetmap::VertexPair;

/// All tets have positive volume.
class FrameTets {
 public:
  /// @param mesh  a manifold of positive tets
  FrameTets(TetMesh mesh, double featureAngleInDegrees, Stage& stage);

  [[nodiscard]] const TetMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const adjacency::TetTopology& topology() const noexcept { return topology_; }
  [[nodiscard]] std::size_t size() const noexcept { return mesh_.tets.size(); }
  /// The tet of the given mesh that contains a tet.
  [[nodiscard]] Index parentOf(Index tet) const { return parents_[tet]; }
  [[nodiscard]] std::span<const Index> parents() const noexcept { return parents_; }
  [[nodiscard]] const tetmap::AddedVertices& added() const noexcept { return added_; }
  /// Boundary edges with more than the feature angle between normals, ascending.
  [[nodiscard]] const std::vector<VertexPair>& features() const noexcept { return features_; }
  [[nodiscard]] bool isFeature(const VertexPair& edge) const;

  [[nodiscard]] Eigen::Vector3d point(Index vertex) const {
    const Vec3& p = mesh_.points[vertex];
    return {p[0], p[1], p[2]};
  }
  /// The outward normal, with twice the area as length.
  [[nodiscard]] Eigen::Vector3d normal(adjacency::HalfFace h) const;
  [[nodiscard]] double volume(Index tet) const;
  /// An estimate of the mean edge length.
  [[nodiscard]] double edgeLength() const noexcept { return edgeLength_; }
  /// Per vertex, whether it is on the boundary.
  [[nodiscard]] std::vector<bool> boundaryVertices() const;

  /// Splits tets until each has at most one boundary triangle and one feature edge.
  void makeRoom(Stage& stage);
  /// Splits all edges longer than edgeLength().
  void refine(Stage& stage);
  /// Splits edges, the longest first. Parts of a tet inherit its frame.
  void split(std::vector<tetmap::EdgeInTet> edges, Stage& stage);

  std::vector<Frame> frames;  ///< per tet; empty until there is a field
  /// Per half-face: from parameters of its tet to those of the neighbour. Inverse to that of the
  /// mate.
  std::vector<lattice::Rotation> rotations;

 private:
  void buildTopology(Stage& stage);
  void findFeatures(double angle, Stage& stage);
  void splitFeature(const VertexPair& edge, Index middle);
  void splitTets(const std::vector<Index>& tets, Stage& stage);
  [[nodiscard]] tetmap::BoundaryCurves boundaryCurves() const;
  /// One edge of each boundary triangle with three feature edges.
  [[nodiscard]] std::vector<tetmap::EdgeInTet> edgesBetweenFeatures() const;

  TetMesh mesh_;
  std::vector<Index> parents_;
  tetmap::AddedVertices added_;
  std::vector<VertexPair> features_;
  adjacency::TetTopology topology_;
  double edgeLength_ = 0;
};

/// The tets around each edge in order, counterclockwise as seen from the edge's second vertex.
class EdgeWalks {
 public:
  explicit EdgeWalks(const FrameTets& tets);

  [[nodiscard]] std::size_t size() const noexcept { return edges_.size(); }
  [[nodiscard]] const VertexPair& operator[](std::size_t edge) const { return edges_[edge]; }
  [[nodiscard]] bool isBoundary(std::size_t edge) const { return starts_[edge] != kNone; }
  /// The half-face where the walk around a boundary edge enters its first tet; the last one of
  /// outs() is on the boundary, too. kNone for inner edges.
  [[nodiscard]] adjacency::HalfFace start(std::size_t edge) const { return starts_[edge]; }
  /// The half-faces through which the walk leaves its tets.
  [[nodiscard]] std::span<const adjacency::HalfFace> outs(std::size_t edge) const {
    return std::span(outs_).subspan(begins_[edge], begins_[edge + 1] - begins_[edge]);
  }
  /// The three edges of a triangle.
  [[nodiscard]] std::array<Index, 3> edgesOf(adjacency::HalfFace h) const;
  [[nodiscard]] const adjacency::EdgeFans& fans() const noexcept { return fans_; }

 private:
  adjacency::EdgeFans fans_;
  std::vector<VertexPair> edges_;
  std::vector<adjacency::HalfFace> starts_;
  std::vector<std::size_t> begins_ = {0};
  std::vector<adjacency::HalfFace> outs_;
};

}  // namespace hexhex::shape
