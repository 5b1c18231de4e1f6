// heel-sim and heeld for the tests of the page: a person who walks slowly ahead, a taught shirt, a page with a token.

import { execFileSync, spawn } from "node:child_process";
import { chmodSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const kSource = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const kPrograms = join(process.env.HEEL_BUILD_DIR ?? join(kSource, "build/release"), "bin");
const kTeach_m = 1.5;
export const kToken = "a token of the tests of the page";

/** Slow enough that the robot can catch up after each test that has stopped it. */
const kScenario = `name = "page"
seed = 3
duration_s = 600.0
[person]
shirt = "bold"
walk_after_s = 4.0
[[person.path]]
step = "straight"
length_m = 40.0
speed_m_s = 0.2
[camera]
mount_x_m = 0.15
mount_z_m = 1.1
[robot]
x_m = -1.8
[room]
objects = 30
`;

function freePort() {
  return new Promise((done, fail) => {
    const server = createServer();
    server.once("error", fail);
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });
}

export async function eventually(condition, what, wait_ms = 120_000) {
  const end = Date.now() + wait_ms;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${wait_ms / 1000} s: ${what}`);
    await new Promise((done) => setTimeout(done, 25));
  }
}

/** CLOCK_MONOTONIC in seconds, the clock of heel-sim's file of bytes. */
export const monotonic_s = () => Number(process.hrtime.bigint()) * 1e-9;

export class Walk {
  folder = mkdtempSync(join(tmpdir(), "heel-page-"));
  processes = new Map();

  path(name) {
    return join(this.folder, name);
  }

  async begin() {
    this.port = await freePort();
    this.address = `http://127.0.0.1:${this.port}`;
    this.config = this.path("heel.toml");
    writeFileSync(this.path("walk.toml"), kScenario);
    const still = execFileSync(join(kPrograms, "heel-sim"), ["--scenario", this.path("walk.toml"), "--still", this.path("reference.png"),
      "--distance", String(kTeach_m), "--camera-info-out", this.path("camera.yaml")], { encoding: "utf8" });
    this.region = /roi=([\d,]+)/.exec(still)[1];
    execFileSync(join(kPrograms, "heel"), ["teach", "--image", this.path("reference.png"), "--roi", this.region, "--distance", String(kTeach_m),
      "--camera-info", this.path("camera.yaml"), "--reach-time", "0", "-o", this.path("shirt.heel")], { stdio: "ignore" });
    writeFileSync(this.path("token"), `${kToken}\n`);
    chmodSync(this.path("token"), 0o600);
    this.writeConfig();
    this.spawn("heel-sim", ["--scenario", this.path("walk.toml"), "--live-faults", "--robot", `pty:${this.path("robot")}`, "--camera", this.camera,
      "--truth", this.path("truth.csv"), "--wire", this.path("wire.txt")]);
    await eventually(() => existsSync(this.path("robot")), "heel-sim has its pty");
    await this.startDaemon();
  }

  get camera() {
    return `sim:page-${process.pid}`;
  }

  writeConfig() {
    writeFileSync(this.config, `# The configuration of the tests of the page.
[camera]
source = "${this.camera}"
info = "camera.yaml"
mount_z_m = 1.1
[target]
shirt = "shirt.heel"
[control]
# This comment stays when the value below is saved.
gain_yaw_1_s = 0.82
[robot]
address = "pty:robot"
sync_retry_s = 0.2
reconnect_s = 0.2
[operator]
socket = "control.sock"
[view]
address = "127.0.0.1:${this.port}"
token_file = "token"
[supervisor]
# The tests of a busy machine do not test its lateness.
lateness_max_s = 2.0
[telemetry]
black_box = ""
[runtime]
realtime = false
`);
  }

  spawn(name, args, env = {}) {
    const child = spawn(join(kPrograms, name), args, { env: { ...process.env, ...env }, stdio: ["pipe", "pipe", "pipe"] });
    const entry = { child, log: "" };
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (entry.log += text));
    this.processes.set(name, entry);
    return entry;
  }

  /** What happens to the robot now, as heel-sim --live-faults reads it. */
  fault(line) {
    this.processes.get("heel-sim").child.stdin.write(`${line}\n`);
  }

  async startDaemon() {
    const heeld = this.spawn("heeld", ["--config", this.config], { HEEL_PAGE_DIR: join(kSource, "src/operator/page") });
    await eventually(() => {
      if (heeld.child.exitCode !== null) throw new Error(`heeld has ended:\n${heeld.log}`);
      return heeld.log.includes("the first frame has arrived");
    }, "heeld has robot and camera").catch((error) => {
      throw new Error(`${error.message}\n${heeld.log}`);
    });
  }

  async end(name, signal = "SIGTERM") {
    const entry = this.processes.get(name);
    if (!entry) return;
    this.processes.delete(name);
    const ended = new Promise((done) => entry.child.once("exit", done));
    if (entry.child.exitCode === null && entry.child.kill(signal)) await ended;
  }

  async endAll() {
    await this.end("heeld");
    await this.end("heel-sim");
    rmSync(this.folder, { recursive: true, force: true });
  }

  /** The file's text, for what has been saved. */
  savedConfig() {
    return readFileSync(this.config, "utf8");
  }

  /** When the first command to stand still came to the robot after `from_s`: VEL with the argument 0. Undefined: not yet. */
  firstZero_s(from_s) {
    for (const line of readFileSync(this.path("wire.txt"), "utf8").split("\n")) {
      const [t_s, ...bytes] = line.split(/\s+/);
      if (Number(t_s) < from_s) continue;
      if (/fafb060b3b0000/i.test(bytes.join(""))) return Number(t_s);
    }
    return undefined;
  }

  /** The robot's true speed now. */
  speed_m_s() {
    const rows = readFileSync(this.path("truth.csv"), "utf8").split("\n");
    const column = rows[0].split(",").indexOf("robot_v_m_s");
    return Number(rows[rows.length - 2].split(",")[column]);
  }
}
