#include "replay/vision_replay.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "config/config_load.h"
#include "core/picture_turn.h"
#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "recording/recording_reader.h"
#include "vision/pose/template_selector.h"
#include "vision/template/turned_template.h"

namespace heel {
namespace {

/// What vision begins with, and what it found.
class VisionInputs final : public RecordingVisitor {
 public:
  void on_pose(const PoseEstimate& pose) override { poses.push_back(pose); }
  void on_configuration(const ConfigurationText& text) override {
    if (text.number == 0) configuration = text.text;
  }
  bool wants(std::string_view topic) const override {
    return topic == "/heel/pose" || topic == "/heel/configuration";
  }
  std::vector<PoseEstimate> poses;
  std::string configuration;
};

/// The files that go with a recording, unpacked; removed at the end.
class UnpackedFiles {
 public:
  explicit UnpackedFiles(const std::map<std::string, std::string>& files) {
    std::string name = (std::filesystem::temp_directory_path() / "heel-replay-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot make this folder");
    folder_ = name;
    for (const auto& [file, content] : files) {
      if (file.find('/') != std::string::npos) continue;  // no file of ours
      std::ofstream(path(file), std::ios::binary) << content;
    }
  }
  ~UnpackedFiles() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  UnpackedFiles(const UnpackedFiles&) = delete;
  UnpackedFiles& operator=(const UnpackedFiles&) = delete;

  std::string path(const std::string& file) const { return folder_ + '/' + file; }

 private:
  std::string folder_;
};

std::vector<ShirtTemplate> recorded_templates(const Config& config, const UnpackedFiles& files) {
  TargetConfig target = config.target;
  target.shirt = files.path("shirt-0.heel");
  for (std::size_t i = 0; i < target.more_shirts.size(); ++i)
    target.more_shirts[i] = files.path(fmt::format("shirt-{}.heel", i + 1));
  return read_templates(target);
}

class VisionReplayer final : public RecordingVisitor {
 public:
  VisionReplayer(const VisionInputs& inputs, TemplateSelector& vision) : inputs_(inputs), vision_(vision) {}

  void on_picture(const RecordedPicture& picture) override;
  bool wants(std::string_view topic) const override { return topic == "/camera"; }

  VisionReplayResult result;

 private:
  const VisionInputs& inputs_;
  TemplateSelector& vision_;
};

/// Vision keeps what it saw before: each frame needs all frames before it, as they were.
void VisionReplayer::on_picture(const RecordedPicture& picture) {
  if (!result.ended.empty() || result.frames == inputs_.poses.size()) return;
  const PoseEstimate& recorded = inputs_.poses[result.frames];
  if (picture.format != "png") {
    result.ended =
        "vision is not replayed: the pictures are JPEG (telemetry.pictures = \"lossless\" repeats it)";
    return;
  }
  if (picture.header.sequence != recorded.frame_sequence ||
      picture.header.t_capture_ns != recorded.t_capture_ns) {
    result.ended = fmt::format("vision is replayed up to frame {}: its picture is not in the recording",
                               recorded.frame_sequence);
    return;
  }
  const std::vector<std::uint8_t> pixels = picture_pixels(picture);
  PoseEstimate replayed = vision_.estimate({picture.header, pixels.data(), picture.header.width_px});
  replayed.t_done_ns = recorded.t_done_ns;
  ++result.frames;
  if (same_flow(recorded, replayed)) {
    ++result.same;
    return;
  }
  const std::vector<FieldDifference> fields = flow_differences(recorded, replayed);
  for (const FieldDifference& field : fields) ++result.quantities[field.name];
  if (result.first) return;
  result.first = recorded;
  result.fields = fields;
}

}  // namespace

VisionReplayResult replay_vision(const std::string& recording) {
  VisionInputs inputs;
  const RecordingReport report = read_recording(recording, inputs);
  if (!report.attachments.contains("camera.yaml") || inputs.poses.empty()) {
    VisionReplayResult none;
    none.ended = "vision is not replayed: the recording has no pictures";
    return none;
  }
  const Config config = parse_config(inputs.configuration, recording + ": configuration 0").config;
  const UnpackedFiles files(report.attachments);
  const CameraModel camera = read_camera_model(files.path("camera.yaml"));
  const PictureTurn turn = picture_turn(config.camera.rotate, config.camera.mirror);  // as the pictures were
  const std::vector<ShirtTemplate> shirts =
      templates_for_turned(recorded_templates(config, files), camera, turn).shirts;
  TemplateSelector vision(shirts, turned_camera(camera, turn), config.vision);
  VisionReplayer replayer(inputs, vision);
  read_recording(recording, replayer);
  if (replayer.result.frames == 0 && replayer.result.ended.empty())
    replayer.result.ended = "vision is not replayed: the recording has no pictures";
  return std::move(replayer.result);
}

}  // namespace heel
