// SPDX-License-Identifier: MIT
// What a signal does to a tool at a stage that does not look at the flag: each test forks a process that stands there.
#include "common/signals.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>

#include "common/exit_code.h"
#include "common/output_folder.h"
#include "mesh/atomic_file.h"
#include "mesh/unnamed_file.h"
#include "meshbound/error.h"
#include "run_tool.h"
#include "setting.h"

namespace meshbound::tools {
namespace signals_test {

namespace fs = std::filesystem;
using testing_tools::content_of;
using testing_tools::line_count;

class Signals : public testing::Test {
 protected:
  /// The exit code of a process that runs `work`; what it says on stderr goes to the file "err".
  int run(const std::function<void()>& work) const {
    const pid_t process = ::fork();
    if (process == 0) {
      if (std::freopen((folder_ / "err").c_str(), "w", stderr) == nullptr) ::_exit(99);
      ::alarm(0);
      watch_interrupts("tool");
      work();
      ::_exit(98);
    }
    int status = 0;
    ::waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  [[nodiscard]] std::ptrdiff_t file_count() const {
    return std::distance(fs::recursive_directory_iterator(folder_.path()), {});
  }
  [[noreturn]] static void stay() {
    for (;;) ::pause();
  }
  test::TemporaryFolder folder_;
};

TEST_F(Signals, EndAProcessThatDoesNotListenInOneLineAndRemoveItsFiles) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const test::Setting has_unnamed_files(internal::has_unnamed_files, signal == SIGHUP);
    const int code = run([&] {
      const OutputFolder folder(folder_ / "levels");
      AtomicFile first(folder_ / "levels/first"), second(folder_ / "second");
      first.write("half");
      second.write("whole, but not to be seen");
      second.complete();
      ::raise(signal);
      ::raise(signal);  // as `timeout` and impatient users do
      stay();
    });
    EXPECT_EQ(code, ExitBadInput);
    EXPECT_EQ(content_of(folder_ / "err"), "tool: interrupted; unfinished files were removed\n");
    EXPECT_EQ(file_count(), 1) << "only what was said is there";
  }
}

TEST_F(Signals, ThatKillLeaveNoFile) {
  const int code = run([&] {
    AtomicFile first(folder_ / "first"), second(folder_ / "second");
    first.write("half");
    second.write("whole, but not to be seen");
    second.complete();
    ::raise(SIGKILL);
  });
  EXPECT_EQ(code, 128 + SIGKILL);
  EXPECT_EQ(file_count(), 1) << "only what was said is there";
}

TEST_F(Signals, LetFilesAppearTogether) {
  const int code = run([&] {
    AtomicFile first(folder_ / "first"), second(folder_ / "second");
    {
      const UninterruptedScope together;
      first.commit();
      ::raise(SIGINT);
      ::pause();  // until the process would be ended
      second.commit();
    }
    stay();
  });
  EXPECT_EQ(code, ExitBadInput);
  EXPECT_TRUE(fs::exists(folder_ / "first"));
  EXPECT_TRUE(fs::exists(folder_ / "second"));
  EXPECT_EQ(file_count(), 3);
}

/// A FIFO that nobody reads does not keep the process from ending, not even inside an `UninterruptedScope`.
TEST_F(Signals, EndTheWaitForTheReaderOfAFifo) {
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  const int code = run([&] {
    const UninterruptedScope together;
    AtomicFile file(folder_ / "fifo", AtomicFile::Stream::Staged, {.cancel = &interrupted()});
    file.write("for nobody");
    const pid_t parent = ::getpid();
    if (::fork() == 0) {
      ::usleep(50000);  // most likely the other process waits by then; the outcome is the same if not
      ::kill(parent, SIGTERM);
      ::_exit(0);
    }
    try {
      file.commit();
    } catch (const Interrupted&) {
      ::_exit(7);
    }
  });
  EXPECT_EQ(code, 7);
  EXPECT_TRUE(fs::is_fifo(folder_ / "fifo"));
}

TEST_F(Signals, OfAHangUpAreIgnoredUnderNohup) {
  const int code = run([] {
    std::signal(SIGHUP, SIG_IGN);
    watch_interrupts("tool");
    ::raise(SIGHUP);
    ::_exit(interrupted() ? 1 : 0);
  });
  EXPECT_EQ(code, 0);
}

}  // namespace signals_test
}  // namespace meshbound::tools
