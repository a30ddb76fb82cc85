// See ../rapidcheck.h.
#pragma once

#include <rapidcheck.h>

#include <gtest/gtest.h>

#define RC_GTEST_PROP(Suite, Name, Arguments)                          \
  void property##Suite##Name Arguments;                                \
  TEST(Suite, Name) { EXPECT_TRUE(rc::check(property##Suite##Name)); } \
  void property##Suite##Name Arguments
