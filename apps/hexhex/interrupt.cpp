#include "interrupt.hpp"

#include <atomic>
#include <csignal>

namespace hexhex::command {
namespace {

std::atomic<Context*> contextToCancel{nullptr};
static_assert(std::atomic<Context*>::is_always_lock_free, "signal handlers may not lock");

extern "C" void cancelContext(int signal) {
  if (Context* const context = contextToCancel.load()) context->cancel();
  std::signal(signal, SIG_DFL);
}

}  // namespace

CancelOnSignal::CancelOnSignal(Context& context) {
  contextToCancel = &context;
  std::signal(SIGINT, cancelContext);
  std::signal(SIGTERM, cancelContext);
#ifdef SIGHUP
  std::signal(SIGHUP, cancelContext);
#endif
}

CancelOnSignal::~CancelOnSignal() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
#ifdef SIGHUP
  std::signal(SIGHUP, SIG_DFL);
#endif
  contextToCancel = nullptr;
}

}  // namespace hexhex::command
