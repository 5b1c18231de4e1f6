#include "files/camera_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "files/atomic_file.h"
#include "files/byte_view.h"
#include "files/other_file_kind.h"
#include "files/picture_kind.h"

namespace heel {
namespace {

constexpr std::size_t kMaxCameraInfoBytes = 1 << 20;
constexpr int kMaxSensorSide_px = 32768;
constexpr std::size_t kMostNodes = 10000;
constexpr int kMostLevels = 50;  // of maps or lists in each other: one that holds itself has no end
/// By which the camera files of other programs are known.
constexpr std::array<std::pair<const char*, const char*>, 6> kForeignKeys{{
    {"cam0", "a camera chain of kalibr"},
    {"Camera.fx", "settings of ORB-SLAM"},
    {"Camera1.fx", "settings of ORB-SLAM"},
    {"projection_parameters", "a camera file of VINS or camodocal"},
    {"value0", "a calibration of basalt"},
    {"mtx", "a camera matrix without the size of the picture"},
}};
constexpr std::size_t kBeginningBytes = 64;  // of a file say what it is

/// OpenCV begins its files with "%YAML:1.0", which is not a YAML directive. The line is emptied, not removed,
/// so that line numbers in messages stay right.
std::string without_opencv_directive(std::string text) {
  if (text.starts_with("%YAML:")) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    text.replace(0, end, "");
  }
  return text;
}

/// What a file is that was given in place of a camera file; empty for text that may be one.
std::string mistaken_file(ByteView head) {
  for (const std::string& picture : {unreadable_picture_kind(head), readable_picture_kind(head)})
    if (!picture.empty()) return picture + " picture";
  if (const std::string video = video_kind(head); !video.empty()) return video + " video";
  if (begins_with(head, "heel-template ")) return "a template of a shirt";
  return other_file_kind(head);
}

/// Before the whole of it is read: pictures and videos may be too large for that.
void refuse_mistaken_file(const std::string& path) {
  require_regular_file(path);
  std::array<char, kBeginningBytes> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file) return;  // read_whole_file says why
  file.read(head.data(), head.size());
  const std::string kind = mistaken_file(
      {reinterpret_cast<const std::uint8_t*>(head.data()), static_cast<std::size_t>(file.gcount())});
  if (!kind.empty())
    throw Error(
        fmt::format("{}: {} (expected a camera file: YAML with image_width, image_height, camera_matrix, "
                    "distortion_coefficients; were two files exchanged?)",
                    path, kind));
}

