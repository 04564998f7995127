// Gap, normal velocity and rotation in time, with events; the pinned state's behind them.
import uPlot from "uplot";
import { short } from "./text";
import type { Trajectory } from "./trajectory";

const SCALES: [number, string][] = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
const PANELS = [
  { column: "gap", label: "gap", unit: "m", factor: 1 },
  { column: "velocity", label: "gap rate", unit: "m/s", factor: 1 },
  { column: "rotation", label: "rotation", unit: "°", factor: 180 / Math.PI },
] as const;
const HEIGHT = 118;

/** The font of canvases at a part of the page's size. */
export const font = (part: number, weight = ""): string => `${weight} ${(part * parseFloat(getComputedStyle(document.body).fontSize)).toFixed(1)}px system-ui, sans-serif`;
export const css = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** The factor and prefix in which numbers up to `most` are written. */
function prefix(most: number): [number, string] {
  return SCALES.find(([factor]) => most >= factor) ?? [1, ""];
}

export class Curves {
  private plots: uPlot[] = [];
  private heads: HTMLElement[] = [];
  private path: Trajectory | null = null;
  private pinned: Trajectory | null = null;
  private stretched = true;
  private unit = 1;

  constructor(
    private readonly parent: HTMLElement,
    private readonly onTime: (time: number) => void,
  ) {
    new ResizeObserver(() => this.draw()).observe(parent);
  }

  show(path: Trajectory | null, pinned: Trajectory | null, stretched: boolean): void {
    [this.path, this.pinned, this.stretched] = [path, pinned, stretched];
    this.draw();
  }

  draw(): void {
    const { path, pinned } = this;
    const width = this.parent.clientWidth;
    this.plots.forEach((each) => each.destroy());
    [this.plots, this.heads] = [[], []];
    if (!path || !width) return;
    const end = Math.max(path.end, pinned?.end ?? 0);
    const [unit, letter] = prefix(end);
    this.unit = unit;
    const tau = Math.min(path.tau, end / 2);
    const panels = PANELS.filter((each) => each.column !== "rotation" || path.geometry.partner); // beside a wall nothing turns
    this.plots = panels.map((panel, k) => {
      const most = Math.max(...path.columns[panel.column].map(Math.abs), 1e-300);
      const [scale, small] = panel.unit === "°" ? [1 / panel.factor, ""] : prefix(most);
      const tables = [path, ...(pinned ? [pinned] : [])].map(
        (each) => [each.columns.time.map((t) => t / unit), each.columns[panel.column].map((v) => v / scale)] as uPlot.AlignedData,
      );
      const data = tables.length > 1 ? uPlot.join(tables) : tables[0]!;
      const last = k === panels.length - 1;
      const axis = { stroke: () => css("--soft"), grid: { stroke: () => css("--line"), width: 1 }, ticks: { show: false }, font: font(0.8) };
      const plot = new uPlot(
        {
          width,
          height: HEIGHT + (last ? 30 : 0),
          title: `${panel.label}, ${small}${panel.unit}`,
          legend: { show: false },
          cursor: { show: false },
          select: { show: false, left: 0, top: 0, width: 0, height: 0 },
          scales: {
            x: { time: false, range: [0, end / unit], ...(this.stretched ? { distr: 4, asinh: tau / unit } : {}) },
          },
          axes: [
            { ...axis, ...(this.stretched ? { splits: () => decades(tau / unit, end / unit), filter: (_: uPlot, splits: number[]) => splits } : {}), size: last ? 26 : 8, values: last ? (_, splits) => splits.map((each) => short(each)) : () => [], label: last ? `time, ${letter}s` : undefined, labelSize: 16, labelFont: axis.font },
            { ...axis, size: 54, space: 26 },
          ],
          series: [{}, { stroke: () => css("--accent"), width: 2, spanGaps: true, points: { show: false } }, ...(pinned ? [{ stroke: () => css("--pin"), width: 2, dash: [6, 4], spanGaps: true, points: { show: false } }] : [])],
          hooks: { draw: [(u) => this.drawEvents(u, path)] },
        },
        data,
        this.parent,
      );
      const head = document.createElement("div");
      head.className = "head";
      plot.over.append(head);
      this.heads.push(head);
      plot.over.addEventListener("pointerdown", (event) => this.pick(plot, event));
      plot.over.addEventListener("pointermove", (event) => event.buttons && this.pick(plot, event));
      return plot;
    });
  }

  private pick(plot: uPlot, event: PointerEvent): void {
    const left = event.clientX - plot.over.getBoundingClientRect().left;
    this.onTime(Math.max(plot.posToVal(left, "x"), 0) * this.unit);
  }

  private drawEvents(plot: uPlot, path: Trajectory): void {
    const context = plot.ctx;
    context.save();
    context.strokeStyle = css("--soft");
    context.setLineDash([2, 4]);
    context.beginPath();
    for (const event of path.events) {
      const x = plot.valToPos(event.time / this.unit, "x", true);
      context.moveTo(x, plot.bbox.top);
      context.lineTo(x, plot.bbox.top + plot.bbox.height);
    }
    context.stroke();
    context.restore();
  }

  /** Moves the line of the present time. */
  mark(time: number): void {
    this.plots.forEach((plot, k) => (this.heads[k]!.style.left = `${plot.valToPos(Math.min(time, this.path!.end) / this.unit, "x")}px`));
  }

  get canvases(): HTMLCanvasElement[] {
    return this.plots.map((each) => each.ctx.canvas);
  }
}

/** Zero and the powers of ten between two times; with their halves and fifths where these are few. */
function decades(from: number, to: number): number[] {
  const [first, last] = [Math.floor(Math.log10(from)), Math.floor(Math.log10(to))];
  const parts = last - first > 1 ? [1] : [1, 2, 5];
  const times = Array.from({ length: last - first + 1 }, (_, k) => parts.map((part) => part * 10 ** (first + k))).flat();
  return [0, ...times.filter((each) => each >= from && each <= to)];
}
