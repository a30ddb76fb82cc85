// Tagged simplices of a tet mesh, and tagged vertices, edges and quads of a hex mesh: sharp edges,
// surface patches, corners of a CAD model. Tags accompany the mesh and never change it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hexhex/export.h>

namespace hexhex HEXHEX_API_NAMESPACE {

/// A tagged vertex. The creator of the mesh chooses the tags; 0 means "no feature", so elements
/// with tag 0 are not listed.
struct FeatureVertex {
  std::uint32_t vertex = 0;
  std::int32_t tag = 0;
  bool operator==(const FeatureVertex&) const = default;
};

/// A tagged edge, given by its two vertices in any order.
struct FeatureEdge {
  std::array<std::uint32_t, 2> vertices{};
  std::int32_t tag = 0;
  bool operator==(const FeatureEdge&) const = default;
};

/// A tagged triangle, given by its three vertices in any order.
struct FeatureFace {
  std::array<std::uint32_t, 3> vertices{};
  std::int32_t tag = 0;
  bool operator==(const FeatureFace&) const = default;
};

/// A tagged quad, given by its four vertices in cyclic order (any start, either direction).
struct FeatureQuad {
  std::array<std::uint32_t, 4> vertices{};
  std::int32_t tag = 0;
  bool operator==(const FeatureQuad&) const = default;
};

/// Name of a tag in a file; tags without an entry are named by their numbers.
struct TagName {
  int dimension = 0;  ///< dimension of the elements: 0 vertices, 1 edges, 2 faces, 3 cells (region)
  std::int32_t tag = 0;
  std::string name;
  bool operator==(const TagName&) const = default;
};

/// Features of a tet mesh. Each element is listed at most once.
struct Features {
  std::vector<FeatureVertex> vertices;
  std::vector<FeatureEdge> edges;
  std::vector<FeatureFace> faces;
  std::vector<TagName> names = {};

  [[nodiscard]] bool empty() const noexcept {
    return vertices.empty() && edges.empty() && faces.empty();
  }
  bool operator==(const Features&) const = default;
};

/// The same as a view of the caller's arrays.
struct FeaturesView {
  std::span<const FeatureVertex> vertices = {};
  std::span<const FeatureEdge> edges = {};
  std::span<const FeatureFace> faces = {};
  std::span<const TagName> names = {};

  FeaturesView() = default;
  FeaturesView(std::span<const FeatureVertex> vertices_, std::span<const FeatureEdge> edges_,
               std::span<const FeatureFace> faces_)
      : vertices(vertices_), edges(edges_), faces(faces_) {}
  // NOLINTNEXTLINE(google-explicit-constructor): features convert to a view of themselves.
  FeaturesView(const Features& features)
      : vertices(features.vertices),
        edges(features.edges),
        faces(features.faces),
        names(features.names) {}

  [[nodiscard]] Features copy() const {
    return {{vertices.begin(), vertices.end()},
            {edges.begin(), edges.end()},
            {faces.begin(), faces.end()},
            {names.begin(), names.end()}};
  }

  [[nodiscard]] bool empty() const noexcept {
    return vertices.empty() && edges.empty() && faces.empty();
  }
};

/// Features of a hex mesh. Each element is listed at most once.
struct HexFeatures {
  std::vector<FeatureVertex> vertices;
  std::vector<FeatureEdge> edges;
  std::vector<FeatureQuad> quads;
  std::vector<TagName> names = {};

  [[nodiscard]] bool empty() const noexcept {
    return vertices.empty() && edges.empty() && quads.empty();
  }
  bool operator==(const HexFeatures&) const = default;
};

}  // namespace HEXHEX_API_NAMESPACE
