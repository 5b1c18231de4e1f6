// What vision found, drawn over the picture that it was found in.

import { colour } from "./dom.js";

/** Radius of an inlier's dot on the screen. */
const kInlierLeast = 0.6;
const kInlierMost = 1.7;

/**
 * Draws quadrilateral, inliers and predicted region of one pose.
 * @param {CanvasRenderingContext2D} context in pixels of the whole picture
 * @param {import("./messages.js").Pose} pose
 * @param {number} px how many pixels of the whole picture one pixel of the screen is
 */
export function drawPose(context, pose, px) {
  const quad = colour("quad");
  if (pose.predicted) {
    const [x0, y0, x1, y1] = pose.predicted;
    context.setLineDash([6 * px, 5 * px]);
    context.lineWidth = 1.5 * px;
    context.strokeStyle = "rgba(255, 255, 255, 0.8)";
    context.strokeRect(x0, y0, x1 - x0, y1 - y0);
    context.setLineDash([]);
  }
  const radius = inlierRadius(pose, px);
  context.fillStyle = "rgba(60, 220, 120, 0.9)";
  for (const [x, y] of pose.inlier_px ?? []) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
  }
  if (!pose.quad) return;
  context.beginPath();
  for (const [x, y] of pose.quad) context.lineTo(x, y);
  context.closePath();
  context.lineJoin = "round";
  context.lineWidth = 5 * px;
  context.strokeStyle = "rgba(0, 0, 0, 0.6)";
  context.stroke();
  context.lineWidth = 2.5 * px;
  context.strokeStyle = pose.found ? quad : colour("line-strong");
  context.stroke();
  drawUpMark(context, pose.quad, px);
}

/**
 * So small that the print is still seen between many inliers in a small picture.
 * @param {import("./messages.js").Pose} pose
 * @param {number} px
 */
function inlierRadius({ quad, inlier_px }, px) {
  if (!quad || !inlier_px?.length) return kInlierMost * px;
  const [[x0, y0], [x1, y1], [x2, y2], [x3, y3]] = quad;
  const area = Math.abs((x2 - x0) * (y3 - y1) - (x3 - x1) * (y2 - y0)) / 2;
  const apart = Math.sqrt(area / inlier_px.length);
  return Math.max(kInlierLeast * px, Math.min(kInlierMost * px, apart / 4));
}

/**
 * A small triangle at the middle of the upper edge: which way the template is up.
 * @param {CanvasRenderingContext2D} context
 * @param {[number, number][]} quad
 * @param {number} px
 */
function drawUpMark(context, quad, px) {
  const [[x0, y0], [x1, y1]] = quad;
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  const [mx, my] = [(x0 + x1) / 2, (y0 + y1) / 2];
  const size = 7 * px;
  context.fillStyle = colour("quad");
  context.beginPath();
  context.moveTo(mx + uy * size * 1.3, my - ux * size * 1.3);
  context.lineTo(mx + ux * size, my + uy * size);
  context.lineTo(mx - ux * size, my - uy * size);
  context.fill();
}
