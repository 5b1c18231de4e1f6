#include "files/folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

TEST(MakeFolder, MakesThoseAboveItToo) {
  const test::TemporaryFolder folder;
  const std::string deep = folder.file("a/b");
  make_folder(deep);
  EXPECT_TRUE(std::filesystem::is_directory(deep));
  EXPECT_NO_THROW(make_folder(deep)) << "it is there already";
}

TEST(MakeFolder, SaysWhyAFolderCannotBeMade) {
  const test::TemporaryFolder folder;
  const std::string file = test::write_text(folder.file("file"), "");
  for (const std::string& name : {file, file + "/below"}) {
    EXPECT_EQ(test::complaint_of([&] { make_folder(name); }),
              name + ": cannot make this folder: Not a directory (expected a folder, not a file)");
  }
  const std::string longer = folder.file(std::string(300, 'x'));
  EXPECT_EQ(
      test::complaint_of([&] { make_folder(longer); }),
      longer + ": cannot make this folder: File name too long (expected a place where a folder can be made)");
}

TEST(MakeFolder, RefusesAFolderThatCannotBeWritten) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  const std::string closed = folder.file("closed");
  fs::create_directory(closed);
  fs::permissions(folder.path(), fs::perms{0755});
  fs::permissions(closed, fs::perms{0555});
  // Permissions do not hold for root, who becomes another user for this call.
  const bool root = geteuid() == 0;
  ASSERT_EQ(root ? seteuid(65534) : 0, 0);
  const std::string complaint = test::complaint_of([&] { make_folder(closed); });
  ASSERT_EQ(root ? seteuid(0) : 0, 0);
  fs::permissions(closed, fs::perms{0755});
  EXPECT_EQ(
      complaint,
      closed + ": cannot write into this folder: Permission denied (expected one that this user can write)");
}

}  // namespace
}  // namespace heel
