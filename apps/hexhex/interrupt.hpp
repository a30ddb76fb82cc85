// Ctrl-C ends long work in an orderly way.
#pragma once

#include <hexhex/context.hpp>

namespace hexhex::command {

/// While it lives, SIGINT, SIGTERM and SIGHUP cancel the context. A second signal ends the process
/// at once.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Context& context);
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
};

}  // namespace hexhex::command
