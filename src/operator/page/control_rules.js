// Which of start, stop and reset can work now, and why not. The daemon decides; this only spares a useless press.

/** The reason that a press answers with the sign-in dialog. */
export const kSignIn = "sign in first";

/** Reasons that the state beside the buttons shows already: told at a press only. */
export const kPlain = new Set(["the robot is started already", "there is nothing to reset"]);

/**
 * @param {"start" | "stop" | "reset"} command
 * @param {{connected: boolean, mayWrite: boolean, hasToken: boolean, old: boolean, tick: import("./messages.js").Tick | undefined}} now
 * @returns {string} empty: it can be pressed
 */
export function whyNot(command, now) {
  if (!now.connected || now.old) return "there is no connection to heeld";
  if (!now.hasToken) return "heeld has no token (view.token_file), so that this page only shows";
  if (!now.mayWrite) return kSignIn;
  if (!now.tick) return "nothing is known of the robot yet";
  const { state, reason, robot } = now.tick;
  if (command === "stop") return "";
  if (command === "start") {
    if (state === "emergency") return "press Reset first";
    if (robot.stop_button) return "release the robot's STOP button first";
    if (state === "stopped" && reason === "motors off") return "press Reset first";
    return state === "idle" || state === "stopped" ? "" : "the robot is started already";
  }
  if (robot.stop_button) return "release the robot's STOP button first";
  return state === "emergency" || state === "stopped" ? "" : "there is nothing to reset";
}
