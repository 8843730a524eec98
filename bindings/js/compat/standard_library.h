// SPDX-License-Identifier: MIT
/// Included before everything else: what the core uses of C++20 and the standard library of Emscripten 3.1.6 lacks.
#pragma once
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <type_traits>
#include <utility>
#include <version>

namespace std {

#if !defined(__cpp_lib_bit_cast)
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  return __builtin_bit_cast(To, from);
}
#endif

#if !defined(__cpp_lib_smart_ptr_for_overwrite)
template <class Array>
unique_ptr<Array> make_unique_for_overwrite(size_t size) {
  static_assert(is_array_v<Array>);
  return unique_ptr<Array>(new remove_extent_t<Array>[size]);
}
#endif

#if !defined(__cpp_lib_ranges)
namespace ranges {

template <class Range, class Predicate>
constexpr bool all_of(Range&& range, Predicate predicate) {
  return std::all_of(std::begin(range), std::end(range), std::move(predicate));
}

template <class Range, class Predicate>
constexpr bool any_of(Range&& range, Predicate predicate) {
  return std::any_of(std::begin(range), std::end(range), std::move(predicate));
}

template <class Range, class Predicate>
constexpr auto count_if(Range&& range, Predicate predicate) {
  return std::count_if(std::begin(range), std::end(range), std::move(predicate));
}

}  // namespace ranges
#endif

// As other standard libraries have it, for finite numbers and at least 32 characters of room.
to_chars_result to_chars(char* first, char* last, double value);

}  // namespace std
