// SPDX-License-Identifier: MIT
/// "-" on a command line: a mesh read from standard input or written to standard output.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "meshbound/stop_token.h"

namespace CLI {
class App;
}

namespace meshbound::tools {

enum class StandardStream { Input, Output };

/// The formats of meshes, as an option names them.
[[nodiscard]] std::vector<std::string> mesh_formats();

/// Adds the option `name`, the format of `meshes`: --format of meshes on standard input or output.
void add_stream_format(CLI::App& app, const std::string& name, std::string& format, const std::string& meshes);

/// The path that stands for `argument` inside the tool: itself, or for "-" a path below the device of the stream, where
/// no file can be, with the extension of `format`. Throws `InvalidInput`, naming `role`, for "-" without a format.
[[nodiscard]] std::string stream_path(const std::string& role, const std::string& argument, StandardStream stream,
                                      const std::string& format);

/// Whether `path` is one that `stream_path` made of "-".
[[nodiscard]] bool is_stream_path(const std::filesystem::path& path);

/// The argument as typed: "-" for a path that `stream_path` made of it.
[[nodiscard]] std::string as_typed(const std::string& path);

/// A message in which "standard input" and "standard output" stand for the paths that `stream_path` made of "-".
[[nodiscard]] std::string with_stream_names(std::string message);

/// The file or device that is written to for `path`.
[[nodiscard]] std::filesystem::path device_of(const std::filesystem::path& path);

/// Has something stand on descriptors 0 to 2 that nothing can be read from or written to, where they are closed: else
/// the next file that is opened would be taken for standard output. To be called before any file is opened.
void occupy_standard_streams();

/// Everything on standard input. Throws `Interrupted` and `Stopped` as `stop` says, `IoError`. O(size).
[[nodiscard]] std::string read_standard_input(const StopToken& stop);

}  // namespace meshbound::tools
