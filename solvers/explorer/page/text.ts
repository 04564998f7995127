// Numbers and answers in words.
import type { Collision, Impact } from "./law";
import type { Scene } from "./scene";

/** A number with a few digits, as people write it. */
export function short(x: number, digits = 3): string {
  if (x === Infinity) return "never";
  if (!Number.isFinite(x)) return "–";
  const a = Math.abs(x);
  if (a !== 0 && (a >= 1e6 || a < 1e-4)) return x.toExponential(digits - 1).replace("e+", "e");
  return Number(x.toPrecision(digits)).toString();
}

const PREFIXES: [number, string][] = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** A quantity with a prefixed SI unit. */
export function quantity(x: number, unit: string): string {
  if (!Number.isFinite(x)) return "–";
  const [factor, prefix] = PREFIXES.find((each) => Math.abs(x) >= each[0]) ?? [x === 0 ? 1 : 1e-9, x === 0 ? "" : "n"];
  return `${short(x / factor)} ${prefix}${unit}`;
}

export const degrees = (x: number): string => `${short((x * 180) / Math.PI)}°`;
export const percent = (x: number): string => `${(100 * x).toFixed(1)} %`;
export const pretty = (unit: string): string =>
  unit.replace(/\bum\b/, "µm").replace("deg", "°").replace(/\^?3\b/, "³").replace(/\^?2\b/, "²").replace("mPas", "mPa s");

export const OUTCOMES = ["Stick", "Stick, rotate, separate", "Bounce"];
const REBOUNDS = [
  "the liquid turned glassy under the pressure in the film",
  "the spheres deformed elastically",
  "the rough surfaces touched",
];

/** What happens, in sentences. */
export function answer(found: Collision & Impact, scene: Scene): [string, string] {
  if (found.status) return ["No answer", `${found.message}.`];
  const [title, said] = decided(found, scene);
  return [title, said + (found.outside.length ? ` Outside the model's range: ${found.outside.join(", ")}.` : "")];
}

function decided(found: Collision & Impact, scene: Scene): [string, string] {
  const title = OUTCOMES[found.outcome]!;
  const what = scene.wall ? "sphere and wall" : "spheres";
  if (found.outcome === 0) {
    const proof = found.certified ? "" : " It is not proved that they never part later.";
    const criterion = found.rebound >= 0 ? ` They rebounded, as ${REBOUNDS[found.rebound]}, but did not get apart.` : "";
    return [title, `The ${what} stay together.${criterion}${proof}`];
  }
  const parts = [`normal restitution ${found.restitution.toFixed(3)} (of the approach speed)`];
  if (Number.isFinite(found.tangential_restitution)) parts.push(`tangential ${found.tangential_restitution.toFixed(3)}`);
  parts.push(`together for ${quantity(found.contact_time, "s")}`);
  if (!scene.wall) parts.push(`turned by ${degrees(found.rotation)}`);
  parts.push(`smallest gap ${quantity(found.smallest_gap, "m")}`);
  const why = found.outcome === 2 && found.rebound >= 0 ? ` They rebounded because ${REBOUNDS[found.rebound]}.` : "";
  const turned = found.outcome === 1 ? " They turned together as a doublet until the rotation pulled them apart." : "";
  return [title, `${parts.join(", ")}.${why}${turned}`.replace(/^./, (c) => c.toUpperCase())];
}

/** An event's words from the code before it and behind it (shim.h). */
export function eventWords(before: number, after: number, strings: boolean): string {
  const digit = (code: number, of: number): number => Math.floor(code / of) % 10;
  if (digit(before, 1000) !== digit(after, 1000))
    return ["glass transition: rebound", "elastic rebound", "rough surfaces touch"][digit(after, 1000) - 1] ?? "rebound";
  const [from, to] = [digit(before, 1), digit(after, 1)];
  if (from !== to) {
    if (to === 3) return strings ? "films part" : "separation";
    if (to === 4) return "cut off: the strings' experiment ends";
    if (to === 5) return "cannot be followed further";
    if (to === 2) return "rests in contact";
    if (from === 2) return "released";
    return to === 1 ? "gap begins to open" : "gap closes again";
  }
  if (digit(before, 100) !== digit(after, 100)) return digit(after, 100) ? "into the film" : "out of the film";
  return "certain to stick";
}