YAML::Node parse_camera_file(const std::string& path) {
  refuse_mistaken_file(path);
  const std::string text = read_whole_file(path, kMaxCameraInfoBytes);
  if (text.starts_with("<?xml")) {
    throw Error(path + ": this is XML (expected camera_info YAML, or OpenCV FileStorage in YAML or JSON)");
  }
  if (text.starts_with("# oST")) {
    throw Error(path +
                ": parameters in ROS's old form (expected camera_info YAML; the calibrator writes ost.yaml "
                "beside ost.txt)");
  }
  YAML::Node root;
  try {
    root = YAML::Load(without_opencv_directive(text));
  } catch (const YAML::Exception& error) {
    std::string why = error.msg;  // which may quote a byte of the file
    std::replace_if(
        why.begin(), why.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    if (text.find("\n\t") != std::string::npos) why += "; lines begin with tabs, which YAML does not take";
    throw Error(fmt::format("{}:{}:{}: not YAML: {} (expected a camera_info file)", path, error.mark.line + 1,
                            error.mark.column + 1, why));
  }
  if (!root.IsMap()) {
    throw Error(path +
                ": not a camera file (expected YAML with image_width, image_height, camera_matrix, "
                "distortion_coefficients)");
  }
  return root;
}

const std::vector<std::string> kMatrix{"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"};
const std::vector<std::string> kFx{"fx", "Fx"}, kFy{"fy", "Fy"}, kPpx{"ppx", "PPX", "cx"},
    kPpy{"ppy", "PPY", "cy"};

/// Counts nodes, because aliases make a few lines as large as they like, or endless.
class NodeCount {
 public:
  explicit NodeCount(const std::string& path) : path_(path) {}
  void add_one(int level) {
    if (++nodes_ > kMostNodes || level > kMostLevels)
      throw Error(fmt::format("{}: more than {} values, by aliases (expected a camera_info file)", path_,
                              kMostNodes));
  }

 private:
  const std::string& path_;
  std::size_t nodes_ = 0;
};

/// YAML takes the first of two values and says nothing.
void refuse_duplicates(const YAML::Node& map, const std::string& path, NodeCount& nodes, int level = 0) {
  std::set<std::string> keys;
  for (const auto& entry : map) {
    nodes.add_one(level);
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (!keys.insert(key).second) {
      throw Error(
          fmt::format("{}:{}: {}: given twice (expected once)", path, entry.first.Mark().line + 1, key));
    }
    if (entry.second.IsMap()) refuse_duplicates(entry.second, path, nodes, level + 1);
  }
}

/// Also one that is written as 640.0, as programs do that keep all numbers as floating-point numbers. None
/// for another, and one beyond 32 bits.
std::optional<long> whole_number(const YAML::Node& node) {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) return std::nullopt;
  if (!(std::abs(value) <= std::numeric_limits<std::int32_t>::max()) || value != std::trunc(value))
    return std::nullopt;
  return static_cast<long>(value);
}

/// Adds the numbers of a node: one, several between spaces, or a list of these.
void add_numbers(const YAML::Node& node, const std::string& path, const std::string& key,
                 std::vector<double>& values, NodeCount& nodes, int level = 0) {
  nodes.add_one(level);
  if (node.IsSequence()) {
    for (const YAML::Node& part : node) add_numbers(part, path, key, values, nodes, level + 1);
    return;
  }
  std::istringstream words(node.IsScalar() ? node.Scalar() : "?");
  for (std::string word; words >> word;) {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(YAML::Node(word), value) ||
        !std::isfinite(value)) {
      throw camera_key_error(path, fmt::format("{}[{}]", key, values.size()),
                             node.IsScalar() ? "'" + word + "'" : "not a number", "a finite number");
    }
    values.push_back(value);
  }
}

}  // namespace

Error camera_key_error(const std::string& path, const std::string& key, const std::string& found,
                       const std::string& expected) {
  return Error(fmt::format("{}: {}: {} (expected {})", path, key, found, expected));
}

CameraYaml::CameraYaml(const std::string& path) : path_(path), root_(parse_camera_file(path)) {
  NodeCount nodes(path);
  refuse_duplicates(root_, path, nodes);
  for (const auto& [key, kind] : kForeignKeys) {
    if (!root_[key]) continue;
    throw Error(
        fmt::format("{}: {}: {} (expected camera_info YAML: image_width, image_height, camera_matrix, "
                    "distortion_model, distortion_coefficients)",
                    path, key, kind));
  }
}

std::string CameraYaml::key_of(const std::vector<std::string>& spellings) const {
  for (const std::string& key : spellings)
    if (root_[key]) return key;
  return spellings.front();
}

std::string CameraYaml::width_key() const {
  return key_of({"image_width", "image_Width", "width", "Width"});
}

std::string CameraYaml::height_key() const {
  return key_of({"image_height", "image_Height", "height", "Height"});
}

std::string CameraYaml::matrix_key() const {
  return has_single_values() ? "fx, fy, ppx, ppy" : key_of(kMatrix);
}

