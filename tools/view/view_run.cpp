// SPDX-License-Identifier: MIT
#include "view/view_run.h"

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "common/distance_text.h"
#include "common/distinct_files.h"
#include "common/length.h"
#include "common/mesh_input.h"
#include "common/output.h"
#include "common/output_folder.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/run_clock.h"
#include "common/signals.h"
#include "decimation/drivers.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "report/json_parts.h"
#include "view/gltf_view.h"
#include "view/scene_file.h"

namespace meshbound::tools {
namespace {

namespace fs = std::filesystem;

/// One run of the tool, in the order of its phases.
class ViewRun {
 public:
  ViewRun(const DecimationOptions& options, const ViewRequest& request)
      : options_(options),
        request_(request),
        folder_(request.folder),
        format_(request.format),
        clock_(options.common) {}

  int operator()() {
    if (is_gltf(request_.scene))
      read_gltf();
    else
      read_json();
    const OutputFolder folder(folder_);
    make_levels();
    const std::string document = to_json();
    write_text(view_path().string(), document);
    if (!options_.common.json.empty()) write_text(options_.common.json, document);
    if (options_.common.prints_summary()) print();
    if (!ended_by_time_) return ExitDone;
    std::fprintf(stderr, "lod_chain: the time limit came first: levels are the best meshes that were proven by then\n");
    return ExitUndecided;
  }

 private:
  void read_json() {
    scene_ = read_scene(request_.scene);
    check_paths();
    const StopToken stop = clock_.stop_of_reading();
    for (const std::string& path : scene_.models)
      meshes_.push_back(read_input(path, true, models_.emplace_back(), stop));
  }

  void read_gltf() {
    gltf_ = read_gltf_view(request_.scene, request_.limit, clock_.stop_of_reading());
    scene_ = std::move(gltf_->scene);
    meshes_ = std::move(gltf_->meshes);
    models_ = std::move(gltf_->reports);
    check_paths();
  }

  [[nodiscard]] fs::path view_path() const { return fs::path(folder_) / "view.json"; }
  [[nodiscard]] std::string level_file(std::size_t model, std::size_t level) const {
    return "model_" + std::to_string(model) + "_lod_" + std::to_string(level) + "." + format_;
  }

  void check_paths() const {
    constexpr std::size_t max_levels = 16;  // no model can have more
    std::vector<NamedPath> inputs{{"--scene", request_.scene}},
        outputs{{"DIR", view_path()}, {"--json", options_.common.json}};
    for (std::size_t model = 0; model < scene_.models.size(); ++model) {
      inputs.push_back({"models[" + std::to_string(model) + "]", scene_.models[model]});
      for (std::size_t level = 1; level <= max_levels; ++level)
        outputs.push_back({"DIR", fs::path(folder_) / level_file(model, level)});
    }
    require_distinct_files(inputs, outputs);
    check_writable(options_.common.json);
  }

  void make_levels() {
    ProgressBar bar("simplifying and measuring", options_.common.quiet);
    ViewOptions view;
    view.pixels = scene_.pixels;
    view.lod.driver = collapse_driver(options_.driver, options_.cost);
    view.lod.preserve_boundary = options_.preserve_boundary;
    if (options_.feature_angle) view.lod.feature_angle = *options_.feature_angle / 180 * std::numbers::pi;
    if (options_.placement == "subset") view.lod.placements = CollapsePlacements::Subset;
    if (stores_floats(format_of(level_file(0, 1)), options_.write)) view.lod.precision = Precision::Single;
    view.lod.threads = options_.common.threads;
    view.lod.cancel = &interrupted();
    view.lod.progress = bar.callback();
    view.lod.time_limit = clock_.seconds_left();
    levels_ = view_levels(meshes_, scene_.instances, scene_.cameras, view,
                          [this](std::size_t model, std::size_t level, const LodLevel& made) {
                            ended_by_time_ = ended_by_time_ || made.ended_by == EndedBy::TimeLimit;
                            write(level_file(model, level), made.mesh);
                          });
  }

  /// What was measured is the mesh in memory, so the file must hold the same triangles to the last bit.
  void write(const std::string& name, const TriangleMesh& mesh) const {
    if (interrupted())
      throw Error("interrupted; the levels written so far are in " + folder_ + ", without a view.json");
    const fs::path path = fs::path(folder_) / name;
    write_mesh(path, mesh, options_.write);
    if (!same_surface(read_file(path.string(), false, stop_at_signal()).content.mesh, mesh))
      throw Error(path.string() + " reads as another mesh than was measured; use PLY, OFF or OBJ");
  }

