// Puts the parts of the page together.

import { Banner } from "./banner.js";
import { Bus } from "./bus.js";
import { Controls } from "./controls.js";
import { setUpDialogs } from "./dialogs.js";
import { EmergencyStop } from "./estop.js";
import { LiveConnection } from "./live_connection.js";
import { LogView } from "./log.js";
import { MapView } from "./map.js";
import { OperatorChannel } from "./operator_channel.js";
import { PictureView } from "./picture.js";
import { PlotsView } from "./plots.js";
import { SettingsView } from "./settings.js";
import { StatusView } from "./status_view.js";
import { setUpTabs } from "./tabs.js";

const kFacts_ms = 4000;

/**
 * A file of facts of the daemon; nothing when it does not come, and the page then goes on without it.
 * @param {string} path
 * @returns {Promise<any>}
 */
async function facts(path) {
  try {
    const answer = await fetch(path, { cache: "no-store", signal: AbortSignal.timeout(kFacts_ms) });
    return answer.ok ? await answer.json() : undefined;
  } catch {
    return undefined;
  }
}

const bus = new Bus();
const live = new LiveConnection(bus);
const channel = new OperatorChannel(bus);
const banner = new Banner(bus, live);
const emergencyStop = new EmergencyStop(bus, channel, banner);
new Controls(bus, channel, setUpDialogs(bus, channel));
new StatusView(bus);
new PictureView(bus, live);
new MapView(bus);
new PlotsView(bus);
new SettingsView(bus, channel, () => readInto("config", "/api/config"));
new LogView(bus, channel);
setUpTabs(bus);

/** @type {Map<string, Promise<void>>} */
const waiting = new Map();
let lastRead = Promise.resolve();

/**
 * Reads a path, one request after another: a browser opens six connections to a host, for all its tabs, and the emergency stop needs
 * one of them also when nothing is answered. What waits already is not asked for again.
 * @param {string} name
 * @param {string} path
 * @returns {Promise<void>}
 */
function readInto(name, path) {
  const read = async () => {
    waiting.delete(path);
    const value = await facts(path);
    if (value) bus.emit(name, value);
  };
  const promise = waiting.get(path) ?? lastRead.then(read);
  if (!waiting.has(path)) lastRead = promise;
  waiting.set(path, promise);
  return promise;
}

// After each connection: the daemon may be another one than before.
bus.on("live", (open) => {
  if (!open) return;
  readInto("info", "/api/info");
  readInto("config", "/api/config");
  readInto("log", "/api/log?n=200");
});
// A set, save or reload by anybody changes the values that are in use.
let set = "";
bus.on("status", (status) => {
  const now = JSON.stringify(status.set ?? null);
  if (now !== set) readInto("config", "/api/config");
  set = now;
});

// For tests and for people at the console.
Object.assign(window, { heel: { bus, live, channel, emergencyStop } });
