// Files that are replaced in one step: permissions, and what a failure leaves.
#include "files/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <set>

#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

TEST(AtomicFile, HasThePermissionsOfAnOrdinaryNewFile) {
  const test::TemporaryFolder folder;
  const mode_t before = umask(0027);
  write_file_atomically(folder.file("new"), "content");
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat(folder.file("new").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
  EXPECT_EQ(test::read_text(folder.file("new")), "content");
}

TEST(AtomicFile, AFailureLeavesNoTemporaryFile) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "taken" / "by a folder");
  EXPECT_THAT(test::complaint_of([&] { write_file_atomically(folder.file("taken"), "content"); }),
              HasSubstr(folder.file("taken") + ": cannot write"));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("taken"));
}

}  // namespace
}  // namespace heel
