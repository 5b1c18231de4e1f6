// The plots: yaw, place of the person, commands and latency over the last seconds or minutes.

import { byId, colour, make, makeSegments, setText, signed } from "./dom.js";
import { writesText } from "./estop.js";
import { Series } from "./series.js";

const kDegrees = 180 / Math.PI;
const kRedraw_ms = 250;
/** A long window moves by less than a pixel in that time: it is drawn again when it has moved by this part of itself. */
const kRedrawShare = 1 / 200;
/** @type {[string, string][]} */
const kWindows = [["30", "30 s"], ["60", "1 min"], ["120", "2 min"], ["300", "5 min"]];

/**
 * `span`: the values shown are at least so far apart, so that noise does not look like motion.
 * @type {{name: string, title: string, unit: string, digits: number, span: number, labels: string[]}[]}
 */
const kPlots = [
  { name: "yaw", title: "Yaw of the back", unit: "°", digits: 0, span: 20, labels: ["yaw", "travel"] },
  { name: "t_x", title: "t_x, to the right", unit: "m", digits: 2, span: 0.2, labels: ["t_x"] },
  { name: "t_z", title: "t_z, ahead", unit: "m", digits: 2, span: 0.2, labels: ["t_z"] },
  { name: "speed", title: "Speed", unit: "m/s", digits: 2, span: 0.2, labels: ["command", "measured"] },
  { name: "turn", title: "Yaw rate", unit: "°/s", digits: 0, span: 10, labels: ["command", "measured"] },
  { name: "latency", title: "Latency", unit: "ms", digits: 0, span: 20, labels: ["capture to command", "capture to pose"] },
];

/** Of which a value is missing for most times: not every pose leads to a command. */
const kSparse = "latency";

export class PlotsView {
  /** @type {Map<string, {series: Series, graph: any, box: HTMLElement, values: HTMLElement[]}>} */
  #plots = new Map();
  #window_s = 60;
  #paused = false;
  #clock_ms = 0;
  #pausedAt_ms = 0;
  #drawn_ms = 0;

