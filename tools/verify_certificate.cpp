// SPDX-License-Identifier: MIT
// verify_certificate ORIGINAL SIMPLIFIED CERTIFICATE: exit 0 when the certificate proves that the two meshes are within
// its tolerance of each other, 1 when it does not, 2 for bad usage and files that cannot be read.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/distance_text.h"
#include "common/distinct_files.h"
#include "common/length.h"
#include "common/mesh_input.h"
#include "common/output.h"
#include "common/provenance.h"
#include "common/sha256.h"
#include "common/signals.h"
#include "common/stopwatch.h"
#include "common/tool_main.h"
#include "mesh/file_bytes.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "report/json_parts.h"
#include "verify/certificate_reader.h"
#include "verify/verifier.h"

namespace meshbound::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string original, simplified, certificate, tolerance, line_tolerance, texture_tolerance, json;
  bool quiet = false;
};

struct Inputs {
  TriangleMesh original, simplified;
  MeshAttributes original_attributes, simplified_attributes;  ///< empty unless the certificate speaks of textures
  std::string original_sha256, simplified_sha256;             ///< empty: not computed
  std::vector<std::uint8_t> certificate;
};

/// Reads the magic first: if the file is no certificate, nothing more is read, however long it is.
std::vector<std::uint8_t> certificate_of(const std::string& path, const StopToken& stop) {
  const FileBytes head(path, stop, verify::magic.size());
  const bool is_certificate = head.bytes() == verify::magic;
  const std::size_t limit = is_certificate ? std::numeric_limits<std::size_t>::max() : verify::magic.size();
  const FileBytes file(path, stop, limit);
  return {file.bytes().begin(), file.bytes().end()};
}

/// Rejects what proves a larger tolerance than `option` asks for, or nothing where it asks for something.
void require_tolerance(std::optional<double> proven, const std::string& option, const std::string& typed,
                       const std::string& of_what, const TriangleMesh& original) {
  if (typed.empty()) return;
  const double wanted = parse_length(option, typed).in_model_units(bounding_box_diagonal(original));
  if (!proven) throw verify::Rejected("it proves nothing" + of_what);
  if (*proven > wanted)
    throw verify::Rejected("it proves a tolerance of " + exact_number(*proven) + of_what + ", more than the wanted " +
                           exact_number(wanted));
}

void require_tolerances(const verify::Proof& proof, const Options& options, const TriangleMesh& original) {
  const auto tolerance_of = [](const auto& part) {
    return part ? std::optional<double>(part->tolerance) : std::nullopt;
  };
  require_tolerance(proof.tolerance, "--tolerance", options.tolerance, "", original);
  require_tolerance(tolerance_of(proof.lines), "--line-tolerance", options.line_tolerance, " about feature lines",
                    original);
  require_tolerance(tolerance_of(proof.texture), "--texture-tolerance", options.texture_tolerance, " about the texture",
                    original);
}

Json to_json(const verify::Proof::Direction& direction) {
  return {{"pieces", direction.pieces},
          {"by_degree", direction.by_parity},
          {"cuts", direction.cuts},
          {"bytes", direction.bytes},
          {"exact_decisions", direction.exact_decisions}};
}

Json to_json(const verify::Proof::Lines& lines) {
  return {{"tolerance", lines.tolerance},
          {"original_edges", lines.original_edges},
          {"simplified_edges", lines.simplified_edges},
          {"all_borders", lines.has_all_borders},
          {"original_to_simplified", to_json(lines.original_to_simplified)},
          {"simplified_to_original", to_json(lines.simplified_to_original)}};
}

Json to_json(const verify::TextureProof& proof) {
  return {{"pieces", proof.pieces},
          {"cuts", proof.cuts},
          {"bytes", proof.bytes},
          {"uncovered_percent", 100 * proof.uncovered_share},
          {"left_out_percent", 100 * proof.left_out_share}};
}

