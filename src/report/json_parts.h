// SPDX-License-Identifier: MIT
/// The objects that several reports have in common.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "meshbound/report.h"

namespace meshbound::report {

using Json = nlohmann::ordered_json;

/// A JSON number, or null when `value` is infinite or not a number.
[[nodiscard]] Json number(double value);

/// {"absolute":..,"percent_of_diagonal":..}
[[nodiscard]] Json length(double absolute, double diagonal);

/// {"path":..,"vertices":..,"faces":..,"components":..,"closed":..,"bbox_diagonal":..} and what the reader did
[[nodiscard]] Json mesh(const MeshReport& mesh);

/// {"tool":..,"version":..,"date":..,"command":[..]}
[[nodiscard]] Json provenance(const Provenance& provenance);

/// {"lower":..,"upper":..}
[[nodiscard]] Json bounds(const Bounds& bounds);

/// {"from":[x,y,z],"to":[x,y,z],"from_triangle":..,"to_triangle":..,"distance":..}
[[nodiscard]] Json witness(const Witness& witness);

/// Bounds, whether the direction was searched, and if so its outcome and witness.
[[nodiscard]] Json one_sided(const OneSidedDistance& distance);

/// {"direction":..,"point":[x,y,z],"triangle":..,"nearest":[x,y,z],"distance":{"lower":..,"upper":..}}; `from_a` and
/// `from_b` name the directions.
[[nodiscard]] Json worst(const WorstSpot& spot, const char* from_a, const char* from_b);

/// Bounds of both directions and their maximum; a is the original, b the simplified mesh.
[[nodiscard]] Json symmetric(const HausdorffDistance& distance);
[[nodiscard]] Json lines(const LineReport& lines, double diagonal);

/// Bounds of the texture deviation of both directions and their maximum; `from_a` and `from_b` name the directions.
[[nodiscard]] Json texture(const TextureReport& texture, double diagonal, const char* from_a, const char* from_b);

/// Statistics of both directions; `from_a` and `from_b` name them.
[[nodiscard]] Json deviation(const DeviationReport& report, const char* from_a, const char* from_b);

/// {"tolerance":..,"max_degrees":..,"witness":{..}}
[[nodiscard]] Json normals(const NormalReport& normals);

/// Adds what is known of the lines, the texture and the normals of a level.
void add_appearance(const LevelReport& level, double diagonal, Json& to);

/// Statistics over the directions that were searched: sums of counts, and means of percentages weighted by those
/// counts.
[[nodiscard]] Json stats(const std::vector<const OneSidedDistance*>& directions);

/// {"read":..,"simplify":..,"certify":..,"write":..,"total":..}
[[nodiscard]] Json seconds(const SimplifyReport::Seconds& seconds);
[[nodiscard]] Json communication(const CommunicationReport& communication);

/// The document as text, see `to_json`.
[[nodiscard]] std::string text(const Json& document);

}  // namespace meshbound::report
