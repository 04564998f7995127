// The map of outcomes as a picture: cells, boundaries, names of regions, the chosen point and the pinned one.
import uPlot from "uplot";
import { css, font } from "./curves";
import { fromPart, segments, toPart, type Grid } from "./mapper";
import { pretty } from "./text";
import type { Knob, Scene, State } from "./scene";

const DARK: [number, number, number][] = [[78, 121, 158], [140, 72, 0], [122, 104, 12]]; // of the largest restitution
const DEPTH = [0, 0.62, 0.3]; // of an outcome's darkest colour; far apart, for those who see no hue
const DOT: [number, number, number] = [85, 85, 85];
const NONE: [number, number, number] = [221, 221, 221];
const STEPS = 100; // of the arrow keys across the map

export class RegimeMap {
  private plot: uPlot | null = null;
  private grid: Grid | null = null;
  private lines: ReturnType<typeof segments> = [];
  private axes = "";
  private readonly cells = document.createElement("canvas");
  private readonly fills: [number, number, number][];

  constructor(
    private readonly parent: HTMLElement,
    private readonly scene: Scene,
    private readonly state: () => State,
    private readonly pinned: () => State | null,
    private readonly choose: (across: number, upward: number) => void,
  ) {
    this.fills = scene.colours.map((each) => [1, 3, 5].map((k) => parseInt(each.slice(k, k + 2), 16)) as [number, number, number]);
    new ResizeObserver(() => this.resize()).observe(parent);
    parent.addEventListener("keydown", (event) => this.key(event));
  }

  private knob(name: string): Knob {
    return this.scene.knobs.find((each) => each.name === name)!;
  }

  show(grid: Grid): void {
    this.grid = grid;
    this.lines = segments(grid);
    const n = grid.across.length;
    this.cells.width = this.cells.height = n;
    const image = new ImageData(n, n);
    for (let k = 0; k < n * n; k++) {
      const [r, c] = [Math.floor(k / n), k % n];
      const dotted = grid.outside[k]! && r % 4 === 1 && c % 4 === 1;
      image.data.set([...(dotted ? DOT : this.colour(grid.outcome[k]!, grid.restitution[k]!, (r + c) % 2 === 0)), 255], 4 * ((n - 1 - r) * n + c));
    }
    this.cells.getContext("2d")!.putImageData(image, 0, 0);
    this.redraw();
  }

  /** Deeper with the restitution, and chequered above 1. */
  private colour(outcome: number, restitution: number, even: boolean): [number, number, number] {
    const [fill, dark] = [this.fills[outcome], DARK[outcome]];
    if (!fill || !dark) return NONE;
    const part = Math.min(restitution, 1) * DEPTH[outcome]! * (restitution > 1 && even ? 0.7 : 1);
    return [0, 1, 2].map((k) => Math.round(fill[k]! + (dark[k]! - fill[k]!) * part)) as [number, number, number];
  }

  /** The cell where the region of an outcome is widest; -1 if it has none that is seen. */
  widest = (outcome: number): number => (this.grid ? widest(this.grid, outcome) : -1);

  /** Chooses an impact with this outcome, which has a region, where its region is widest. */
  find(outcome: number): void {
    const place = this.widest(outcome);
    const n = this.grid!.across.length;
    this.choose(this.grid!.across[place % n]!, this.grid!.upward[Math.floor(place / n)]!);
  }

  /** A strip of the colours of an outcome, restitution 0 to 1 and above. */
  legend(outcome: number): HTMLCanvasElement {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [60, 12];
    const image = new ImageData(60, 12);
    for (let y = 0; y < 12; y++)
      for (let x = 0; x < 60; x++) image.data.set([...this.colour(outcome, x < 45 ? x / 45 : 2, (Math.floor(x / 3) + Math.floor(y / 3)) % 2 === 0), 255], 4 * (60 * y + x));
    canvas.getContext("2d")!.putImageData(image, 0, 0);
    return canvas;
  }

  /** Draws again, with new axes where the state has others. */
  redraw(): void {
    const state = this.state();
    const axes = `${state.across} ${state.upward} ${state.speed}`;
    if (!this.plot || axes !== this.axes) this.make(state);
    this.axes = axes;
    this.plot!.redraw(false);
  }

