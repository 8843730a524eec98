// SPDX-License-Identifier: MIT
#include "mesh/output_target.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <string>

#include "meshbound/error.h"

namespace meshbound {
namespace {

[[noreturn]] void refuse_to_write(const std::filesystem::path& path, const std::string& reason) {
  throw IoError(path.string() + ": cannot write: " + reason);
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// The descriptor that a symbolic link stands for: 1 for `/proc/self/fd/1`; -1 for any other path.
int descriptor_named(const std::filesystem::path& link) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::canonical(folder_of(link), error);
  if (error || folder != "/proc/" + std::to_string(::getpid()) + "/fd") return -1;
  const std::string name = link.filename().string();
  int descriptor = -1;
  const auto [rest, fault] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
  return fault == std::errc{} && rest == name.data() + name.size() ? descriptor : -1;
}

/// One step along a chain of symbolic links; nothing at its end, and at a link that names a descriptor.
std::optional<std::filesystem::path> next_link(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error) || descriptor_named(path) >= 0) return std::nullopt;
  const std::filesystem::path next = std::filesystem::read_symlink(path, error);
  if (error) return std::nullopt;
  return path.parent_path() / next;  // an absolute `next` replaces the folder
}

bool grants_writing(const std::filesystem::path& path, const struct stat& status) {
  constexpr mode_t anybody = S_IWUSR | S_IWGRP | S_IWOTH;
  if ((status.st_mode & (status.st_uid == ::geteuid() ? S_IWUSR : anybody)) == 0) return false;
  return ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
}

void require_folder(const std::filesystem::path& named, const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) refuse_to_write(named, "no such folder: " + folder.string());
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    refuse_to_write(named, "the folder is not writable");
}

}  // namespace

std::filesystem::path follow_links(std::filesystem::path path) {
  constexpr int max_chain = 40;  // as the kernel's own limit
  for (int i = 0; i < max_chain; ++i) {
    std::optional<std::filesystem::path> next = next_link(path);
    if (!next) break;
    path = std::move(*next);
  }
  return path;
}

OutputTarget output_target(const std::filesystem::path& path) {
  OutputTarget target;
  target.path = follow_links(path);
  struct stat status {};
  if (::stat(target.path.c_str(), &status) != 0) {
    if (errno != ENOENT && errno != ENOTDIR) refuse_to_write(path, std::strerror(errno));
    require_folder(path, folder_of(target.path));
    return target;
  }
  if (S_ISDIR(status.st_mode)) refuse_to_write(path, "it is a folder; name a file in it");
  target.descriptor = descriptor_named(target.path);
  target.is_stream =
      target.descriptor >= 0 || S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode) || S_ISFIFO(status.st_mode);
  if (!target.is_stream && !S_ISREG(status.st_mode)) refuse_to_write(path, "it is neither a file nor a device");
  if (target.descriptor < 0 && !grants_writing(target.path, status))
    refuse_to_write(path, "it is write-protected; change its mode or name another file");
  if (target.is_stream) return target;
  target.replaced = {status.st_mode & 07777, status.st_uid, status.st_gid};
  require_folder(path, folder_of(target.path));
  return target;
}

}  // namespace meshbound
