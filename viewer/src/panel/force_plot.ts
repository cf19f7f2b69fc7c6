import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import { kTraceSeconds, type ForceTrace } from "../session/trace";

/** Of the trace that are drawn; more than there are pixels is of no use. */
const kPoints = 500;
/** ms between two drawings: what the eye reads off a plot. */
const kEvery = 60;
const kHeight = 150; // px

const cssColour = (name: string) => (): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Force over the last seconds: its size, thinner its components, and that of another response; the advances as upright lines. */
export class ForcePlot {
  private readonly plot: uPlot;
  private advances: readonly number[] = []; // s
  private limit = 0; // N
  private drawnAt = 0;

  constructor(private readonly frame: HTMLElement) {
    const thin = (label: string, colour: string): uPlot.Series => ({ label, stroke: cssColour(colour), width: 1, points: { show: false } });
    const axis = (): uPlot.Axis => ({
      stroke: cssColour("--quiet"),
      grid: { stroke: cssColour("--line"), width: 1 },
      ticks: { stroke: cssColour("--line"), width: 1, size: 4 },
      font: "11px system-ui, sans-serif",
    });
    this.plot = new uPlot(
      {
        width: Math.max(200, frame.clientWidth),
        height: kHeight,
        legend: { show: false },
        cursor: { show: false },
        padding: [8, 8, 0, 0],
        scales: { x: { time: false }, y: { range: (_, least, most) => this.range(least, most) } },
        axes: [
          // Time from now, which stands at the right.
          { ...axis(), size: 28, values: (plot, ticks) => ticks.map((t) => `${Math.round(t - (plot.scales["x"]?.max ?? 0)) || 0} s`), splits: (plot) => this.seconds(plot) },
          { ...axis(), size: 48, values: (_, ticks) => ticks.map((n) => `${Math.round(n * 100) / 100} N`) },
        ],
        series: [{}, thin("x", "--x"), thin("y", "--y"), thin("z", "--z"), { label: "force", stroke: cssColour("--force"), width: 2, points: { show: false } }, { label: "compared", stroke: cssColour("--compared"), width: 2, dash: [6, 3], points: { show: false } }],
        hooks: { drawClear: [(plot) => this.drawMarks(plot)] },
      },
      [[0], [0], [0], [0], [0], [0]],
      frame,
    );
    const canvas = frame.querySelector("canvas");
    canvas?.setAttribute("role", "img");
    canvas?.setAttribute("aria-label", `Force on the hand over the last ${kTraceSeconds} seconds: its size and its components along x, y and z`);
    new ResizeObserver(() => this.plot.setSize({ width: Math.max(200, frame.clientWidth), height: kHeight })).observe(frame);
  }

  /** `own` is drawn in the place of the length of `trace` where it is known: as little cut as `compared`. */
  show(trace: ForceTrace, own: ForceTrace, compared: ForceTrace, advances: readonly number[], limit: number, force = false): void {
    const now = performance.now();
    if (!force && (now - this.drawnAt < kEvery || this.frame.clientWidth === 0)) return;
    this.drawnAt = now;
    this.advances = advances;
    this.limit = limit;
    const columns = trace.columns(kPoints);
    const end = trace.time;
    // uPlot leaves a gap for null, and takes NaN for a number.
    const gaps = (column: Float64Array) => Array.from(column, (value) => (Number.isNaN(value) ? null : value));
    const at = (other: ForceTrace) => other.columns(kPoints, trace.endTick).size;
    const size = at(own).map((value, k) => (Number.isNaN(value) ? (columns.size[k] ?? NaN) : value));
    const data = [Array.from(columns.time), ...columns.along.map(gaps), gaps(size), gaps(at(compared))] as uPlot.AlignedData;
    this.plot.setData(data, false);
    this.plot.batch(() => {
      this.plot.setScale("x", { min: end - kTraceSeconds, max: end });
    });
  }

  /** In other colours. */
  repaint(): void {
    this.plot.redraw();
  }

  private range(least: number | null, most: number | null): [number, number] {
    const high = Math.max(0.1, most ?? 0);
    return [Math.min(0, (least ?? 0) * 1.1), high * 1.1];
  }

  /** Every two seconds before now. */
  private seconds(plot: uPlot): number[] {
    const end = plot.scales["x"]?.max ?? 0;
    return [-10, -8, -6, -4, -2, 0].map((s) => end + s);
  }

  private drawMarks(plot: uPlot): void {
    const { ctx: pen, bbox: box } = plot;
    pen.save();
    pen.lineWidth = 1;
    pen.strokeStyle = cssColour("--tear")();
    const { min = 0, max = 0 } = plot.scales["x"] ?? {};
    for (const time of this.advances) {
      if (time < min || time > max) continue;
      const x = Math.round(plot.valToPos(time, "x", true)) + 0.5;
      pen.beginPath();
      pen.moveTo(x, box.top);
      pen.lineTo(x, box.top + box.height);
      pen.stroke();
    }
    const top = plot.scales["y"]?.max ?? 0;
    if (this.limit > 0 && this.limit <= top) {
      const y = Math.round(plot.valToPos(this.limit, "y", true)) + 0.5;
      pen.strokeStyle = cssColour("--quiet")();
      pen.setLineDash([4, 4]);
      pen.beginPath();
      pen.moveTo(box.left, y);
      pen.lineTo(box.left + box.width, y);
      pen.stroke();
    }
    pen.restore();
  }
}
