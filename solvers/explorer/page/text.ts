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
export const percent = (x: number): string => `${(100 * x).toFixed(1).replace(/^-(?=0\.0$)/, "")} %`;
export const pretty = (unit: string): string =>
  unit.replace(/\bum\b/, "µm").replace("deg", "°").replace(/\^?3\b/, "³").replace(/\^?2\b/, "²").replace("mPas", "mPa s");

export const OUTCOMES = ["Stick", "Stick, rotate, separate", "Bounce"];
export const MEANINGS = ["they stay together", "rotation pulls them apart", "they rebound"];
const REBOUNDS = [
  "the liquid turned glassy under the pressure in the film",
  "the spheres deformed elastically",
  "the rough surfaces touched",
];

/** What happens, in sentences. */
export function answer(found: Collision & Impact, scene: Scene, stokes: number): [string, string] {
  if (found.status) return ["No answer", `${found.message}.`];
  const impact = `Impact at ${quantity(found.speed, "m/s")} ${along(scene)} (Stokes number ${short(stokes)}), ${degrees(found.angle)} from head-on.`;
  const outside = found.outside.length ? ` Outside the model's range: ${found.outside.join("; ")}.` : "";
  return [OUTCOMES[found.outcome]!, `${impact} ${decided(found, scene)}${outside}`];
}


/** The normal direction. */
export const along = (scene: Scene): string => (scene.wall ? "normal to the wall" : "along the line of centres");

function decided(found: Collision & Impact, scene: Scene): string {
  const what = scene.wall ? "sphere and wall" : "spheres";
  const cause = found.rebound >= 0 ? REBOUNDS[found.rebound]! : "";
  if (found.outcome === 0) {
    const proof = found.certified ? "" : " It is not proved that they never part later.";
    return `The ${what} stay together.${cause && ` They rebounded, as ${cause}, but did not get apart.`}${proof}`;
  }
  const turned = scene.wall ? "" : ` and turn by ${degrees(found.rotation)}`;
  const across = Number.isFinite(found.tangential_restitution) ? `, and with ${found.tangential_restitution.toFixed(3)} of that ${scene.wall ? "along it" : "across it"} (tangential restitution)` : "";
  return [
    `The ${what} are together for ${quantity(found.contact_time, "s")}${turned}.`,
    found.outcome === 1 ? "Then the rotation pulls them apart," : `They rebound${cause && ` because ${cause}`}, and part`,
    `with ${found.restitution.toFixed(3)} of the approach speed ${along(scene)} (normal restitution)${across}.`,
    `Smallest gap ${quantity(found.smallest_gap, "m")}.`,
  ].join(" ");
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
    // the code holds the first criterion only, so that a further rough contact looks as a gap that turns
    return to !== 1 ? "gap closes again" : digit(after, 1000) ? "gap opens again" : "gap begins to open";
  }
  if (digit(before, 100) !== digit(after, 100)) return digit(after, 100) ? "into the film" : "out of the film";
  return "certain to stick";
}
