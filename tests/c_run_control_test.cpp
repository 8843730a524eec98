// SPDX-License-Identifier: MIT
// A call of the C interface can be watched, and ended by a request or by its progress function.
#include <gtest/gtest.h>
#include <meshbound.h>

#include <chrono>
#include <string>
#include <thread>

#include "c_calls.h"
#include "datasets/analytic_meshes.h"

namespace {

using meshbound::TriangleMesh;
using namespace meshbound::test;

class CRunControl : public testing::Test {
 protected:
  TriangleMesh torus_ = meshbound::datasets::torus(1, 0.3, 48, 24);
  TriangleMesh sphere_ = meshbound::datasets::icosphere(1, 3);
  TriangleMesh large_ = meshbound::datasets::terrain(1, 129, 3);
  mb_mesh a_ = c_mesh(torus_), b_ = c_mesh(sphere_), terrain_ = c_mesh(large_);

  /// The status that simplifying the terrain ends with, which takes long enough to be watched.
  [[nodiscard]] mb_status status_of(const mb_simplify_options& options) const {
    Simplification result;
    return mb_simplify(&terrain_, &options, &result.handle);
  }
};

TEST_F(CRunControl, EndsWhenItIsCancelled) {
  mb_cancel* cancel = mb_cancel_new();
  mb_cancel_request(cancel);
  auto distance_options = defaults(mb_distance_options_init);
  distance_options.cancel = cancel;
  mb_distance distance{};
  EXPECT_EQ(mb_measure(&a_, &b_, &distance_options, &distance), MB_CANCELLED);
  EXPECT_EQ(std::string(mb_error_message()), "cancelled");
  auto options = simplify_options(0.01);
  options.cancel = cancel;
  mb_simplification* result = nullptr;
  EXPECT_EQ(mb_simplify(&a_, &options, &result), MB_CANCELLED);
  EXPECT_EQ(result, nullptr);
  mb_cancel_reset(cancel);
  EXPECT_EQ(mb_measure(&a_, &b_, &distance_options, &distance), MB_OK);
  mb_cancel_free(cancel);
}

TEST_F(CRunControl, IsWatchedAndEndedByTheProgressFunction) {
  struct Seen {
    int calls = 0;
    std::thread::id thread;
    int answer = 0;
  } seen;
  auto options = simplify_options(0.01);
  options.user = &seen;
  options.progress = [](double fraction, void* user) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    auto* s = static_cast<Seen*>(user);
    ++s->calls;
    s->thread = std::this_thread::get_id();
    return s->answer;
  };
  ASSERT_EQ(status_of(options), MB_OK) << mb_error_message();
  EXPECT_GT(seen.calls, 0);
  EXPECT_EQ(seen.thread, std::this_thread::get_id());
  seen.answer = 1;
  EXPECT_EQ(status_of(options), MB_CANCELLED);
}

/// A request that comes while the call runs, here from its own progress function.
TEST_F(CRunControl, EndsAtARequestWhileItIsWatched) {
  mb_cancel* cancel = mb_cancel_new();
  auto options = simplify_options(0.01);
  options.cancel = cancel;
  options.user = cancel;
  options.progress = [](double, void* user) {
    mb_cancel_request(static_cast<mb_cancel*>(user));
    return 0;
  };
  EXPECT_EQ(status_of(options), MB_CANCELLED);
  options.progress = [](double, void*) { return 0; };
  EXPECT_EQ(status_of(options), MB_CANCELLED) << "the request stands until it is taken back";
  mb_cancel_reset(cancel);
  EXPECT_EQ(status_of(options), MB_OK) << mb_error_message();
  mb_cancel_free(cancel);
}

/// While a call runs that its progress function will end, another one with the same `mb_cancel` starts, and goes on.
TEST_F(CRunControl, ProgressEndsItsOwnCallOnly) {
  struct Other {
    const mb_mesh *a, *b;
    mb_distance_options options = defaults(mb_distance_options_init);
    mb_status status = MB_FAILED;
  } other{&a_, &b_};
  other.options.cancel = mb_cancel_new();
  other.options.progress = [](double, void*) { return 0; };
  auto options = simplify_options(0.01);
  options.cancel = other.options.cancel;
  options.user = &other;
  options.progress = [](double, void* user) {
    auto* call = static_cast<Other*>(user);
    mb_distance distance{};
    call->status = mb_measure(call->a, call->b, &call->options, &distance);
    return 1;
  };
  EXPECT_EQ(status_of(options), MB_CANCELLED);
  EXPECT_EQ(other.status, MB_OK);
  options.progress = nullptr;
  EXPECT_EQ(status_of(options), MB_OK) << "the caller's mb_cancel ended a call after the one that was to end";
  mb_cancel_free(options.cancel);
}

/// Calls that are over before a tenth of a second has passed, some before the library reports anything.
TEST_F(CRunControl, IsToldThatItIsDone) {
  struct Told {
    int calls = 0;
    double last = -1;
    static int note(double fraction, void* user) {
      auto* told = static_cast<Told*>(user);
      ++told->calls;
      return (told->last = fraction) > 1 ? 1 : 0;
    }
  } told;
  auto options = defaults(mb_distance_options_init);
  options.progress = Told::note;
  options.user = &told;
  const auto expect_told = [&](const char* call, mb_status status) {
    EXPECT_EQ(status, MB_OK) << call << ": " << mb_error_message();
    EXPECT_GE(told.calls, 1) << call;
    EXPECT_EQ(told.last, 1) << call;
    told = {};
  };
  mb_distance distance{};
  mb_verdict verdict{};
  expect_told("measure", mb_measure(&a_, &b_, &options, &distance));
  expect_told("check", mb_check(&a_, &b_, 3, &options, &verdict, &distance));
  mb_level_checker* checker = nullptr;
  expect_told("level_checker_new", mb_level_checker_new(&a_, &options, &checker));
  expect_told("level_checker_check", mb_level_checker_check(checker, &a_, 0, &options, &verdict, &distance));
  expect_told("level_checker_measure", mb_level_checker_measure(checker, &a_, &options, &distance));
  mb_level_checker_free(checker);
  mb_certificate* certificate = nullptr;
  expect_told("certificate_new", mb_certificate_new(&a_, &a_, 0.1, &options, &certificate));
  mb_certificate_free(certificate);
  auto simplification_options = simplify_options(0.01);
  simplification_options.progress = Told::note;
  simplification_options.user = &told;
  Simplification result;
  expect_told("simplify", mb_simplify(&a_, &simplification_options, &result.handle));
}

/// The call that says that the work is done can still end it.
TEST_F(CRunControl, EndsAtTheLastReport) {
  auto options = defaults(mb_distance_options_init);
  options.progress = [](double fraction, void*) { return fraction == 1 ? 1 : 0; };
  mb_level_checker* checker = nullptr;
  EXPECT_EQ(mb_level_checker_new(&a_, &options, &checker), MB_CANCELLED);
  EXPECT_EQ(checker, nullptr);
}

/// At most ten times a second, after the first call, and once at the end.
TEST_F(CRunControl, IsNotWatchedMoreOftenThanPeopleLook) {
  using Clock = std::chrono::steady_clock;
  int calls = 0;
  auto options = simplify_options(0.01);
  options.user = &calls;
  options.progress = [](double, void* user) {
    ++*static_cast<int*>(user);
    return 0;
  };
  const Clock::time_point start = Clock::now();
  ASSERT_EQ(status_of(options), MB_OK) << mb_error_message();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  EXPECT_LE(calls, 2 + 10 * seconds);
  EXPECT_GE(calls, 2);
}

}  // namespace
