// SPDX-License-Identifier: MIT
#include "guard.h"

#include <array>
#include <cfenv>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <string>

#include "meshbound/error.h"
#include "meshbound/floating_point_scope.h"
#include "meshbound/stop_token.h"

namespace meshbound::c_interface {
namespace {

/// An array instead of a string: reporting that memory ran out must not allocate.
thread_local std::array<char, 512> last_message{};

mb_status failed(mb_status status, const char* message) {
  std::snprintf(last_message.data(), last_message.size(), "%s", message);
  return status;
}

/// Whether the process rounds to nearest and keeps denormal numbers. The scope that restores this mode costs a parallel
/// region, so it is made only for programs that have changed it.
bool is_default_mode() {
  volatile double tiny = std::numeric_limits<double>::min(), half = 0.5;
  return std::fegetround() == FE_TONEAREST && tiny * half != 0;
}

}  // namespace

mb_status guarded_call(int threads, const std::function<void()>& work) noexcept {
  try {
    std::optional<FloatingPointScope> scope;
    if (!is_default_mode()) scope.emplace(threads);
    work();
    return MB_OK;
  } catch (const InvalidInput& error) {
    return failed(MB_INVALID_INPUT, error.what());
  } catch (const Interrupted& error) {
    return failed(MB_CANCELLED, error.what());
  } catch (const Stopped& error) {
    return failed(MB_CANCELLED, error.what());
  } catch (const std::bad_alloc&) {
    return failed(MB_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    return failed(MB_FAILED, error.what());
  } catch (...) {
    return failed(MB_FAILED, "an unknown exception");
  }
}

void require(const void* pointer, const char* argument) {
  if (pointer == nullptr) throw InvalidInput("the argument " + std::string(argument) + " is NULL");
}

}  // namespace meshbound::c_interface

const char* mb_error_message() { return meshbound::c_interface::last_message.data(); }
int mb_abi_version() { return MB_ABI_VERSION; }
const char* mb_version() { return MESHBOUND_VERSION; }
