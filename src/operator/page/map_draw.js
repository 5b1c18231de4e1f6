// The parts of the map, each drawn in the odometry frame: x up, y to the left, as the robot looked when it started.

import { colour } from "./dom.js";
import { knownPlace, odomFromRobot } from "./map_paths.js";

/** @typedef {import("./map_paths.js").Point} Point */
/**
 * @typedef {object} View
 * @property {CanvasRenderingContext2D} context
 * @property {number} width device pixels
 * @property {number} height
 * @property {number} px device pixels of one CSS pixel
 * @property {number} scale device pixels of one metre
 * @property {(point: Point) => [number, number]} place
 */

const kNice_m = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const kSonarHalfBeam_rad = 0.13;
/** A sonar without an echo says 5 m. */
const kNoEcho_m = 4.95;
const kEchoOld_s = 1.0;

/** @param {View} view */
export function drawGrid(view) {
  const { context, px } = view;
  const step_m = kNice_m.find((length_m) => length_m * view.scale >= 34 * px) ?? 100;
  const [ox, oy] = view.place({ x: 0, y: 0 });
  const step = step_m * view.scale;
  context.strokeStyle = colour("grid");
  context.lineWidth = px;
  context.beginPath();
  for (let x = ((ox % step) + step) % step; x < view.width; x += step) {
    context.moveTo(x, 0);
    context.lineTo(x, view.height);
  }
  for (let y = ((oy % step) + step) % step; y < view.height; y += step) {
    context.moveTo(0, y);
    context.lineTo(view.width, y);
  }
  context.stroke();
}

/** @param {View} view */
export function drawScaleBar(view) {
  const { context, px } = view;
  const length_m = [...kNice_m].reverse().find((candidate_m) => candidate_m * view.scale <= 120 * px) ?? kNice_m[0];
  const [x, y] = [12 * px, view.height - 12 * px];
  const end = x + length_m * view.scale;
  context.strokeStyle = context.fillStyle = colour("text");
  context.lineWidth = 2 * px;
  context.beginPath();
  context.moveTo(x, y - 5 * px);
  context.lineTo(x, y);
  context.lineTo(end, y);
  context.lineTo(end, y - 5 * px);
  context.stroke();
  context.font = `${12 * px}px system-ui, sans-serif`;
  context.textAlign = "left";
  context.fillText(length_m < 1 ? `${length_m * 100} cm` : `${length_m} m`, end + 7 * px, y);
}

/**
 * @param {View} view
 * @param {Point[]} points
 * @param {string} stroke
 * @param {number} width
 */
export function drawPath(view, points, stroke, width) {
  const { context, px } = view;
  context.beginPath();
  for (const point of points) context.lineTo(...view.place(point));
  context.lineJoin = context.lineCap = "round";
  context.lineWidth = width * px;
  context.strokeStyle = stroke;
  context.stroke();
}

/**
 * @param {View} view
 * @param {import("./messages.js").Tick} tick
 * @param {import("./messages.js").Info | undefined} info
 */
export function drawRobot(view, tick, info) {
  const { context, px } = view;
  const { robot } = tick;
  const outline = info?.robot_outline ?? { front_m: 0.31, rear_m: 0.31, width_m: 0.5 };
  const halfView_rad = (info?.camera?.hfov_rad ?? 0) / 2;
  if (halfView_rad > 0) {
    const reach_m = 3.5;
    context.beginPath();
    context.moveTo(...view.place(odomFromRobot(robot, 0, 0)));
    for (let i = 0; i <= 16; ++i) {
      const angle = halfView_rad * (i / 8 - 1);
      context.lineTo(...view.place(odomFromRobot(robot, reach_m * Math.cos(angle), reach_m * Math.sin(angle))));
    }
    context.closePath();
    context.globalAlpha = 0.1;
    context.fillStyle = colour("robot");
    context.fill();
    context.globalAlpha = 1;
  }
  const half_m = outline.width_m / 2;
  const corners = [[outline.front_m, half_m], [outline.front_m, -half_m], [-outline.rear_m, -half_m], [-outline.rear_m, half_m]];
  context.beginPath();
  for (const [x, y] of corners) context.lineTo(...view.place(odomFromRobot(robot, x, y)));
  context.closePath();
  context.fillStyle = colour("robot");
  context.globalAlpha = 0.28;
  context.fill();
  context.globalAlpha = 1;
  context.lineWidth = 2 * px;
  context.strokeStyle = colour("robot");
  context.stroke();
  // The heading: a triangle inside the front edge.
  context.beginPath();
  context.moveTo(...view.place(odomFromRobot(robot, outline.front_m * 0.9, 0)));
  context.lineTo(...view.place(odomFromRobot(robot, 0, half_m * 0.55)));
  context.lineTo(...view.place(odomFromRobot(robot, 0, -half_m * 0.55)));
  context.closePath();
  context.fillStyle = colour("robot");
  context.fill();
}

