#include "log/journal_sink.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <set>

#include "log/fields.h"
#include "tests/support/temporary_folder.h"

namespace haptic::log {
namespace {

std::multiset<std::string>& entry() {
  static std::multiset<std::string> fields;
  return fields;
}

int remember(const iovec* fields, int count) {
  entry().clear();
  for (int i = 0; i < count; ++i) {
    entry().emplace(static_cast<const char*>(fields[i].iov_base), fields[i].iov_len);
  }
  return 0;
}

void write(spdlog::level::level_enum level, const std::string& text) {
  JournalSink sink(&remember);
  sink.log({{}, "hapticd", level, text});
}

TEST(JournalSink, TellsThePriorityAndTheWholeMessage) {
  write(spdlog::level::warn, "two\nlines, 100 %s");
  EXPECT_EQ(entry(), (std::multiset<std::string>{"MESSAGE=two\nlines, 100 %s", "PRIORITY=4",
                                                 "SYSLOG_IDENTIFIER=hapticd"}));
  write(spdlog::level::err, "");
  EXPECT_TRUE(entry().contains("PRIORITY=3"));
  write(spdlog::level::debug, "");
  EXPECT_TRUE(entry().contains("PRIORITY=7"));
}

TEST(JournalSink, TellsTheFieldsThatTheLineHas) {
  const Fields outer(FieldList{{"HAPTICD_TICK", "12"}});
  {
    const Fields inner(FieldList{{"HAPTICD_FAULT", "over_speed"}, {"HAPTICD_DEVICE", "left=1\n"}});
    write(spdlog::level::warn, "fault");
    EXPECT_TRUE(entry().contains("HAPTICD_TICK=12"));
    EXPECT_TRUE(entry().contains("HAPTICD_FAULT=over_speed"));
    EXPECT_TRUE(entry().contains("HAPTICD_DEVICE=left=1\n"));
  }
  write(spdlog::level::info, "no fault");
  EXPECT_TRUE(entry().contains("HAPTICD_TICK=12"));
  EXPECT_FALSE(entry().contains("HAPTICD_FAULT=over_speed"));
}

TEST(JournalSink, IsForADescriptorThatTheServiceManagerHasNamed) {
  const test::TemporaryFolder folder;
  const int file = ::open(folder.write("stream", "").c_str(), O_WRONLY);
  struct stat status {};
  ASSERT_EQ(::fstat(file, &status), 0);
  ::setenv("JOURNAL_STREAM", (std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino)).c_str(),
           1);
  EXPECT_TRUE(is_journal(file));
  ::setenv("JOURNAL_STREAM", (std::to_string(status.st_dev) + ":1").c_str(), 1);
  EXPECT_FALSE(is_journal(file));
  ::unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(is_journal(file));
  ::close(file);
}

}  // namespace
}  // namespace haptic::log
