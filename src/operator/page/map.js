// The map from above: what is drawn when, and how it is moved and zoomed.

import { byId, colour, fitCanvas } from "./dom.js";
import { drawEchoes, drawGoal, drawGrid, drawPath, drawPerson, drawRobot, drawScaleBar } from "./map_draw.js";
import { knownPlace, odomFromRobot, Path } from "./map_paths.js";

const kScaleFirst = 62;
const kScaleLeast = 4;
const kScaleMost = 400;
const kZoomStep = 1.35;
const kSpoken_ms = 2000;
/** Around what must be in view. */
const kMargin_m = 1.4;

export class MapView {
  #canvas = /** @type {HTMLCanvasElement} */ (byId("map"));
  #context = /** @type {CanvasRenderingContext2D} */ (this.#canvas.getContext("2d"));
  #robotPath = new Path();
  #personPath = new Path();
  /** The place in the middle, odometry frame, and CSS pixels for each metre. */
  #middle = { x: 0, y: 0 };
  #scale = kScaleFirst;
  #follows = true;
  #drawing = false;
  #spoken_ms = 0;

  /** @param {import("./bus.js").Bus} bus */
  constructor(bus) {
    this.bus = bus;
    bus.on("tick", (tick) => this.#take(tick));
    for (const name of ["info", "old"]) bus.on(name, () => this.#drawSoon());
    document.addEventListener("themechange", () => this.#drawSoon());
    new ResizeObserver(() => this.#drawSoon()).observe(this.#canvas);
    byId("map-in").addEventListener("click", () => this.#zoom(kZoomStep));
    byId("map-out").addEventListener("click", () => this.#zoom(1 / kZoomStep));
    byId("map-follow").addEventListener("click", () => this.#follow(!this.#follows));
    byId("map-fit").addEventListener("click", () => this.#fit());
    this.#listenToPointers();
    this.#listenToKeys();
  }

  /** @param {import("./messages.js").Tick} tick */
  #take(tick) {
    if (this.#robotPath.add({ x: tick.robot.x_m, y: tick.robot.y_m })) this.#personPath.points = [];
    const body = knownPlace(tick.target.body_odom);
    if (body) this.#personPath.add({ x: body.x_m, y: body.y_m });
    this.#drawSoon();
  }

  #drawSoon() {
    if (this.#drawing || this.#canvas.clientWidth === 0) return;
    this.#drawing = true;
    requestAnimationFrame(() => {
      this.#drawing = false;
      this.#draw();
    });
  }

  #draw() {
    /** @type {import("./messages.js").Tick | undefined} */
    const tick = this.bus.newest("tick");
    /** @type {import("./messages.js").Info | undefined} */
    const info = this.bus.newest("info");
    const px = fitCanvas(this.#canvas);
    const { width, height } = this.#canvas;
    const top = this.#top() * px;
    let scale = this.#scale * px;
    if (tick && this.#follows) {
      // Halfway to the person, and so small that both are in view.
      const person = knownPlace(tick.target);
      this.#middle = odomFromRobot(tick.robot, (person?.x_m ?? 0) / 2, (person?.y_m ?? 0) / 2);
      if (person) scale = Math.min(scale, Math.min(width, height - top) / (Math.hypot(person.x_m, person.y_m) + kMargin_m));
    }
    const view = {
      context: this.#context, width, height, px, scale,
      place: (/** @type {import("./map_paths.js").Point} */ point) => /** @type {[number, number]} */ ([
        width / 2 - (point.y - this.#middle.y) * scale, (height + top) / 2 - (point.x - this.#middle.x) * scale]) };
    this.#context.clearRect(0, 0, width, height);
    this.#context.globalAlpha = 1;
    drawGrid(view);
    drawPath(view, this.#personPath.points, colour("person"), 2);
    drawPath(view, this.#robotPath.points, colour("robot"), 2);
    if (tick) {
      drawEchoes(view, tick);
      drawPerson(view, tick, info?.set_distance_m);
      drawGoal(view, tick);
      drawRobot(view, tick, info);
      this.#speak(tick);
    }
    drawScaleBar(view);
  }

  /** CSS pixels at the upper edge which the buttons cover. */
  #top() {
    const buttons = byId("map-buttons");
    return buttons.offsetTop + buttons.offsetHeight;
  }

  /** @param {import("./messages.js").Tick} tick */
  #speak(tick) {
    const now_ms = performance.now();
    if (now_ms - this.#spoken_ms < kSpoken_ms) return;
    this.#spoken_ms = now_ms;
    const { target, robot } = tick;
    const turned = (/** @type {number | null | undefined} */ angle_rad) => `${Math.round(((angle_rad ?? 0) * 180) / Math.PI)} degrees`;
    const place = knownPlace(target);
    const person = place
      ? `the person ${Math.hypot(place.x_m, place.y_m).toFixed(1)} metres away at ${turned(Math.atan2(place.y_m, place.x_m))} to the left, ` +
        `walking ${turned(target.travel_yaw_rad)} to the left of the robot's heading` : "no person known";
    this.#canvas.setAttribute("aria-label",
      `Map: the robot at ${robot.x_m.toFixed(1)}, ${robot.y_m.toFixed(1)} metres; ${person}. Arrow keys move, plus and minus zoom.`);
  }

  /** @param {number} factor */
  #zoom(factor) {
    this.#scale = Math.min(kScaleMost, Math.max(kScaleLeast, this.#scale * factor));
    this.#drawSoon();
  }

  /** @param {boolean} follows */
  #follow(follows) {
    this.#follows = follows;
    byId("map-follow").setAttribute("aria-checked", String(follows));
    this.#drawSoon();
  }

  /** Both paths as large as they fit. */
  #fit() {
    const points = [...this.#robotPath.points, ...this.#personPath.points];
    if (points.length === 0) return;
    const range = (/** @type {number[]} */ values) =>
      values.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);
    const [xLeast, xMost] = range(points.map((point) => point.x));
    const [yLeast, yMost] = range(points.map((point) => point.y));
    this.#follow(false);
    this.#middle = { x: (xLeast + xMost) / 2, y: (yLeast + yMost) / 2 };
    this.#scale = 1;
    this.#zoom(Math.min((this.#canvas.clientHeight - this.#top()) / (xMost - xLeast + kMargin_m), this.#canvas.clientWidth / (yMost - yLeast + kMargin_m)));
  }

  /**
   * @param {number} right CSS pixels by which the picture moves
   * @param {number} down
   */
  #move(right, down) {
    this.#follow(false);
    this.#middle = { x: this.#middle.x + down / this.#scale, y: this.#middle.y + right / this.#scale };
    this.#drawSoon();
  }

  #listenToPointers() {
    /** @type {Map<number, {x: number, y: number}>} */
    const pointers = new Map();
    const spread = () => {
      const [a, b] = [...pointers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    this.#canvas.addEventListener("pointerdown", (event) => {
      this.#canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    this.#canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const spreadBefore = pointers.size === 2 ? spread() : 0;
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (pointers.size === 2 && spreadBefore > 0) this.#zoom(spread() / spreadBefore);
      else this.#move(event.clientX - before.x, event.clientY - before.y);
    });
    for (const name of ["pointerup", "pointercancel"])
      this.#canvas.addEventListener(name, (event) => pointers.delete(/** @type {PointerEvent} */ (event).pointerId));
    this.#canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.#zoom(Math.exp(-event.deltaY / 400));
    }, { passive: false });
  }

  #listenToKeys() {
    const kMove = 40;
    /** @type {Record<string, () => void>} */
    const actions = {
      ArrowLeft: () => this.#move(kMove, 0), ArrowRight: () => this.#move(-kMove, 0),
      ArrowUp: () => this.#move(0, kMove), ArrowDown: () => this.#move(0, -kMove),
      "+": () => this.#zoom(kZoomStep), "=": () => this.#zoom(kZoomStep), "-": () => this.#zoom(1 / kZoomStep),
      f: () => this.#follow(true), F: () => this.#follow(true) };
    this.#canvas.addEventListener("keydown", (event) => {
      const action = actions[event.key];
      if (!action || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      action();
    });
  }
}
