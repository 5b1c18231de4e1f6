// The live picture. The newest wins: one picture is decoded at a time, and an older one is never drawn after a newer one.

import { byId, fitCanvas, setText } from "./dom.js";
import { drawPose } from "./picture_overlay.js";

const kPosesKept = 60;
const kAge_ms = 200;
/** So old a picture is marked as one that stands still. */
const kStale_ms = 1500;
const kSpoken_ms = 2000;

export class PictureView {
  #canvas = /** @type {HTMLCanvasElement} */ (byId("picture"));
  #context = /** @type {CanvasRenderingContext2D} */ (this.#canvas.getContext("2d"));
  #stale = byId("picture-stale");
  /** @type {Map<number, import("./messages.js").Pose>} */
  #poses = new Map();
  /** @type {import("./messages.js").Picture | null} */
  #shown = null;
  /** @type {ImageBitmap | null} */
  #bitmap = null;
  /** @type {import("./messages.js").Picture | null} the newest that waits for the decoder */
  #next = null;
  #decoding = false;
  #inView = false;
  #spoken_ms = 0;

  /**
   * @param {import("./bus.js").Bus} bus gets drawn: {frame, t_s, drawn_ms, age_ms} for each picture on the screen
   * @param {import("./live_connection.js").LiveConnection} live
   */
  constructor(bus, live) {
    this.bus = bus;
    this.live = live;
    bus.on("picture", (picture) => {
      this.#next = picture;
      if (!this.#decoding) this.#decode();
    });
    bus.on("pose", (pose) => this.#takePose(pose));
    bus.on("live", (open) => {
      // A daemon that has started again counts its frames from the beginning.
      if (open) this.#poses.clear();
      if (open) this.#shown = null;
    });
    new IntersectionObserver((entries) => {
      this.#inView = entries.some((entry) => entry.isIntersecting);
      this.#wantPictures();
    }).observe(this.#canvas);
    document.addEventListener("visibilitychange", () => this.#wantPictures());
    new ResizeObserver(() => this.#draw()).observe(this.#canvas);
    setInterval(() => this.#showAge(), kAge_ms);
  }

  #wantPictures() {
    this.live.wantPictures(this.#inView && document.visibilityState === "visible");
  }

  async #decode() {
    this.#decoding = true;
    while (this.#next) {
      const picture = this.#next;
      this.#next = null;
      try {
        const bitmap = await createImageBitmap(picture.jpeg);
        const late = this.#shown !== null && picture.head.frame <= this.#shown.head.frame;
        if (late) bitmap.close();
        else this.#show(picture, bitmap);
      } catch {
        // A damaged picture is left out; the next one is asked for all the same.
      }
      this.live.pictureShown(picture.head.frame);
    }
    this.#decoding = false;
  }

  /**
   * @param {import("./messages.js").Picture} picture
   * @param {ImageBitmap} bitmap
   */
  #show(picture, bitmap) {
    this.#bitmap?.close();
    this.#bitmap = bitmap;
    this.#shown = picture;
    this.#draw();
    const drawn_ms = performance.now();
    this.bus.emit("drawn", {
      frame: picture.head.frame, t_s: picture.head.t_s, drawn_ms, age_ms: picture.head.age_ms + drawn_ms - picture.received_ms });
    this.#stale.hidden = true;
  }

  /** @param {import("./messages.js").Pose} pose */
  #takePose(pose) {
    this.#poses.set(pose.frame, pose);
    if (this.#poses.size > kPosesKept) this.#poses.delete(/** @type {number} */ (this.#poses.keys().next().value));
    this.#showFound(pose);
    if (pose.frame === this.#shown?.head.frame) this.#draw();
  }

  #draw() {
    if (!this.#bitmap || !this.#shown) return;
    const { full_width, full_height, frame } = this.#shown.head;
    this.#canvas.style.aspectRatio = `${full_width} / ${full_height}`;
    const px = fitCanvas(this.#canvas);
    const scale = Math.min(this.#canvas.width / full_width, this.#canvas.height / full_height);
    if (!(scale > 0)) return;
    const context = this.#context;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
    context.translate((this.#canvas.width - full_width * scale) / 2, (this.#canvas.height - full_height * scale) / 2);
    context.scale(scale, scale);
    context.drawImage(this.#bitmap, 0, 0, full_width, full_height);
    const pose = this.#poses.get(frame);
    if (pose) drawPose(context, pose, px / scale);
  }

  /** @param {import("./messages.js").Pose} pose */
  #showFound(pose) {
    const found = byId("picture-found");
    const distance = pose.found && pose.position_m ? `, ${pose.position_m[2].toFixed(2)} m` : "";
    setText(found, pose.found ? `shirt found${distance}` : `not found: ${pose.reason}`);
    found.dataset.found = String(pose.found);
    byId("certainty").value = pose.certainty;
    setText(byId("certainty-value"), pose.certainty.toFixed(2));
    const now_ms = performance.now();
    if (now_ms - this.#spoken_ms < kSpoken_ms) return;
    this.#spoken_ms = now_ms;
    this.#canvas.setAttribute("aria-label", `Picture of the robot's camera: ${found.textContent}, certainty ${pose.certainty.toFixed(2)}`);
  }

  #showAge() {
    const age = byId("picture-age");
    if (!this.#shown) {
      setText(age, "not yet come");
      return;
    }
    const age_ms = this.#shown.head.age_ms + performance.now() - this.#shown.received_ms;
    const stale = age_ms > kStale_ms;
    setText(age, age_ms < 1000 ? `${Math.round(age_ms / 10) * 10} ms old` : `${(age_ms / 1000).toFixed(1)} s old`);
    this.#stale.hidden = !stale;
    if (stale) setText(this.#stale, `This picture is ${(age_ms / 1000).toFixed(0)} s old`);
  }
}
