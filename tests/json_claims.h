// SPDX-License-Identifier: MIT
/// What every JSON document of the tools promises, as GoogleTest expectations: it keeps to its schema, and each witness
/// in it is a pair of points that anyone can check.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "reference/exact_distance.h"
#include "run_tool.h"

namespace meshbound::testing_tools {

using Json = nlohmann::json;

/// Every required key is there, no key is unknown, and each word is one of those that the schema lists, recursively.
/// References point into the schema itself.
inline void expect_schema(const Json& schema, const Json& part, const Json& value, const std::string& where) {
  if (part.contains("$ref")) {
    const std::string name = part["$ref"].get<std::string>().substr(std::string("#/$defs/").size());
    return expect_schema(schema, schema["$defs"][name], value, where);
  }
  if (part.contains("enum")) {
    EXPECT_NE(std::find(part["enum"].begin(), part["enum"].end(), value), part["enum"].end()) << where << ": " << value;
  }
  if (part.contains("items") && value.is_array()) {
    for (const Json& entry : value) expect_schema(schema, part["items"], entry, where + "[]");
  }
  if (part.contains("required")) {
    for (const auto& key : part["required"]) EXPECT_TRUE(value.contains(key)) << where << " lacks " << key;
  }
  if (!part.contains("properties") || !value.is_object()) return;
  for (const auto& [key, entry] : value.items()) {
    EXPECT_TRUE(part["properties"].contains(key)) << where << " has a key that the schema does not know: " << key;
    if (part["properties"].contains(key)) expect_schema(schema, part["properties"][key], entry, where + "/" + key);
  }
}

inline Eigen::Vector3d point_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

/// What the coordinates of a witness may be off: they are rounded, and found by arithmetic on centred coordinates that
/// loses a few units in the last place.
inline double witness_rounding(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double units = 16384;
  const double largest = std::max(from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff());
  return units * (std::numeric_limits<double>::epsilon() * largest + std::numeric_limits<double>::denorm_min());
}

/// The two points are as far apart as the lower bound says, and no further than the upper one.
inline void expect_witness(const Json& direction, const std::string& where) {
  const Json& witness = direction["witness"];
  const Eigen::Vector3d from = point_of(witness["from"]), to = point_of(witness["to"]);
  const double length = (from - to).stableNorm();
  const double slack = 1e-9 * length + witness_rounding(from, to);
  EXPECT_NEAR(witness["distance"].get<double>(), length, slack) << where;
  EXPECT_NEAR(direction["lower"].get<double>(), length, slack) << where << ": the witness does not realise lower";
  if (direction["upper"].is_null()) return;
  EXPECT_LE(length, direction["upper"].get<double>() + slack) << where;
}

/// Checks every direction of a document, at any depth: it has a witness if and only if it says that it was searched.
inline void expect_witnesses(const Json& part, const std::string& where = "document") {
  if (!part.is_structured()) return;
  if (part.is_object() && part.contains("searched")) {
    EXPECT_EQ(part["searched"].get<bool>(), part.contains("witness")) << where;
    if (part.contains("witness")) expect_witness(part, where);
  }
  for (const auto& [key, entry] : part.items()) expect_witnesses(entry, where + "/" + key);
}

/// The second point of a direction's witness is the nearest of all points of `other` to the first one. O(n).
inline void expect_nearest(const Json& direction, const MeshView& other) {
  const Eigen::Vector3d from = point_of(direction["witness"]["from"]), to = point_of(direction["witness"]["to"]);
  const double length = (from - to).stableNorm();
  EXPECT_NEAR(reference::exact_distance(from, other).approximate(), length, 1e-9 * length + witness_rounding(from, to));
}

/// The document in `text`, checked against its schema, and its witnesses against its bounds.
inline Json checked_document(const std::string& text) {
  const Json document = Json::parse(text);
  std::string name = document["schema"].get<std::string>().substr(std::string("meshbound/").size());
  std::replace(name.begin(), name.end(), '/', '-');
  const Json schema = Json::parse(content_of(MESHBOUND_SOURCE_DIR "/tools/schema/" + name + ".schema.json"));
  expect_schema(schema, schema, document, name);
  expect_witnesses(document);
  return document;
}

}  // namespace meshbound::testing_tools
