// Working memory for the blocks of a parallel loop, reused from block to block.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

#include <base/parallel.hpp>

namespace hexhex {

/// Lends workspaces: as many as are in use at once, hence at most one per thread.
template <class Workspace>
class Workspaces {
 public:
  Workspaces() = default;
  Workspaces(const Workspaces&) = delete;
  Workspaces& operator=(const Workspaces&) = delete;

  /// Calls use(workspace) with a workspace that has been used before, or with a new one from
  /// make(). Thread-safe.
  template <class Make, class Use>
  void with(const Make& make, const Use& use) {
    std::unique_ptr<Workspace> workspace = take();
    if (!workspace) workspace.reset(new Workspace(make()));
    use(*workspace);
    // Not after an exception, which may leave it in any state.
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  /// Calls visit(workspace) for all that have been returned. Not while any is in use.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const std::unique_ptr<Workspace>& workspace : idle_) visit(std::as_const(*workspace));
  }

 private:
  /// nullptr if all are in use.
  std::unique_ptr<Workspace> take() {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty()) return nullptr;
    std::unique_ptr<Workspace> last = std::move(idle_.back());
    idle_.pop_back();
    return last;
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
};

/// Like parallelBlocks(), but lends each block a workspace that no other block uses at the same
/// time: f(begin, end, block, workspace). Workspaces come from make() and keep their contents from
/// block to block, so that memory is allocated once. No result may depend on what a block finds in
/// its workspace.
template <class Make, class F>
void parallelBlocksWith(Stage& stage, std::size_t n, std::size_t grain, const Make& make,
                        const F& f) {
  Workspaces<std::invoke_result_t<Make>> workspaces;
  parallelBlocks(stage, n, grain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    workspaces.with(make, [&](auto& workspace) { f(begin, end, block, workspace); });
  });
}

/// Like parallelFor(), with a workspace for each call, as above: f(i, workspace).
template <class Make, class F>
void parallelForWith(Stage& stage, std::size_t n, std::size_t grain, const Make& make, const F& f) {
  parallelBlocksWith(
      stage, n, grain, make,
      [&f](std::size_t begin, std::size_t end, std::size_t /*block*/, auto& workspace) {
        for (std::size_t i = begin; i < end; ++i) f(i, workspace);
      });
}

}  // namespace hexhex
