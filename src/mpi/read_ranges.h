// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "meshbound/stop_token.h"
#include "mpi/communicator.h"

namespace meshbound::mpi {

/// The bytes of a file on all ranks: each reads an equal range, then they exchange them, so that the disk gives each
/// byte once. Throws as `FileBytes`, on all ranks.
[[nodiscard]] std::string read_ranges(Communicator& ranks, const std::filesystem::path& path, const StopToken& stop);

}  // namespace meshbound::mpi
