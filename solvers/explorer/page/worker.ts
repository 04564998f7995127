// Parts of a map, and points of its boundaries, beside the page.
import { Law } from "./law";
import type { Knob, Layout, Limit, SpeedKind, Values } from "./scene";

export interface Start {
  module: WebAssembly.Module;
  layout: Layout;
  knobs: Knob[];
  entries: Record<string, number>;
  limits: Limit[];
}

/** Lines `from` to `to` of a map: numbers of the knobs across and upward; every line has one upward number. */
export interface Part {
  id: number;
  values: Values;
  speed: SpeedKind;
  across: [string, Float64Array];
  upward: [string, Float64Array];
}

/** Pairs of points of unlike outcome, four numbers each; all have the outcome of their first point. */
export interface Edges {
  id: number;
  values: Values;
  speed: SpeedKind;
  across: string;
  upward: string;
  pairs: Float64Array;
  first: Int8Array;
  logarithmic: [boolean, boolean];
}

export interface Cells {
  id: number;
  outcome: Int8Array;
  restitution: Float32Array;
  outside: Int16Array;
  milliseconds: number;
}

const RTOL = 1e-6; // of what is only coloured
const BUDGET = 20000;
const BISECTIONS = 9;
let law: Law;

onmessage = (event: MessageEvent<Start | Part | Edges>) => {
  const data = event.data;
  if ("module" in data) {
    law = new Law(data.module, data.layout, data.knobs, data.entries, data.limits);
    postMessage(null);
  } else if ("pairs" in data) postMessage({ id: data.id, points: bisected(data) });
  else postMessage(cells(data));
};

const isImpact = (name: string): boolean => name.startsWith("impact.");

function cells(part: Part): Cells {
  const start = performance.now();
  const [across, columns] = part.across;
  const [upward, lines] = part.upward;
  const size = columns.length * lines.length;
  const outcome = new Int8Array(size);
  const restitution = new Float32Array(size);
  const outside = new Int16Array(size);
  const values = { ...part.values };
  // cells with one material go to the law together
  const byColumn = !isImpact(across) && isImpact(upward);
  const [outer, inner] = byColumn ? [columns, lines] : [lines, columns];
  const [outerName, innerName] = byColumn ? [across, upward] : [upward, across];
  const alone = !isImpact(innerName);
  for (let o = 0; o < outer.length; o++) {
    values[outerName] = outer[o]!;
    let bad = alone ? 0 : law.set(values);
    for (let i = 0; i < inner.length; i++) {
      values[innerName] = inner[i]!;
      if (alone) bad = law.set(values);
      law.put(alone ? 0 : i, law.impact(values, part.speed));
      if (alone) {
        if (!bad) law.run(1, RTOL, BUDGET);
        keep(o, i, bad ? -1 : 0);
      }
    }
    if (alone) continue;
    if (!bad) law.run(inner.length, RTOL, BUDGET);
    for (let i = 0; i < inner.length; i++) keep(o, i, bad ? -1 : i);
  }
  return { id: part.id, outcome, restitution, outside, milliseconds: performance.now() - start };

  function keep(o: number, i: number, at: number): void {
    const cell = byColumn ? i * columns.length + o : o * columns.length + i;
    const failed = at < 0 || law.status(at) !== 0;
    outcome[cell] = failed ? -1 : law.outcome(at);
    restitution[cell] = failed ? NaN : law.restitution(at);
    outside[cell] = failed ? 0 : law.outside(at);
  }
}

/** Points between those of each pair at which the outcome stops being that of the first. */
function bisected(edges: Edges): Float64Array {
  const points = new Float64Array(edges.first.length * 2);
  const values = { ...edges.values };
  const middle = (a: number, b: number, logarithmic: boolean): number => (logarithmic ? Math.sqrt(a * b) : (a + b) / 2);
  for (let k = 0; k < edges.first.length; k++) {
    let [x0, y0, x1, y1] = edges.pairs.subarray(4 * k, 4 * k + 4) as unknown as [number, number, number, number];
    for (let b = 0; b < BISECTIONS; b++) {
      const x = middle(x0, x1, edges.logarithmic[0]);
      const y = middle(y0, y1, edges.logarithmic[1]);
      values[edges.across] = x;
      values[edges.upward] = y;
      const bad = law.set(values);
      law.put(0, law.impact(values, edges.speed));
      if (!bad) law.run(1, RTOL, BUDGET);
      if (!bad && !law.status(0) && law.outcome(0) === edges.first[k]) [x0, y0] = [x, y];
      else [x1, y1] = [x, y];
    }
    points.set([middle(x0, x1, edges.logarithmic[0]), middle(y0, y1, edges.logarithmic[1])], 2 * k);
  }
  return points;
}
