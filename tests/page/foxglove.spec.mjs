// /foxglove by the client of the protocol's authors: channels, schemas, parameters, a viewer that does not read, and the layout file
// that is shipped. No browser takes part.

import foxglove from "@foxglove/ws-protocol";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import WebSocket from "ws";
import { expect, test } from "./page_fixture.mjs";
import { eventually, kToken } from "./walk.mjs";

const kProtocols = ["foxglove.websocket.v1", "foxglove.sdk.v1"];
const kTopics = ["/heel/tick", "/heel/pose", "/log", "/camera", "/tf", "/person"];
const kLayout = JSON.parse(readFileSync(fileURLToPath(new URL("../../config/foxglove/heel-layout.json", import.meta.url)), "utf8"));

/** A viewer that keeps the newest of everything. */
class Viewer {
  channels = new Map();
  newest = new Map();
  counts = new Map();
  parameters = new Map();
  statuses = [];

  static async open(walk, { protocol = kProtocols[0], token = "" } = {}) {
    const viewer = new Viewer();
    const query = token ? `?token=${encodeURIComponent(token)}` : "";
    viewer.socket = new WebSocket(`${walk.address.replace("http", "ws")}/foxglove${query}`, [protocol]);
    viewer.client = new foxglove.FoxgloveClient({ ws: viewer.socket });
    viewer.client.on("error", (error) => viewer.statuses.push({ message: String(error) }));
    viewer.client.on("serverInfo", (info) => (viewer.info = info));
    viewer.client.on("status", (status) => viewer.statuses.push(status));
    viewer.client.on("advertise", (channels) => channels.forEach((one) => viewer.channels.set(one.topic, one)));
    viewer.client.on("parameterValues", ({ parameters }) => parameters.forEach((one) => viewer.parameters.set(one.name, one.value)));
    viewer.client.on("message", ({ subscriptionId, timestamp, data }) => {
      const topic = viewer.topics.get(subscriptionId);
      viewer.newest.set(topic, { t_ns: timestamp, text: data });
      viewer.counts.set(topic, (viewer.counts.get(topic) ?? 0) + 1);
    });
    await eventually(() => viewer.info && viewer.channels.size === kTopics.length, `${protocol}: server and channels`);
    return viewer;
  }

  topics = new Map();

  subscribe(topics = kTopics) {
    for (const topic of topics) this.topics.set(this.client.subscribe(this.channels.get(topic).id), topic);
  }

  message(topic) {
    const newest = this.newest.get(topic);
    return newest && JSON.parse(new TextDecoder().decode(newest.text));
  }

  value(name) {
    this.parameters.delete(name);
    this.client.getParameters([name]);
    return eventually(() => this.parameters.get(name), name);
  }

  close() {
    this.socket.terminate();
  }
}

const viewers = [];
async function open(walk, options) {
  viewers.push(await Viewer.open(walk, options));
  return viewers.at(-1);
}
test.afterEach(() => viewers.splice(0).forEach((viewer) => viewer.close()));

/** The kilobytes of memory that heeld has. */
function resident_kB(walk) {
  const { pid } = walk.processes.get("heeld").child;
  return Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);
}

/** Why a message does not fit a schema; empty: it fits. */
function misfit(schema, value, path = "") {
  const is = Array.isArray(value) ? "array" : value === null ? "null" : Number.isInteger(value) ? "integer" : typeof value;
  const types = schema.type === undefined ? [] : [schema.type].flat();
  if (types.length > 0 && !types.includes(is) && !(is === "integer" && types.includes("number"))) return `${path}: ${is}, not ${types}`;
  for (const name of schema.required ?? []) if (!(name in value)) return `${path}.${name}: missing`;
  for (const [name, inner] of Object.entries(schema.properties ?? {})) {
    const why = name in (value ?? {}) ? misfit(inner, value[name], `${path}.${name}`) : "";
    if (why) return why;
  }
  for (const one of is === "array" && schema.items ? value : []) {
    const why = misfit(schema.items, one, `${path}[]`);
    if (why) return why;
  }
  return "";
}