std::string CameraYaml::distortion_key() const {
  return key_of(
      {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D", "d", "coeffs", "Coeffs"});
}

bool CameraYaml::has_single_values() const {
  return !root_[key_of(kMatrix)] && (root_[key_of(kFx)] || root_[key_of(kFy)]);
}

std::vector<double> CameraYaml::matrix_of_single_values() const {
  const auto value = [&](const std::vector<std::string>& spellings) {
    const std::string key = key_of(spellings);
    const std::vector<double> values = matrix(key, "a number of px");
    if (values.size() != 1)
      throw camera_key_error(path_, key, fmt::format("{} numbers", values.size()), "one, px");
    return values.front();
  };
  return {value(kFx), 0.0, value(kPpx), 0.0, value(kFy), value(kPpy), 0.0, 0.0, 1.0};
}

std::string CameraYaml::model() const {
  if (!has_single_values()) return word("distortion_model");
  std::string name = word(key_of({"distortion_model", "model", "Distortion"}));
  if (const std::size_t at = name.find("distortion"); at != std::string::npos)
    name.erase(0, at + std::string_view("distortion.").size());  // "rs.distortion.", "RS2_DISTORTION_"
  // The structure's numbers.
  constexpr std::array kByNumber{"none",    "modified_brown_conrady", "inverse_brown_conrady",
                                 "f_theta", "brown_conrady",          "kannala_brandt4"};
  for (std::size_t i = 0; i < kByNumber.size(); ++i)
    if (name == std::to_string(i)) return kByNumber[i];
  return name;
}

YAML::Node CameraYaml::required(const std::string& key, const std::string& expected) const {
  const YAML::Node node = root_[key];
  if (!node || node.IsNull()) throw camera_key_error(path_, key, "missing", expected);
  return node;
}

int CameraYaml::side_px(const std::string& key) const {
  const std::string expected = fmt::format("whole number of pixels, 1…{}", kMaxSensorSide_px);
  const YAML::Node node = required(key, expected);
  const std::optional<long> side_px = whole_number(node);
  if (!side_px || *side_px < 1 || *side_px > kMaxSensorSide_px) {
    throw camera_key_error(path_, key, node.IsScalar() ? "'" + node.Scalar() + "'" : "not a number",
                           expected);
  }
  return static_cast<int>(*side_px);
}

std::vector<double> CameraYaml::matrix(const std::string& key, const std::string& expected) const {
  const YAML::Node matrix = required(key, expected);
  const bool is_map = matrix.IsMap();
  const YAML::Node data = is_map ? matrix["data"] : matrix;
  const std::string data_key = is_map ? key + ".data" : key;
  if (!data || data.IsNull() || data.IsMap())
    throw camera_key_error(path_, data_key, "missing or not a list", expected);

  std::vector<double> values;
  NodeCount nodes(path_);
  add_numbers(data, path_, data_key, values, nodes);
  if (is_map && matrix["rows"] && matrix["cols"]) {
    const std::optional<long> rows = whole_number(matrix["rows"]), cols = whole_number(matrix["cols"]);
    if (!rows || !cols || *rows * *cols != static_cast<long>(values.size()))
      throw camera_key_error(path_, key, fmt::format("{} numbers", values.size()), "rows × cols of them");
  }
  return values;
}

bool CameraYaml::is_null(const std::string& key) const {
  const YAML::Node node = root_[key];
  if (!node) return false;
  return node.IsNull() || (node.IsMap() && node["data"] && node["data"].IsNull());
}

std::string CameraYaml::word(const std::string& key) const {
  const YAML::Node node = root_[key];
  if (!node || node.IsNull()) return "";
  if (!node.IsScalar()) throw camera_key_error(path_, key, "not a word", "plumb_bob");
  std::string word = node.Scalar();
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) {
    return c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return word;
}

long CameraYaml::count(const std::string& key, const std::string& sub_key) const {
  YAML::Node node = root_[key];
  if (node && node.IsMap() && !sub_key.empty()) node.reset(node[sub_key]);
  return node ? whole_number(node).value_or(0) : 0;
}

}  // namespace heel
