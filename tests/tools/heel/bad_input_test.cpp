// Bad input to heel's commands is refused in one line that names what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "tools/heel/printed_shirt.h"
#include "tools/heel/refusals.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::expect_refused;
using test::Outcome;
using test::read_text;
using test::run_heel;
using test::TemporaryFolder;
using test::write_text;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Good files, and one bad file of each kind.
class Files {
 public:
  Files() {
    const cv::Mat image = test::printed_plane();
    cv::imwrite(at("back.png"), image);
    cv::imwrite(at("small.png"), image(cv::Rect(0, 0, 320, 240)));
    write_camera_model(test::shirt_camera(), at("camera.yaml"));
    std::string other = read_text(at("camera.yaml"));
    other.replace(other.find("plumb_bob"), 9, "omnidirectional");
    write_text(at("mirror.yaml"), other);
    write_text(at("words.txt"), "neither image nor template\n");
    const std::string png = read_text(at("back.png"));
    write_text(at("cut.png"), std::string_view(png).substr(0, png.size() / 2));
    std::filesystem::create_directory(at("empty"));
    const Outcome taught = run_heel(teach({}));
    EXPECT_EQ(taught.status, 0) << taught.err;
    const std::string shirt = read_text(at("shirt.heel"));
    write_text(at("cut.heel"), std::string_view(shirt).substr(0, shirt.size() - 100));
    std::string flipped = shirt;
    flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 4);
    write_text(at("flipped.heel"), flipped);
  }

  std::string at(const std::string& name) const { return folder_.file(name); }

  /// A good command line with some options replaced or added.
  std::vector<std::string> teach(const std::vector<std::string>& changes) const {
    return changed({"teach", "--image", at("back.png"), "--roi", test::kRoi, "--distance", "1.5",
                    "--camera-info", at("camera.yaml"), "-o", at("shirt.heel")},
                   changes);
  }
  std::vector<std::string> pose(const std::vector<std::string>& changes) const {
    return changed({"pose", "--template", at("shirt.heel"), "--camera-info", at("camera.yaml"), "--json"},
                   changes);
  }
  std::vector<std::string> bench(const std::vector<std::string>& changes) const {
    return changed({"bench", "vision", "--json"}, changes);
  }
  /// Adds the options that pictures need.
  std::vector<std::string> own(std::vector<std::string> more) const {
    more.insert(more.end(), {"--template", at("shirt.heel"), "--camera-info", at("camera.yaml")});
    return more;
  }

 private:
  static std::vector<std::string> changed(std::vector<std::string> good,
                                          const std::vector<std::string>& changes) {
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const auto option = std::find(good.begin(), good.end(), changes[i]);
      if (option != good.end() && i + 1 < changes.size()) {
        *(option + 1) = changes[++i];
      } else {
        good.push_back(changes[i]);
      }
    }
    return good;
  }

  TemporaryFolder folder_;
};

TEST(BadInput, OfUnknownCommandsAndOptionsIsRefused) {
  const Files f;
  const std::string image = f.at("back.png");
  expect_refused({
      {{}, "heel: ", "subcommand"},
      {{"taech"}, "heel: ", "no command 'taech' (expected one of calibrate, teach, pose"},
      {{"--frobnicate"}, "heel: ", "--help"},
      {{"teach"}, "heel teach: ", "is required"},
      {f.teach({"--colour"}), "heel teach: ", "--colour"},
      {f.pose({image, "--frobnicate"}), "heel pose: ", "--frobnicate"},
      {f.pose({}), "heel pose: ", "inputs"},
      {f.pose({""}), "heel pose: ", "inputs: an empty name (expected a file"},
      {f.pose({image, "--template", ""}), "heel pose: ", "--template: an empty name (expected a file"},
      {f.teach({"-o", ""}), "heel teach: ", "--output: an empty name (expected a file"},
      {f.bench({""}), "heel bench vision: ", "inputs: an empty name (expected a file"},
  });
}

