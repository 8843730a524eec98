// SPDX-License-Identifier: MIT
#include "common/output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "mesh/output_target.h"
#include "meshbound/error.h"

namespace meshbound::tools {

void check_writable(const std::string& path) {
  if (path.empty()) return;
  if (path != "-") {
    (void)output_target(path);
  } else if ((::fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY) {
    throw IoError("cannot write to standard output: it is closed, or open for reading only");
  }
}

void write_text(const std::string& path, const std::string& text, const StopToken& stop) {
  if (path == "-") {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (std::fflush(stdout) != 0 || !written)
      throw IoError(std::string("cannot write to standard output: ") + std::strerror(errno));
    return;
  }
  AtomicFile file(path, AtomicFile::Stream::Direct, stop);
  file.write(text);
  file.commit();
}

StagedText::StagedText(std::string path, std::string text, const StopToken& stop)
    : path_(std::move(path)), text_(std::move(text)), stop_(stop) {
  if (path_ == "-" || output_target(path_).is_stream) return;
  file_.emplace(path_, AtomicFile::Stream::Direct, stop_);
  file_->write(text_);
  file_->complete();
}

void StagedText::publish() {
  if (file_)
    file_->commit();
  else
    write_text(path_, text_, stop_);
}

}  // namespace meshbound::tools
