// SPDX-License-Identifier: MIT
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "run_tool.h"

namespace meshbound::testing_tools {

/// The run ended with exit code 2, one line on stderr that contains `why`, and nothing on stdout.
inline void expect_refused(const ToolRun& result, const std::string& why) {
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(line_count(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
  EXPECT_EQ(result.out, "");
}

}  // namespace meshbound::testing_tools