  /** @param {import("./bus.js").Bus} bus */
  constructor(bus) {
    this.bus = bus;
    for (const plot of kPlots) this.#addPlot(plot);
    makeSegments(byId("plot-window"), kWindows, String(this.#window_s), (value) => {
      this.#window_s = Number(value);
      this.#redraw(true);
    });
    const pause = byId("plot-pause");
    pause.addEventListener("click", () => this.#pause(!this.#paused));
    document.addEventListener("keydown", (event) => {
      if (event.key.toLowerCase() === "p" && !writesText(event.target) && !event.ctrlKey && !event.metaKey) this.#pause(!this.#paused);
    });
    bus.on("tick", (tick) => this.#takeTick(tick));
    bus.on("pose", (pose) => this.#takePose(pose));
    bus.on("tab", () => requestAnimationFrame(() => this.#redraw(true)));
    new ResizeObserver(() => this.#resize()).observe(byId("plot-list"));
    document.addEventListener("themechange", () => {
      for (const { graph } of this.#plots.values()) graph?.updateOptions({ colors: seriesColours(), gridLineColor: colour("grid"), axisLineColor: colour("line") });
    });
    setInterval(() => {
      const now_ms = performance.now();
      if (now_ms - this.#drawn_ms >= this.#window_s * 1000 * kRedrawShare) this.#redraw(false);
    }, kRedraw_ms);
  }

  /** @param {typeof kPlots[number]} plot */
  #addPlot({ name, title, unit, labels }) {
    const box = make("div");
    const values = labels.map((label, i) => {
      const value = make("output", { "aria-label": `${title}, ${label}` }, "–");
      return { value, part: make("span", { class: "plot-value", "data-series": String(i + 1) }, labels.length > 1 ? `${label} ` : "", value, ` ${unit}`) };
    });
    byId("plot-list").append(make("figure", { class: "plot", "aria-label": title },
      make("figcaption", { class: "plot-title" }, make("strong", {}, title), ...values.map(({ part }) => part)),
      make("div", { class: "plot-box", "aria-hidden": "true" }, box)));
    this.#plots.set(name, { series: new Series(), graph: null, box, values: values.map(({ value }) => value) });
  }

  /**
   * @param {string} name
   * @param {number} wall_ms
   * @param {(number | null | undefined)[]} values
   */
  #add(name, wall_ms, values) {
    this.#plots.get(name)?.series.add(wall_ms, values);
  }

  /** @param {import("./messages.js").Tick} tick */
  #takeTick(tick) {
    this.#clock_ms = tick.wall_ms - tick.t_s * 1000;
    this.#add("speed", tick.wall_ms, [tick.command.v_m_s, tick.robot.v_m_s]);
    this.#add("turn", tick.wall_ms, [tick.command.yaw_rate_rad_s * kDegrees, tick.robot.yaw_rate_rad_s * kDegrees]);
  }

  /** @param {import("./messages.js").Pose} pose */
  #takePose(pose) {
    if (this.#clock_ms === 0) return;
    const wall_ms = this.#clock_ms + pose.t_s * 1000;
    /** @type {import("./messages.js").Tick | undefined} */
    const tick = this.bus.newest("tick");
    // The yaw of a pose grows to the right of the picture; angles of the robot grow to the left.
    const travel_rad = tick?.target.known ? tick.target.travel_yaw_rad : undefined;
    const found = pose.found;
    this.#add("yaw", wall_ms, [found ? pose.yaw_rad * kDegrees : null, Number.isFinite(travel_rad) ? -Number(travel_rad) * kDegrees : null]);
    this.#add("t_x", wall_ms, [found ? pose.position_m?.[0] : null]);
    this.#add("t_z", wall_ms, [found ? pose.position_m?.[2] : null]);
    this.#add("latency", wall_ms, [pose.latency_ms.to_command, pose.latency_ms.capture_to_vision]);
  }

  /** @param {boolean} paused */
  #pause(paused) {
    this.#paused = paused;
    this.#pausedAt_ms = paused ? this.#newest_ms() : 0;
    byId("plot-pause").setAttribute("aria-pressed", String(paused));
    setText(byId("plot-pause"), paused ? "Go on" : "Pause");
    setText(byId("plot-time"), paused ? "paused; drag in a plot to zoom, double-click for all" : "");
    this.#redraw(true);
  }

  #newest_ms() {
    return Math.max(0, ...[...this.#plots.values()].map(({ series }) => Number(series.rows[series.rows.length - 1]?.[0] ?? 0)));
  }

  /** @param {boolean} always also while it is paused */
  #redraw(always) {
    const visible = byId("panel-plots").offsetParent !== null && document.visibilityState === "visible";
    if (!visible || (this.#paused && !always)) return;
    this.#drawn_ms = performance.now();
    const end_ms = this.#paused ? this.#pausedAt_ms : this.#newest_ms();
    const dateWindow = [end_ms - this.#window_s * 1000, end_ms];
    for (const { name, labels, digits, span } of kPlots) {
      const plot = this.#plots.get(name);
      if (!plot || plot.series.rows.length < 2) continue;
      const range = { dateWindow, valueRange: plot.series.range(dateWindow[0], span) };
      if (plot.graph) plot.graph.updateOptions({ file: plot.series.rows, ...range });
      else plot.graph = this.#makeGraph(plot, labels, range);
      if (!this.#paused) this.#showValues(plot, name === kSparse ? plot.series.newest() : plot.series.rows[plot.series.rows.length - 1], digits);
    }
  }

  /**
   * @param {{values: HTMLElement[]}} plot
   * @param {(number | null | Date)[]} row
   * @param {number} digits
   */
  #showValues(plot, row, digits) {
    plot.values.forEach((value, i) => {
      const number = /** @type {number | null} */ (row[i + 1]);
      setText(value, number === null ? "–" : signed(number, digits));
    });
  }

  /**
   * @param {any} plot
   * @param {string[]} labels
   * @param {object} range
   */
  #makeGraph(plot, labels, range) {
    const Dygraph = /** @type {any} */ (window).Dygraph;
    if (!Dygraph) return null;  // libjs-dygraphs is missing: the newest values are still shown
    // The legend, which is not used, would set a style that the Content-Security-Policy forbids.
    Dygraph.PLUGINS = Dygraph.PLUGINS.filter((/** @type {any} */ plugin) => plugin !== Dygraph.Plugins.Legend);
    const last = this.#plots.get(kPlots[kPlots.length - 1].name);
    const showAt = (/** @type {number} */ wall_ms) => {
      for (const { name, digits } of kPlots) {
        const other = this.#plots.get(name);
        const row = other?.series.at(wall_ms);
        if (other && row) this.#showValues(other, row, digits);
      }
    };
    return new Dygraph(plot.box, plot.series.rows, {
      labels: ["time", ...labels], ...range, colors: seriesColours(), strokeWidth: 1.5,
      legend: "never", gridLineColor: colour("grid"), axisLineColor: colour("line"), axisLabelFontSize: 11,
      axes: { y: { axisLabelWidth: 38, pixelsPerLabel: 17 }, x: { axisLabelWidth: 66, pixelsPerLabel: 90, drawAxis: plot === last } },
      xRangePad: 0, highlightCircleSize: 3, connectSeparatedPoints: plot === this.#plots.get(kSparse),
      highlightCallback: (/** @type {any} */ _event, /** @type {number} */ wall_ms) => {
        if (this.#paused) showAt(wall_ms);
      },
    });
  }

  #resize() {
    for (const { graph } of this.#plots.values()) graph?.resize();
  }
}

function seriesColours() {
  return [colour("accent"), colour("series-2")];
}
