// Memory that blocks of a parallel loop work in, one block after the other.
#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

#include <base/parallel.hpp>

namespace hexhex {

/// Lends workspaces: as many as are in use at the same time, hence at most one per thread.
template <class Workspace>
class Workspaces {
 public:
  Workspaces() = default;
  Workspaces(const Workspaces&) = delete;
  Workspaces& operator=(const Workspaces&) = delete;

  /// A workspace that goes back at the end of this object's life, unless an exception ends it:
  /// nobody knows in which state that leaves the workspace.
  class Loan {
   public:
    Loan(Workspaces& lender, std::unique_ptr<Workspace> workspace) noexcept
        : lender_(lender), workspace_(std::move(workspace)) {}
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    ~Loan() {
      if (std::uncaught_exceptions() == exceptions_) lender_.takeBack(std::move(workspace_));
    }

    [[nodiscard]] Workspace& operator*() const noexcept { return *workspace_; }

   private:
    Workspaces& lender_;
    std::unique_ptr<Workspace> workspace_;
    int exceptions_ = std::uncaught_exceptions();  ///< on their way when it was lent
  };

  /// One that was lent before, or what make() returns. Several threads may call this.
  template <class Make>
  [[nodiscard]] Loan lend(const Make& make) {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Workspace> last = std::move(idle_.back());
        idle_.pop_back();
        return Loan(*this, std::move(last));
      }
      idle_.reserve(++made_);  // so that nothing can fail when it comes back
    }
    return Loan(*this, std::unique_ptr<Workspace>(new Workspace(make())));
  }

  /// Calls visit(workspace) for all that came back. Not while any is lent.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const std::unique_ptr<Workspace>& workspace : idle_) visit(std::as_const(*workspace));
  }

 private:
  void takeBack(std::unique_ptr<Workspace> workspace) noexcept {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
  std::size_t made_ = 0;
};

/// As parallelBlocks(), and lends each block a workspace that no other one uses at the same time:
/// f(begin, end, block, workspace). Workspaces come from make(), and then from block to block with
/// all that they hold, so that what they allocate is allocated once. No result may depend on what a
/// block finds in them.
template <class Make, class F>
void parallelBlocksWith(Stage& stage, std::size_t n, std::size_t grain, const Make& make,
                        const F& f) {
  Workspaces<std::invoke_result_t<Make>> workspaces;
  parallelBlocks(stage, n, grain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    const auto loan = workspaces.lend(make);
    f(begin, end, block, *loan);
  });
}

/// As parallelFor(), and lends f(i, workspace) a workspace in the same way.
template <class Make, class F>
void parallelForWith(Stage& stage, std::size_t n, std::size_t grain, const Make& make, const F& f) {
  parallelBlocksWith(
      stage, n, grain, make,
      [&f](std::size_t begin, std::size_t end, std::size_t /*block*/, auto& workspace) {
        for (std::size_t i = begin; i < end; ++i) f(i, workspace);
      });
}

}  // namespace hexhex
