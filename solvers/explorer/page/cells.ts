// The cells of a part of a map.
import type { Law } from "./law";
import type { SpeedKind, Values } from "./scene";

export const RTOL = 1e-6; // of what is only coloured
export const BUDGET = 20000;

/** A part of a map: numbers of the knobs across and upward. */
export interface Part {
  id: number;
  values: Values;
  speed: SpeedKind;
  across: [string, Float64Array];
  upward: [string, Float64Array];
}

export interface Cells {
  id: number;
  outcome: Int8Array;
  restitution: Float32Array;
  outside: Int16Array;
  milliseconds: number;
}

const isImpact = (name: string): boolean => name.startsWith("impact.");

export function cells(law: Law, part: Part): Cells {
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
