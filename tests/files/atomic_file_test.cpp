// Files that are replaced in one step: permissions, and what a failure leaves.
#include "files/atomic_file.h"

#include <gmock/gmock.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "support/complaint.h"
#include "support/process.h"
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

TEST(AtomicFile, KeepsThePermissionsOfTheFileItReplaces) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("old"), "before");
  for (const mode_t mode : {0600u, 0644u, 0664u, 0604u}) {
    ASSERT_EQ(chmod(path.c_str(), mode), 0);
    write_file_atomically(path, "content");
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, mode);
    EXPECT_EQ(status.st_gid, getgid());
  }
  EXPECT_EQ(test::read_text(path), "content");
}

// Only root may give a file to a group that it is not in.
TEST(AtomicFile, KeepsTheGroupOrGivesAnotherOneNoMoreThanEverybodyHas) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root";
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("old"), "before");
  constexpr gid_t kGroup = 12345, kOther = 54321;
  ASSERT_EQ(chown(path.c_str(), 0, kGroup), 0);
  ASSERT_EQ(chmod(path.c_str(), 0664), 0);
  write_file_atomically(path, "by root");
  struct stat status {};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_gid, kGroup);
  EXPECT_EQ(status.st_mode & 0777u, 0664u);

  ASSERT_EQ(chown(folder.path().c_str(), kOther, kOther), 0);
  test::Process another([&] {
    if (setgroups(0, nullptr) != 0 || setgid(kOther) != 0 || setuid(kOther) != 0) _exit(1);
    write_file_atomically(path, "by another");
  });
  ASSERT_TRUE(test::eventually([&] { return test::read_text(path) == "by another"; }));
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_gid, kOther);
  EXPECT_EQ(status.st_mode & 0777u, 0644u);
}

TEST(AtomicFile, AFailureLeavesNoTemporaryFile) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "taken" / "by a folder");
  EXPECT_THAT(test::complaint_of([&] { write_file_atomically(folder.file("taken"), "content"); }),
              HasSubstr(folder.file("taken") + ": cannot write"));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("taken"));
}

TEST(AtomicFile, ALinkStaysOneAndWhatItLinksToIsWritten) {
  const test::TemporaryFolder folder;
  namespace fs = std::filesystem;
  test::write_text(folder.file("there"), "before");
  fs::create_symlink("there", folder.file("link"));
  write_file_atomically(folder.file("link"), "after");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(test::read_text(folder.file("there")), "after");
  fs::create_symlink("not yet", folder.file("dangling"));
  write_file_atomically(folder.file("dangling"), "new");
  EXPECT_TRUE(fs::is_symlink(folder.file("dangling")));
  EXPECT_EQ(test::read_text(folder.file("not yet")), "new");
}

TEST(AtomicFile, WhatIsNoFileIsNotReplaced) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(test::complaint_of([&] { write_file_atomically(folder.file("pipe"), "x"); }),
            folder.file("pipe") + ": cannot write: it is a device or pipe (expected the name of a file)");
  EXPECT_TRUE(std::filesystem::is_fifo(folder.file("pipe")));
  EXPECT_EQ(test::complaint_of([&] { write_file_atomically(folder.path().string(), "x"); }),
            folder.path().string() + ": cannot write: it is a folder (expected the name of a file)");
}

}  // namespace
}  // namespace heel
