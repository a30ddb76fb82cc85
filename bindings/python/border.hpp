// The border between C++ and Python: arrays in and out without copies, long work without the GIL.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <hexhex/check.hpp>
#include <hexhex/context.hpp>
#include <hexhex/error.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/fields.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/quantize.hpp>
#include <hexhex/types.hpp>
#include <hexhex/verify.hpp>

namespace hexhex::python {

namespace nb = nanobind;

template <class Scalar, int kWidth>
using In = nb::ndarray<const Scalar, nb::shape<-1, kWidth>, nb::c_contig, nb::device::cpu>;
template <class Scalar>
using In1 = nb::ndarray<const Scalar, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using InPoints = In<double, 3>;
using InTets = In<Index, 4>;
using InCells = In<Index, 8>;
using InIgm = nb::ndarray<const double, nb::shape<-1, 4, 3>, nb::c_contig, nb::device::cpu>;
using Progress = std::optional<nb::typed<nb::callable, nb::object(nb::str, double)>>;
using Dict = nb::typed<nb::dict, nb::str, nb::any>;

template <class Element, class NdArray>
std::span<const Element> elements(const NdArray& array) {
  return {reinterpret_cast<const Element*>(array.data()), array.shape(0)};
}

/// The fields of a report by name.
template <class Report>
Dict fieldsOf(const Report& report) {
  Dict d;
  visitFields(report, [&d](const char* field, const auto& value) { d[field] = value; });
  return d;
}

template <class To, class From>
void assign(To& to, const From& from) {
  to.assign(from.begin(), from.end());
}

/// The arrays of a map, which live as long as this does.
struct ArrayMap {
  InPoints points;
  InTets tets;
  InIgm igm;
  In<std::int32_t, 2> featureVertices;  ///< vertex, tag
  In<std::int32_t, 3> featureEdges;     ///< vertices, tag
  In<std::int32_t, 4> featureFaces;     ///< vertices, tag
  In1<std::int32_t> regions;            ///< one per tet, or none
  In<std::int32_t, 3> edgeValences;     ///< vertices, offset
  In<std::int8_t, 4> rotations;         ///< one per tet, or none
  std::vector<TagName> names = {};

