// SPDX-License-Identifier: MIT
/// Options out of the keyword arguments of a function of the package. What an option cannot be is `InvalidInput` with
/// its name.
#pragma once
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "meshbound/error.h"

namespace meshbound::python {

/// The value of `name` among the keyword arguments as a `Value`; absent where it is None or left out. Throws
/// `InvalidInput` where it cannot be one: `name` must be `description`.
template <class Value>
std::optional<Value> taken(const pybind11::dict& given, const char* name, const char* description) {
  if (!given.contains(name) || given[name].is_none()) return std::nullopt;
  try {
    return given[name].cast<Value>();
  } catch (const pybind11::cast_error&) {
    throw InvalidInput(std::string(name) + " must be " + description);
  }
}

template <class Value>
void take(const pybind11::dict& given, const char* name, const char* description, Value& value) {
  if (auto found = taken<Value>(given, name, description)) value = std::move(*found);
}

template <class Value>
void take(const pybind11::dict& given, const char* name, const char* description, std::optional<Value>& value) {
  if (auto found = taken<Value>(given, name, description)) value = found;
}

/// One of two words; throws `InvalidInput` for others.
template <class Choice>
void take_word(const pybind11::dict& given, const char* name, const char* first, const char* second, Choice& choice) {
  const std::string description = std::string("\"") + first + "\" or \"" + second + "\"";
  const auto word = taken<std::string>(given, name, description.c_str());
  if (!word) return;
  if (*word != first && *word != second) throw InvalidInput(std::string(name) + " must be " + description);
  choice = static_cast<Choice>(*word == second);
}

/// The function that the call reports to, or None. Throws `InvalidInput` for what cannot be called.
inline pybind11::object taken_progress(const pybind11::dict& given) {
  pybind11::object progress = pybind11::none();
  if (given.contains("progress")) progress = given["progress"];
  if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) throw InvalidInput("progress must be a function");
  return progress;
}

}  // namespace meshbound::python