TEST(BadInput, OfTeachIsRefused) {
  const Files f;
  const std::string image = f.at("back.png");
  expect_refused({
      {f.teach({"--image", f.at("absent.png")}), "heel teach: ", "absent.png: cannot read: No such file"},
      {f.teach({"--image", f.at("words.txt")}), "heel teach: ", "words.txt: not an image or video"},
      {f.teach({"--image", f.at("empty")}), "heel teach: ", "empty: no image in this folder"},
      {f.teach({"--image", f.at("small.png")}),
       "heel teach: ", "small.png: 320x240 pixels (expected 640x480"},
      {f.teach({"--camera", "file:" + image}), "heel teach: ", "either --image or --camera"},
      {f.teach({"--frame", "1"}), "heel teach: ", "--frame 1"},
      {f.teach({"--frame", "-1"}), "heel teach: ", "--frame: '-1' (expected a frame number, 0 or more)"},
      {f.teach({"--roi", "1,2,3"}), "heel teach: ", "--roi: '1,2,3' (expected X,Y,W,H: left, top, width"},
      {f.teach({"--roi", "1,2,3,x"}), "heel teach: ", "--roi: '1,2,3,x' (expected X,Y,W,H: left, top, width"},
      {f.teach({"--roi", "1.5,2,3,4"}), "heel teach: ", "in whole pixels, e.g. 250,120,140,180)"},
      {f.teach({"--roi", "160x200+240+140"}), "heel teach: ", "; WxH+X+Y is 240,140,160,200 here)"},
      {f.teach({"--roi", "500,140,620,340"}), "heel teach: ", "; between two corners it is 500,140,120,200)"},
      {f.teach({"--roi", "500,140,160,200"}),
       "heel teach: ", "--roi: '500,140,160,200' (expected X,Y,W,H inside the 640x480"},
      {f.teach({"--roi", "-5,140,160,200"}), "heel teach: ", "--roi"},
      {f.teach({"--roi", "240,140,0,200"}), "heel teach: ", "--roi: '240,140,0,200'"},
      {f.teach({"--roi", "240,140,2147483647,200"}), "heel teach: ", "--roi"},
      {f.teach({"--distance", "0"}), "heel teach: ", "--distance"},
      {f.teach({"--distance", "1500"}), "heel teach: ", "(expected metres, 0.1…100; 1500 mm are 1.5)"},
      {f.teach({"--distance", "near"}), "heel teach: ", "'near' (expected metres, 0.1…100)"},
      {f.teach({"--distance", "nan"}), "heel teach: ", "--distance"},
      {f.teach({"--camera-info", f.at("absent.yaml")}), "heel teach: ", "absent.yaml: cannot read"},
      {f.teach({"--camera-info", f.at("words.txt")}), "heel teach: ", "words.txt: not a camera file"},
      {f.teach({"--camera-info", f.at("mirror.yaml")}),
       "heel teach: ", "mirror.yaml: distortion_model: 'omnidirectional'"},
      {f.teach({"-o", f.at("no/such/folder.heel")}), "heel teach: ", "no/such/folder.heel: cannot write"},
      {f.teach({"--picture", f.at("verdict.xyz")}), "heel teach: ", "verdict.xyz: unknown kind of picture"},
      {f.teach({"--max", "0"}), "heel teach: ", "--max"},
  });
}

TEST(BadInput, OfPoseIsRefused) {
  const Files f;
  const std::string image = f.at("back.png");
  expect_refused({
      {f.pose({f.at("absent.mp4")}), "heel pose: ", "absent.mp4: cannot read: No such file"},
      {f.pose({f.at("words.txt")}), "heel pose: ", "words.txt: not an image or video"},
      {f.pose({f.at("cut.png")}), "heel pose: ", "cut.png: not a whole image"},
      {f.pose({f.at("empty")}), "heel pose: ", "empty: no image in this folder"},
      {f.pose({f.at("small.png")}), "heel pose: ", "small.png: 320x240 pixels (expected 640x480 as in"},
      {f.pose({image, "--template", f.at("absent.heel")}), "heel pose: ", "absent.heel: cannot read"},
      {f.pose({image, "--template", f.at("words.txt")}), "heel pose: ", "words.txt: not a template"},
      {f.pose({image, "--template", f.at("cut.heel")}), "heel pose: ", "cut.heel: truncated"},
      {f.pose({image, "--template", f.at("flipped.heel")}), "heel pose: ", "flipped.heel: checksum"},
      {f.pose({image, "--camera-info", f.at("mirror.yaml")}), "heel pose: ", "mirror.yaml: distortion_model"},
      {f.pose({image, "--first", "-1"}), "heel pose: ", "--first: '-1' (expected a frame number, 0 or more)"},
      {f.pose({image, "--last", "-1"}), "heel pose: ", "--last: '-1' (expected a frame number, 0 or more)"},
      {f.pose({image, "--first", "3"}),
       "heel pose: ", "--first 3: " + image + " ends after 1 frame (expected a frame number below 1)"},
      {f.pose({image, "--first", "1"}), "heel pose: ", "--first 1: " + image + " ends after 1 frame"},
      {f.pose({image, f.at("small.png"), "--first", "2"}),
       "heel pose: ", "--first 2: the 2 inputs end after 2 frames"},
      {f.pose({image, "--first", "3", "--last", "2"}), "heel pose: ", "--last 2"},
      {f.pose({image, "--octaves", "9"}), "heel pose: ", "--octaves"},
      {{"pose", image, "--template", f.at("shirt.heel")},
       "heel pose: ",
       "expected --config, or both --template and --camera-info"},
      {f.pose({image, "--config", f.at("absent.toml")}), "heel pose: ", "absent.toml"},
      {f.pose({image, "--rate", "0"}), "heel pose: ", "--rate"},
      {f.pose({image, "--picture-dir", f.at("words.txt") + "/x"}), "heel pose: ",
       "words.txt/x: cannot make this folder: Not a directory (expected a folder, not a file)"},
  });
}

