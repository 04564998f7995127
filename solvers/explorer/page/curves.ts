// Gap, normal velocity and rotation in time, with events; the pinned state's behind them.
import uPlot from "uplot";
import { short } from "./text";
import type { Trajectory } from "./trajectory";

const SCALES: [number, string][] = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
const PANELS = [
  { column: "gap", label: "gap", unit: "m", factor: 1 },
  { column: "velocity", label: "gap rate (below 0: closing)", unit: "m/s", factor: 1 },
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
  private end = 1;
  private tau = 1;
  private shape = "";

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
    const panels = path && width ? PANELS.filter((each) => each.column !== "rotation" || path.geometry.partner) : []; // beside a wall nothing turns
    const shape = `${panels.length} ${width} ${this.stretched} ${!!pinned} ${font(1)}`;
    if (shape !== this.shape || !path) {
      this.plots.forEach((each) => each.destroy());
      this.heads = [];
      this.plots = panels.map((_, k) => this.make(k, width, k === panels.length - 1));
      this.shape = shape;
    }
    if (!path) return;
    this.end = Math.max(path.end, pinned?.end ?? 0);
    const [unit, letter] = prefix(this.end);
    [this.unit, this.tau] = [unit, Math.min(path.tau, this.end / 2)];
    panels.forEach((panel, k) => {
      const plot = this.plots[k]!;
      const most = path.columns[panel.column].reduce((all, each) => Math.max(all, Math.abs(each)), 1e-300);
      const [scale, small] = panel.unit === "°" ? [1 / panel.factor, ""] : prefix(most);
      const tables = [path, ...(pinned ? [pinned] : [])].map(
        (each) => [each.columns.time.map((t) => t / unit), each.columns[panel.column].map((v) => v / scale)] as uPlot.AlignedData,
      );
      plot.root.querySelector(".u-title")!.textContent = `${panel.label}, ${small}${panel.unit}`;
      plot.axes[0]!.label = k === panels.length - 1 ? `time, ${letter}s${this.stretched ? ` (stretched: logarithmic beyond ${short(this.tau / unit)})` : ""}` : undefined!;
      plot.scales.x!.asinh = this.tau / unit;
      plot.setData(tables.length > 1 ? uPlot.join(tables) : tables[0]!);
    });
  }

  private make(k: number, width: number, last: boolean): uPlot {
    const axis = { stroke: () => css("--soft"), grid: { stroke: () => css("--line"), width: 1 }, ticks: { show: false }, font: font(0.8) };
    const line = (name: string, dash?: number[]): uPlot.Series => ({ stroke: () => css(name), width: 2, spanGaps: true, points: { show: false }, ...(dash ? { dash } : {}) });
    const ticks = { splits: () => decades(this.tau / this.unit, this.end / this.unit), filter: (_: uPlot, splits: number[]) => splits };
    const plot = new uPlot(
      {
        width,
        height: HEIGHT + (last ? 30 : 0),
        title: " ",
        legend: { show: false },
        cursor: { show: false },
        select: { show: false, left: 0, top: 0, width: 0, height: 0 },
        scales: { x: { time: false, range: () => [0, this.end / this.unit], ...(this.stretched ? { distr: 4, asinh: 1 } : {}) } },
        axes: [
          { ...axis, ...(this.stretched ? ticks : {}), size: last ? 26 : 8, values: last ? (_, splits) => splits.map((each) => short(each)) : () => [], ...(last ? { label: " ", labelSize: 16, labelFont: axis.font } : {}) },
          { ...axis, size: 54, space: 26 },
        ],
        series: [{}, line("--accent"), ...(this.pinned ? [line("--pin", [6, 4])] : [])],
        hooks: { draw: [(u) => this.path && this.drawEvents(u, this.path)] },
      },
      this.pinned ? [[], [], []] : [[], []],
      this.parent,
    );
    const head = document.createElement("div");
    head.className = "head";
    plot.over.append(head);
    this.heads[k] = head;
    plot.over.addEventListener("pointerdown", (event) => this.pick(plot, event));
    plot.over.addEventListener("pointermove", (event) => event.buttons && this.pick(plot, event));
    return plot;
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
