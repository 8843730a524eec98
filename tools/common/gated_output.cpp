// SPDX-License-Identifier: MIT
#include "common/gated_output.h"

#include <algorithm>
#include <utility>

#include "common/sha256.h"
#include "mesh/file_bytes.h"
#include "mesh/readers.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound::tools {

GatedOutput::GatedOutput(std::filesystem::path path, const std::atomic<bool>& cancel, const WriteOptions& options)
    : path_(std::move(path)), cancel_(cancel), options_(options) {
  (void)format_of(path_);
  restart();
}

void GatedOutput::restart() { file_ = std::make_unique<AtomicFile>(path_, AtomicFile::Stream::Staged, &cancel_); }

Precision GatedOutput::precision() const {
  return format_of(path_) == FileFormat::Stl || options_.single_precision ? Precision::Single : Precision::Double;
}

void GatedOutput::write(const TriangleMesh& mesh, std::span<const Edge> lines) {
  restart();
  lines_ = line_mesh(mesh, lines);
  write_mesh(*file_, path_, rounded_for(path_, mesh, options_), options_);
  file_->complete();
}

TriangleMesh GatedOutput::written_mesh() const {
  const FileBytes bytes(file_->staged(), &cancel_);
  return parse_mesh(path_, bytes.bytes(), {&cancel_}).mesh;
}

std::string GatedOutput::checksum() const { return sha256(FileBytes(file_->staged(), &cancel_).bytes()); }

const HausdorffDistance& GatedOutput::measure(const Bvh& original, const DistanceOptions& options) {
  const TriangleMesh mesh = written_mesh();
  summary_ = summarise(mesh);
  distance_ = hausdorff_distance(original, Bvh(mesh, BvhOptions{options.threads}), options);
  verdict_ = verdict_of(distance_.bounds, *options.tolerance);
  if (original_lines_ != nullptr && verdict_ == Verdict::Within) measure_lines(mesh, options);
  return distance_;
}

void GatedOutput::measure_lines(const TriangleMesh& written, DistanceOptions options) {
  const auto before = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<Eigen::Vector3d> points = written.vertices;
  std::sort(points.begin(), points.end(), before);
  for (const Eigen::Vector3d& p : lines_.vertices)
    if (!std::binary_search(points.begin(), points.end(), p, before))
      throw Error("internal error: a vertex of a feature line is not in " + path_.string() + " as it was written");
  options.tolerance = std::min(original_lines_->tolerance, *options.tolerance);
  line_distance_ = hausdorff_distance(original_lines_->tree, Bvh(lines_, BvhOptions{options.threads}), options);
  verdict_ = verdict_of(line_distance_->bounds, *options.tolerance);
}

void GatedOutput::fall_back(const GatedOutput* smaller, const TriangleMesh& original, std::span<const Edge> lines,
                            const Bvh& tree, DistanceOptions options) {
  if (smaller == nullptr) {
    write(original, lines);
    options.budget = {};
    measure(tree, options);
    return;
  }
  restart();
  file_->write(FileBytes(smaller->file_->staged(), &cancel_).bytes());
  file_->complete();
  verdict_ = smaller->verdict_;
  distance_ = smaller->distance_;
  lines_ = smaller->lines_;
  line_distance_ = smaller->line_distance_;
  summary_ = smaller->summary_;
}

void GatedOutput::publish() {
  if (verdict_ != Verdict::Within)
    throw Error(path_.string() + " is not proven to be within the tolerance: not written");
  file_->commit();
}

void GatedOutput::copy_rejected_to(const std::filesystem::path& path) const {
  AtomicFile copy(path);
  copy.write(FileBytes(file_->staged()).bytes());
  copy.commit();
}

}  // namespace meshbound::tools
