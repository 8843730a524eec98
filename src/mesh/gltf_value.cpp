// SPDX-License-Identifier: MIT
#include "mesh/gltf_value.h"

#include <cmath>
#include <utility>

namespace meshbound {

GltfValue::GltfValue(const MeshSource& source, const GltfJson& json, std::string path)
    : source_(&source), json_(json), path_(std::move(path)) {}

void GltfValue::fail(const std::string& defect) const { source_->fail(path_.empty() ? defect : path_ + ": " + defect); }

std::optional<GltfValue> GltfValue::find(const char* key) const {
  if (!json_.is_object()) fail("expected an object of JSON");
  const auto found = json_.find(key);
  if (found == json_.end()) return std::nullopt;
  return GltfValue(*source_, *found, path_.empty() ? key : path_ + '.' + key);
}

GltfValue GltfValue::at(const char* key) const {
  auto found = find(key);
  if (!found) fail(std::string("'") + key + "' is missing");
  return *std::move(found);
}

std::size_t GltfValue::count(const char* key) const {
  const auto found = find(key);
  return found ? found->size() : 0;
}

std::size_t GltfValue::size() const {
  if (!json_.is_array()) fail("expected an array of JSON");
  return json_.size();
}

GltfValue GltfValue::item(std::size_t i) const {
  if (i >= size()) fail("expected at least " + std::to_string(i + 1) + " items");
  return {*source_, json_[i], path_ + '[' + std::to_string(i) + ']'};
}

std::size_t GltfValue::integer() const {
  const double value = number();
  if (!(value >= 0 && value <= 0x1p53) || value != std::floor(value)) fail("expected an integer that is not negative");
  return static_cast<std::size_t>(value);
}

std::size_t GltfValue::integer_or(const char* key, std::size_t otherwise) const {
  const auto found = find(key);
  return found ? found->integer() : otherwise;
}

std::size_t GltfValue::index(std::size_t count, const char* what) const {
  const std::size_t value = integer();
  if (value >= count)
    fail("refers to number " + std::to_string(value) + ", but there are only " + std::to_string(count) + ' ' + what +
         " (counted from 0)");
  return value;
}

double GltfValue::number() const {
  if (!json_.is_number()) fail("expected a number");
  const double value = json_.get<double>();
  if (!std::isfinite(value)) fail("expected a finite number");
  return value;
}

std::string GltfValue::text() const {
  if (!json_.is_string()) fail("expected a text");
  return json_.get<std::string>();
}

bool GltfValue::flag_or(const char* key, bool otherwise) const {
  const auto found = find(key);
  if (!found) return otherwise;
  if (!found->json().is_boolean()) found->fail("expected true or false");
  return found->json().get<bool>();
}

}  // namespace meshbound
