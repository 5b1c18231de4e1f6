// One line of JSON → a request, or one clear line why not.
#include "operator/request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "operator/line_buffer.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Request good(const std::string& line) {
  const ParsedRequest parsed = parse_request(line);
  EXPECT_EQ(parsed.error, "") << line;
  return parsed.request;
}
std::string error_of(const std::string& line) {
  const ParsedRequest parsed = parse_request(line);
  EXPECT_EQ(parsed.error.find('\n'), std::string::npos) << "one line";
  return parsed.error;
}

TEST(OperatorRequest, EachKindByItsName) {
  int kinds = 0;
  for (const RequestRow& row : request_table()) {
    ++kinds;
    if (row.kind == RequestKind::Set) continue;
    const Request request = good("{\"v\":1,\"id\":7,\"do\":\"" + std::string(row.name) + "\"}");
    EXPECT_EQ(request.kind, row.kind);
    EXPECT_EQ(request.id, 7);
  }
  EXPECT_EQ(kinds, 11);
}

TEST(OperatorRequest, VersionAndIdMayBeLeftOut) {
  const Request request = good(" { \"do\" : \"status\" } ");
  EXPECT_EQ(request.kind, RequestKind::Status);
  EXPECT_FALSE(request.id.has_value());
  EXPECT_EQ(good("{\"id\":0,\"do\":\"status\"}").id, 0);
}

TEST(OperatorRequest, TheTextOfAMarkIsShort) {
  EXPECT_EQ(good(R"({"do":"mark","text":"it hesitates"})").text, "it hesitates");
  EXPECT_EQ(good(R"({"do":"mark"})").text, "");
  EXPECT_THAT(error_of(R"({"do":"mark","text":5})"), HasSubstr("text: expected a text"));
  const std::string longest(kMaxMarkBytes, 'x');
  EXPECT_EQ(good("{\"do\":\"mark\",\"text\":\"" + longest + "\"}").text, longest);
  EXPECT_THAT(error_of("{\"do\":\"mark\",\"text\":\"" + longest + "x\"}"), HasSubstr("at most 200 bytes"));
}

TEST(OperatorRequest, ValuesOfASet) {
  const Request request = good(
      "{\"do\":\"set\",\"values\":{\"b\":0.5,\"a\":true,\"c\":-3,\"d\":\"debug\",\"e\":1e3,"
      "\"f\":18446744073709551615}}");
  ASSERT_EQ(request.assignments.size(), 6u);
  EXPECT_EQ(request.assignments[0].key, "b");
  EXPECT_EQ(std::get<double>(request.assignments[0].value), 0.5);
  EXPECT_TRUE(std::get<bool>(request.assignments[1].value));
  EXPECT_EQ(std::get<std::int64_t>(request.assignments[2].value), -3);
  EXPECT_EQ(std::get<std::string>(request.assignments[3].value), "debug");
  EXPECT_EQ(std::get<double>(request.assignments[4].value), 1000.0);
  EXPECT_EQ(std::get<double>(request.assignments[5].value), 18446744073709551615.0);
}

TEST(OperatorRequest, ThePeriodOfAWatch) {
  EXPECT_EQ(good("{\"do\":\"watch\",\"period_s\":2}").period_s, 2.0);
  EXPECT_EQ(good("{\"do\":\"watch\"}").period_s, Request().period_s);
  for (const char* wrong : {"0.01", "61", "-1", "\"1\"", "null", "1e999"})
    EXPECT_NE(error_of(std::string("{\"do\":\"watch\",\"period_s\":") + wrong + "}"), "") << wrong;
}

