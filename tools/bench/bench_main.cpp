// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_main.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <set>

#include "measure.h"

namespace meshbound::bench {

std::string listed_names(const Options& options) {
  std::string text;
  std::set<std::string> seen;
  for (const std::string& name : options.left_out_)
    if (seen.insert(name).second) text += (text.empty() ? "" : ", ") + name;
  return text;
}

int bench_main(int argc, char** argv, const char* description, const std::function<int(const Options&)>& run,
               const std::function<void(CLI::App&)>& add_options) {
  CLI::App app{description};
  Options options;
  app.add_flag("--quick", options.quick, "fewer pairs, sizes and steps, and a limit of 20 s");
  app.add_option("--out", options.out, "folder of the results")->capture_default_str();
  app.add_option("--cache", options.cache, "folder of the meshes that are made once")->capture_default_str();
  auto* limit = app.add_option("--limit", options.limit, "CPU seconds after which a run is ended, and a check by CGAL");
  app.add_option("--only", options.only, "measure only what has this in its name");
  app.add_option("--pair", options.pair, "measure these two meshes instead: files A B (pairs, error_bound)")
      ->type_size(2)
      ->expected(1, 1000);
  if (add_options) add_options(app);
  CLI11_PARSE(app, argc, argv);
  if (options.quick && limit->empty()) options.limit = 20;
  options.check_limit = options.quick && limit->empty() ? 3 : options.limit;
  try {
    std::filesystem::create_directories(options.out);
    std::filesystem::create_directories(options.cache);
    options.machine = machine_line();
    const int code = run(options);
    if (options.only.empty() || options.found_any()) return code;
    std::fprintf(stderr, "%s: --only %s: no name has this in it; there are: %s\n", argv[0], options.only.c_str(),
                 listed_names(options).c_str());
    return nothing_measured;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  }
}

}  // namespace meshbound::bench
