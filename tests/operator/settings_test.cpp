// Set, save and reload of a running daemon's configuration, on files.
#include "operator/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::complaint_of;
using test::read_text;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SettingsOnFile : public ::testing::Test {
 protected:
  SettingsOnFile() { write_text(file_, "# mine\n[gate]\nv_max_m_s = 0.5  # slow\n"); }

  SettingsHooks hooks() {
    return {[](const Config& config) {
              if (config.control.bearing_max_rad > 1.0)
                throw Error("control.bearing_max_rad: more than the camera sees");
            },
            [this](const Config& config) {
              if (refuses_) throw Error("the control loop does not take it");
              applied_.push_back(config.gate.v_max_m_s);
            }};
  }
  static std::vector<ConfigChange> set(Settings& settings, const std::string& key, double value) {
    return settings.set(std::vector<ConfigAssignment>{{key, value}});
  }

  test::TemporaryFolder folder_;
  const std::string file_ = folder_.file("heel.toml");
  std::vector<double> applied_;
  bool refuses_ = false;
};

TEST_F(SettingsOnFile, ASetIsInUseAndNotInTheFile) {
  Settings s(load_config(file_), hooks());
  EXPECT_THAT(set(s, "gate.v_max_m_s", 0.2), ElementsAre(ConfigChange{"gate.v_max_m_s", "0.5", "0.2"}));
  EXPECT_THAT(applied_, ElementsAre(0.2));
  EXPECT_EQ(s.view().in_use.gate.v_max_m_s, 0.2);
  EXPECT_EQ(s.view().file.gate.v_max_m_s, 0.5);
  EXPECT_THAT(read_text(file_), HasSubstr("v_max_m_s = 0.5"));
  EXPECT_THAT(set(s, "gate.v_max_m_s", 0.2), IsEmpty()) << "it has that value already";
  EXPECT_THAT(applied_, ElementsAre(0.2));
  EXPECT_THAT(set(s, "gate.v_max_m_s", 0.5), ElementsAre(ConfigChange{"gate.v_max_m_s", "0.2", "0.5"}))
      << "back to the file's value";
  EXPECT_THAT(complaint_of([&] { set(s, "gate.v_max_m_s", 0.6); }), HasSubstr("expected at most 0.5"));
}

TEST_F(SettingsOnFile, ARefusedSetChangesNothing) {
  Settings s(load_config(file_), hooks());
  EXPECT_THAT(complaint_of([&] { set(s, "control.bearing_max_rad", 1.2); }),
              HasSubstr("more than the camera sees"));
  const std::vector<ConfigAssignment> one_is_wrong = {{"gate.v_max_m_s", 0.1}, {"gate.separation_m", 0.1}};
  EXPECT_THAT(complaint_of([&] { s.set(one_is_wrong); }), HasSubstr("gate.separation_m: 0.1"));
  refuses_ = true;
  EXPECT_THAT(complaint_of([&] { set(s, "gate.v_max_m_s", 0.1); }), HasSubstr("does not take it"));
  EXPECT_EQ(s.view().in_use.gate.v_max_m_s, 0.5);
  EXPECT_THAT(applied_, IsEmpty());
}

TEST_F(SettingsOnFile, ASaveWritesWhatWasSetAndShowsTheDifference) {
  Settings s(load_config(file_), hooks());
  EXPECT_THAT(s.save(), IsEmpty());
  set(s, "gate.v_max_m_s", 0.2);
  set(s, "control.gain_yaw_1_s", 0.25);
  ASSERT_EQ(chmod(file_.c_str(), 0604), 0);
  const std::vector<ConfigChange> changes = s.save();
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[1], (ConfigChange{"gate.v_max_m_s", "0.5", "0.2"}));
  EXPECT_EQ(read_text(file_), "# mine\n[gate]\nv_max_m_s = 0.2  # slow\n\n[control]\ngain_yaw_1_s = 0.25\n");
  struct stat status {};
  ASSERT_EQ(stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0604u) << "the permissions of the file stay";
  EXPECT_THAT(s.save(), IsEmpty());
  EXPECT_THAT(complaint_of([&] { set(s, "gate.v_max_m_s", 0.3); }), HasSubstr("expected at most 0.2"))
      << "the saved value is the file's now";
}

TEST_F(SettingsOnFile, ASaveThroughASymbolicLinkKeepsTheLink) {
  std::filesystem::rename(file_, folder_.file("real.toml"));
  std::filesystem::create_symlink("real.toml", file_);
  Settings s(load_config(file_), hooks());
  set(s, "gate.v_max_m_s", 0.2);
  s.save();
  EXPECT_TRUE(std::filesystem::is_symlink(file_));
  EXPECT_THAT(read_text(folder_.file("real.toml")), HasSubstr("v_max_m_s = 0.2  # slow"));
}

TEST_F(SettingsOnFile, AFileThatOthersEditedIsNotWritten) {
  Settings s(load_config(file_), hooks());
  set(s, "gate.v_max_m_s", 0.2);
  const std::string theirs = "[gate]\nv_max_m_s = 0.4\n";
  write_text(file_, theirs);
  EXPECT_THAT(complaint_of([&] { s.save(); }), HasSubstr("gate.v_max_m_s has changed since heeld read it"));
  EXPECT_EQ(read_text(file_), theirs);
  write_text(file_, "# a comment more\n[gate]\nv_max_m_s = 0.5\n");
  EXPECT_EQ(s.save().size(), 1u) << "no value differs";
  EXPECT_EQ(read_text(file_), "# a comment more\n[gate]\nv_max_m_s = 0.2\n");
}

TEST_F(SettingsOnFile, AFileThatIsGoneIsNamed) {
  Settings s(load_config(file_), hooks());
  set(s, "gate.v_max_m_s", 0.2);
  std::filesystem::remove(file_);
  EXPECT_THAT(complaint_of([&] { s.save(); }), HasSubstr(file_ + ": cannot read"));
}

TEST_F(SettingsOnFile, AtAReloadTheFileWinsAndWhatIsDroppedIsNamed) {
  Settings s(load_config(file_), hooks());
  set(s, "gate.v_max_m_s", 0.2);
  write_text(file_, "[gate]\nv_max_m_s = 0.6\nseparation_m = 1.5\n");
  EXPECT_THAT(s.reload(), ElementsAre(ConfigChange{"gate.v_max_m_s", "0.2", "0.6"}));
  EXPECT_EQ(s.view().in_use.gate.v_max_m_s, 0.6);
  EXPECT_EQ(s.view().in_use.gate.separation_m, 1.5);
  EXPECT_EQ(s.view().file.gate.v_max_m_s, 0.6);
  EXPECT_THAT(s.reload(), IsEmpty());
}

TEST_F(SettingsOnFile, ARefusedReloadKeepsWhatWasSet) {
  Settings s(load_config(file_), hooks());
  set(s, "gate.v_max_m_s", 0.2);
  for (const char* text :
       {"[gate]\nspeed = 1\n", "[vision]\noctaves = 3\n", "[control]\nbearing_max_rad = 1.3\n"}) {
    write_text(file_, text);
    EXPECT_NE(complaint_of([&] { s.reload(); }), "accepted") << text;
    EXPECT_EQ(s.view().in_use.gate.v_max_m_s, 0.2);
    EXPECT_EQ(s.view().file.gate.v_max_m_s, 0.5);
  }
}

}  // namespace
}  // namespace heel
