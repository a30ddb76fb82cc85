// Serves a page to browsers of this machine.
#pragma once

#include <functional>
#include <string>

#include <hexhex/context.hpp>
#include <hexhex/view.hpp>

namespace hexhex::command {

/// Where the mesh of a served page is.
inline constexpr const char* kMeshUrl = "/mesh";

/// Serves the page at the loopback address until the context is cancelled. Requests that do not
/// name this address as their host are refused, so that no page from elsewhere reads the mesh.
/// @param port     0: any free one
/// @param onReady  called with the page's address once it can be opened
/// @throws Error InvalidArgument if the port is taken; FileUnsupported if the command was built
///         without a server
void servePage(const ServedPage& page, int port,
               const std::function<void(const std::string& address)>& onReady, Context& context);

}  // namespace hexhex::command