  [[nodiscard]] TetMapView view() const;
  [[nodiscard]] TetMap copy() const;
};

/// An element of an array as a row of a numpy array: its scalars, and how many there are.
template <class Element>
struct Row {
  using Scalar = Element;
  static constexpr std::array<std::size_t, 0> kShape = {};
};
template <class Element>
requires std::is_enum_v<Element>
struct Row<Element> : Row<std::underlying_type_t<Element>> {
};
/// Tagged elements, all of whose numbers have 32 bits.
template <class Element>
requires std::is_class_v<Element>
struct Row<Element> {
  using Scalar = std::int32_t;
  static constexpr std::array<std::size_t, 1> kShape = {sizeof(Element) / sizeof(Scalar)};
};
template <class Element, std::size_t n>
struct Row<std::array<Element, n>> {
  using Scalar = typename Row<Element>::Scalar;
  static constexpr auto kShape = [] {
    std::array<std::size_t, 1 + Row<Element>::kShape.size()> shape = {n};
    std::copy(Row<Element>::kShape.begin(), Row<Element>::kShape.end(), shape.begin() + 1);
    return shape;
  }();
};

/// A numpy array on the scalars of `list`, which `owner` keeps alive.
template <class Scalar, std::size_t kRank, class List>
auto viewOn(List& list, nb::handle owner, const std::array<std::size_t, kRank>& shape) {
  using Element = std::conditional_t<std::is_const_v<List>, const Scalar, Scalar>;
  using Out = nb::ndarray<nb::numpy, Element, nb::ndim<kRank>, nb::c_contig>;
  return Out(reinterpret_cast<Element*>(list.data()), kRank, shape.data(), owner);
}

/// The same with a row for each element.
template <class List>
auto viewOn(List& list, nb::handle owner) {
  using Of = Row<typename List::value_type>;
  std::array<std::size_t, 1 + Of::kShape.size()> shape = {list.size()};
  std::copy(Of::kShape.begin(), Of::kShape.end(), shape.begin() + 1);
  return viewOn<typename Of::Scalar, 1 + Of::kShape.size()>(list, owner, shape);
}

/// A numpy array that owns a list, which is moved into it.
template <class List>
auto ownedArray(List list) {
  auto* const moved = new List(std::move(list));
  const nb::capsule owner(moved, [](void* kept) noexcept { delete static_cast<List*>(kept); });
  return viewOn(*moved, owner);
}

/// Runs work(context) in a thread of its own, without the GIL. A signal (Ctrl-C) or an exception in
/// the progress function cancels it, and is raised when it has ended.
/// @param stages  what ran and how long, if not null
void runWork(int threads, const Progress& progress, const std::function<void(Context&)>& work,
             std::vector<StageTime>* stages = nullptr);

/// Names of tags, as Python has them: (dimension, tag, name) each.
using NameRow = std::tuple<int, std::int32_t, std::string>;
[[nodiscard]] std::vector<NameRow> rowsOf(const std::vector<TagName>& names);
[[nodiscard]] std::vector<TagName> namesOf(const std::vector<NameRow>& rows);

/// The same with a result.
template <class Work>
auto run(int threads, const Progress& progress, const Work& work,
         std::vector<StageTime>* stages = nullptr) {
  using Result = decltype(work(std::declval<Context&>()));
  if constexpr (std::is_void_v<Result>) {
    runWork(threads, progress, work, stages);
  } else {
    std::optional<Result> result;
    runWork(
        threads, progress, [&](Context& context) { result.emplace(work(context)); }, stages);
    return std::move(*result);
  }
}

/// What an extraction tells beside its mesh.
struct Notes {
  ExtractStatistics statistics = {};
  RepairedMap repaired = {};
  std::vector<StageTime> stages = {};
};

/// The C++ object of a Python object, e.g. to make views that keep it alive.
template <class T>
T& unwrapped(nb::handle self) {
  return *nb::inst_ptr<T>(self);
}

/// Defines a property that is a view on a list of an object, and keeps the object alive.
/// @param listOf  a member, or a function from the object to the list
template <class T, class ListOf>
void defineView(nb::class_<T>& binding, const char* name, const ListOf& listOf) {
  binding.def_prop_ro(name, [listOf](nb::handle self) {
    return viewOn(std::invoke(listOf, unwrapped<T>(self)), self);
  });
}

/// What every extraction may be told.
struct Options {
  int scale = 1;
  bool propeller = false;
  double tolerance = 1e-2;
  bool repair = false;
  bool round = false;
  bool exactNodes = false;
  /// @param repaired  receives the map if it is to be repaired
  [[nodiscard]] ExtractOptions get(RepairedMap& repaired) const;
};

[[nodiscard]] Error adviceOn(const Error& error, const ArrayMap& map, int threads);

/// (statistics, report of the repair or None, repaired map or None)
[[nodiscard]] nb::tuple asTuple(const Notes& notes);

/// What work(context, notes) makes, and what it tells beside that; the latter alone if it
/// makes nothing.
template <class Work>
nb::tuple runNoted(int threads, const Progress& progress, const Work& work) {
  Notes notes;
  const auto noted = [&](Context& context) { return work(context, notes); };
  if constexpr (std::is_void_v<decltype(noted(std::declval<Context&>()))>) {
    run(threads, progress, noted, &notes.stages);
    return asTuple(notes);
  } else {
    auto made = run(threads, progress, noted, &notes.stages);
    return nb::make_tuple(std::move(made), asTuple(notes));
  }
}

/// work(), whose error for a map that is not integer says how Python quantizes it.
template <class Work>
auto advising(const ArrayMap& map, int threads, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw adviceOn(error, map, threads);
  }
}

/// Names and seconds.
[[nodiscard]] nb::list asList(const std::vector<StageTime>& stages);

/// Copies of both, for functions that need nothing else.
[[nodiscard]] TetMesh tetMeshOf(const InPoints& points, const InTets& tets);

/// The fields of the class Quality, in their order.
[[nodiscard]] nb::tuple asTuple(Certificate&& certificate);
[[nodiscard]] Dict asDict(const RepairReport& report);
[[nodiscard]] Dict asDict(const QuantizeReport& report);
/// (quality before, quality after, the rest)
[[nodiscard]] nb::tuple asTuple(ImproveReport&& report);
/// (name, expected, found, whether it passed) of each check
[[nodiscard]] nb::list asList(const VerifyReport& report);
[[nodiscard]] nb::list asList(const std::vector<Defect>& defects);

void bindMap(nb::module_& module);
void bindMesh(nb::module_& module);
void bindExtract(nb::module_& module);
void bindCurved(nb::module_& module);
void bindFiles(nb::module_& module);
void bindReports(nb::module_& module);
void bindQuantize(nb::module_& module);
void bindParts(nb::module_& module);
void bindTeam(nb::module_& module);
void bindImprove(nb::module_& module);
void bindShape(nb::module_& module);

}  // namespace hexhex::python
