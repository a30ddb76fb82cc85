// A reference to something that can be called: std::function_ref of C++26 (P0792), as far as it is
// needed here. It owns nothing and allocates nothing, and compiles in a fraction of the time of
// std::function.
#pragma once

#include <memory>
#include <utility>

namespace hexhex {

template <class Signature>
class FunctionRef;

/// For arguments of functions: must not outlive what it refers to.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class F>
  FunctionRef(const F& function) noexcept
      : function_(std::addressof(function)),
        call_([](const void* f, Arguments... arguments) -> Result {
          return (*static_cast<const F*>(f))(std::forward<Arguments>(arguments)...);
        }) {}

  Result operator()(Arguments... arguments) const {
    return call_(function_, std::forward<Arguments>(arguments)...);
  }

 private:
  const void* function_;
  Result (*call_)(const void*, Arguments...);
};

}  // namespace hexhex
