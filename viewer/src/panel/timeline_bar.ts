import { clock } from "../base/format";
import type { Command, Timeline } from "../protocol/messages";
import { byId, make, setText } from "./dom";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5] as const;
/** ms between two Seeks while the slider is dragged. */
const kScrub = 50;

/** A recording that is played: where it is, where the crack ran on, how fast. */
export class TimelineBar {
  private readonly bar = byId("timeline", HTMLDivElement);
  private readonly button = make("button", { type: "button", id: "replay-play" });
  private readonly slider = make("input", { type: "range", id: "replay-time", min: "0", step: "0.001" });
  private readonly marks = make("div", { className: "marks", ariaHidden: "true" });
  private readonly time = make("output", { className: "clock" });
  private readonly speed = make("select", { id: "replay-speed" });
  private timeline: Timeline | null = null;
  private heardAt = 0; // ms
  private isDragged = false;
  private soughtAt = 0; // ms

  constructor(private readonly send: (command: Command) => void) {
    this.speed.append(...kSpeeds.map((speed) => make("option", { value: String(speed), textContent: `${speed} ×`, selected: speed === 1 })));
    this.speed.setAttribute("aria-label", "Speed");
    this.slider.setAttribute("aria-label", "Time of the recording");
    this.bar.append(this.button, make("div", { className: "track" }, this.slider, this.marks), this.time, this.speed);
    this.button.addEventListener("click", () => this.toggle());
    this.speed.addEventListener("change", () => this.play(this.timeline?.playing ?? false));
    this.slider.addEventListener("input", () => this.scrub());
    this.slider.addEventListener("change", () => this.endScrub());
  }

  hear(timeline: Timeline): void {
    const isOther = this.timeline?.duration !== timeline.duration || this.timeline.marks.length !== timeline.marks.length;
    this.timeline = timeline;
    this.heardAt = performance.now();
    this.bar.hidden = false;
    this.slider.max = String(timeline.duration);
    if (isOther) this.drawMarks(timeline);
    for (const option of this.speed.options) option.selected = Number(option.value) === timeline.speed;
    setText(this.button, timeline.playing ? "Pause" : "Play");
    this.tick();
  }

  /** Between two Timelines the clock runs on by itself. */
  tick(): void {
    const timeline = this.timeline;
    if (timeline === null || this.isDragged) return;
    const since = timeline.playing ? ((performance.now() - this.heardAt) / 1000) * timeline.speed : 0;
    this.showTime(Math.min(timeline.duration, timeline.time + since), timeline.duration);
  }

  toggle(): void {
    const timeline = this.timeline;
    if (timeline === null) return;
    // From the end there is nowhere to go but to the start.
    if (!timeline.playing && timeline.time >= timeline.duration) this.send({ kind: "seek", time: 0 });
    this.play(!timeline.playing);
  }

  set isHidden(on: boolean) {
    this.bar.hidden = on;
  }

  set isEnabled(on: boolean) {
    for (const control of [this.button, this.slider, this.speed]) control.disabled = !on;
  }

  private play(on: boolean): void {
    this.send({ kind: "play", on, speed: Number(this.speed.value) });
  }

  private scrub(): void {
    this.isDragged = true;
    this.showTime(Number(this.slider.value), this.timeline?.duration ?? 0, false);
    const now = performance.now();
    if (now - this.soughtAt < kScrub) return;
    this.soughtAt = now;
    this.send({ kind: "seek", time: Number(this.slider.value) });
  }

  private endScrub(): void {
    this.isDragged = false;
    this.send({ kind: "seek", time: Number(this.slider.value) });
  }

  private showTime(time: number, duration: number, moves = true): void {
    if (moves) this.slider.value = String(time);
    const text = `${clock(time)} / ${clock(duration)}`;
    setText(this.time, text);
    this.slider.setAttribute("aria-valuetext", text);
  }

  private drawMarks(timeline: Timeline): void {
    this.marks.replaceChildren(
      ...timeline.marks.map((time) => {
        const mark = make("i", { title: `advance at ${clock(time)}` });
        mark.style.left = `${(100 * time) / Math.max(timeline.duration, 1e-9)}%`;
        return mark;
      }),
    );
  }
}
