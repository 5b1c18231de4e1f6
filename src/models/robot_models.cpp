#include "models/robot_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "heel/error.h"
#include "models/embedded_files.h"
#include "models/robot_model_file.h"

namespace heel {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::vector<RobotModel> read_all() {
  std::vector<RobotModel> models;
  for (const EmbeddedFile& file : embedded_robot_files())
    models.push_back(parse_robot_model(file.text, std::string(file.name)));
  return models;
}

}  // namespace

std::span<const RobotModel> robot_models() {
  static const std::vector<RobotModel> models = read_all();
  return models;
}

std::optional<std::size_t> index_of_model(std::string_view subclass) {
  const std::span<const RobotModel> models = robot_models();
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (same_name(models[i].subclass, subclass)) return i;
  }
  return std::nullopt;
}

const RobotModel& robot_model(std::string_view subclass) {
  const auto index = index_of_model(subclass);
  if (!index)
    throw Error(
        fmt::format("'{}' is not a robot that heel knows (expected {})", subclass, robot_model_names()));
  return robot_models()[*index];
}

std::string robot_model_names() {
  std::string names;
  for (const RobotModel& model : robot_models()) names += (names.empty() ? "" : ", ") + model.subclass;
  return names;
}

}  // namespace heel
