// Parts of a map, and points of its boundaries, beside the page.
import { BUDGET, cells, RTOL, type Part } from "./cells";
import { Law } from "./law";
import type { Knob, Layout, SpeedKind, Values } from "./scene";

export interface Start {
  module: WebAssembly.Module;
  layout: Layout;
  knobs: Knob[];
  entries: Record<string, number>;
  limits: string[];
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

const BISECTIONS = 9;
let law: Law;

onmessage = (event: MessageEvent<Start | Part | Edges>) => {
  const data = event.data;
  if ("module" in data) {
    law = new Law(data.module, data.layout, data.knobs, data.entries, data.limits);
    postMessage(null);
  } else if ("pairs" in data) postMessage({ id: data.id, points: bisected(data) });
  else postMessage(cells(law, data));
};

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
