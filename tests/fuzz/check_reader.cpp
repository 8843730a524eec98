// SPDX-License-Identifier: MIT
#include <stdexcept>

#include "fuzz/claims.h"
#include "mesh/readers.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"

namespace meshbound::fuzz {

void check_reader(const std::string& extension, Bytes content) {
  const std::string name = "fuzz" + extension;
  const std::string_view bytes(reinterpret_cast<const char*>(content.data()), content.size());
  try {
    validate(parse_mesh(name, bytes).mesh);
  } catch (const InvalidInput& refusal) {
    const std::string line = refusal.what();
    if (line.find(name) == std::string::npos) throw std::logic_error("the refusal does not name the file: " + line);
    if (line.find('\n') != std::string::npos) throw std::logic_error("the refusal is not one line: " + line);
  }
}

}  // namespace meshbound::fuzz
