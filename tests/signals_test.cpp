// SPDX-License-Identifier: MIT
// What a signal does to a tool at a stage that does not look at the flag: each test forks a process that stands there.
#include "common/signals.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "common/exit_code.h"
#include "common/output_folder.h"
#include "common/tool_main.h"
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
      std::setvbuf(stderr, nullptr, _IONBF, 0);  // as it was
      ::alarm(0);
      // A shell that runs the tests in the background ignores SIGINT.
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
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

/// As under nohup, and in the background of a shell.
TEST_F(Signals, StayIgnoredWhereTheyWere) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const int code = run([signal] {
      std::signal(signal, SIG_IGN);
      watch_interrupts("tool");
      ::raise(signal);
      ::_exit(interrupted() ? 1 : 0);
    });
    EXPECT_EQ(code, 0) << signal;
  }
}

/// What a tool makes of how `work` ends. In a process of its own, as it does not go back to listening for signals.
int exit_code_of_tool(const std::function<int()>& work) {
  CLI::App app("", "tool");
  const char* const arguments[] = {"tool"};
  return tool_main(app, 1, arguments, work);
}

TEST_F(Signals, AreNoTimeLimit) {
  const int code = run([] {
    ::_exit(exit_code_of_tool([] {
      ::raise(SIGINT);
      StopToken{.cancel = &interrupted()}.check();
      return 0;
    }));
  });
  EXPECT_EQ(code, ExitBadInput);
  EXPECT_EQ(content_of(folder_ / "err"), "tool: interrupted; nothing was written\n");
  const int late =
      run([] { ::_exit(exit_code_of_tool([]() -> int { throw Stopped("in.off: the time limit came"); })); });
  EXPECT_EQ(late, ExitUndecided);
  EXPECT_EQ(content_of(folder_ / "err"), "tool: in.off: the time limit came; nothing was written\n");
}

/// However long memory takes to be freed after that.
TEST_F(Signals, AreAnsweredOnce) {
  const int code = run([] {
    const int ended = exit_code_of_tool([]() -> int {
      ::raise(SIGINT);
      throw Error("interrupted by the test");
    });
    ::pause();  // until the process would be ended
    ::_exit(ended);
  });
  EXPECT_EQ(code, ExitBadInput);
  EXPECT_EQ(content_of(folder_ / "err"), "tool: interrupted by the test\n");
}

TEST_F(Signals, DoNotUndoWhatIsDone) {
  const int code = run([] {
    const int ended = exit_code_of_tool([] { return ExitDone; });
    ::raise(SIGINT);
    ::pause();  // until the signal, or the timer that it starts
    ::_exit(ended);
  });
  EXPECT_EQ(code, ExitDone);
  EXPECT_EQ(content_of(folder_ / "err"), "");
}

/// Containers have processes with equal numbers, and a killed one leaves its file.
TEST_F(Signals, ThatKillLeaveNoFileWhoseNameIsUsedAgain) {
  const test::Setting has_unnamed_files(internal::has_unnamed_files, false);
  const auto name_without_process = [](AtomicFile& file) {
    file.complete();
    std::string name = file.staged().filename().string();
    const std::string process = "-" + std::to_string(::getpid()) + "-";
    const std::size_t at = name.find(process);
    return at == std::string::npos ? name : name.replace(at, process.size(), "-");
  };
  ASSERT_EQ(run([&] {
              AtomicFile file(folder_ / "file");
              std::ofstream(folder_ / "name") << name_without_process(file);
              ::raise(SIGKILL);
            }),
            128 + SIGKILL);
  AtomicFile file(folder_ / "file");
  EXPECT_NE(name_without_process(file), content_of(folder_ / "name"));
}

}  // namespace signals_test
}  // namespace meshbound::tools
