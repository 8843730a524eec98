// SPDX-License-Identifier: MIT
#include "simplify/stray_faces.h"

#include <omp.h>

#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// Faces that one thread takes at a time.
constexpr std::size_t faces_of_look = 64;

}  // namespace

std::vector<std::uint32_t> stray_faces(const DecimationState& state, std::span<const std::uint32_t> faces,
                                       DecimationThreads& threads, const StopToken& stop) {
  std::vector<std::uint8_t> is_stray(faces.size(), 0);
  with_team(threads.count(), [&] {
    for_each_range(faces.size(), faces_of_look, [&](std::size_t begin, std::size_t end) {
      stop.check();
      Proposer& proposer = *threads.proposers[static_cast<std::size_t>(omp_get_thread_num())];
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t face = faces[i];
        if (state.is_unproven(face) && !state.mesh.is_removed(face))
          is_stray[i] = proposer.has_stray_edge(face) ? 1 : 0;
      }
    });
  });
  std::vector<std::uint32_t> strays;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (is_stray[i] != 0) strays.push_back(faces[i]);
  return strays;
}

}  // namespace meshbound
