// Maps by workers: a coarse one at once, a fine one after it, then points of the boundaries. The newest request wins.
import type { Scene, State, Values } from "./scene";
import { copyOf } from "./state";
import { cells, type Cells, type Part } from "./cells";
import type { Law } from "./law";
import type { Edges, Start } from "./worker";

export interface Grid {
  state: State;
  across: Float64Array;
  upward: Float64Array;
  outcome: Int8Array;
  restitution: Float32Array;
  outside: Int16Array; // bits of the model's limits
  edges: Crossing[];
  refined: boolean;
}

/** A point of a boundary between neighbouring cells: right of a cell, or above it. */
export interface Crossing {
  cell: number;
  above: boolean;
  x: number;
  y: number;
}

export const [COARSE, FINE] = [30, 100];
const LINES = 10; // of a task of the fine map, so that a newer request does not wait
const MOST = 3000; // crossings that are refined

export class Mapper {
  private readonly workers: Worker[] = [];
  private readonly waiting = new Map<number, (answer: any) => void>();
  private readonly free: Worker[] = [];
  private readonly queue: (() => void)[] = [];
  private wanted: State | null = null;
  private running = false;
  private id = 0;
  readonly timings: { coarse: number; fine: number; cpu: number } = { coarse: 0, fine: 0, cpu: 0 };

  constructor(
    private readonly scene: Scene,
    module: WebAssembly.Module,
    script: string,
    private readonly onGrid: (grid: Grid) => void,
    count: number,
  ) {
    const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    const start: Start = { module, layout: scene.layout, knobs: scene.knobs, entries: scene.entries, limits: scene.limits };
    for (let k = 0; k < count; k++) {
      const worker = new Worker(url);
      worker.onmessage = (event: MessageEvent<{ id: number } | null>) => {
        if (event.data) {
          this.waiting.get(event.data.id)?.(event.data);
          this.waiting.delete(event.data.id);
        }
        this.free.push(worker);
        this.queue.shift()?.();
      };
      worker.postMessage(start);
      this.workers.push(worker);
    }
  }

  /** The coarse map at once, here, as workers take longer to start; they go on with the fine one. */
  first(state: State, law: Law): void {
    const start = performance.now();
    const [across, upward] = [this.axis(state.across, COARSE), this.axis(state.upward, COARSE)];
    const part: Part = { id: 0, values: state.values, speed: state.speed, across: [state.across, across], upward: [state.upward, upward] };
    const grid: Grid = { state: copyOf(state), across, upward, ...cells(law, part), edges: [], refined: false };
    grid.edges = crossings(grid, this.logarithmic(state));
    this.timings.coarse = performance.now() - start;
    this.onGrid(grid);
    this.wanted = copyOf(state);
    void this.loop(true);
  }

  /** Asks for the map of a state; `onGrid` is called for each stage. */
  request(state: State): void {
    this.wanted = copyOf(state);
    if (!this.running) void this.loop();
  }

  close(): void {
    this.workers.forEach((each) => each.terminate());
  }

  get idle(): boolean {
    return !this.running;
  }

  private async loop(isCoarseDone = false): Promise<void> {
    this.running = true;
    while (this.wanted) {
      const state = this.wanted;
      this.wanted = null;
      let start = performance.now();
      if (!isCoarseDone) {
        await this.map(state, COARSE, Math.ceil(COARSE / this.workers.length), true);
        this.timings.coarse = performance.now() - start;
      }
      isCoarseDone = false;
      if (this.wanted) continue;
      start = performance.now();
      this.timings.cpu = 0;
      const grid = await this.map(state, FINE, LINES, false);
      if (!grid) continue;
      this.timings.fine = performance.now() - start;
      await this.refine(grid);
    }
    this.running = false;
  }

  private send<Answer>(task: Omit<Part, "id"> | Omit<Edges, "id">): Promise<Answer> {
    const id = ++this.id;
    return new Promise((resolve) => {
      this.waiting.set(id, resolve);
      const go = (): void => this.free.pop()!.postMessage({ ...task, id });
      if (this.free.length) go();
      else this.queue.push(go);
    });
  }

  /** The map of n x n cells in tasks of some lines; null if a newer request has come. */
  private async map(state: State, n: number, lines: number, always: boolean): Promise<Grid | null> {
    const across = this.axis(state.across, n);
    const upward = this.axis(state.upward, n);
    const grid: Grid = {
      state, across, upward, outcome: new Int8Array(n * n), restitution: new Float32Array(n * n), outside: new Int16Array(n * n), edges: [], refined: false,
    };
    const values: Values = state.values;
    const starts = Array.from({ length: Math.ceil(n / lines) }, (_, k) => k * lines);
    // columns are split where lines of one material run upward, so that a worker has whole ones
    const columns = !state.across.startsWith("impact.") && state.upward.startsWith("impact.");
    const one = async (): Promise<void> => {
      for (let from = starts.shift(); from !== undefined; from = starts.shift()) {
        if (this.wanted && !always) return;
        const part = (axis: Float64Array): Float64Array => axis.slice(from, from! + lines);
        const cells = await this.send<Cells>({
          values,
          speed: state.speed,
          across: [state.across, columns ? part(across) : across],
          upward: [state.upward, columns ? upward : part(upward)],
        });
        this.timings.cpu += cells.milliseconds;
        const width = columns ? Math.min(lines, n - from) : n;
        for (let k = 0; k < cells.outcome.length; k++) {
          const cell = columns ? Math.floor(k / width) * n + from + (k % width) : from * n + k;
          grid.outcome[cell] = cells.outcome[k]!;
          grid.restitution[cell] = cells.restitution[k]!;
          grid.outside[cell] = cells.outside[k]!;
        }
      }
    };
    await Promise.all(this.workers.map(one));
    if (this.wanted && !always) return null;
    grid.edges = crossings(grid, this.logarithmic(state));
    this.onGrid(grid);
    return grid;
  }

