// The error that a call is expected to throw.
#pragma once

#include <string_view>

#include <gtest/gtest.h>

#include <hexhex/error.hpp>

namespace hexhex::test {

/// Calls f, which must throw an Error: a call that throws none fails the test, and any other
/// exception reaches the test runner.
template <class F>
Error errorOf(const F& f) {
  try {
    f();
  } catch (const Error& error) {
    EXPECT_GT(std::string_view(error.what()).size(), 20U) << "a sentence, please";
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::Internal, "no error"};
}

/// The code of that error.
template <class F>
ErrorCode codeOf(const F& f) {
  return errorOf(f).code();
}

}  // namespace hexhex::test
