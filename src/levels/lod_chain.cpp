// SPDX-License-Identifier: MIT
#include "meshbound/lod_chain.h"

#include <cmath>
#include <utility>

#include "levels/level_run.h"
#include "levels/measured_level.h"
#include "mesh/validated.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

const LodOptions& checked(const LodOptions& options) {
  if (!std::isnan(options.tolerance) || !options.levels.empty())
    throw InvalidInput("the options of a chain hold no tolerance and no levels: they are asked for one by one");
  if (options.target_faces || options.target_ratio)
    throw InvalidInput("a chain ends its levels at their tolerances; leave the target unset");
  LodOptions complete = options;
  complete.tolerance = 0;
  check_options(complete);
  return options;
}

}  // namespace

struct LodChain::Impl {
  TriangleMesh original;
  LodOptions options;
  LevelRun run;
  std::optional<Bvh> tree;  ///< of the original in model coordinates; built for the first measurement
  double tolerance = 0, texture_tolerance;
  double measure_seconds = 0;

  Impl(TriangleMesh mesh, const LodOptions& wanted)
      : original(std::move(mesh)),
        options(checked(wanted)),
        run(validated(original), options),
        texture_tolerance(options.texture_tolerance) {}
};

LodChain::LodChain(TriangleMesh original, const LodOptions& options) {
  impl_ = std::make_unique<Impl>(std::move(original), options);
}
LodChain::LodChain(LodChain&&) noexcept = default;
LodChain& LodChain::operator=(LodChain&&) noexcept = default;
LodChain::~LodChain() = default;

LodLevel LodChain::next(double tolerance) {
  if (!std::isfinite(tolerance) || !(tolerance >= impl_->tolerance))
    throw InvalidInput("the tolerances of a chain must be lengths, and grow from level to level");
  impl_->tolerance = tolerance;
  LodLevel level = impl_->run.next(tolerance, 0);
  const auto start = LevelRun::Clock::now();
  if (!impl_->tree) impl_->tree.emplace(impl_->original, BvhOptions{impl_->options.threads});
  measure_level(impl_->original, *impl_->tree, impl_->run.lines(), level, impl_->options);
  impl_->measure_seconds += seconds_since(start);
  return level;
}

void LodChain::set_texture_tolerance(double tolerance) {
  if (impl_->options.texture_coordinates.empty())
    throw InvalidInput("a texture tolerance needs texture coordinates in the options of the chain");
  if (!(tolerance >= impl_->texture_tolerance))
    throw InvalidInput("the texture tolerances of a chain must be lengths, and grow from level to level");
  impl_->texture_tolerance = tolerance;
  impl_->run.set_texture_tolerance(tolerance);
}

SimplifyResult LodChain::describe() const {
  SimplifyResult result;
  impl_->run.describe(result);
  result.seconds.measure = impl_->measure_seconds;
  return result;
}

std::size_t build_lod_chain(const MeshView& original, std::span<const double> tolerances, const LodOptions& options,
                            const LodSink& sink) {
  double before = -1;
  for (const double tolerance : tolerances) {
    if (!std::isfinite(tolerance) || !(tolerance >= 0) || !(tolerance > before))
      throw InvalidInput("the tolerances of a chain must be lengths, 0 or more, each larger than the one before");
    before = tolerance;
  }
  if (tolerances.empty()) return 0;
  if (!sink) throw InvalidInput("the levels of a chain need a function that takes them");
  LodChain chain(original, options);
  for (std::size_t i = 0; i < tolerances.size(); ++i) {
    if (!sink(i, chain.next(tolerances[i]))) return i + 1;
  }
  return tolerances.size();
}

}  // namespace meshbound
