// SPDX-License-Identifier: MIT
#include "view/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <numbers>

#include "lod/pixel_limit.h"
#include "meshbound/error.h"
#include "meshbound/pose.h"

namespace meshbound::tools {
namespace {

using SceneJson = nlohmann::json;

/// A value and where it stands in the file, for messages.
class Place {
 public:
  Place(const SceneJson& value, std::string where) : value_(value), where_(std::move(where)) {}

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InvalidInput(where_ + (where_.back() == ' ' ? "" : ": ") + reason);
  }

  /// An object with no other keys than these.
  const Place& object(std::initializer_list<const char*> keys) const {
    if (!value_.is_object()) refuse("expected an object");
    for (const auto& entry : value_.items())
      if (std::none_of(keys.begin(), keys.end(), [&](const char* key) { return entry.key() == key; }))
        refuse("unknown key \"" + entry.key() + "\"");
    return *this;
  }
  [[nodiscard]] bool has(const char* key) const { return value_.contains(key); }
  [[nodiscard]] Place at(const char* key) const {
    if (!value_.contains(key)) refuse(std::string("\"") + key + "\" is missing");
    return {value_.at(key), where_ + (where_.back() == ' ' ? "" : ".") + key};
  }
  [[nodiscard]] std::vector<Place> list() const {
    if (!value_.is_array()) refuse("expected a list");
    std::vector<Place> places;
    for (std::size_t i = 0; i < value_.size(); ++i)
      places.emplace_back(value_[i], where_ + "[" + std::to_string(i) + "]");
    return places;
  }
  [[nodiscard]] double number() const {
    if (!value_.is_number()) refuse("expected a number");
    return value_.get<double>();
  }
  [[nodiscard]] double positive() const {
    if (!(number() > 0)) refuse("expected a positive number");
    return number();
  }
  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) refuse("expected a text in quotes");
    return value_.get<std::string>();
  }
  [[nodiscard]] std::size_t index_below(std::size_t count) const {
    if (!value_.is_number_unsigned() || value_.get<std::size_t>() >= count)
      refuse("expected a number from 0 to " + std::to_string(count - 1));
    return value_.get<std::size_t>();
  }
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const {
    const std::vector<Place> places = list();
    if (places.size() != count) refuse("expected " + std::to_string(count) + " numbers");
    std::vector<double> values;
    for (const Place& place : places) values.push_back(place.number());
    return values;
  }
  [[nodiscard]] Eigen::Vector3d point() const {
    const std::vector<double> p = numbers(3);
    return {p[0], p[1], p[2]};
  }

 private:
  const SceneJson& value_;
  std::string where_;
};

AffineMap pose_of(const Place& place) {
  const std::vector<double> entries = place.numbers(16);
  AffineMap pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(entries.data());
  if (pose.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    place.refuse("the last four of the 16 numbers must be 0 0 0 1 (row-major order)");
  return pose;
}

ViewInstance instance_of(const Place& place, SceneFile& scene) {
  place.object({"model", "pose", "group"});
  ViewInstance instance;
  instance.model = place.at("model").index_below(scene.models.size());
  if (place.has("pose")) instance.pose = pose_of(place.at("pose"));
  if (!place.has("group")) return instance;
  const std::string group = place.at("group").text();
  const auto known = std::find(scene.groups.begin(), scene.groups.end(), group);
  instance.group = static_cast<std::size_t>(known - scene.groups.begin());
  if (known == scene.groups.end()) scene.groups.push_back(group);
  return instance;
}

ViewCamera camera_of(const Place& place, const ViewCamera& screen) {
  place.object({"position", "direction"});
  ViewCamera camera = screen;
  camera.position = place.at("position").point();
  camera.direction = place.at("direction").point();
  if (camera.direction.isZero(0)) place.at("direction").refuse("must have a length");
  return camera;
}

ViewCamera screen_of(const Place& place) {
  place.object({"height", "fov", "aspect"});
  ViewCamera camera;
  camera.screen.vertical_field_of_view = default_fov / 180 * std::numbers::pi;
  if (place.has("height")) camera.screen.height_pixels = place.at("height").positive();
  if (place.has("fov")) {
    if (place.at("fov").positive() >= 180) place.at("fov").refuse("expected degrees below 180");
    camera.screen.vertical_field_of_view = place.at("fov").number() / 180 * std::numbers::pi;
  }
  if (place.has("aspect")) camera.aspect_ratio = place.at("aspect").positive();
  return camera;
}

}  // namespace

SceneFile read_scene(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) throw IoError("--scene: cannot read " + path);
  SceneJson document;
  try {
    document = SceneJson::parse(file);
  } catch (const SceneJson::parse_error& error) {
    throw InvalidInput(path + ": byte " + std::to_string(error.byte) + ": this is no JSON");
  } catch (const SceneJson::exception&) {
    throw InvalidInput(path + ": holds a number beyond the range of doubles");
  }
  const Place root(document, path + ": ");
  root.object({"schema", "pixels", "screen", "models", "instances", "cameras"});
  if (root.at("schema").text() != "meshbound/scene/1") root.at("schema").refuse("expected \"meshbound/scene/1\"");
  SceneFile scene;
  if (root.has("pixels")) scene.pixels = root.at("pixels").positive();
  for (const Place& model : root.at("models").list())
    scene.models.push_back((std::filesystem::path(path).parent_path() / model.text()).string());
  if (scene.models.empty()) root.at("models").refuse("there is none");
  for (const Place& instance : root.at("instances").list()) scene.instances.push_back(instance_of(instance, scene));
  const SceneJson no_screen = SceneJson::object();
  const ViewCamera screen = screen_of(root.has("screen") ? root.at("screen") : Place(no_screen, path + ": screen"));
  for (const Place& camera : root.at("cameras").list()) scene.cameras.push_back(camera_of(camera, screen));
  if (scene.cameras.empty()) root.at("cameras").refuse("there is none");
  return scene;
}

}  // namespace meshbound::tools
