// SPDX-License-Identifier: MIT
#include "common/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <cstring>

#include "mesh/file_stop.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

constexpr const char* input_device = "/dev/stdin";
constexpr const char* output_device = "/dev/stdout";

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

}  // namespace

std::vector<std::string> mesh_formats() { return {"ply", "obj", "off", "stl", "glb", "gltf"}; }

void add_stream_format(CLI::App& app, const std::string& name, std::string& format, const std::string& meshes) {
  app.add_option(name, format, "Format of a mesh given as '-', on standard " + meshes)
      ->check(CLI::IsMember(mesh_formats()));
}

std::string stream_path(const std::string& role, const std::string& argument, StandardStream stream,
                        const std::string& format) {
  if (argument != "-") return argument;
  const bool is_input = stream == StandardStream::Input;
  if (format.empty())
    throw InvalidInput(role + " is standard " + (is_input ? "input" : "output") +
                       ": say its format, such as --format ply");
  return std::string(is_input ? input_device : output_device) + "/mesh." + format;
}

bool is_stream_path(const std::filesystem::path& path) {
  return path.parent_path() == input_device || path.parent_path() == output_device;
}

std::string as_typed(const std::string& path) { return is_stream_path(path) ? "-" : path; }

std::string with_stream_names(std::string message) {
  for (const std::string& format : mesh_formats()) {
    replace_all(message, std::string(input_device) + "/mesh." + format, "standard input");
    replace_all(message, std::string(output_device) + "/mesh." + format, "standard output");
  }
  // What `device_of` returns, where a file is named that cannot be written.
  if (const std::string device = std::string(output_device) + ":"; message.starts_with(device))
    message.replace(0, device.size(), "standard output:");
  return message;
}

std::filesystem::path device_of(const std::filesystem::path& path) {
  return is_stream_path(path) ? path.parent_path() : path;
}

void occupy_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) < 0 && ::open("/dev/null", O_PATH) < 0) ::open("/", O_PATH);
}

std::string read_standard_input(const StopToken& stop) {
  constexpr int milliseconds_between_looks = 50;
  std::string bytes;
  std::array<char, std::size_t{1} << 16> buffer;
  while (true) {
    end_if_stopped(stop, "standard input", "read");
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (::poll(&ready, 1, milliseconds_between_looks) == 0) continue;
    const ssize_t count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count == 0) return bytes;
    if (count < 0 && errno != EINTR && errno != EAGAIN)
      throw IoError(std::string("standard input: cannot read: ") + std::strerror(errno));
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace meshbound::tools
