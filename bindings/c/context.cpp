#include <string>

#include "handles.hpp"

namespace {

hexhex::Context::Progress asFunction(hexhex_context& context, hexhex_progress progress,
                                     void* user) {
  if (progress == nullptr) return {};
  return [&context, progress, user](std::string_view stage, double share) {
    if (progress(user, std::string(stage).c_str(), share) != 0) context.context.cancel();
  };
}

}  // namespace

hexhex_context::hexhex_context(int threads, hexhex_progress progress, void* user)
    : context(threads, asFunction(*this, progress, user)) {}

hexhex_status hexhex_context_create(const hexhex_context_options* options, hexhex_context** context,
                                    hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const hexhex_context_options given =
        readStruct(options, HEXHEX_CONTEXT_OPTIONS_INIT, "options");
    if (given.threads < 0) {
      throw hexhex::Error(hexhex::ErrorCode::InvalidArgument,
                          "The number of threads is " + std::to_string(given.threads) +
                              ". Choose it from 1, or 0 for all cores.");
    }
    require(context, "context");
    *context = enter(std::make_unique<hexhex_context>(given.threads, given.progress, given.user));
  });
}

void hexhex_context_destroy(hexhex_context* context) { hexhex::c::destroy(context); }

void hexhex_context_cancel(hexhex_context* context) {
  if (const hexhex::c::Used used(context, std::nothrow, hexhex::c::Use::Look); used) {
    used->context.cancel();
  }
}

int hexhex_context_cancelled(const hexhex_context* context) {
  const hexhex::c::Used used(context, std::nothrow, hexhex::c::Use::Look);
  return used && used->context.cancelled() ? 1 : 0;
}

int hexhex_context_threads(const hexhex_context* context) {
  const hexhex::c::Used used(context, std::nothrow, hexhex::c::Use::Look);
  return used ? used->context.threads() : 0;
}

size_t hexhex_context_stage_count(const hexhex_context* context) {
  const hexhex::c::Used used(context, std::nothrow);
  return used ? used->context.stageTimes().size() : 0;
}

hexhex_status hexhex_context_stage(const hexhex_context* context, size_t stage, const char** name,
                                   double* seconds, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(context, "context");
    const auto& times = used->context.stageTimes();
    if (stage >= times.size()) {
      throw hexhex::Error(hexhex::ErrorCode::InvalidArgument,
                          "There is no stage " + std::to_string(stage) + ".");
    }
    if (name != nullptr) *name = times[stage].stage.c_str();
    if (seconds != nullptr) *seconds = times[stage].seconds;
  });
}
