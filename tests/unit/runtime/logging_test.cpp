// Logging: levels, the journal's prefix, and that it is only used when standard error is the journal.
#include "runtime/logging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <string>

#include "heel/error.h"

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

TEST(Logging, JournalLinesCarryTheSyslogPriority) {
  EXPECT_EQ(written(make_journal_formatter(), spdlog::level::debug, "text"), "<7>text\n");
  EXPECT_EQ(written(make_journal_formatter(), spdlog::level::info, "text"), "<6>text\n");
  EXPECT_EQ(written(make_journal_formatter(), spdlog::level::warn, "text"), "<4>text\n");
  EXPECT_EQ(written(make_journal_formatter(), spdlog::level::err, "text"), "<3>text\n");
  EXPECT_EQ(written(make_journal_formatter(), spdlog::level::critical, "text"), "<2>text\n");
}

TEST(Logging, TerminalLinesCarryTimeAndLevel) {
  EXPECT_THAT(written(make_terminal_formatter(), spdlog::level::warn, "text"),
              testing::MatchesRegex("[0-9][0-9]:[0-9][0-9]:[0-9][0-9]\\.[0-9]+ warning text\n"));
}

TEST(Logging, TheJournalIsRecognisedByDeviceAndInodeOfStandardError) {
  struct stat file {};
  ASSERT_EQ(fstat(STDERR_FILENO, &file), 0);
  unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(stderr_is_journal());
  setenv("JOURNAL_STREAM", "1:2", 1);
  EXPECT_FALSE(stderr_is_journal()) << "inherited from elsewhere";
  setenv("JOURNAL_STREAM", (std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino)).c_str(), 1);
  EXPECT_TRUE(stderr_is_journal());
  unsetenv("JOURNAL_STREAM");
}

TEST(Logging, UnknownLevelsAreRefusedAndChangeNothing) {
  start_logging("warn");
  try {
    set_log_level("loud");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'loud'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("expected trace"));
  }
  EXPECT_EQ(spdlog::get_level(), spdlog::level::warn);
  set_log_level("error");
  EXPECT_EQ(spdlog::get_level(), spdlog::level::err);
  stop_logging();
  EXPECT_THROW(start_logging(""), Error);
}

TEST(Logging, WhatWasLoggedIsWrittenBeforeStopAndLateMessagesStillFindALogger) {
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

}  // namespace
}  // namespace heel