Json to_json(const verify::Proof::Texture& texture) {
  return {{"tolerance", texture.tolerance},
          {"original_to_simplified", to_json(texture.original_to_simplified)},
          {"simplified_to_original", to_json(texture.simplified_to_original)}};
}

struct Outcome {
  std::optional<verify::Proof> proof;
  std::string reason;  ///< why it was rejected
  double read_seconds = 0, verify_seconds = 0;
};

Json mesh_json(const std::string& path, const TriangleMesh& mesh, const std::string& sha256) {
  return {{"path", path}, {"faces", mesh.triangles.size()}, {"sha256", sha256}};
}

void write_json(const Options& options, const Inputs& inputs, const Outcome& outcome) {
  Json json = {
      {"schema", "meshbound/verify/1"},
      {"verdict", outcome.proof ? "proven" : "rejected"},
      {"reason", outcome.proof ? Json() : Json(outcome.reason)},
      {"provenance", report::provenance(provenance())},
      {"original", mesh_json(options.original, inputs.original, inputs.original_sha256)},
      {"simplified", mesh_json(options.simplified, inputs.simplified, inputs.simplified_sha256)},
      {"certificate",
       {{"path", options.certificate},
        {"bytes", inputs.certificate.size()},
        {"sha256", sha256({reinterpret_cast<const char*>(inputs.certificate.data()), inputs.certificate.size()})}}}};
  if (outcome.proof) {
    json["tolerance"] = outcome.proof->tolerance;
    json["original_to_simplified"] = to_json(outcome.proof->original_to_simplified);
    json["simplified_to_original"] = to_json(outcome.proof->simplified_to_original);
    if (outcome.proof->lines) json["lines"] = to_json(*outcome.proof->lines);
    if (outcome.proof->texture) json["texture"] = to_json(*outcome.proof->texture);
  }
  json["seconds"] = {{"read", outcome.read_seconds}, {"verify", outcome.verify_seconds}};
  write_text(options.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// What a proof about the texture says nothing of; empty where there is no such triangle.
std::string left_out(const verify::Proof::Texture& texture) {
  const double original = texture.original_to_simplified.left_out_share,
               simplified = texture.simplified_to_original.left_out_share;
  if (original == 0 && simplified == 0) return "";
  return "; it says nothing of triangles without area in the texture that are " + short_number(100 * original) +
         "% and " + short_number(100 * simplified) + "%";
}

void print(const Options& options, const Inputs& inputs, const Outcome& outcome) {
  const verify::Proof::Direction &forward = outcome.proof->original_to_simplified,
                                 &backward = outcome.proof->simplified_to_original;
  const double diagonal = bounding_box_diagonal(inputs.original);
  print_line("proven", options.original + " and " + options.simplified + " are within " +
                           both_units(outcome.proof->tolerance, diagonal) + " of each other");
  print_line("pieces", std::to_string(forward.pieces) + " of the original, " + std::to_string(backward.pieces) +
                           " of the simplified mesh; " + std::to_string(forward.by_parity + backward.by_parity) +
                           " of them proven by parity");
  if (const auto& lines = outcome.proof->lines)
    print_line("lines", std::to_string(lines->original_edges) + " edges of the original and " +
                            std::to_string(lines->simplified_edges) + " of the simplified mesh are within " +
                            both_units(lines->tolerance, diagonal) + " of each other; " +
                            (lines->has_all_borders ? "all" : "not all") + " borders are among them");
  if (const auto& texture = outcome.proof->texture)
    print_line("texture", "moves by at most " + both_units(texture->tolerance, diagonal) +
                              "; not covered by the other mesh are " +
                              short_number(100 * texture->original_to_simplified.uncovered_share) +
                              "% of the original's area and " +
                              short_number(100 * texture->simplified_to_original.uncovered_share) +
                              "% of the simplified mesh's" + left_out(*texture));
  print_line("bytes", std::to_string(inputs.certificate.size()) + ", " +
                          short_number(static_cast<double>(inputs.certificate.size()) /
                                       static_cast<double>(inputs.original.triangles.size())) +
                          " for each original triangle");
  print_line("seconds",
             "read " + rounded_seconds(outcome.read_seconds) + ", verify " + rounded_seconds(outcome.verify_seconds));
}

int run(const Options& options) {
  require_distinct_files(
      {{"ORIGINAL", options.original}, {"SIMPLIFIED", options.simplified}, {"CERTIFICATE", options.certificate}},
      {{"--json", options.json}});
  check_writable(options.json);
  Outcome outcome;
  Stopwatch watch;
  Inputs inputs;
  const StopToken stop = stop_at_signal();
  inputs.certificate = certificate_of(options.certificate, stop);
  const bool with_checksums = !options.json.empty();
  const bool with_texture = verify::speaks_of_texture(inputs.certificate);
  InputFile original = read_file(options.original, with_checksums, stop, with_texture);
  InputFile simplified = read_file(options.simplified, with_checksums, stop, with_texture);
  inputs.original = std::move(original.content.mesh);
  inputs.original_attributes = std::move(original.content.attributes);
  inputs.original_sha256 = original.sha256;
  inputs.simplified = std::move(simplified.content.mesh);
  inputs.simplified_attributes = std::move(simplified.content.attributes);
  inputs.simplified_sha256 = simplified.sha256;
  outcome.read_seconds = watch.lap();
  try {
    outcome.proof = verify::check_certificate(inputs.original, inputs.simplified, inputs.certificate,
                                              &inputs.original_attributes, &inputs.simplified_attributes);
    require_tolerances(*outcome.proof, options, inputs.original);
  } catch (const verify::Rejected& rejected) {
    outcome.proof.reset();
    outcome.reason = rejected.what();
  }
  outcome.verify_seconds = watch.lap();
  if (!options.json.empty()) write_json(options, inputs, outcome);
  if (!outcome.proof) {
    std::fprintf(stderr, "verify_certificate: %s: rejected: %s\n", options.certificate.c_str(), outcome.reason.c_str());
    return ExitExceeds;
  }
  if (!options.quiet && options.json != "-") print(options, inputs, outcome);
  return ExitDone;
}

void declare(CLI::App& app, Options& options) {
  app.add_option("ORIGINAL", options.original, "The mesh that was simplified")->required();
  app.add_option("SIMPLIFIED", options.simplified, "The result")->required();
  app.add_option("CERTIFICATE", options.certificate,
                 "File written by --certificate of simplify_with_bound or hausdorff_distance")
      ->required();
  app.add_option(
      "--tolerance", options.tolerance,
      "Reject certificates of larger tolerances of the surface: model units, or 0.1% of the original's diagonal");
  app.add_option(
      "--line-tolerance", options.line_tolerance,
      "Reject certificates that prove nothing about feature lines, or a larger tolerance: units as --tolerance");
  app.add_option(
      "--texture-tolerance", options.texture_tolerance,
      "Reject certificates that prove nothing about the texture, or a larger tolerance: units as --tolerance. "
      "What the other mesh does not cover in the texture does not count; how much that is, is printed");
  app.add_flag("--quiet", options.quiet, "Nothing on stdout; the exit code tells");
  add_json_option(app, options.json);
  app.footer("Exit codes: 0 proven, 1 rejected, 2 bad usage or files that cannot be read.");
  add_examples(app, {"verify_certificate bunny.ply small.ply small.cert"});
  app.set_version_flag("--version", "verify_certificate " MESHBOUND_VERSION);
}

}  // namespace
}  // namespace meshbound::tools

int main(int argc, char** argv) {
  CLI::App app("Checks a certificate that two meshes are within a tolerance of each other, by exact arithmetic.",
               "verify_certificate");
  meshbound::tools::Options options;
  meshbound::tools::declare(app, options);
  return meshbound::tools::tool_main(app, argc, argv, [&] { return meshbound::tools::run(options); });
}
