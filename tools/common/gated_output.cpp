// SPDX-License-Identifier: MIT
#include "common/gated_output.h"

#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "common/output_target.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace meshbound::tools {

GatedOutput::GatedOutput(std::filesystem::path path) : path_(std::move(path)) {
  (void)format_of(path_);
  target_ = output_target(path_);
}

GatedOutput::GatedOutput(GatedOutput&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      verdict_(other.verdict_),
      distance_(other.distance_),
      summary_(other.summary_) {}

GatedOutput::~GatedOutput() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

double GatedOutput::largest_rounding(double largest) const {
  if (format_of(path_) != FileFormat::Stl) return 0;
  // Half an ulp of float in each coordinate, or half its smallest step; 2 > sqrt(3) covers the length of three.
  return 2 * std::max(largest * 0x1p-24, 0x1p-150);
}

void GatedOutput::write(const TriangleMesh& mesh) {
  std::ostringstream name;
  name << '.' << target_.stem().string() << ".unproven" << getpid() << target_.extension().string();
  temporary_ = target_.parent_path() / name.str();
  write_mesh(temporary_, rounded_for(temporary_, mesh));
}

TriangleMesh GatedOutput::written_mesh() const { return read_mesh(temporary_).mesh; }

const SymmetricDistance& GatedOutput::measure(const Bvh& original, const DistanceOptions& options) {
  const TriangleMesh mesh = written_mesh();
  summary_ = summarise(mesh);
  distance_ = symmetric_distance(original, Bvh(mesh, BvhOptions{options.threads}), options);
  verdict_ = distance_.bounds.upper <= *options.tolerance  ? Verdict::Within
             : distance_.bounds.lower > *options.tolerance ? Verdict::Exceeds
                                                           : Verdict::Undecided;
  return distance_;
}

void GatedOutput::fall_back(const GatedOutput* smaller, const TriangleMesh& original, const Bvh& tree,
                            DistanceOptions options) {
  if (smaller == nullptr) {
    write(original);
    options.budget = {};
    measure(tree, options);
    return;
  }
  std::error_code error;
  std::filesystem::copy_file(smaller->temporary_, temporary_, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw IoError("cannot write " + path_.string() + ": " + error.message());
  verdict_ = smaller->verdict_;
  distance_ = smaller->distance_;
  summary_ = smaller->summary_;
}

void GatedOutput::publish() {
  if (verdict_ != Verdict::Within)
    throw Error(path_.string() + " is not proven to be within the tolerance: not written");
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) throw IoError("cannot write " + path_.string() + ": " + error.message());
  temporary_.clear();
}

void GatedOutput::keep_rejected_as(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::rename(temporary_, path, error);
  if (error) throw IoError("cannot write " + path.string() + ": " + error.message());
  temporary_.clear();
}

}  // namespace meshbound::tools
