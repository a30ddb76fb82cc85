#include <hexhex/check.hpp>

#include <igm/measures.hpp>

namespace hexhex {

namespace {

void countElements(const TetTopology& topology, CheckReport& report) {
  report.edges = topology.edgeCount();
  for (const HalfFace mate : topology.mate) report.boundaryFaces += mate == kNone ? 1 : 0;
  report.innerFaces = (4 * topology.tetCount() - report.boundaryFaces) / 2;
  report.faces = report.innerFaces + report.boundaryFaces;
  for (Index v = 0; v < topology.pointCount; ++v) {
    report.isolatedVertices += topology.isIsolated(v) ? 1 : 0;
  }
}

void countSingularities(const Singularities& singularities, CheckReport& report) {
  for (const SingularEdge& edge : singularities.edges) {
    ++(edge.boundary ? report.boundarySingularTetEdges
                     : report.innerSingularTetEdges)[edge.valence];
  }
  for (Index v = 0; v + 1 < singularities.begin.size(); ++v) {
    report.singularNodes += singularities.isNode(v) ? 1 : 0;
  }
}

}  // namespace

CheckReport check(const TetMapView& map, const CheckOptions& options, Context& context) {
  CheckReport report;
  report.points = map.points.size();
  report.tets = map.tets.size();
  withThreads(context.threads(), [&] {
    DefectCollector defects;
    PreparedMap prepared = prepareMap(map, options.tolerance, options.scale, context, defects);
    Stage stage(context, "measures");
    report.defects = defects.defects();
    report.mirrored = prepared.input.mirrored;
    report.cornersReversed = prepared.input.cornersReversed;
    report.tetsInvertedInSpace = prepared.input.tetsInvertedInSpace;
    // What a defect kept from being computed stays empty, and is counted as nothing.
    if (!prepared.singularities.areKnown()) return;
    addEdges(prepared.topology, stage);
    countElements(prepared.topology, report);
    report.chartJumps = prepared.exact.transitions.nonTrivial;
    report.maxTransitionResidual = prepared.exact.transitions.maxResidual;
    report.maxDisplacement = prepared.exact.maxDisplacement;
    countSingularities(prepared.singularities, report);
    report.boundaryGenus = boundaryGenus(prepared.topology);
    if (report.valid()) report.expected = computeExpectation(prepared, options.scale);
  });
  return report;
}

CheckReport check(const TetMapView& map, const CheckOptions& options) {
  Context context;
  return check(map, options, context);
}

}  // namespace hexhex
