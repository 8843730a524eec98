// SPDX-License-Identifier: MIT
/// What a test changes for all of its process is as it was when the object goes, however the test ends.
#pragma once
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

namespace meshbound::test {

/// A variable has a value for the lifetime of this.
template <class T>
class Setting {
 public:
  Setting(T& variable, T value) : variable_(variable), before_(std::exchange(variable, value)) {}
  ~Setting() { variable_ = before_; }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  T& variable_;
  const T before_;
};

/// A variable of the environment, which programs inherit that are run, has a value for the lifetime of this.
class EnvironmentSetting {
 public:
  EnvironmentSetting(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* const before = std::getenv(name_.c_str())) before_ = before;
    ::setenv(name_.c_str(), value.c_str(), 1);
  }
  ~EnvironmentSetting() {
    if (before_)
      ::setenv(name_.c_str(), before_->c_str(), 1);
    else
      ::unsetenv(name_.c_str());
  }
  EnvironmentSetting(const EnvironmentSetting&) = delete;
  EnvironmentSetting& operator=(const EnvironmentSetting&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

}  // namespace meshbound::test
