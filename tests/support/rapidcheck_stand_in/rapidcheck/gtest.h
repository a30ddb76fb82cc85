// See ../rapidcheck.h.
#pragma once

#include <gtest/gtest.h>

#include <rapidcheck.h>

#define RC_GTEST_PROP(Suite, Name, Arguments)                          \
  void property##Suite##Name Arguments;                                \
  TEST(Suite, Name) { EXPECT_TRUE(rc::check(property##Suite##Name)); } \
  void property##Suite##Name Arguments
