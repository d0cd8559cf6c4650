#include "core/base/system/log.h"

#include <gtest/gtest.h>

#include <vector>

namespace dubsar {
namespace {

TEST(Log, AHandlerThatLogsItselfNeitherBlocksNorRunsForEver) {
  std::vector<std::string> heard;
  set_log_handler([&](LogLevel, std::string_view message) {
    heard.emplace_back(message);
    log_info("the handler says {}", message);
  });
  log_info("one");
  log_warning("two");
  set_log_handler({});
  log_info("three");
  EXPECT_EQ(heard, (std::vector<std::string>{"one", "two"}));
}

}  // namespace
}  // namespace dubsar
