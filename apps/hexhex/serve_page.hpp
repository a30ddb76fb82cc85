// Serves a page to browsers of this machine.
#pragma once

#include <functional>
#include <string>

#include <hexhex/context.hpp>
#include <hexhex/view.hpp>

namespace hexhex::command {

/// Where the mesh of a served page is, seen from the page.
inline constexpr const char* kMeshUrl = "mesh";

/// Serves the page at the loopback address until the context is cancelled. The address has a secret
/// in it, since others may use the machine, too; and requests have to name this address as their
/// host, so that no page from elsewhere reads the mesh under a name of its own. Anything but GET
/// and HEAD of page and mesh is refused, and who is slow is let down: docs/developer/reliability.md
/// has the rules.
/// @param port     0: any free one
/// @param onReady  called with the page's address once it can be opened
/// @throws Error InvalidArgument if the port is taken
void servePage(const ServedPage& page, int port,
               const std::function<void(const std::string& address)>& onReady, Context& context);

}  // namespace hexhex::command