  private resize(): void {
    const [width, height] = this.size();
    if (this.plot && width) this.plot.setSize({ width, height });
  }

  private size(): [number, number] {
    const width = this.parent.clientWidth;
    return [width, Math.round(Math.min(Math.max(width * 0.8, 260), innerHeight * 0.62 + 60))];
  }

  private make(state: State): void {
    this.plot?.destroy();
    const [width, height] = this.size();
    const [x, y] = [this.knob(state.across), this.knob(state.upward)];
    const scale = (knob: Knob): uPlot.Scale => ({ time: false, auto: false, range: [knob.low, knob.high], distr: knob.logarithmic ? 3 : 1 });
    const axis = (knob: Knob): uPlot.Axis => ({
      label: axisLabel(knob, state),
      stroke: () => css("--ink"),
      grid: { show: false },
      ticks: { stroke: () => css("--ink"), size: 5 },
      font: font(0.8),
      labelFont: font(0.87),
      values: (_, splits) => splits.map((each) => (each === null || (knob.logarithmic && Math.log10(each) % 1 !== 0 && knob.high / knob.low > 30) ? "" : String(Number(each.toPrecision(6))))),
    });
    this.plot = new uPlot(
      {
        width,
        height,
        legend: { show: false },
        cursor: { show: false },
        scales: { x: scale(x), y: scale(y) },
        axes: [{ ...axis(x), labelSize: 22, size: 34 }, { ...axis(y), labelSize: 22, size: 52 }],
        series: [{}, { show: true, stroke: "transparent", points: { show: false } }],
        hooks: { drawClear: [(u) => this.draw(u)], draw: [(u) => this.overlay(u)] },
      },
      [[x.low, x.high], [y.low, y.high]],
      this.parent,
    );
    const over = this.plot.over;
    over.style.cursor = "crosshair";
    over.style.touchAction = "none";
    const pick = (event: PointerEvent): void => {
      const box = over.getBoundingClientRect();
      const part = (at: number): number => Math.min(Math.max(at, 0), 1);
      this.choose(fromPart(x, part((event.clientX - box.left) / box.width)), fromPart(y, part(1 - (event.clientY - box.top) / box.height)));
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      pick(event);
    });
    over.addEventListener("pointermove", (event) => event.buttons && pick(event));
  }

  private key(event: KeyboardEvent): void {
    const step = (event.shiftKey ? 5 : 1) / STEPS;
    const move = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
    if (!move) return;
    event.preventDefault();
    const state = this.state();
    const moved = (name: string, by: number): number => {
      const knob = this.knob(name);
      return by ? fromPart(knob, Math.min(Math.max(toPart(knob, state.values[name]!) + by, 0), 1)) : state.values[name]!;
    };
    this.choose(moved(state.across, move[0]!), moved(state.upward, move[1]!));
  }

  private draw(u: uPlot): void {
    const { left, top, width, height } = u.bbox;
    u.ctx.save();
    u.ctx.imageSmoothingEnabled = false;
    if (this.grid && this.grid.state.across === this.state().across && this.grid.state.upward === this.state().upward)
      u.ctx.drawImage(this.cells, left, top, width, height);
    u.ctx.restore();
  }

  private overlay(u: uPlot): void {
    const { ctx, bbox } = u;
    const grid = this.grid;
    if (!grid || grid.state.across !== this.state().across || grid.state.upward !== this.state().upward) return;
    const scale = devicePixelRatio;
    const at = (x: number, y: number): [number, number] => [u.valToPos(x, "x", true), u.valToPos(y, "y", true)];
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineWidth = 1.8 * scale;
    ctx.lineCap = "round";
    ctx.strokeStyle = "#202020";
    ctx.beginPath();
    for (const [from, to] of this.lines) {
      ctx.moveTo(...at(from.x, from.y));
      ctx.lineTo(...at(to.x, to.y));
    }
    ctx.stroke();
    this.regions(ctx, grid, at, scale);
    const pinned = this.pinned();
    if (pinned) this.point(ctx, ...at(pinned.values[grid.state.across]!, pinned.values[grid.state.upward]!), scale, true);
    const { values } = this.state();
    this.point(ctx, ...at(values[grid.state.across]!, values[grid.state.upward]!), scale, false);
    ctx.restore();
  }

  /** The name of each outcome where its region is widest. */
  private regions(ctx: CanvasRenderingContext2D, grid: Grid, at: (x: number, y: number) => [number, number], scale: number): void {
    const n = grid.across.length;
    const names = ["stick", "stick, rotate, separate", "bounce"];
    ctx.font = font(0.87 * scale, "600");
    ctx.textAlign = "center";
    ctx.lineJoin = "round";
    const { values } = this.state();
    const [crossX, crossY] = at(values[grid.state.across]!, values[grid.state.upward]!);
    names.forEach((name, outcome) => {
      const place = widest(grid, outcome);
      if (place < 0) return;
      const [middle, middleY] = at(grid.across[place % n]!, grid.upward[Math.floor(place / n)]!);
      const half = ctx.measureText(name).width / 2 + 4 * scale;
      const [left, right] = [at(grid.across[0]!, grid.upward[0]!)[0] + half, at(grid.across[n - 1]!, grid.upward[0]!)[0] - half];
      const x = Math.min(Math.max(middle, left), right);
      const hidden = Math.abs(x - crossX) < half + 12 * scale && Math.abs(middleY - crossY) < 20 * scale;
      const y = hidden ? crossY - 24 * scale : middleY;
      ctx.strokeStyle = "rgba(255,255,255,.85)";
      ctx.lineWidth = 4 * scale;
      ctx.strokeText(name, x, y);
      ctx.fillStyle = "#202020";
      ctx.fillText(name, x, y);
    });
  }

  private point(ctx: CanvasRenderingContext2D, x: number, y: number, scale: number, pinned: boolean): void {
    const r = 8 * scale;
    for (const [color, width] of [["#fff", 5], [pinned ? "#b0005e" : "#000", 2.2]] as const) {
      ctx.strokeStyle = color;
      ctx.lineWidth = width * scale;
      ctx.beginPath();
      if (pinned) ctx.rect(x - r * 0.8, y - r * 0.8, 1.6 * r, 1.6 * r);
      else {
        ctx.arc(x, y, r, 0, 7);
        for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
          ctx.moveTo(x + dx * r * 0.5, y + dy * r * 0.5);
          ctx.lineTo(x + dx * r * 1.8, y + dy * r * 1.8);
        }
      }
      ctx.stroke();
    }
  }

  get canvas(): HTMLCanvasElement {
    return this.plot!.ctx.canvas;
  }
}

