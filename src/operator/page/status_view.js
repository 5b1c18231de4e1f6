// State, reason and advice in large letters, the figures beside them, and the chips in the bar.

import { byId, setText, signed } from "./dom.js";
import { describe, describeOld } from "./sentence.js";

const kChips_ms = 500;
/** A sentence with more letters is written smaller: it then needs one line beside the figures, or at most two. */
const kMiddle = 22;
const kLong = 44;
/** Over which the frames are counted. */
const kRate_s = 2;
/** So long without a pose, and the camera counts as silent. */
const kCameraSilent_ms = 1000;

export class StatusView {
  /** @type {number[]} times of the newest frames */
  #frames_s = [];
  #pose_ms = 0;
  #spoken = "";

  /** @param {import("./bus.js").Bus} bus */
  constructor(bus) {
    this.bus = bus;
    bus.on("tick", (tick) => this.#showTick(tick));
    bus.on("old", (old) => {
      const tick = bus.newest("tick");
      if (old) this.#showSentence(describeOld(tick), "old");
      else if (tick) this.#showTick(tick);
    });
    bus.on("pose", (/** @type {import("./messages.js").Pose} */ { t_s }) => {
      // A daemon that has started again may begin with an earlier time.
      this.#frames_s = [...this.#frames_s.filter((one_s) => one_s < t_s && one_s > t_s - kRate_s), t_s];
      this.#pose_ms = performance.now();
    });
    bus.on("info", (/** @type {import("./messages.js").Info} */ info) => {
      setText(byId("robot-name"), info.robot || "");
      byId("robot-name").title = `heel ${info.version}`;
    });
    setInterval(() => this.#showChips(), kChips_ms);
    this.#showChips();
  }

  /**
   * Screen readers hear it when `what` changes, and not each time when a distance in the sentence does.
   * @param {ReturnType<typeof describe>} description
   * @param {string} what
   */
  #showSentence({ sentence, advice, level }, what) {
    setText(byId("sentence"), sentence);
    byId("sentence").dataset.length = sentence.length > kLong ? "long" : sentence.length > kMiddle ? "middle" : "short";
    setText(byId("advice"), advice);
    document.body.dataset.level = level;
    if (what === this.#spoken) return;
    this.#spoken = what;
    setText(byId("spoken"), `${sentence}. ${advice}`);
  }

  /** @param {import("./messages.js").Tick} tick */
  #showTick(tick) {
    this.#showSentence(describe(tick), `${tick.state}, ${tick.reason}, ${tick.hold}`);
    document.body.dataset.state = tick.state;
    document.title = `${tick.state} – heel`;
    setText(byId("figure-speed"), `${signed(tick.robot.v_m_s, 2)} m/s`);
    setText(byId("figure-turn"), `${signed((tick.robot.yaw_rate_rad_s * 180) / Math.PI, 0)} °/s`);
    setText(byId("figure-person"), metres(tick.person_m));
    setText(byId("figure-free"), metres(tick.free_distance_m));
  }

  #showChips() {
    /** @type {import("./messages.js").Tick | undefined} */
    const tick = this.bus.newest("tick");
    const old = this.bus.newest("old") ?? true;
    const now_ms = performance.now();
    if (!tick || old) {
      for (const name of ["battery", "link", "camera"]) chip(name, `${name === "link" ? "robot" : name} ?`, "", "not known");
    } else {
      const { battery_v } = tick.robot;
      chip("battery", battery_v === null ? "battery ?" : `${battery_v.toFixed(1)} V`, battery_v === null ? "" : this.#batteryLevel(battery_v),
        "voltage of the robot's battery");
      const linked = tick.robot.link === "running";
      chip("link", linked ? "robot" : `robot ${tick.robot.link}`, linked ? "good" : "bad", `the line to the robot is ${tick.robot.link}`);
      const silent = now_ms - this.#pose_ms > kCameraSilent_ms;
      chip("camera", silent ? "camera silent" : `camera ${this.#rate_hz()}/s`, silent ? "bad" : "good", "frames that vision has processed in a second");
    }
    const recording = this.bus.newest("info")?.recording;
    chip("recording", recording ? "recording" : "not recording", recording ? "good" : "", "telemetry.directory");
  }

  /** By the times of the frames, not of their news, which come in bursts on a busy network. */
  #rate_hz() {
    const [first_s, last_s] = [this.#frames_s[0], this.#frames_s[this.#frames_s.length - 1]];
    return last_s > first_s ? Math.round((this.#frames_s.length - 1) / (last_s - first_s)) : 0;
  }

  /** @param {number} battery_v */
  #batteryLevel(battery_v) {
    const limit = (/** @type {string} */ key) =>
      this.bus.newest("config")?.keys.find((/** @type {any} */ setting) => setting.key === key)?.value ?? 0;
    if (battery_v < limit("supervisor.battery_low_v")) return "bad";
    return battery_v < limit("supervisor.battery_ok_v") ? "warn" : "good";
  }
}

/**
 * @param {string} name
 * @param {string} text
 * @param {string} level
 * @param {string} meaning
 */
function chip(name, text, level, meaning) {
  const element = byId(`chip-${name}`);
  setText(element, text);
  if (element.title !== meaning) element.title = meaning;
  element.dataset.level = level;
}

/** @param {number | null | undefined} length_m null: not known, or without end */
function metres(length_m) {
  return length_m === null || length_m === undefined ? "–" : `${length_m.toFixed(2)} m`;
}
