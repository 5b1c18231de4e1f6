#include "support/test_data.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace heel::test {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

}  // namespace

std::string source_path(const std::string& relative) {
  return std::string(HEEL_SOURCE_DIR "/") + relative;
}

std::string data_path(const std::string& relative) {
  const std::string_view given = environment("HEEL_TEST_DATA");
  const std::filesystem::path folder =
      given.empty() ? std::filesystem::path(HEEL_SOURCE_DIR).parent_path() / "shared" / "data"
                    : std::filesystem::path(given);
  return relative.empty() ? folder.string() : (folder / relative).string();
}

bool has_data(const std::string& relative) {
  return std::filesystem::exists(data_path(relative));
}

bool data_is_required() {
  return environment("HEEL_REQUIRE_DATA") == "1";
}

void print_data_use(const std::string& relative) {
  std::printf("test data: %s\n", relative.c_str());
}

std::string absent_data_message(const std::string& relative) {
  return "no test data at " + data_path(relative) +
         " (expected in the folder HEEL_TEST_DATA, else ../shared/data)";
}

}  // namespace heel::test