/** The cell of an outcome that is farthest from others, apart from those near the sides; -1 if its region is narrow. */
function widest(grid: Grid, outcome: number): number {
  const n = grid.across.length;
  const margin = Math.ceil(n * 0.14);
  const is = (r: number, c: number): boolean => grid.outcome[r * n + c] === outcome;
  let [best, place] = [n * 0.03, -1];
  for (let r = 2; r < n - 2; r += 2)
    for (let c = margin; c < n - margin; c += 2) {
      let depth = 0;
      while (depth < n / 2 && c - 2 * depth >= 0 && c + 2 * depth < n && r - depth >= 0 && r + depth < n && is(r, c - 2 * depth) && is(r, c + 2 * depth) && is(r - depth, c) && is(r + depth, c)) depth++;
      if (depth >= best) [best, place] = [depth + 0.5, r * n + c];
    }
  return place;
}

export function axisLabel(knob: Knob, state: State): string {
  if (knob.name === "impact.speed") return speedLabel(knob, state.speed);
  return knob.unit ? `${knob.label}, ${pretty(knob.unit)}` : knob.label;
}

export function speedLabel(knob: Knob, kind: State["speed"]): string {
  const unit = pretty(knob.unit || "m/s");
  return { stokes: "Stokes number", speed: `Normal speed, ${unit}`, relative_speed: `Relative speed, ${unit}` }[kind];
}
