// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "mesh/descriptor.h"
#include "mesh/unnamed_file.h"

namespace meshbound {

/// Where the large arrays of a run are kept.
struct StoreSpace {
  std::filesystem::path folder;  ///< for files that have no name there, so that no ending leaves any; empty: in memory
};

/// Where other processes of this user on this machine find the first bytes of a store.
struct SharedBytes {
  SharedFile file;
  std::uint64_t size = 0;
};

/// Bytes that are appended and read by ranges. Any number of threads may read while none appends.
/// A moved-from store may only be destroyed or assigned to.
class ByteStore {
 public:
  /// Throws `IoError` where the folder takes no files.
  explicit ByteStore(const StoreSpace& space);
  /// The bytes of a store of another process, which may go meanwhile; what is appended stands in the same file behind
  /// `shared.size`. Throws `IoError` where the file cannot be opened.
  ByteStore(const StoreSpace& space, const SharedBytes& shared);

  /// Throws `IoError`, such as for a full disk.
  void append(const void* bytes, std::size_t size);
  /// The range must have been appended. Throws `IoError`.
  void read(std::uint64_t first, void* to, std::size_t size) const;
  [[nodiscard]] std::uint64_t size() const { return written_ + filled_; }
  /// For a store in a folder: everything that was appended is in the file from here on. Throws `IoError`.
  [[nodiscard]] SharedBytes share();

 private:
  void write_chunk();
  void read_written(std::uint64_t first, char* to, std::size_t size) const;
  [[noreturn]] void fail(const char* action, int error) const;

  StoreSpace space_;
  Descriptor file_;                              ///< if there is one
  std::vector<std::unique_ptr<char[]>> chunks_;  ///< what has been written where there is no file
  std::unique_ptr<char[]> last_;                 ///< the chunk that is being filled
  std::size_t filled_ = 0;                       ///< bytes of it
  std::uint64_t written_ = 0;                    ///< bytes before it
};

}  // namespace meshbound
