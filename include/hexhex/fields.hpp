// The fields of reports by name, as Python has them, and the command's JSON but for some of
// extractions (docs/user/report.md).
#pragma once

#include <hexhex/check.hpp>
#include <hexhex/export.h>
#include <hexhex/extract.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/repair.hpp>
#include <hexhex/shape.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

// Each calls visit(const char* name, const auto& value) for the numbers, flags and texts of a
// report. Reports and lists of cells inside of it are left to the caller.

template <class Visit>
void visitFields(const Expectation& expected, const Visit& visit) {
  visit("cells", expected.cells);
  visit("boundary_quads", expected.boundaryQuads);
  visit("inner_singular_edges", expected.innerSingularEdges);
  visit("boundary_singular_edges", expected.boundarySingularEdges);
  visit("euler_characteristic", expected.eulerCharacteristic);
  visit("components", expected.components);
  visit("boundary_components", expected.boundaryComponents);
}

template <class Visit>
void visitFields(const CheckReport& report, const Visit& visit) {
  visit("points", report.points);
  visit("tets", report.tets);
  visit("edges", report.edges);
  visit("faces", report.faces);
  visit("inner_faces", report.innerFaces);
  visit("boundary_faces", report.boundaryFaces);
  visit("chart_jumps", report.chartJumps);
  visit("isolated_vertices", report.isolatedVertices);
  visit("tets_inverted_in_space", report.tetsInvertedInSpace);
  visit("mirrored", report.mirrored);
  visit("corners_reversed", report.cornersReversed);
  visit("max_transition_residual", report.maxTransitionResidual);
  visit("max_displacement", report.maxDisplacement);
  visit("inner_singular_tet_edges", report.innerSingularTetEdges);
  visit("boundary_singular_tet_edges", report.boundarySingularTetEdges);
  visit("singular_nodes", report.singularNodes);
  visit("boundary_genus", report.boundaryGenus);
}

template <class Visit>
void visitFields(const ExtractStatistics& statistics, const Visit& visit) {
  visit("seconds", statistics.seconds);
  visit("threads", statistics.threads);
  visit("mirrored", statistics.mirrored);
  visit("tets_inverted_in_space", statistics.tetsInvertedInSpace);
  visit("max_displacement", statistics.maxDisplacement);
  visit("max_transition_residual", statistics.maxTransitionResidual);
  visit("chart_jumps", statistics.chartJumps);
  visit("inner_faces", statistics.innerFaces);
  visit("singular_edges", statistics.singularEdges);
  visit("generators", statistics.generators);
  visit("vertices", statistics.vertices);
  visit("local_propellers", statistics.localPropellers);
  visit("global_propellers", statistics.globalPropellers);
  visit("charts", statistics.charts);
  visit("cut_faces", statistics.cutFaces);
  visit("overlapping_tets", statistics.overlappingTets);
  visit("traced_cells", statistics.tracedCells);
}

template <class Visit>
void visitFields(const RepairReport& report, const Visit& visit) {
  visit("bad_tets", report.badTets);
  visit("moved_vertices", report.movedVertices);
  visit("largest_move", report.largestMove);
  visit("rounded_vertices", report.roundedVertices);
  visit("split_edges", report.splitEdges);
  visit("added_tets", report.addedTets);
  visit("seconds", report.seconds);
}

template <class Visit>
void visitFields(const QuantizeReport& report, const Visit& visit) {
  visit("cells_wanted", report.cellsWanted);
  visit("cells", report.cells);
  visit("scale", report.scale);
  visit("displacement", report.displacement);
  visit("blocks", report.blocks);
  visit("arcs", report.arcs);
  visit("shortest_arc", report.shortestArc);
  visit("longest_arc", report.longestArc);
  visit("integers_by", report.integersBy);
  visit("attempts", report.attempts);
  visit("split_edges", report.splitEdges);
  visit("added_tets", report.addedTets);
}

template <class Visit>
void visitFields(const LabelReport& labels, const Visit& visit) {
  visit("charts", labels.charts);
  visit("corners", labels.corners);
  visit("bad_loops", labels.badLoops);
  visit("bad_corners", labels.badCorners);
  visit("opposite_edges", labels.oppositeEdges);
  visit("turning_points", labels.turningPoints);
  visit("wrong_turns", labels.wrongTurns);
  visit("flat_charts", labels.flatCharts);
  visit("deviation", labels.deviation);
}

template <class Visit>
void visitFields(const ShapeReport& report, const Visit& visit) {
  visit("label_moves", report.labelMoves);
  visit("added_tets", report.addedTets);
  visit("feature_edges", report.featureEdges);
  visit("tagged_edges", report.taggedEdges);
  visit("inner_faces", report.innerFaces);
  visit("aligned_faces", report.alignedFaces);
  visit("aligned_area", report.alignedArea);
}

template <class Visit>
void visitFields(const FillReport& report, const Visit& visit) {
  visit("mesher", report.mesher);
  visit("tet_size", report.tetSize);
  visit("tets", report.tets);
  visit("triangles", report.triangles);
  visit("bodies", report.bodies);
  visit("voids", report.voids);
  visit("volume", report.volume);
  visit("filled_volume", report.filledVolume);
  visit("flat_triangles", report.flatTriangles);
}

/// Without certificates, distances to the surface, numbers of vertices and the worst cell, which
/// JSON nests.
template <class Visit>
void visitFields(const ImproveReport& report, const Visit& visit) {
  visit("diagonal", report.diagonal);
  visit("inner_distance_before", report.innerDistanceBefore);
  visit("inner_distance_after", report.innerDistanceAfter);
  visit("far_cells_before", report.farCellsBefore);
  visit("moved_vertices", report.movedVertices);
  visit("largest_move", report.largestMove);
  visit("mean_move", report.meanMove);
  visit("off_surface", report.offSurface);
  visit("off_creases", report.offCreases);
  visit("added_cells", report.addedCells);
  visit("curve_length", report.curveLength);
  visit("curves_followed", report.curvesFollowed);
  visit("snapped_curves", report.snappedCurves);
  visit("seconds", report.seconds);
}

template <class Visit>
void visitFields(const PartsSummary& summary, const Visit& visit) {
  visit("cells", summary.cells);
  visit("vertices", summary.vertices);
  visit("largest", summary.largest);
  visit("smallest", summary.smallest);
  visit("empty", summary.empty);
  visit("shared_vertices", summary.sharedVertices);
  visit("shared_faces", summary.sharedFaces);
  visit("most_neighbours", summary.mostNeighbours);
}

}  // namespace HEXHEX_API_NAMESPACE
