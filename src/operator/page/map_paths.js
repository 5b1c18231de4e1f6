// The paths of robot and person in the odometry frame, thinned to one point every few centimetres.

const kStep_m = 0.04;
const kPointsMost = 6000;
/** A jump farther than this is another odometry: heeld, or the robot, has started again. */
const kJump_m = 1.5;

/** @typedef {{x: number, y: number}} Point */

/**
 * A place that is known in both directions.
 * @param {{x_m?: number | null, y_m?: number | null} | null | undefined} place
 * @returns {{x_m: number, y_m: number} | null}
 */
export function knownPlace(place) {
  return place && Number.isFinite(place.x_m) && Number.isFinite(place.y_m)
    ? { x_m: Number(place.x_m), y_m: Number(place.y_m) } : null;
}

export class Path {
  /** @type {Point[]} */
  points = [];

  /**
   * @param {Point} point
   * @returns {boolean} whether the path began again, because the point is far from the last one
   */
  add(point) {
    const last = this.points[this.points.length - 1];
    const step_m = last ? Math.hypot(point.x - last.x, point.y - last.y) : Infinity;
    if (step_m < kStep_m) return false;
    const jumped = last !== undefined && step_m > kJump_m;
    if (jumped) this.points = [];
    this.points.push(point);
    if (this.points.length > kPointsMost) this.points.splice(0, kPointsMost / 10);
    return jumped;
  }
}

/**
 * A point of the robot frame in the odometry frame.
 * @param {{x_m: number, y_m: number, heading_rad: number}} robot
 * @param {number} x_m
 * @param {number} y_m
 * @returns {Point}
 */
export function odomFromRobot(robot, x_m, y_m) {
  const [c, s] = [Math.cos(robot.heading_rad), Math.sin(robot.heading_rad)];
  return { x: robot.x_m + c * x_m - s * y_m, y: robot.y_m + s * x_m + c * y_m };
}
