// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "mesh/output_target.h"
#include "mesh/temporary_files.h"
#include "mesh/unnamed_file.h"
#include "meshbound/stop_token.h"

namespace meshbound {

/// A file that appears whole or not at all: written without a name, which `commit` gives it, so that no ending leaves
/// anything behind. Where the file system knows only files with names it is written under a temporary one in the same
/// folder; where it is not committed, the destructor or `remove_temporary_files` removes it. A symbolic link is
/// followed, so that what it points to is replaced, or made. A file that is replaced leaves its permissions to the new
/// one. Devices and FIFOs are written to as they are. Buffered; every member throws `IoError` with the path as it was
/// given, also when the disk is full.
class AtomicFile {
 public:
  /// When bytes are sent to a device or FIFO, which cannot be read back.
  enum class Stream {
    Direct,  ///< at once
    Staged   ///< by `commit`; until then the bytes stand in a file in the folder for temporary files
  };

  /// Checks that `path` can be written to (see `output_target`) and touches nothing yet. Writing throws `Interrupted`
  /// or `Stopped` as `stop` says.
  explicit AtomicFile(std::filesystem::path path, Stream stream = Stream::Direct, const StopToken& stop = {});
  /// The file of another process, which alone commits it; `path` is for messages.
  AtomicFile(std::filesystem::path path, const SharedFile& shared);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }  ///< as the caller named it

  void write(std::string_view bytes);

  /// Returns room for at least `size` bytes (at most the 1 MiB of the buffer). The caller fills it from the start and
  /// passes the end of what it wrote to `use`, which adds those bytes to the file.
  [[nodiscard]] char* room(std::size_t size);
  void use(const char* end) { filled_ = static_cast<std::size_t>(end - buffer_.get()); }

  /// What is written next stands at this byte of the file, which is no stream.
  void seek(std::uint64_t offset);

  /// Where other processes of this user on this machine write to the same file, each its own bytes, until `complete`.
  [[nodiscard]] SharedFile share();

  /// Ends the writing: every byte has reached the file from here on. Call once.
  void complete();

  /// The file that holds what was written, between `complete` and `commit`. Empty for a stream that is not staged.
  [[nodiscard]] const std::filesystem::path& staged() const { return staged_; }

  /// Makes the file visible under its name, or sends what was staged to the stream. Call once, last.
  void commit();

 private:
  void open();
  void make_buffer();
  void open_staged(const std::filesystem::path& folder);
  void open_stream();
  [[nodiscard]] std::filesystem::path list_temporary_name(const std::filesystem::path& folder);
  void name_staged();
  void flush();
  void write_through(const char* from, std::size_t size);
  void send_staged();
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;  // as the caller named it, for messages
  OutputTarget target_;
  Stream stream_;
  StopToken stop_;
  std::filesystem::path staged_;     // where what was written can be read; empty for a stream that is not staged
  std::filesystem::path temporary_;  // a name that must not stay; empty where there is none
  std::optional<TemporaryName> listed_;
  int fd_ = -1;
  std::unique_ptr<char[]> buffer_;
  std::size_t filled_ = 0;
};

}  // namespace meshbound