  [[nodiscard]] std::string to_json() const {
    using namespace report;
    Json json = {{"schema", "meshbound/view/1"}, {"provenance", report::provenance(tools::provenance())}};
    json["scene"] = request_.scene;
    json["pixels"] = scene_.pixels;
    json["models"] = Json::array();
    for (std::size_t model = 0; model < models_.size(); ++model) {
      Json entry = {{"original", mesh(models_[model])}, {"levels", Json::array()}};
      for (std::size_t level = 1; level < levels_.models[model].size(); ++level) {
        const ViewLevel& made = levels_.models[model][level];
        entry["levels"].push_back({{"file", level_file(model, level)},
                                   {"tolerance", number(made.tolerance)},
                                   {"error", number(made.error)},
                                   {"faces", made.faces}});
      }
      if (gltf_) entry["mesh"] = gltf_->mesh_of_model[model];
      json["models"].push_back(std::move(entry));
    }
    for (std::size_t i = 0; gltf_ && i < scene_.instances.size(); ++i)
      json["instances"].push_back({{"node", gltf_->node_of_instance[i]}, {"model", scene_.instances[i].model}});
    json["cameras"] = Json::array();
    for (std::size_t camera = 0; camera < levels_.cameras.size(); ++camera) {
      const ViewChoice& choice = levels_.cameras[camera];
      Json entry = {
          {"levels", Json::array()}, {"triangles", choice.triangles}, {"full_triangles", choice.full_triangles}};
      for (const std::uint32_t level : choice.level)
        entry["levels"].push_back(level == ViewChoice::hidden ? Json(nullptr) : Json(level));
      entry["groups"] = Json::array();
      for (std::size_t group = 0; group < levels_.group_errors[camera].size(); ++group)
        entry["groups"].push_back(
            {{"name", scene_.groups[group]}, {"error", number(levels_.group_errors[camera][group])}});
      if (gltf_) entry["node"] = gltf_->node_of_camera[camera];
      json["cameras"].push_back(std::move(entry));
    }
    if (gltf_) json["orthographic_cameras"] = gltf_->orthographic_cameras;
    json["levels_computed"] = levels_.levels_computed;
    json["levels_skipped"] = levels_.levels_skipped;
    json["seconds"] = {{"total", number(clock_.seconds())}};
    return text(json);
  }

  [[nodiscard]] std::string name_of(std::size_t model) const {
    return scene_.models[model] + (gltf_ ? ", mesh " + std::to_string(gltf_->mesh_of_model[model]) : "");
  }

  void print() const {
    for (std::size_t model = 0; model < models_.size(); ++model) {
      print_line("model " + std::to_string(model), name_of(model) + ", " + face_count(models_[model].summary.faces));
      for (std::size_t level = 1; level < levels_.models[model].size(); ++level)
        print_line("  level " + std::to_string(level), face_count(levels_.models[model][level].faces) + ", error " +
                                                           short_number(levels_.models[model][level].error));
    }
    for (std::size_t camera = 0; camera < levels_.cameras.size(); ++camera)
      print_line("camera " + std::to_string(camera), std::to_string(levels_.cameras[camera].triangles) + " of " +
                                                         std::to_string(levels_.cameras[camera].full_triangles) +
                                                         " triangles drawn");
    if (gltf_ && gltf_->orthographic_cameras > 0)
      print_line("left out", "orthographic cameras: " + std::to_string(gltf_->orthographic_cameras));
    print_line("levels", std::to_string(levels_.levels_computed) + " computed, " +
                             std::to_string(levels_.levels_skipped) + " that no instance needs skipped");
    print_line("seconds", "total " + rounded_seconds(clock_.seconds()));
  }

  const DecimationOptions& options_;
  const ViewRequest& request_;
  const std::string &folder_, &format_;
  RunClock clock_;
  SceneFile scene_;
  std::optional<GltfView> gltf_;  ///< where the scene is one of glTF: what is left of it besides the scene
  std::vector<MeshReport> models_;
  std::vector<TriangleMesh> meshes_;
  ViewLevels levels_;
  bool ended_by_time_ = false;  ///< for some level
};

}  // namespace

int run_view(const DecimationOptions& options, const ViewRequest& request) { return ViewRun(options, request)(); }

}  // namespace meshbound::tools
