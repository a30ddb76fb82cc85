#include "run_guarded.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include <hexhex/error.hpp>

#include <vtkAlgorithm.h>

namespace hexhex::paraview {
namespace {

/// How often the progress bar moves.
constexpr std::chrono::milliseconds kInterval{50};

/// What the working thread tells the calling one.
struct State {
  std::mutex mutex;
  std::condition_variable changed;
  std::string stage;
  double share = 0;
  bool ended = false;
  std::string problem;
};

std::string asText(const Error& error) {
  const std::string place = toString(error.place());
  return std::string(error.what()) + " [" + std::string(name(error.code())) +
         (place.empty() ? "" : ", ") + place + "]";
}

std::string problemOf(const std::function<void(Context&)>& work, Context& context) {
  try {
    work(context);
    return {};
  } catch (const Error& error) {
    return asText(error);
  } catch (const std::bad_alloc&) {
    return "The memory does not suffice. Try a smaller scale. [OutOfMemory]";
  } catch (const std::exception& error) {
    return std::string("Unexpected: ") + error.what() + " [Internal]";
  }
}

}  // namespace

std::string runGuarded(vtkAlgorithm& algorithm, int threads,
                       const std::function<void(Context&)>& work) {
  State state;
  Context context(threads, [&state](std::string_view stage, double share) {
    const std::lock_guard lock(state.mutex);
    state.stage = stage;
    state.share = share;
  });
  std::thread worker([&] {
    std::string problem = problemOf(work, context);
    const std::lock_guard lock(state.mutex);
    state.problem = std::move(problem);
    state.ended = true;
    state.changed.notify_one();
  });
  for (std::unique_lock lock(state.mutex); !state.ended;) {
    state.changed.wait_for(lock, kInterval);
    const std::string stage = state.stage;
    const double share = state.share;
    // Observers may take their time, or run the algorithm's own functions.
    lock.unlock();
    algorithm.SetProgressText(stage.c_str());
    algorithm.UpdateProgress(share);
    if (algorithm.GetAbortExecute() != 0) context.cancel();
    lock.lock();
  }
  worker.join();
  return state.problem;
}

}  // namespace hexhex::paraview
