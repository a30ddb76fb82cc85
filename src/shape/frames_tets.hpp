// Tets that frames live on: split where frames would have no room, with frames and rotations
// carried along.
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

/// Tets that are positive in space.
class FrameTets {
 public:
  /// @param mesh  a manifold of positive tets
  FrameTets(TetMesh mesh, double featureAngleInDegrees, Stage& stage);

  [[nodiscard]] const TetMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const adjacency::TetTopology& topology() const noexcept { return topology_; }
  [[nodiscard]] std::size_t size() const noexcept { return mesh_.tets.size(); }
  /// Of a tet of the mesh given, the number of which this is a part.
  [[nodiscard]] Index parentOf(Index tet) const { return parents_[tet]; }
  [[nodiscard]] std::span<const Index> parents() const noexcept { return parents_; }
  [[nodiscard]] const tetmap::AddedVertices& added() const noexcept { return added_; }
  /// Edges of the boundary at which it turns by more than the angle, ascending.
  [[nodiscard]] const std::vector<VertexPair>& features() const noexcept { return features_; }
  [[nodiscard]] bool isFeature(const VertexPair& edge) const;

  [[nodiscard]] Eigen::Vector3d point(Index vertex) const {
    const Vec3& p = mesh_.points[vertex];
    return {p[0], p[1], p[2]};
  }
  /// Outwards, as long as twice the area.
  [[nodiscard]] Eigen::Vector3d normal(adjacency::HalfFace h) const;
  [[nodiscard]] double volume(Index tet) const;
  /// Of an edge, on the average.
  [[nodiscard]] double edgeLength() const noexcept { return edgeLength_; }
  /// Per vertex.
  [[nodiscard]] std::vector<bool> boundaryVertices() const;

  /// Splits tets until each has one constraint at most: a triangle of the boundary, or a feature,
  /// and that besides.
  void makeRoom(Stage& stage);
  /// Splits all edges that are longer than they are on the average.
  void refine(Stage& stage);
  /// Splits edges, the longest first. Parts of a tet inherit its frame.
  void split(std::vector<tetmap::EdgeInTet> edges, Stage& stage);

  std::vector<Frame> frames;  ///< per tet; none before there is a field
  /// Per half-face: from parameters of the tet here to those of its neighbour. Inverse to each
  /// other on both sides.
  std::vector<lattice::Rotation> rotations;

 private:
  void buildTopology(Stage& stage);
  void findFeatures(double angle, Stage& stage);
  void splitFeature(const VertexPair& edge, Index middle);
  void splitTets(const std::vector<Index>& tets, Stage& stage);
  [[nodiscard]] tetmap::BoundaryCurves boundaryCurves() const;
  /// Of boundary triangles between three features, one each.
  [[nodiscard]] std::vector<tetmap::EdgeInTet> edgesBetweenFeatures() const;

  TetMesh mesh_;
  std::vector<Index> parents_;
  tetmap::AddedVertices added_;
  std::vector<VertexPair> features_;
  adjacency::TetTopology topology_;
  double edgeLength_ = 0;
};

/// The tets around each edge in order: counterclockwise, seen from the edge's larger vertex.
class EdgeWalks {
 public:
  explicit EdgeWalks(const FrameTets& tets);

  [[nodiscard]] std::size_t size() const noexcept { return edges_.size(); }
  [[nodiscard]] const VertexPair& operator[](std::size_t edge) const { return edges_[edge]; }
  [[nodiscard]] bool isBoundary(std::size_t edge) const { return starts_[edge] != kNone; }
  /// Of a boundary edge: the half-face outside of the first tet. The last one of outs() is outside
  /// of the last tet.
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
