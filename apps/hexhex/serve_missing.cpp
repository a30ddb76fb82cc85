// `hexhex view --serve` of a command that was built without a server.
#include <hexhex/error.hpp>

#include "serve_page.hpp"

namespace hexhex::command {

void servePage(const ServedPage& /*page*/, int /*port*/,
               const std::function<void(const std::string& address)>& /*onReady*/,
               Context& /*context*/) {
  throw Error(ErrorCode::FileUnsupported,
              "This hexhex was built without a server. Install libcpp-httplib-dev, configure, and "
              "build again; or leave out --serve.");
}

}  // namespace hexhex::command
