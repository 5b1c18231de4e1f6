#include "files/template_header.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"

namespace heel {
namespace {

using Json = nlohmann::ordered_json;

Json further_json(const FurtherView& further, std::size_t image_bytes) {
  const Eigen::Matrix3d R_transposed = further.R_further_from_ref.transpose();  // so that it is row-major
  return {{"image_bytes", image_bytes},
          {"R_further_from_ref", std::vector<double>(R_transposed.data(), R_transposed.data() + 9)},
          {"t_over_d", std::vector<double>(further.t_over_d.data(), further.t_over_d.data() + 3)}};
}

template <std::size_t N>
std::array<double, N> numbers(const Json& further, const char* key, const std::string& path) {
  const Json& list = further.at(key);
  if (!list.is_array() || list.size() != N)
    throw Error(fmt::format("{}: further_views: {}: expected {} numbers", path, key, N));
  return list.get<std::array<double, N>>();
}

/// The poses of the further views, without their pictures, and the bytes of each picture.
std::vector<std::size_t> parse_further(const Json& header, const std::string& path, ShirtTemplate& shirt) {
  std::vector<std::size_t> image_bytes;
  if (!header.contains("further_views")) return image_bytes;
  for (const Json& one : header.at("further_views")) {
    const auto R = numbers<9>(one, "R_further_from_ref", path);
    const auto t = numbers<3>(one, "t_over_d", path);
    FurtherView& further = shirt.further_views.emplace_back();
    further.R_further_from_ref = Eigen::Map<const Eigen::Matrix3d>(R.data()).transpose();
    further.t_over_d = Eigen::Map<const Eigen::Vector3d>(t.data());
    image_bytes.push_back(one.at("image_bytes").get<std::size_t>());
  }
  return image_bytes;
}

/// Of another lens than plumb_bob, which has no key of its own.
void read_lens(const Json& camera, const std::string& path, CameraModel& model) {
  if (!camera.contains("lens")) return;
  const auto name = camera.at("lens").get<std::string>();
  for (const LensModel lens : {LensModel::Rational, LensModel::Fisheye}) {
    if (name == lens_model_name(lens)) model.lens = lens;
  }
  if (model.lens == LensModel::PlumbBob)
    throw Error(
        fmt::format("{}: camera: lens: '{}' (expected rational_polynomial or equidistant)", path, name));
  camera.at("k4").get_to(model.k4);
  camera.at("k5").get_to(model.k5);
  camera.at("k6").get_to(model.k6);
}

}  // namespace

std::string template_header(const ShirtTemplate& shirt, const std::vector<std::size_t>& further_bytes) {
  const CameraModel& c = shirt.camera;
  const Region& r = shirt.roi;
  Json header = {
      {"region", {{"x_px", r.x_px}, {"y_px", r.y_px}, {"width_px", r.width_px}, {"height_px", r.height_px}}},
      {"distance_m", shirt.distance_m},
      {"yaw_rad", shirt.yaw_rad},
      {"camera",
       {{"width_px", c.width_px},
        {"height_px", c.height_px},
        {"fx", c.fx},
        {"fy", c.fy},
        {"cx", c.cx},
        {"cy", c.cy},
        {"k1", c.k1},
        {"k2", c.k2},
        {"p1", c.p1},
        {"p2", c.p2},
        {"k3", c.k3}}},
      {"settings", {{"oriented", shirt.oriented}, {"max_features", shirt.max_features}}}};
  if (shirt.upright) header["turned"] = true;  // by 0°, too; by this key earlier programs leave it as it is
  if (c.lens != LensModel::PlumbBob) {
    Json& camera = header["camera"];
    camera["lens"] = lens_model_name(c.lens);
    camera["k4"] = c.k4;
    camera["k5"] = c.k5;
    camera["k6"] = c.k6;
  }
  for (std::size_t i = 0; i < further_bytes.size(); ++i)
    header["further_views"].push_back(further_json(shirt.further_views[i], further_bytes[i]));
  return header.dump(2) + "\n";
}

std::vector<std::size_t> parse_template_header(std::string_view text, const std::string& path,
                                               ShirtTemplate& shirt) {
  try {
    const Json header = Json::parse(text);
    const Json& region = header.at("region");
    region.at("x_px").get_to(shirt.roi.x_px);
    region.at("y_px").get_to(shirt.roi.y_px);
    region.at("width_px").get_to(shirt.roi.width_px);
    region.at("height_px").get_to(shirt.roi.height_px);
    header.at("distance_m").get_to(shirt.distance_m);
    shirt.yaw_rad = header.value("yaw_rad", 0.0);  // older files have none
    shirt.upright = header.value("turned", false);
    const Json& camera = header.at("camera");
    camera.at("width_px").get_to(shirt.camera.width_px);
    camera.at("height_px").get_to(shirt.camera.height_px);
    camera.at("fx").get_to(shirt.camera.fx);
    camera.at("fy").get_to(shirt.camera.fy);
    camera.at("cx").get_to(shirt.camera.cx);
    camera.at("cy").get_to(shirt.camera.cy);
    camera.at("k1").get_to(shirt.camera.k1);
    camera.at("k2").get_to(shirt.camera.k2);
    camera.at("p1").get_to(shirt.camera.p1);
    camera.at("p2").get_to(shirt.camera.p2);
    camera.at("k3").get_to(shirt.camera.k3);
    read_lens(camera, path, shirt.camera);
    header.at("settings").at("oriented").get_to(shirt.oriented);
    header.at("settings").at("max_features").get_to(shirt.max_features);
    return parse_further(header, path, shirt);
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: header: {} (expected the header of format version {})", path, error.what(),
                            kTemplateFormatVersion));
  }
}

}  // namespace heel