test.describe("Foxglove", () => {
  for (const protocol of kProtocols) {
    test(`connects as ${protocol} and reads channels, schemas and parameters`, async ({ walk }) => {
      const viewer = await open(walk, { protocol });
      expect(viewer.socket.protocol).toBe(protocol);
      expect(viewer.info.capabilities).toEqual(["parameters", "parametersSubscribe"]);
      expect([...viewer.channels.keys()].sort()).toEqual([...kTopics].sort());
      viewer.subscribe();
      await eventually(() => ["/heel/tick", "/heel/pose", "/camera", "/tf"].every((topic) => viewer.newest.has(topic)), "a message of each");
      for (const topic of viewer.newest.keys()) {
        const { encoding, schemaEncoding, schema } = viewer.channels.get(topic);
        expect([encoding, schemaEncoding]).toEqual(["json", "jsonschema"]);
        expect(misfit(JSON.parse(schema), viewer.message(topic)), topic).toBe("");
      }
      expect(viewer.channels.get("/camera").schemaName).toBe("foxglove.CompressedImage");
      expect(await viewer.value("control.gain_yaw_1_s")).toBe(0.82);
      viewer.client.getParameters([]);
      await eventually(() => viewer.parameters.size > 50, "every key");
      expect(viewer.statuses).toEqual([]);
    });
  }

  test("another sub-protocol is refused", async ({ walk }) => {
    const socket = new WebSocket(`${walk.address.replace("http", "ws")}/foxglove`, ["foxglove.websocket.v0"]);
    const error = await new Promise((done) => socket.once("error", done));
    expect(String(error)).toContain("Unexpected server response: 4");
  });

  test("a parameter is set with the token only, within its bounds", async ({ walk }) => {
    const reader = await open(walk);
    const writer = await open(walk, { token: kToken });
    const stranger = await open(walk, { token: "not the token of this robot" });
    reader.client.subscribeParameterUpdates([]);
    for (const viewer of [reader, stranger]) {
      viewer.client.setParameters([{ name: "control.gain_yaw_1_s", value: 0.5 }]);
      await eventually(() => viewer.statuses.some((one) => one.message.includes("token")), "a refusal");
      expect(await viewer.value("control.gain_yaw_1_s")).toBe(0.82);
    }
    writer.client.setParameters([{ name: "control.gain_yaw_1_s", value: 0.5 }], "mine");
    await eventually(() => reader.parameters.get("control.gain_yaw_1_s") === 0.5, "the reader gets the change");
    writer.client.setParameters([{ name: "control.gain_yaw_1_s", value: 11 }]);
    await eventually(() => writer.statuses.some((one) => one.message.includes("expected")), "a refusal with the range");
    expect(await writer.value("control.gain_yaw_1_s")).toBe(0.5);
    writer.client.setParameters([{ name: "control.gain_yaw_1_s", value: 0.82 }]);
    await eventually(() => reader.parameters.get("control.gain_yaw_1_s") === 0.82, "as in the file again");
  });

  test("a viewer that does not read costs a bounded amount, and gets the newest when it reads again", async ({ walk }) => {
    const reader = await open(walk), sleeper = await open(walk);
    reader.subscribe(["/heel/tick"]);
    sleeper.subscribe();
    await eventually(() => sleeper.newest.has("/camera"), "pictures");
    const before_kB = resident_kB(walk), ticks = reader.counts.get("/heel/tick") ?? 0;
    sleeper.socket.pause();
    await new Promise((done) => setTimeout(done, 6000));
    expect(resident_kB(walk) - before_kB, "kB that heeld has grown").toBeLessThan(6000);
    expect(reader.counts.get("/heel/tick") - ticks, "ticks for the other viewer").toBeGreaterThan(30);
    sleeper.socket.resume();
    await eventually(() => {
      if (sleeper.socket.readyState !== WebSocket.OPEN) return true;  // closed is a bound as well
      const newest = sleeper.newest.get("/heel/tick");
      return Number(BigInt(Date.now()) * 1000000n - newest.t_ns) < 1e9;
    }, "a tick that is less than a second old");
  });

  test("the layout that is shipped names topics and fields that exist", async ({ walk }) => {
    const panels = new Set();
    const collect = (node) => (typeof node === "string" ? panels.add(node) : [node.first, node.second].forEach(collect));
    collect(kLayout.layout);
    expect([...panels].sort()).toEqual(Object.keys(kLayout.configById).sort());
    const viewer = await open(walk);
    viewer.subscribe();
    await eventually(() => ["/heel/tick", "/heel/pose"].every((topic) => viewer.newest.has(topic)), "messages");
    const panel = Object.values(kLayout.configById);
    const topics = panel.flatMap((one) => [one.imageMode?.imageTopic, one.topicToRender, ...Object.keys(one.topics ?? {})]).filter(Boolean);
    expect(topics.sort()).toEqual(["/camera", "/log", "/person"]);
    topics.forEach((topic) => expect(viewer.channels.has(topic), topic).toBe(true));
    const paths = panel.flatMap((one) => (one.paths ?? []).map((path) => path.value));
    expect(paths.length).toBeGreaterThan(8);
    for (const path of paths) {
      const [topic, ...fields] = path.split(".");
      const value = fields.reduce((object, field) => object?.[field], viewer.message(topic));
      expect(value, path).toBeDefined();
    }
  });
});
