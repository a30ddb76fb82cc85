// Generated maps, and what is known of their meshes.
#include <iterator>
#include <string>
#include <utility>

#include <hexhex/samples.hpp>

#include "handles.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

hexhex::SampleKind kindNamed(const char* kind) {
  for (const hexhex::SampleKindName& entry : hexhex::sampleKinds()) {
    if (entry.name == kind) return entry.kind;
  }
  throw Error(ErrorCode::InvalidArgument, std::string("There is no kind of map called \"") + kind +
                                              "\". Choose one of those in hexhex.h.");
}

hexhex::SampleOptions sampleOptions(const hexhex_sample_options* given) {
  const hexhex_sample_options options =
      hexhex::c::readStruct(given, HEXHEX_SAMPLE_OPTIONS_INIT, "options");
  if (options.charts < HEXHEX_CHARTS_ALIGNED || options.charts > HEXHEX_CHARTS_SCATTERED) {
    throw Error(ErrorCode::InvalidArgument, "There is no such style of charts.");
  }
  if (options.defect_kind < HEXHEX_DEFECTS_INTERIOR ||
      options.defect_kind > HEXHEX_DEFECTS_SLIVER) {
    throw Error(ErrorCode::InvalidArgument, "There is no such kind of defect.");
  }
  return {.cells = options.cells,
          .refine = options.refine,
          .valence = options.valence,
          .charts = static_cast<hexhex::ChartStyle>(options.charts),
          .jitter = options.jitter,
          .onLattice = options.on_lattice,
          .noise = options.noise,
          .offset = options.offset,
          .features = options.features != 0,
          .seed = options.seed,
          .defects = options.defects,
          .defectKind = static_cast<hexhex::DefectKind>(options.defect_kind)};
}

std::shared_ptr<const hexhex::SampleAnswer> answerOf(const hexhex_map* map) {
  const hexhex::c::Used given(map, "map");
  if (!given->answer) {
    throw Error(ErrorCode::InvalidArgument,
                "The map was not generated, so nothing is known of its mesh. Use hexhex_check().");
  }
  return given->answer;
}

/// work(table) of the table that a number means.
template <class Work>
void withTable(const hexhex::SampleAnswer& answer, hexhex_answer_table table, const Work& work) {
  switch (table) {
    case HEXHEX_ANSWER_INNER_EDGES:
      return work(answer.expected.innerSingularEdges);
    case HEXHEX_ANSWER_BOUNDARY_EDGES:
      return work(answer.expected.boundarySingularEdges);
    case HEXHEX_ANSWER_TAGGED_VERTICES:
      return work(answer.features.vertices);
    case HEXHEX_ANSWER_TAGGED_EDGES:
      return work(answer.features.edges);
    case HEXHEX_ANSWER_TAGGED_QUADS:
      return work(answer.features.quads);
  }
  throw Error(ErrorCode::InvalidArgument, "There is no such table of an answer.");
}

}  // namespace

hexhex_status hexhex_map_generate(const char* kind, const hexhex_sample_options* options,
                                  hexhex_map** map, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(map, "map");
    hexhex::Sample sample =
        hexhex::generateSample(kindNamed(&require(kind, "kind")), sampleOptions(options));
    auto answer = std::make_shared<const hexhex::SampleAnswer>(std::move(sample.answer));
    give(std::move(sample.map), map);
    (*map)->answer = std::move(answer);
  });
}

size_t hexhex_sample_kind_count(void) { return hexhex::sampleKinds().size(); }

hexhex_status hexhex_get_sample_kind(size_t number, const char** name, const char** description,
                                     hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    // Of literals, which end with a zero.
    const hexhex::SampleKindName& found = at(hexhex::sampleKinds(), number, "kinds of maps");
    if (name != nullptr) *name = found.name.data();
    if (description != nullptr) *description = found.description.data();
  });
}

const char* hexhex_defect_kind_name(hexhex_defect_kind kind) {
  for (const hexhex::DefectKindName& entry : hexhex::defectKinds()) {
    if (static_cast<int>(entry.kind) == static_cast<int>(kind)) return entry.name.data();
  }
  return "Unknown";
}

hexhex_status hexhex_map_get_answer(const hexhex_map* map, hexhex_sample_answer* answer,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const auto answerOfMap = answerOf(map);
    const hexhex::SampleAnswer& known = *answerOfMap;
    const hexhex_sample_answer result = {.size = sizeof(hexhex_sample_answer),
                                         .cells = known.expected.cells,
                                         .vertices = known.vertices,
                                         .boundary_quads = known.expected.boundaryQuads,
                                         .euler_characteristic = known.expected.eulerCharacteristic,
                                         .components = known.expected.components,
                                         .boundary_components = known.expected.boundaryComponents,
                                         .regions = known.features.regions};
    writeStruct(result, require(answer, "answer"), "answer");
  });
}

hexhex_status hexhex_map_count_answer(const hexhex_map* map, hexhex_answer_table table,
                                      size_t* entries, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    withTable(*answerOf(map), table,
              [&](const auto& found) { require(entries, "entries") = found.size(); });
  });
}

hexhex_status hexhex_map_get_answer_entry(const hexhex_map* map, hexhex_answer_table table,
                                          size_t number, int32_t* key, uint64_t* count,
                                          hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    withTable(*answerOf(map), table, [&](const auto& found) {
      if (number >= found.size()) {
        throw Error(ErrorCode::InvalidArgument, "There are " + std::to_string(found.size()) +
                                                    " entries; there is no number " +
                                                    std::to_string(number) + ".");
      }
      const auto entry = std::next(found.begin(), static_cast<std::ptrdiff_t>(number));
      if (key != nullptr) *key = entry->first;
      if (count != nullptr) *count = entry->second;
    });
  });
}
