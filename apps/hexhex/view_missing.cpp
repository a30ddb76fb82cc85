// `hexhex view` and --view in builds without the viewer page.
#include <hexhex/error.hpp>

#include "view_page.hpp"

namespace hexhex::command {
namespace {

[[noreturn]] void refuseWithoutViewer() {
  throw Error(ErrorCode::FileUnsupported,
              "This hexhex was built without the viewer page. Install nodejs, npm and zlib1g-dev, "
              "configure with -DHEXHEX_BUILD_VIEWER=ON, and build again; or write a .vtu file and "
              "open it in ParaView.");
}

}  // namespace

int view(const ViewArguments& /*arguments*/) { refuseWithoutViewer(); }

void requirePage(const std::string& page) {
  if (!page.empty()) refuseWithoutViewer();
}

void writePage(const HexMesh& /*mesh*/, const std::string& /*page*/, const std::string& /*output*/,
               ViewOptions /*options*/, Context& /*context*/) {
  refuseWithoutViewer();
}

void writePage(const LagrangeMesh& /*mesh*/, const std::string& /*page*/,
               const std::string& /*output*/, ViewOptions /*options*/, Context& /*context*/) {
  refuseWithoutViewer();
}

void writePartPage(const TetMesh& /*tets*/, const std::string& /*page*/,
                   const std::string& /*part*/, const Error& /*error*/, LongRun& /*longRun*/) {}

}  // namespace hexhex::command
