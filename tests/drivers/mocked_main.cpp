// SPDX-License-Identifier: MIT
// Begins anew with umockdev's library loaded before all others, so that the test can be run by its plain
// name.
#include <cstdlib>
#include <iostream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

int main(int argc, char** argv) {
  if (!std::getenv("DYNSLAM_MOCKED")) {
    const char* others = std::getenv("LD_PRELOAD");
    const std::string all = std::string(DYNSLAM_PRELOAD) + (others ? std::string(":") + others : "");
    ::setenv("LD_PRELOAD", all.c_str(), 1);
    ::setenv("DYNSLAM_MOCKED", "1", 1);
    ::execv("/proc/self/exe", argv);
    std::cerr << "cannot begin anew with " << all << "\n";
    return 1;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
