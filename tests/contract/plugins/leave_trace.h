// Code that runs when the library is loaded, before anybody calls it: it writes the file that $GNOMON_TEST_TRACE names.
#pragma once

#include <cstdlib>
#include <fstream>

namespace {

struct LeavesTrace {
  LeavesTrace() {
    if (const char* file = std::getenv("GNOMON_TEST_TRACE")) std::ofstream(file) << "loaded\n";
  }
};
const LeavesTrace leavesTrace;

}  // namespace