TEST(OperatorRequest, WhatIsWrongIsNamed) {
  EXPECT_THAT(error_of("hello"), HasSubstr("no JSON at byte 1"));
  EXPECT_THAT(error_of("{\"do\":\"stop\"} {}"), HasSubstr("no JSON at byte"));
  EXPECT_THAT(error_of("[1]"), HasSubstr("no JSON object"));
  EXPECT_THAT(error_of("{}"), HasSubstr("do: missing (expected one of status, start, stop, estop"));
  EXPECT_THAT(error_of("{\"do\":3}"), HasSubstr("do: missing"));
  EXPECT_THAT(error_of("{\"do\":\"begin\"}"), HasSubstr("do: 'begin' (expected one of status, start"));
  EXPECT_THAT(error_of("{\"do\":\"start\",\"now\":true}"),
              HasSubstr("'now': a field that 'start' does not have (expected v, id, do)"));
  EXPECT_THAT(error_of("{\"do\":\"watch\",\"perod_s\":1}"), HasSubstr("(expected v, id, do, period_s)"));
  EXPECT_THAT(error_of("{\"v\":2,\"do\":\"stop\"}"),
              HasSubstr("another version of the protocol (expected 1)"));
  EXPECT_THAT(error_of("{\"id\":-1,\"do\":\"stop\"}"), HasSubstr("id: expected a whole number"));
  EXPECT_THAT(error_of("{\"id\":\"a\",\"do\":\"stop\"}"), HasSubstr("id: expected a whole number"));
  EXPECT_THAT(error_of("{\"do\":\"set\"}"), HasSubstr("values: expected an object"));
  EXPECT_THAT(error_of("{\"do\":\"set\",\"values\":{}}"), HasSubstr("values: expected an object"));
  EXPECT_THAT(error_of("{\"do\":\"set\",\"values\":{\"a\":[1]}}"),
              HasSubstr("values: 'a': expected a number"));
  EXPECT_THAT(error_of("{\"do\":\"\xff\"}"), HasSubstr("no JSON"));
}

TEST(OperatorRequest, AnErrorKeepsTheIdAndNothingElse) {
  const ParsedRequest parsed = parse_request("{\"id\":9,\"do\":\"estop\",\"x\":1}");
  EXPECT_NE(parsed.error, "");
  EXPECT_EQ(parsed.request.id, 9);
  EXPECT_EQ(parsed.request.kind, Request().kind);
}

TEST(OperatorRequest, LinesOfTheLongestLengthAndDeepOnes) {
  std::string line = "{\"do\":\"status\"}";
  line.append(kMaxRequestBytes - line.size(), ' ');
  EXPECT_EQ(good(line).kind, RequestKind::Status);
  EXPECT_THAT(error_of(line + ' '), HasSubstr("a line of more than 4096 bytes"));
  EXPECT_THAT(error_of(std::string(kMaxRequestBytes, '[')), HasSubstr("no JSON"));
  const std::size_t half = kMaxRequestBytes / 2;
  EXPECT_THAT(error_of(std::string(half, '[') + std::string(half, ']')), HasSubstr("no JSON object"));
}

// Each example of the manual is what it says: a request that is good.
TEST(OperatorRequest, TheManualHasEveryRequestAndGoodExamples) {
  const std::string manual = test::read_text(test::source_path("docs/operator.md"));
  for (const RequestRow& row : request_table())
    EXPECT_THAT(manual, HasSubstr("\"do\":\"" + std::string(row.name) + "\"")) << row.name;
  std::istringstream lines(manual);
  int examples = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("> {")) continue;
    ++examples;
    good(line.substr(2));
  }
  EXPECT_GE(examples, 10);
}

std::vector<std::string> lines_of(LineBuffer& buffer) {
  std::vector<std::string> lines;
  for (std::string line; buffer.take(line);) lines.push_back(line);
  return lines;
}

TEST(LineBuffer, EverySplitPointGivesTheSameLines) {
  const std::string bytes = "{\"do\":\"stop\"}\r\n\nab\r\r\nlast";
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    for (std::size_t second = cut; second <= bytes.size(); ++second) {
      LineBuffer buffer(100);
      buffer.feed(bytes.substr(0, cut));
      buffer.feed(bytes.substr(cut, second - cut));
      buffer.feed(bytes.substr(second));
      ASSERT_THAT(lines_of(buffer), ElementsAre("{\"do\":\"stop\"}", "ab\r")) << cut << " " << second;
      ASSERT_TRUE(buffer.has_partial_line());
    }
  }
}

TEST(LineBuffer, ALineThatIsTooLongIsSeenToBeSoAndTheNextOneIsWhole) {
  for (const std::size_t piece : {1u, 3u, 50u}) {
    LineBuffer buffer(8);
    const std::string bytes = "12345678\r\n123456789\r\n" + std::string(30, 'x') + "\nok\n";
    for (std::size_t at = 0; at < bytes.size(); at += piece) buffer.feed(bytes.substr(at, piece));
    const std::vector<std::string> lines = lines_of(buffer);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0], "12345678");
    EXPECT_EQ(lines[1], "123456789");
    EXPECT_GT(lines[2].size(), 8u);
    EXPECT_LE(lines[2].size(), 10u);
    EXPECT_EQ(lines[3], "ok");
  }
}

}  // namespace
}  // namespace heel
