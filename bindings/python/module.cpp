// hexhex._hexhex: what the Python package hexhex is made of, over the public headers.
//
// Arrays come in as numpy arrays of exactly the right type and layout (the package converts
// others), and leave as views on meshes and maps that they keep alive. Long work runs in a thread
// of its own without the GIL, while the caller's thread looks for signals.
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include <nanobind/stl/string.h>

#include <hexhex/error.hpp>
#include <hexhex/repair.hpp>
#include <hexhex/version.hpp>

#include "border.hpp"

namespace hexhex::python {
namespace {

/// What Python raises for an error of the library: an instance of a class of hexhex._errors.
void translate(const std::exception_ptr& exception, void* /*payload*/) {
  const auto raise = [](ErrorCode code, const char* message, const Place& place) {
    const nb::object error = nb::module_::import_("hexhex._errors")
                                 .attr("make")(std::string(name(code)), message, toString(place),
                                               place.index, place.second);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
  };
  constexpr const char* kNoMemory = "Memory is exhausted. Use a smaller scale.";
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    raise(error.code(), error.what(), error.place());
  } catch (const std::bad_alloc&) {
    raise(ErrorCode::OutOfMemory, kNoMemory, {});
  } catch (const std::length_error&) {
    raise(ErrorCode::OutOfMemory, kNoMemory, {});
  } catch (const std::system_error&) {  // no thread to be had
    raise(ErrorCode::OutOfMemory, kNoMemory, {});
  }
}

}  // namespace

NB_MODULE(_hexhex, module) {
  nb::register_exception_translator(translate);
  // What a program still holds at its end is no leak worth a message.
  nb::set_leak_warnings(false);
  module.def("version", [] { return std::string(version()); });
  module.def("can_repair", &canRepair);
  bindMap(module);
  bindMesh(module);
  bindExtract(module);
  bindCurved(module);
  bindFiles(module);
  bindReports(module);
  bindQuantize(module);
  bindParts(module);
  bindTeam(module);
  bindImprove(module);
  bindShape(module);
}

}  // namespace hexhex::python
