// State and reason as a sentence, and what a person can do about it.

/**
 * What to do for each reason to rest (heel/states.h, StopReason, as to_string() writes it).
 * @type {Readonly<Record<string, string>>}
 */
export const kAdvice = Object.freeze({
  "following": "It keeps its distance along your path. Press Stop to let it rest.",
  "shutting down": "heeld is being ended; nothing is to be done.",
  "no link to the robot": "Is the robot on, and its cable in? heeld connects again by itself.",
  "robot silent": "Check the robot's cable and power. heeld connects again by itself.",
  "stop button pressed": "Release the STOP button on the robot, then press Reset, then Start.",
  "motors off": "Check the STOP button and the battery, then press Reset, then Start.",
  "bumper pressed": "Free the bumper.",
  "wheels stalled": "Free the wheels.",
  "sonars silent": "Check that the sonars click, and their cable.",
  "no target seen yet": "Stand with your back to the camera, in the shirt that was taught, and wait until it is found.",
  "camera silent": "Check the camera's cable. heeld opens it again by itself.",
  "target lost": "Come back into the picture with your back to the camera.",
  "certainty too low": "Come nearer, turn your back to the camera, or give more light.",
  "shirt seen at two places": "Only one such shirt may be in the picture: let the other one leave.",
  "battery low": "Charge the robot's battery.",
  "control too late": "The computer is overloaded: end other programs.",
  "clock jumped": "Check the computer's clock.",
  "turning towards the person makes their bearing grow":
    "Check camera.rotate and camera.mirror, the mount, and the cables of wheels and gyro; then press Reset.",
  "operator away": "Switch on \"I am watching\".",
  "not started": "Press Start: the robot then follows as soon as it sees the shirt.",
  "emergency stop": "Make the way free, then press Reset, then Start.",
});

/** Reasons that leave the state "stopped" by more than a Start: their advice says so itself. */
const kOwnWayOut = new Set(["stop button pressed", "motors off", "turning towards the person makes their bearing grow"]);

/**
 * @param {import("./messages.js").Tick} tick
 * @returns {{sentence: string, advice: string, level: "good" | "warn" | "bad" | "rest"}}
 */
export function describe(tick) {
  return { sentence: plainSentence(tick.sentence), advice: adviceFor(tick), level: levelOf(tick) };
}

/**
 * What can be said when nothing is heard any more.
 * @param {import("./messages.js").Tick | undefined} tick the last that came
 * @returns {ReturnType<typeof describe>}
 */
export function describeOld(tick) {
  const last = tick ? ` It was: ${plainSentence(tick.sentence)}.` : "";
  return { sentence: "No news from the robot", advice: `Use the robot's STOP button if it must stop.${last}`, level: "bad" };
}

/**
 * The daemon's sentence without its commands for a terminal, as a sentence begins.
 * @param {string} sentence
 * @returns {string}
 */
export function plainSentence(sentence) {
  const cut = sentence.indexOf("; ");
  const plain = cut >= 0 && sentence.indexOf("`", cut) >= 0 ? sentence.slice(0, cut) : sentence;
  return plain.charAt(0).toUpperCase() + plain.slice(1);
}

/**
 * @param {import("./messages.js").Tick} tick
 * @returns {string}
 */
function adviceFor(tick) {
  if (tick.hold === "person too near") return "The robot waits until the person walks on.";
  if (tick.hold === "obstacle ahead") return "Make the way free; the robot then goes on by itself.";
  if (tick.state === "searching") return "Come back into the picture; the robot drives along your path and looks for you.";
  const advice = kAdvice[tick.reason] ?? "";
  if (tick.state === "stopped" && !kOwnWayOut.has(tick.reason)) return `${advice} When it is over, press Start.`.trim();
  return advice;
}

/**
 * @param {import("./messages.js").Tick} tick
 * @returns {"good" | "warn" | "bad" | "rest"}
 */
function levelOf(tick) {
  if (tick.state === "stopped" || tick.state === "emergency") return "bad";
  if (tick.hold !== "none" || tick.state === "searching" || tick.state === "waiting") return "warn";
  if (tick.state === "following") return "good";
  return "rest";
}
