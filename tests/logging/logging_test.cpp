// Logging: levels, the journal's fields, and that the journal is used only when standard error is the
// journal.
#include "logging/logging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include "logging/journal_sink.h"
#include "logging/recent_log.h"
#include "support/complaint.h"
#include "support/process.h"

namespace heel {
namespace {

std::string written(std::unique_ptr<spdlog::formatter> formatter, spdlog::level::level_enum level,
                    const std::string& text) {
  std::ostringstream out;
  auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(out);
  sink->set_formatter(std::move(formatter));
  spdlog::logger logger("test", sink);
  logger.set_level(spdlog::level::trace);
  logger.log(level, text);
  return out.str();
}

std::vector<std::string> fields_of(spdlog::level::level_enum level, const spdlog::source_loc& source = {}) {
  return journal_fields(spdlog::details::log_msg(source, "test", level, "text"));
}

TEST(Logging, JournalMessagesCarryTheSyslogPriority) {
  using testing::Contains;
  EXPECT_THAT(fields_of(spdlog::level::debug), Contains("PRIORITY=7"));
  EXPECT_THAT(fields_of(spdlog::level::info), Contains("PRIORITY=6"));
  EXPECT_THAT(fields_of(spdlog::level::warn), Contains("PRIORITY=4"));
  EXPECT_THAT(fields_of(spdlog::level::err), Contains("PRIORITY=3"));
  EXPECT_THAT(fields_of(spdlog::level::critical), Contains("PRIORITY=2"));
}

TEST(Logging, JournalMessagesCarryPartAndEvent) {
  EXPECT_THAT(fields_of(spdlog::level::info),
              testing::ElementsAre("MESSAGE=text", "PRIORITY=6", "SYSLOG_IDENTIFIER=heeld"));

  class Kept : public spdlog::sinks::base_sink<std::mutex> {
   public:
    std::vector<std::string> fields;
    void sink_it_(const spdlog::details::log_msg& message) override { fields = journal_fields(message); }
    void flush_() override {}
  };
  const auto kept = std::make_shared<Kept>();
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", kept));
  log_event({.part = "camera", .event = "camera lost"}, spdlog::level::warn, "camera lost: {} unplugged");
  spdlog::set_default_logger(before);
  EXPECT_THAT(kept->fields,
              testing::ElementsAre("MESSAGE=camera lost: {} unplugged", "PRIORITY=4",
                                   "SYSLOG_IDENTIFIER=heeld", "HEEL_PART=camera", "HEEL_EVENT=camera lost"));
}

TEST(Logging, TerminalLinesCarryTimeAndLevel) {
  EXPECT_THAT(written(make_terminal_formatter(), spdlog::level::warn, "text"),
              testing::MatchesRegex("[0-9][0-9]:[0-9][0-9]:[0-9][0-9]\\.[0-9]+ warning text\n"));
}

TEST(Logging, TheJournalIsRecognisedByTheDeviceAndInodeOfStandardError) {
  struct stat file {};
  ASSERT_EQ(fstat(STDERR_FILENO, &file), 0);
  unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(stderr_is_journal());
  setenv("JOURNAL_STREAM", "1:2", 1);
  EXPECT_FALSE(stderr_is_journal()) << "the variable is inherited, and names another stream";
  setenv("JOURNAL_STREAM", (std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino)).c_str(), 1);
  EXPECT_TRUE(stderr_is_journal());
  unsetenv("JOURNAL_STREAM");
}

TEST(Logging, UnknownLevelsAreRefusedAndChangeNothing) {
  start_logging("warn");
  EXPECT_THAT(test::complaint_of([] { set_log_level("loud"); }),
              testing::AllOf(testing::HasSubstr("'loud'"), testing::HasSubstr("expected trace")));
  EXPECT_EQ(spdlog::get_level(), spdlog::level::warn);
  set_log_level("error");
  EXPECT_EQ(spdlog::get_level(), spdlog::level::err);
  stop_logging();
  EXPECT_THROW(start_logging(""), Error);
}

TEST(Logging, StopWritesTheWaitingMessagesAndLaterMessagesAreStillLogged) {
  testing::internal::CaptureStderr();
  start_logging("info");
  for (int i = 0; i < 100; ++i) spdlog::info("message {}", i);
  spdlog::debug("not this one");
  stop_logging();
  spdlog::info("late");
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_THAT(text, testing::HasSubstr("message 0\n"));
  EXPECT_THAT(text, testing::HasSubstr("message 99\n"));
  EXPECT_THAT(text, testing::HasSubstr("late\n"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("not this one")));
}

TEST(Logging, AFullStandardErrorBlocksNoThreadThatLogs) {
  test::Process process([] {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0 || dup2(ends[1], STDERR_FILENO) < 0) _exit(1);
    start_logging("info");
    // More than the pipe, which is not read, and the queue of messages hold.
    const std::string text(200, 'x');
    for (int i = 0; i < 20'000; ++i) spdlog::info(text);
    // Without what the thread sanitizer does in exit(): it flushes standard error, for which this pipe is
    // full.
    syscall(SYS_exit_group, 0);
  });
  EXPECT_EQ(process.wait(), 0);
}

TEST(RecentLog, KeepsTheNewestLinesWithTheirPart) {
  const auto recent = std::make_shared<RecentLog>();
  start_logging("info", recent);
  spdlog::debug("not logged at this level");
  for (std::size_t i = 1; i < RecentLog::kKept + 10; ++i) spdlog::info("line {}", i);
  const auto newest = [&] {
    const std::vector<LoggedLine> lines = recent->after(0, 1);
    return lines.empty() ? LoggedLine() : lines[0];
  };
  ASSERT_TRUE(test::eventually([&] { return newest().text == "line 509"; }));
  const std::vector<LoggedLine> all = recent->after(0, 10'000);
  ASSERT_EQ(all.size(), RecentLog::kKept);
  EXPECT_EQ(all.front().text, "line 10");
  EXPECT_EQ(recent->after(all.back().number - 2, 100).size(), 2u);
  EXPECT_EQ(recent->after(all.back().number, 100).size(), 0u);
  log_event({.part = "camera", .event = "camera lost"}, spdlog::level::warn, "gone");
  ASSERT_TRUE(test::eventually([&] { return newest().text == "gone"; }));
  EXPECT_EQ(newest().part, "camera");
  EXPECT_EQ(newest().level, spdlog::level::warn);
  stop_logging();
}

}  // namespace
}  // namespace heel
