#include "sim/scene/sent_picture.h"

#include "core/picture_turn.h"
#include "sim/scene/world.h"
#include "vision/template/turned_template.h"

namespace heel::sim {

CameraModel sent_camera(const ScenarioCamera& camera) {
  return turned_camera(camera.model, camera.turn.inverse());
}

ShirtTemplate sent_reference_view(const Scenario& scenario, double distance_m) {
  const ReferenceView view = World(scenario).reference_view(distance_m);
  ShirtTemplate shirt;
  shirt.grey = view.grey;
  shirt.camera = scenario.camera.model;
  shirt.roi = view.roi;
  shirt.distance_m = distance_m;
  if (!scenario.camera.turn.any()) return shirt;
  shirt = turned_template(shirt, scenario.camera.turn.inverse());
  shirt.upright = false;  // the camera sends it like that
  return shirt;
}

}  // namespace heel::sim
