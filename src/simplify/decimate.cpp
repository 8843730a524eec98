// SPDX-License-Identifier: MIT
#include "simplify/decimate.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "simplify/repair.h"

namespace meshbound {
namespace {
double now() { return double(clock()) / CLOCKS_PER_SEC; }
}  // namespace

void decimate(DecimationState& state, const DecimationGoal& goal, int threads) {
  state.tolerance = goal.tolerance;
  state.limit = state.provable(goal.tolerance);
  const auto stop = [&](std::size_t removed) { return state.faces - removed <= goal.target_faces; };
  double t = now();
  const auto lap = [&](const char* what) {
    const double u = now();
    std::fprintf(stderr, "  %-10s %.3f s  faces %zu\n", what, u - t, state.faces);
    t = u;
  };
  Proposer proposer(state);
  ProofWorkers workers(state, threads);
  lap("set up");
  std::vector<double> shares;
  const char* spec = std::getenv("SHARES");
  for (const char* p = spec ? spec : "0.9,0.98"; *p;) {
    char* e;
    shares.push_back(std::strtod(p, &e));
    p = *e ? e + 1 : e;
  }
  for (const double share : shares) {
    for (int pass = 0; pass < 8; ++pass) {
      const std::size_t before = state.faces;
      {
        Split s = whole(state);
        propose(state, s, s.regions[0], proposer, share, nullptr, stop);
        merge(state, std::move(s));
      }
      lap("propose");
      if (before - state.faces < before / 100) break;
    }
    Proof proof(state, workers);
    for (int k = 0; k < 1000; ++k) {
      proof.run(goal.stop);
      if (k < 3) {
        std::fprintf(stderr, "    unproven %zu originals %zu faces of %llu %llu\n", proof.unproven().originals.size(),
                     proof.unproven().faces.size(), (unsigned long long)proof.originals_tested,
                     (unsigned long long)proof.faces_tested);
      }
      if (proof.unproven().empty()) break;
      proof.reopen(repair(state, proof.unproven()));
    }
    proof.commit();
    lap("prove");
  }
  const double last = std::getenv("LAST") ? std::atof(std::getenv("LAST")) : 1.0;
  std::fill(state.share.begin(), state.share.end(), 1.0F);
  std::fill(state.refused_at.begin(), state.refused_at.end(), 0);
  const auto before_counts = proposer.counts;
  ChangeProver prover(state);
  for (int pass = 0; pass < 8; ++pass) {
    const std::size_t before = state.faces;
    {
      Split s = whole(state);
      propose(state, s, s.regions[0], proposer, last, &prover, stop);
      merge(state, std::move(s));
    }
    lap("checked");
    std::fprintf(stderr, "    proven %llu uncovered %llu too far %llu tried %llu hopeless %llu\n",
                 (unsigned long long)prover.proven, (unsigned long long)prover.uncovered,
                 (unsigned long long)prover.too_far, (unsigned long long)(proposer.counts.tried - before_counts.tried),
                 (unsigned long long)(proposer.counts.hopeless - before_counts.hopeless));
    if (before - state.faces < before / 100) break;
  }
  const auto& c = proposer.counts;
  std::fprintf(stderr,
               "  tried %llu topology %llu cost %llu minimax %llu hopeless %llu near %llu folded %llu stray %llu\n",
               (unsigned long long)c.tried, (unsigned long long)c.by_topology, (unsigned long long)c.by_cost,
               (unsigned long long)c.by_minimax, (unsigned long long)c.hopeless, (unsigned long long)c.near_misses,
               (unsigned long long)c.folded, (unsigned long long)c.stray);
}

}  // namespace meshbound
