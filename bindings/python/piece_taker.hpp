// A sink to which Python hands a mesh in pieces.
#pragma once

#include <memory>

#include <hexhex/stream.hpp>

#include "border.hpp"

namespace hexhex::python {

/// A sink with the context that it wants.
class PieceTaker {
 public:
  void begin(std::uint64_t points, std::uint64_t cells) { sink_->begin(points, cells); }
  void points(std::uint64_t first, const InPoints& points, const In1<Index>& generatorTet,
              const In1<CornerSet>& generatorCorners) {
    sink_->points({first, elements<Vec3>(points), elements<Index>(generatorTet),
                   elements<CornerSet>(generatorCorners)});
  }
  void cells(std::uint64_t first, const InCells& cells) {
    sink_->cells(first, elements<Hex>(cells));
  }
  void cells64(std::uint64_t first, const In<std::uint64_t, 8>& cells) {
    sink_->cells(first, elements<Hex64>(cells));
  }
  void end() { sink_->end(); }

 protected:
  Context context_;
  std::unique_ptr<MeshSink> sink_;
};

template <class Taker>
void definePieces(nb::class_<Taker> binding) {
  using namespace nanobind::literals;
  const nb::call_guard<nb::gil_scoped_release> released;
  binding.def("begin", &Taker::begin, "points"_a, "cells"_a, released)
      .def("points", &Taker::points, "first"_a, "points"_a.noconvert(),
           "generator_tet"_a.noconvert(), "generator_corners"_a.noconvert(), released)
      .def("cells", &Taker::cells, "first"_a, "cells"_a.noconvert(), released)
      .def("cells64", &Taker::cells64, "first"_a, "cells"_a.noconvert(), released)
      .def("end", &Taker::end, released);
}

}  // namespace hexhex::python
