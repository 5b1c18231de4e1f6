// Every kept input of the fuzz targets, whole, cut and with single bits changed. A target that finds a
// violation ends the program with SIGABRT; the input's name then stands last in the output.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "support/process.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"
#include "support/text.h"

extern "C" {
int fuzz_arcos(const std::uint8_t* data, std::size_t size);
int fuzz_camera_file(const std::uint8_t* data, std::size_t size);
int fuzz_config_edit(const std::uint8_t* data, std::size_t size);
int fuzz_mcap(const std::uint8_t* data, std::size_t size);
int fuzz_operator(const std::uint8_t* data, std::size_t size);
int fuzz_page(const std::uint8_t* data, std::size_t size);
int fuzz_picture(const std::uint8_t* data, std::size_t size);
int fuzz_session(const std::uint8_t* data, std::size_t size);
int fuzz_template(const std::uint8_t* data, std::size_t size);
int fuzz_video(const std::uint8_t* data, std::size_t size);
}

namespace heel {
namespace {

namespace fs = std::filesystem;

struct FuzzTarget {
  const char* name;
  int (*feed)(const std::uint8_t*, std::size_t);
  int damaged;  ///< copies of each input
};

constexpr FuzzTarget kFuzzTargets[] = {
    {"fuzz_arcos", fuzz_arcos, 200},
    {"fuzz_camera_file", fuzz_camera_file, 100},
    {"fuzz_config_edit", fuzz_config_edit, 40},
    {"fuzz_mcap", fuzz_mcap, 200},
    {"fuzz_operator", fuzz_operator, 200},
    {"fuzz_page", fuzz_page, 200},
    {"fuzz_picture", fuzz_picture, 20},
    {"fuzz_session", fuzz_session, 100},
    {"fuzz_template", fuzz_template, 100},
    {"fuzz_video", fuzz_video, 4},
};

std::string damaged(std::string bytes, std::uint64_t seed) {
  if (bytes.empty()) return bytes;
  Random random(seed);
  if (seed % 2 == 0) bytes.resize(random.next() % bytes.size());
  for (std::uint64_t flips = seed % 3; flips > 0 && !bytes.empty(); --flips) {
    char& byte = bytes[random.next() % bytes.size()];
    byte = static_cast<char>(byte ^ (1 << (random.next() % 8)));
  }
  return bytes;
}

void feed(const FuzzTarget& target, const std::string& bytes) {
  // A copy of exactly this size: checks of the library's containers see a read beyond its end.
  const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  EXPECT_EQ(target.feed(copy.data(), copy.size()), 0);
}

/// Returns how many inputs there are in the folder.
int feed_folder(const FuzzTarget& target, const fs::path& folder) {
  int inputs = 0;
  if (!fs::is_directory(folder)) return inputs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::printf("%s: %s\n", target.name, entry.path().filename().c_str());
    std::fflush(stdout);
    const std::string bytes = test::read_text(entry.path());
    feed(target, bytes);
    for (int copy = 1; copy <= target.damaged; ++copy)
      feed(target, damaged(bytes, static_cast<std::uint64_t>(copy)));
    ++inputs;
  }
  return inputs;
}

TEST(FuzzCorpora, EveryTargetTakesItsInputsAndDamagedCopiesOfThem) {
  const test::TemporaryFolder made;
  ASSERT_EQ(test::run_program({test::built_program("fuzz_seeds"), made.path().string()}).status, 0);
  for (const FuzzTarget& target : kFuzzTargets) {
    const int kept = feed_folder(target, fs::path(test::source_path("tests/fuzz/corpora")) / target.name);
    EXPECT_GT(kept + feed_folder(target, made.path() / target.name), 1) << target.name;
  }
}

}  // namespace
}  // namespace heel
