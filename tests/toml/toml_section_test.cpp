// One section of a TOML file: what is read, and the one-line message for each kind of error.
#include "toml/toml_section.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "heel/error.h"
#include "support/temporary_folder.h"
#include "toml/toml_file.h"

namespace heel {
namespace {

using Read = std::function<void(TomlSection& root)>;

/// The message of the error that `read` throws for a file of this text; empty when it throws none.
std::string message(const std::string& text, const Read& read) {
  try {
    const toml::table table = parse_toml(text, "f.toml");
    TomlSection root(table, "", "f.toml");
    read(root);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The parser would call itself for each part, until there is no stack left.
TEST(Toml, ANameOfVeryManyPartsIsRefused) {
  std::string name = "a";
  for (int i = 0; i < 100000; ++i) name += ".a";
  const auto said = [](const std::string& text) { return message(text, [](TomlSection&) {}); };
  const std::string refused = "f.toml:2: a name of more than 200 parts (expected section.key)";
  EXPECT_EQ(said("\n" + name + " = 1\n"), refused);
  EXPECT_EQ(said("\n[" + name + "]\n"), refused);
  EXPECT_EQ(said("\nx = {" + name + " = 1}\n"), refused);
  std::string numbers = "x = [0.5";
  for (int i = 0; i < 1000; ++i) numbers += ", 0.5";
  EXPECT_EQ(said("# " + std::string(1000, '.') + "\n" + numbers + "]\n"), "");
}

TEST(Toml, AFileThatIsTooLargeIsNotReadToItsEnd) {
  try {
    read_toml_text("/dev/zero", "a configuration file");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "/dev/zero: more than 4194304 bytes (expected a configuration file)");
  }
}

TEST(Toml, WhatProgramsForTextMakeOfAFileIsNamed) {
  const auto said = [](const std::string& text) { return message(text, [](TomlSection&) {}); };
  const auto names = [&](const std::string& text, const std::string& cause) {
    return said(text).find(cause) != std::string::npos && said(text).starts_with("f.toml:");
  };
  EXPECT_TRUE(names(std::string("\xff\xfe[\0a\0]\0", 8), "UTF-16")) << said("\xff\xfe");
  EXPECT_TRUE(
      names("x = 1\n# K\xfc"
            "che\n",
            "save it as that"));
  EXPECT_TRUE(names("x = 1\nname = \u201cyard\u201d\n", "straight quotes"));
  EXPECT_TRUE(names("x = 1\nspeed = 0,5\n", "a point in a number"));
  EXPECT_TRUE(names("x = 1\nspeed = [0,5\n", "(expected TOML)"));
  EXPECT_TRUE(names("# 0,5 \u201cyard\u201d\nspeed 1\n", "(expected TOML)")) << "on another line";
  EXPECT_TRUE(names("camera:\n  rate_hz: 30\n", "is this YAML?"));
  EXPECT_TRUE(names(R"({"camera": {"rate_hz": 30}})", "this is JSON"));
  EXPECT_TRUE(names("x = 1\nsource = file:walk.mp4\n", "text in quotes"));
  EXPECT_TRUE(names("x = 1\npath = /dev/video0\n", "text in quotes"));
  EXPECT_TRUE(names("rate_hz = 30fps\n", "a number without its unit"));
  EXPECT_TRUE(names("gain = 0.5 1/s\n", "(expected TOML)"));
  EXPECT_TRUE(
      names(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "another kind of file, e.g. a picture"));
  EXPECT_EQ(said("\xef\xbb\xbfspeed = 1\r\n"), "") << "a byte order mark, and line ends of Windows";
}

TEST(TomlSection, GivesValuesAndFallbacks) {
  const toml::table table = parse_toml(
      "speed = 2\ncount = 3\nname = 'x'\non = true\ncorners = [1, 2.5]\nfaults = ['a', "
      "'b']\n[[leg]]\n[[leg]]\n",
      "f.toml");
  TomlSection root(table, "", "f.toml");
  EXPECT_EQ(root.number("speed", 0.0, {0, 5, "m/s"}), 2.0) << "a whole number is also a number";
  EXPECT_EQ(root.number("absent", 7.0, {0, 5, "m/s"}), 7.0);
  EXPECT_EQ(root.required_number("speed", {0, 5, "m/s"}), 2.0);
  EXPECT_EQ(root.integer("count", 0, 0, 10), 3);
  EXPECT_EQ(root.text("name", ""), "x");
  EXPECT_TRUE(root.boolean("on", false));
  EXPECT_EQ(root.numbers("corners", 2), (std::vector<double>{1.0, 2.5}));
  EXPECT_TRUE(root.numbers("absent", 2).empty());
  EXPECT_EQ(root.texts("faults"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(root.sections("leg").size(), 2U);
  EXPECT_EQ(root.section("absent").number("x", 1.5, {0, 5, ""}), 1.5);
  root.reject_unknown_keys();
}

TEST(TomlSection, ErrorsNameThePlaceTheValueAndWhatIsExpected) {
  const Read speed = [](TomlSection& root) { root.section("leg").number("speed", 0.0, {0, 5, "m/s"}); };
  EXPECT_EQ(message("[leg]\nspeed = 'fast'\n", speed),
            "f.toml:2:9: leg.speed: 'fast' (expected a number 0…5 m/s)");
  EXPECT_EQ(message("[leg]\nspeed = nan\n", speed), "f.toml:2:9: leg.speed: nan (expected a number 0…5 m/s)");
  EXPECT_EQ(message("[leg]\nspeed = [1]\n", speed),
            "f.toml:2:9: leg.speed: a list (expected a number 0…5 m/s)");
  EXPECT_EQ(message("leg = 3\n", speed), "f.toml:1:7: leg: 3 (expected a section [leg])");
  EXPECT_EQ(message("count = 2.5\n", [](TomlSection& root) { root.integer("count", 0, 1, 9); }),
            "f.toml:1:9: count: 2.5 (expected a whole number 1…9)");
  EXPECT_EQ(message("on = 1\n", [](TomlSection& root) { root.boolean("on", false); }),
            "f.toml:1:6: on: 1 (expected true or false)");
  EXPECT_EQ(message("corners = [1.0]\n", [](TomlSection& root) { root.numbers("corners", 2); }),
            "f.toml:1:11: corners: a list of 1 (expected a list of 2 numbers)");
  EXPECT_EQ(message("faults = ['a', 2]\n", [](TomlSection& root) { root.texts("faults"); }),
            "f.toml:1:16: faults: 2 (expected a list of texts in quotes)");
  EXPECT_EQ(message("[leg]\n",
                    [](TomlSection& root) {
                      root.section("leg").required_number("x", {0, 1, "m"});
                    }),
            "f.toml:1:1: leg.x: missing (expected a number in m)");
  EXPECT_EQ(message("leg = 1\n", [](TomlSection& root) { root.sections("leg"); }),
            "f.toml:1:7: leg: 1 (expected sections [[leg]])");
}

TEST(TomlSection, AKeyThatIsNotReadIsAnErrorThatNamesTheNearest) {
  const Read speed = [](TomlSection& root) {
    root.number("speed", 0.0, {0, 5, "m/s"});
    root.text("name", "");
    root.reject_unknown_keys();
  };
  EXPECT_EQ(message("speeed = 1\n", speed),
            "f.toml:1:1: speeed: no such key; did you mean speed? (expected one of: name, speed)");
  EXPECT_EQ(message("x = 1\n", speed), "f.toml:1:1: x: no such key (expected one of: name, speed)");
}

TEST(TomlFile, SyntaxErrorsAndMissingFilesAreNamed) {
  EXPECT_EQ(message("a = = 1\n", [](TomlSection&) {}).substr(0, 12), "f.toml:1:5: ");
  const test::TemporaryFolder folder;
  for (const auto& [path, why] : {std::pair{folder.file("absent.toml"), "No such file or directory"},
                                  std::pair{folder.path().string(), "Is a directory"},
                                  std::pair{folder.file(std::string(300, 'a')), "File name too long"}}) {
    try {
      read_toml_text(path, "a scenario file");
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), path + ": cannot read: " + why + " (expected a scenario file)");
    }
  }
  EXPECT_EQ(read_toml_text(test::write_text(folder.file("empty.toml"), ""), "a file"), "");
}

}  // namespace
}  // namespace heel