  private async refine(grid: Grid): Promise<void> {
    const { state, across, upward, edges } = grid;
    if (!edges.length || edges.length > MOST) return;
    const n = across.length;
    const share = Math.ceil(edges.length / (4 * this.workers.length));
    const parts: Crossing[][] = [];
    for (let k = 0; k < edges.length; k += share) parts.push(edges.slice(k, k + share));
    await Promise.all(
      parts.map(async (part) => {
        const pairs = part.flatMap(({ cell, above }) => {
          const [r, c] = [Math.floor(cell / n), cell % n];
          return [across[c]!, upward[r]!, across[above ? c : c + 1]!, upward[above ? r + 1 : r]!];
        });
        const { points } = await this.send<{ points: Float64Array }>({
          values: state.values,
          speed: state.speed,
          across: state.across,
          upward: state.upward,
          pairs: Float64Array.from(pairs),
          first: Int8Array.from(part, (each) => grid.outcome[each.cell]!),
          logarithmic: this.logarithmic(state),
        });
        part.forEach((each, k) => ([each.x, each.y] = [points[2 * k]!, points[2 * k + 1]!]));
      }),
    );
    grid.refined = true;
    if (!this.wanted) this.onGrid(grid);
  }

  private logarithmic(state: State): [boolean, boolean] {
    const of = (name: string): boolean => this.scene.knobs.find((each) => each.name === name)!.logarithmic;
    return [of(state.across), of(state.upward)];
  }

  /** Middles of n cells between the ends of a knob's slider. */
  private axis(name: string, n: number): Float64Array {
    const knob = this.scene.knobs.find((each) => each.name === name)!;
    return Float64Array.from({ length: n }, (_, k) => fromPart(knob, (k + 0.5) / n));
  }
}

type Ends = { low: number; high: number; logarithmic: boolean };

/** The number at a part, 0 to 1, of a slider, and the part of a number. */
export const fromPart = (knob: Ends, part: number): number =>
  knob.logarithmic ? knob.low * (knob.high / knob.low) ** part : knob.low + (knob.high - knob.low) * part;
export const toPart = (knob: Ends, value: number): number =>
  knob.logarithmic ? Math.log(value / knob.low) / Math.log(knob.high / knob.low) : (value - knob.low) / (knob.high - knob.low);

function crossings(grid: Grid, logarithmic: [boolean, boolean]): Crossing[] {
  const { across, upward, outcome } = grid;
  const n = across.length;
  const found: Crossing[] = [];
  const middle = (a: number, b: number, log: boolean): number => (log ? Math.sqrt(a * b) : (a + b) / 2);
  for (let cell = 0; cell < n * n; cell++) {
    const [r, c] = [Math.floor(cell / n), cell % n];
    if (c + 1 < n && outcome[cell] !== outcome[cell + 1])
      found.push({ cell, above: false, x: middle(across[c]!, across[c + 1]!, logarithmic[0]), y: upward[r]! });
    if (r + 1 < n && outcome[cell] !== outcome[cell + n])
      found.push({ cell, above: true, x: across[c]!, y: middle(upward[r]!, upward[r + 1]!, logarithmic[1]) });
  }
  return found;
}

/** Pieces of the boundaries: crossings around each corner of four cells, joined. */
export function segments(grid: Grid): [Crossing, { x: number; y: number }][] {
  const n = grid.across.length;
  const at = new Map(grid.edges.map((each) => [2 * each.cell + (each.above ? 1 : 0), each]));
  const found: [Crossing, { x: number; y: number }][] = [];
  for (let r = 0; r + 1 < n; r++)
    for (let c = 0; c + 1 < n; c++) {
      const cell = r * n + c;
      const around = [2 * cell, 2 * cell + 1, 2 * (cell + n), 2 * (cell + 1) + 1].flatMap((key) => at.get(key) ?? []);
      if (around.length === 2) found.push([around[0]!, around[1]!]);
      else if (around.length > 2) {
        const mean = (key: "x" | "y"): number => around.reduce((sum, each) => sum + each[key], 0) / around.length;
        for (const each of around) found.push([each, { x: mean("x"), y: mean("y") }]);
      }
    }
  return found;
}
