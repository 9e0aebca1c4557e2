#include "gnomon/base/log.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

class Log : public testing::Test {
 protected:
  void TearDown() override { log::setLevel(log::Level::info); }
};

TEST_F(Log, OneLineEachWithItsSeverity) {
  testing::internal::CaptureStderr();
  log::info("plain {}");
  log::warning("careful");
  log::error("broken");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "plain {}\nwarning: careful\nerror: broken\n");
}

TEST_F(Log, LevelHidesWhatIsBelow) {
  testing::internal::CaptureStderr();
  log::debug("hidden");
  log::setLevel(log::Level::error);
  log::warning("hidden");
  log::error("shown");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "error: shown\n");
}

TEST_F(Log, OffHidesErrors) {
  testing::internal::CaptureStderr();
  log::setLevel(log::Level::off);
  log::error("hidden");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace gnomon
