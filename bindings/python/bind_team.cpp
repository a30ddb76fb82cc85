// Meshes in parts by several processes, which Python connects: see hexhex/mpi.py.
#include <nanobind/stl/string.h>

#include <hexhex/io.hpp>
#include <hexhex/team.hpp>

#include "part_arrays.hpp"

using namespace nanobind::literals;

namespace hexhex::python {
namespace {

/// What a team takes is asked of a Python object, whose methods have these names. Other processes
/// would wait for ever for one that leaves them with an exception: it ends all of them.
class PythonTeam final : public ProcessTeam {
 public:
  explicit PythonTeam(nb::object team)
      : team_(std::move(team)),
        rank_(nb::cast<std::uint32_t>(team_.attr("rank"))),
        size_(nb::cast<std::uint32_t>(team_.attr("size"))) {}

  [[nodiscard]] std::uint32_t rank() const noexcept override { return rank_; }
  [[nodiscard]] std::uint32_t size() const noexcept override { return size_; }

 protected:
  [[nodiscard]] bool doAllSay(bool yes) override {
    bool all = false;
    ask([&] { all = nb::cast<bool>(team_.attr("all_say")(yes)); });
    return all;
  }
  void doShare(std::uint32_t from, std::span<std::byte> bytes) override {
    ask([&] { team_.attr("share")(from, arrayOf<std::uint8_t>(bytes)); });
  }
  void doGather(std::span<const std::uint64_t> mine, std::span<const std::uint64_t> counts,
                std::span<std::uint64_t> all) override {
    ask([&] {
      team_.attr("gather")(arrayOf<const std::uint64_t>(mine), arrayOf<const std::uint64_t>(counts),
                           arrayOf<std::uint64_t>(all));
    });
  }

 private:
  /// A numpy array on memory that lives as long as the call.
  template <class Scalar, class Element>
  static nb::object arrayOf(std::span<Element> elements) {
    const std::array<std::size_t, 1> shape{elements.size()};
    return nb::cast(viewOn<Scalar, 1>(elements, nb::none(), shape), nb::rv_policy::reference);
  }

  template <class Question>
  void ask(const Question& question) {
    const nb::gil_scoped_acquire gil;
    try {
      question();
    } catch (nb::python_error& error) {
      error.restore();
      PyErr_Print();
      team_.attr("abort")();
    }
  }

  nb::object team_;
  std::uint32_t rank_;
  std::uint32_t size_;
};

/// Runs work(team, map, context) in all processes, with what the first one has: a map, or the path
/// of one.
template <class Work>
auto runTogether(const nb::object& connected, const ArrayMap* map, const std::string& path,
                 int threads, const Progress& progress, const Work& work) {
  PythonTeam team(connected);
  return run(threads, progress, [&](Context& context) {
    decltype(work(team, TetMapView(), context)) result;
    team.run([&] {
      const bool reads = team.rank() == 0 && map == nullptr;
      const TetMap read = reads ? readMap(path, context) : TetMap{};
      const TetMapView mine = map == nullptr ? TetMapView(read) : map->view();
      const TetMap shared = shareMap(team, mine);
      result = work(team, team.rank() == 0 ? mine : TetMapView(shared), context);
    });
    return result;
  });
}

nb::tuple extractOne(const nb::object& connected, const ArrayMap* map, const std::string& path,
                     std::uint32_t ghosts, const std::string& partition, bool verify,
                     const Options& options, int threads, const Progress& progress) {
  const PartOptions parts = partOptions(1, ghosts, partition, verify);
  return partTuple(runTogether(connected, map, path, threads, progress,
                               [&](PythonTeam& team, const TetMapView& view, Context& context) {
                                 RepairedMap repaired;
                                 return extractPart(team, view, options.get(repaired), parts,
                                                    context);
                               }));
}

Dict extractTogether(const nb::object& connected, const std::string& file, const ArrayMap* map,
                     const std::string& path, std::uint32_t ghosts, const std::string& partition,
                     bool verify, const Options& options, const std::string& format, int threads,
                     const Progress& progress) {
  const PartOptions parts = partOptions(1, ghosts, partition, verify);
  WriteOptions writing;
  writing.format = format;
  return fieldsOf(runTogether(
      connected, map, path, threads, progress,
      [&](PythonTeam& team, const TetMapView& view, Context& context) {
        const std::unique_ptr<PartSink> sink = openPartSink(file, writing, context, &team);
        PartsSummary summary;
        RepairedMap repaired;
        extractPart(team, *sink, view, options.get(repaired), parts, context, nullptr, &summary);
        return summary;
      }));
}

}  // namespace

void bindTeam(nb::module_& module) {
  module.def("extract_part_of_team", &extractOne, "team"_a, "map"_a.none(), "path"_a, "ghosts"_a,
             "partition"_a, "verify"_a, "options"_a, "threads"_a, "progress"_a.none());
  module.def("extract_to_file_of_team", &extractTogether, "team"_a, "file"_a, "map"_a.none(),
             "path"_a, "ghosts"_a, "partition"_a, "verify"_a, "options"_a, "format"_a, "threads"_a,
             "progress"_a.none());
}

}  // namespace hexhex::python
