// `hexhex view` of a command that was built without the viewer page.
#include <hexhex/error.hpp>

#include "view_page.hpp"

namespace hexhex::command {

int view(const ViewArguments& /*arguments*/) {
  throw Error(ErrorCode::FileUnsupported,
              "This hexhex was built without the viewer page. Install nodejs, npm and zlib1g-dev, "
              "configure with -DHEXHEX_BUILD_VIEWER=ON, and build again; or write a .vtu file and "
              "open it in ParaView.");
}

}  // namespace hexhex::command