/**
 * @param {View} view
 * @param {import("./messages.js").Tick} tick
 */
export function drawEchoes(view, tick) {
  const { context, px } = view;
  context.strokeStyle = colour("echo");
  context.lineCap = "round";
  context.lineWidth = 3.5 * px;
  for (const echo of tick.sonar) {
    if (!(echo.range_m < kNoEcho_m) || !(echo.age_s < kEchoOld_s)) continue;
    const half_m = Math.max(0.05, echo.range_m * Math.tan(kSonarHalfBeam_rad));
    const [dx, dy] = [-Math.sin(echo.angle_rad) * half_m, Math.cos(echo.angle_rad) * half_m];
    context.globalAlpha = 1 - 0.7 * (echo.age_s / kEchoOld_s);
    context.beginPath();
    context.moveTo(...view.place(odomFromRobot(tick.robot, echo.x_m - dx, echo.y_m - dy)));
    context.lineTo(...view.place(odomFromRobot(tick.robot, echo.x_m + dx, echo.y_m + dy)));
    context.stroke();
  }
  context.globalAlpha = 1;
}

/**
 * The person, where they are expected to be, where they go, and the set distance around them.
 * @param {View} view
 * @param {import("./messages.js").Tick} tick
 * @param {number | undefined} set_distance_m
 */
export function drawPerson(view, tick, set_distance_m) {
  const { target, robot } = tick;
  const place = knownPlace(target);
  if (!place) return;
  const { context, px } = view;
  const back = odomFromRobot(robot, place.x_m, place.y_m);
  const bodyPlace = knownPlace(target.body_odom);
  const body = bodyPlace ? { x: bodyPlace.x_m, y: bodyPlace.y_m } : back;
  const [x, y] = view.place(body);
  const travel_rad = robot.heading_rad + (target.travel_yaw_rad ?? 0);
  const orange = colour("person");
  if (set_distance_m) {
    const [backX, backY] = view.place(back);
    context.setLineDash([5 * px, 5 * px]);
    circle(context, backX, backY, set_distance_m * view.scale);
    context.lineWidth = px;
    context.strokeStyle = orange;
    context.stroke();
    context.setLineDash([]);
  }
  // Two standard deviations of the place, and of the direction of travel.
  context.fillStyle = orange;
  context.globalAlpha = 0.25;
  circle(context, x, y, Math.max(2 * (target.body_odom?.sigma_m ?? 0) * view.scale, 2 * px));
  context.fill();
  const spread_rad = Math.min(Math.PI, 2 * (target.travel_yaw_sigma_rad ?? 0));
  const reach = 0.9 * view.scale;
  context.beginPath();
  context.moveTo(x, y);
  context.arc(x, y, reach, -Math.PI / 2 - travel_rad - spread_rad, -Math.PI / 2 - travel_rad + spread_rad);
  context.closePath();
  context.fill();
  context.globalAlpha = 1;
  drawArrow(view, body, travel_rad, 0.9);
  // Shoulders, as the back is turned.
  context.save();
  context.translate(x, y);
  context.rotate(-(robot.heading_rad + (target.yaw_rad ?? 0)));
  context.beginPath();
  context.ellipse(0, 0, 0.24 * view.scale, 0.13 * view.scale, 0, 0, 2 * Math.PI);
  context.fillStyle = orange;
  context.fill();
  context.restore();
}

/**
 * @param {View} view
 * @param {import("./messages.js").Tick} tick
 */
export function drawGoal(view, tick) {
  const goal = knownPlace(tick.goal);
  if (!goal) return;
  const { context, px } = view;
  const [x, y] = view.place(odomFromRobot(tick.robot, goal.x_m, goal.y_m));
  const size = 6 * px;
  context.strokeStyle = colour("goal");
  context.lineWidth = 2.5 * px;
  context.beginPath();
  context.moveTo(x - size, y - size);
  context.lineTo(x + size, y + size);
  context.moveTo(x - size, y + size);
  context.lineTo(x + size, y - size);
  context.stroke();
}

/**
 * @param {View} view
 * @param {Point} from
 * @param {number} direction_rad
 * @param {number} length_m
 */
function drawArrow(view, from, direction_rad, length_m) {
  const { context, px } = view;
  const at = (/** @type {number} */ along_m, /** @type {number} */ aside_m) => view.place({
    x: from.x + along_m * Math.cos(direction_rad) - aside_m * Math.sin(direction_rad),
    y: from.y + along_m * Math.sin(direction_rad) + aside_m * Math.cos(direction_rad) });
  context.strokeStyle = colour("person");
  context.lineWidth = 2 * px;
  context.beginPath();
  context.moveTo(...at(0, 0));
  context.lineTo(...at(length_m, 0));
  context.moveTo(...at(length_m - 0.14, 0.1));
  context.lineTo(...at(length_m, 0));
  context.lineTo(...at(length_m - 0.14, -0.1));
  context.stroke();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 * @param {number} y
 * @param {number} radius
 */
function circle(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
}
