// A folder of recordings that cannot be read to its end, as on a disk that is failing.
#include "telemetry/recording_folder.h"

#include <dirent.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <limits>
#include <string>

#include "support/temporary_folder.h"

namespace {
std::atomic<int> entries_until_error{-1};  // negative: there is none

template <typename Entry>
Entry* next_entry(DIR* folder, const char* function) {
  if (entries_until_error >= 0 && entries_until_error-- == 0) {
    entries_until_error = -1;
    errno = EIO;
    return nullptr;
  }
  return reinterpret_cast<Entry* (*)(DIR*)>(dlsym(RTLD_NEXT, function))(folder);
}
}  // namespace

// In place of those of the C library, for this program.
extern "C" dirent* readdir(DIR* folder) {
  return next_entry<dirent>(folder, "readdir");
}
extern "C" dirent64* readdir64(DIR* folder) {
  return next_entry<dirent64>(folder, "readdir64");
}

namespace heel {
namespace {

TEST(RecordingFolder, AnErrorWhileItIsReadEndsTheListOnly) {
  const test::TemporaryFolder folder;
  for (const char* const name : {"heel-1.mcap", "heel-2.mcap", "heel-3.mcap"})
    test::write_text(folder.file(name), "1000");
  const KeepLimits all{1'000'000, std::numeric_limits<TimeNs>::max()};
  const std::string path = folder.path().string();
  EXPECT_EQ(remove_old_recordings(path, "", all), 12u);
  for (int entries = 0; entries < 3; ++entries) {  // fewer than there are files
    entries_until_error = entries;
    EXPECT_NO_THROW(EXPECT_LT(remove_old_recordings(path, "", all), 12u)) << entries;
    EXPECT_EQ(entries_until_error, -1) << "the error came";
  }
}

}  // namespace
}  // namespace heel
