// SPDX-License-Identifier: MIT
#include "common/tool_main.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <numeric>
#include <utility>
#include <vector>

#include "common/checks.h"
#include "common/completion.h"
#include "common/memory.h"
#include "common/mesh_input.h"
#include "common/omp_spin.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/signals.h"
#include "common/standard_streams.h"
#include "common/threads.h"
#include "meshbound/error.h"
#include "meshbound/stop_token.h"

namespace meshbound::tools {
namespace {

std::terminate_handler default_terminate = nullptr;

/// Memory may run out where nothing catches it: before `tool_main`, and in functions of the parser of the command line
/// that allocate although they are `noexcept`.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: out of memory\n", program_invocation_short_name);
    std::_Exit(ExitBadInput);
  } catch (...) {
  }
  default_terminate();
  std::abort();
}

/// Sets the handler when the program is loaded.
[[maybe_unused]] const bool has_handler = (default_terminate = std::set_terminate(end_without_memory), true);

/// From here on the tool ends by itself: a signal that comes, or came before, neither adds a line nor changes the exit
/// code, however long it takes to free the memory.
void begin_ending() { static const UninterruptedScope ending; }

int complain(const CLI::App& app, std::string message, ExitCode code = ExitBadInput) {
  begin_ending();
  message = with_stream_names(std::move(message));
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), message.c_str());
  return code;
}

/// Returns `code` if everything that was printed has reached standard output.
int conclude(const CLI::App& app, int code) {
  begin_ending();
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  return complain(app, std::string("cannot write to standard output: ") + std::strerror(errno));
}

/// Number of letters to insert, delete or replace to turn `a` into `b`, at least.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

/// "; did you mean --tolerance?" for the first unknown option that is the beginning of an option or nearly equals one;
/// else empty.
std::string suggestion(const CLI::App& app) {
  constexpr std::size_t typing_errors = 2;
  for (const std::string& unknown : app.remaining()) {
    const std::string word = unknown.substr(std::min(unknown.find_first_not_of('-'), unknown.size()));
    if (word.empty() || unknown[0] != '-') continue;
    std::string names;
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames())
        if (name.starts_with(word) || (word.size() > typing_errors && edit_distance(word, name) <= typing_errors))
          names += (names.empty() ? "--" : " or --") + name;
    }
    if (!names.empty()) return "; did you mean " + names + "?";
  }
  return "";
}

/// Like --version it needs no other argument, as callbacks run before required options are missed.
void add_completion_option(CLI::App& app) {
  app.add_option_function<std::string>(
         "--completion",
         [&app](const std::string& shell) {
           std::fputs(completion_script(app, shell).c_str(), stdout);
           throw CLI::Success();
         },
         "Print a script by which this shell completes the options, and exit")
      ->type_name("{bash,zsh,fish}");
}

ProgressStyle progress_style(const std::string& name) {
  if (name == "plain") return ProgressStyle::Plain;
  return name == "none" ? ProgressStyle::Off : ProgressStyle::Automatic;
}

}  // namespace

ExitCode exit_code(Verdict verdict) {
  switch (verdict) {
    case Verdict::Within:
      return ExitDone;
    case Verdict::Exceeds:
      return ExitExceeds;
    case Verdict::Undecided:
      break;
  }
  return ExitUndecided;
}

std::string no_mesh_name(const std::string& path) {
  if (!has_mesh_extension(path)) return "";
  return path +
         " has the name of a mesh, which it would replace; give it another name, or put the option behind the files";
}

void add_write_options(CLI::App& app, WriteOptions& options) {
  app.add_flag("--ascii", options.ascii, "Write PLY and STL as text (OFF and OBJ always are)");
  app.add_flag("--single-precision", options.single_precision,
               "Round coordinates to floats first, so that every bound is of what is written; PLY then stores floats, "
               "as STL always does");
}

void add_json_option(CLI::App& app, std::string& json) {
  app.add_option_function<std::string>(
         "--json", [&json](const std::string& file) { json = file.empty() ? "-" : file; },
         "Write the result as JSON to a file; '-' or nothing: to stdout, and nothing else there")
      ->check(no_mesh_name)
      ->type_name("[FILE]")
      ->expected(0, 1);
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_option("--threads", options.threads, "Threads to use (default: all)")->check(CLI::Range(1, 1024));
  app.add_flag("--quiet", options.quiet, "No progress and no summary, only what was asked for and errors");
  app.add_option("--progress", options.progress,
                 "Progress on stderr: auto is a bar on a terminal, plain a line every ten seconds")
      ->check(CLI::IsMember({"auto", "plain", "none"}))
      ->capture_default_str();
  app.add_option("--time-limit", options.time_limit,
                 "Seconds after which the tool ends with what it has proven (exit 3)")
      ->check(number_of_seconds);
  add_json_option(app, options.json);
  app.final_callback([&options] {
    options.threads = start_threads(options.threads);
    set_progress_style(progress_style(options.progress));
  });
  app.footer(
      "Exit codes: 0 done or within the tolerance, 1 not within it, 2 bad usage or input, 3 undecided or ended by a "
      "limit.");
  app.set_version_flag("--version", app.get_name() + " " MESHBOUND_VERSION);
}

void tell(const CommonOptions& options, const std::string& closing_line, const std::function<void()>& print) {
  if (options.prints_summary()) print();
  if (options.quiet && !closing_line.empty()) std::fprintf(stderr, "%s\n", closing_line.c_str());
}

void add_examples(CLI::App& app, const std::vector<std::string>& command_lines) {
  std::string footer = app.get_footer() + "\n\nExamples:";
  for (const std::string& line : command_lines) footer += "\n  " + line;
  app.footer(footer);
}

int tool_main(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& run) {
  occupy_standard_streams();
  limit_omp_spin();
  remember_command_line(app.get_name(), argc, argv);
  ignore_write_signals();
  watch_interrupts(app.get_name());
  add_completion_option(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& printed) {
    return conclude(app, app.exit(printed));
  } catch (const CLI::ParseError& error) {
    return complain(app, std::string(error.what()) + suggestion(app) + " (see --help)");
  } catch (const InvalidInput& error) {
    return complain(app, error.what());
  }
  try {
    return conclude(app, run());
  } catch (const Stopped& stopped) {
    if (interrupted()) return complain(app, "interrupted; nothing was written");
    return complain(app, std::string(stopped.what()) + "; nothing was written", ExitUndecided);
  } catch (const std::bad_alloc&) {
    return complain(app, out_of_memory(app.get_name()));
  } catch (const std::exception& error) {
    return complain(app, error.what());
  }
}

}  // namespace meshbound::tools