TEST(BadInput, OfCalibrateIsRefused) {
  const Files f;
  const std::string image = f.at("back.png");
  expect_refused({
      {{"calibrate", image, "--board", "9x6", "--square", "0", "-o", f.at("c.yaml")},
       "heel calibrate: ",
       "--square"},
      {{"calibrate", image, "--board", "9x6", "--square", "25", "-o", f.at("c.yaml")},
       "heel calibrate: ",
       "--square: '25' (expected metres, 0.0001…10; 25 mm are 0.025)"},
      {{"calibrate", f.at("words.txt"), "--board", "9x6", "--square", "0.03", "-o", f.at("c.yaml")},
       "heel calibrate: ",
       "words.txt: not an image or video"},
      {{"calibrate", "--board", "9x6", "--square", "0.03", "-o", f.at("c.yaml")},
       "heel calibrate: ",
       "images"},
  });
}

TEST(BadInput, OfBenchVisionIsRefused) {
  const Files f;
  const std::string image = f.at("back.png");
  expect_refused({
      {{"bench"}, "heel bench: ", "subcommand"},
      {f.bench({"--frobnicate"}), "heel bench vision: ", "--frobnicate"},
      {f.bench({"--frames", "0"}), "heel bench vision: ", "--frames"},
      {f.bench({"--size", "640"}), "heel bench vision: ", "--size: '640' (expected WxH"},
      {f.bench({"--size", "640x480x2"}), "heel bench vision: ", "--size: '640x480x2'"},
      {f.bench({"--size", "64x48"}), "heel bench vision: ", "--size: '64x48'"},
      {f.bench({"--simd", "MMX"}), "heel bench vision: ", "--simd: 'MMX' (expected one this processor has"},
      {f.bench({"--picture", f.at("bench.xyz")}),
       "heel bench vision: ", "bench.xyz: unknown kind of picture"},
      {f.bench({"--template", f.at("shirt.heel")}),
       "heel bench vision: ", "--template: given without an input"},
      {f.bench({image}), "heel bench vision: ", "--template: missing"},
      {f.bench({image, "--template", f.at("shirt.heel")}), "heel bench vision: ", "--camera-info: missing"},
      {f.bench(f.own({image, "--size", "640x480"})), "heel bench vision: ", "--size: given with an input"},
      {f.bench(f.own({f.at("absent.mp4")})), "heel bench vision: ", "absent.mp4: cannot read: No such file"},
      {f.bench(f.own({f.at("small.png")})),
       "heel bench vision: ", "small.png: 320x240 pixels (expected 640x480"},
      {f.bench(f.own({image})), "heel bench vision: ", "back.png: frames: 1 (expected 2 or more"},
  });
}

TEST(GoodUsage, HelpAndVersionGoToStandardOutput) {
  const Outcome version = run_heel({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, StartsWith("heel "));
  for (const char* command : {"teach", "pose", "calibrate"}) {
    const Outcome help = run_heel({command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_EQ(help.err, "") << command;
    EXPECT_THAT(help.out, HasSubstr("REQUIRED")) << command;
  }
}

TEST(GoodUsage, AFullDiskAtStandardOutputIsReported) {
  const Outcome outcome = test::run_program({test::built_program("heel"), "--help"}, "/dev/full");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("standard output cannot be written"));
}

}  // namespace
}  // namespace heel
