// The state of the page: its address, the scene as TOML, and the line of Python that gives the same numbers.
import { Law, si } from "./law";
import type { Knob, Scene, SpeedKind, State, Values } from "./scene";

const KINDS: SpeedKind[] = ["stokes", "speed", "relative_speed"];

export function initial(scene: Scene): State {
  const values: Values = Object.fromEntries(scene.knobs.map((each) => [each.name, each.value ?? Infinity]));
  return { values, speed: scene.speed, across: "impact.angle", upward: "impact.speed" };
}

export const copyOf = (state: State): State => ({ ...state, values: { ...state.values } });

/** What of a state differs from the scene's, in full precision. */
export function address(state: State, pinned: State | null, scene: Scene): string {
  const parts = new URLSearchParams();
  const add = (one: State, prefix: string): void => {
    const plain = initial(scene);
    for (const knob of scene.knobs) {
      const value = one.values[knob.name]!;
      if (value !== plain.values[knob.name]) parts.set(prefix + knob.name, value === Infinity ? "never" : String(value));
    }
    if (one.speed !== plain.speed) parts.set(`${prefix}impact.kind`, one.speed);
  };
  add(state, "");
  if (state.across !== "impact.angle") parts.set("across", state.across);
  if (state.upward !== "impact.speed") parts.set("upward", state.upward);
  if (pinned) {
    parts.set("pinned", "1");
    add(pinned, "pinned.");
  }
  return parts.toString();
}

export interface Read {
  state: State;
  pinned: State | null;
  ignored: string[];
}

/** The state of an address; what is not understood in it is ignored, and listed. */
export function fromAddress(text: string, scene: Scene, scenes: number): Read {
  const state = initial(scene);
  const pinned = initial(scene);
  const ignored: string[] = [];
  let isPinned = false;
  for (const [key, raw] of new URLSearchParams(text.slice(0, 4000))) {
    const target = key.startsWith("pinned.") ? pinned : state;
    const name = key.replace(/^pinned\./, "");
    const knob = scene.knobs.find((each) => each.name === name);
    const value = knob ? readNumber(raw, knob) : NaN;
    if (key === "scene" && /^\d{1,3}$/.test(raw) && Number(raw) < scenes) continue; // the page reads it
    if (key === "pinned") isPinned = true;
    else if (name === "impact.kind" && KINDS.includes(raw as SpeedKind)) target.speed = raw as SpeedKind;
    else if ((key === "across" || key === "upward") && scene.knobs.some((each) => each.name === raw)) state[key] = raw;
    else if (knob && !Number.isNaN(value)) target.values[name] = value;
    else ignored.push(`${key}=${raw}`.slice(0, 60));
  }
  if (state.across === state.upward) [state.across, state.upward] = ["impact.angle", "impact.speed"];
  return { state, pinned: isPinned ? pinned : null, ignored };
}

/** The number that a text gives for a knob; NaN if none that makes sense. */
export function readNumber(text: string, knob: Knob): number {
  const plain = text.trim().replace(",", ".");
  if (knob.never !== null && /^(never|∞)$/i.test(plain)) return Infinity;
  if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain)) return NaN;
  const value = Number(plain);
  if (!Number.isFinite(value * knob.factor) || (value !== 0 && Math.abs(value * knob.factor) > 1e30)) return NaN;
  if (knob.name === "impact.angle" && !(value >= 0 && value < 90)) return NaN;
  return knob.name === "impact.speed" && !(value > 0) ? NaN : value;
}

interface Line {
  table: string;
  key: string;
  text: string;
}

/** The entries of the scene as TOML has them; numbers in SI with all their digits. */
function lines(state: State, scene: Scene, law: Law): Line[] {
  law.set(state.values);
  const isNever = (member: string): boolean => scene.knobs.some((each) => each.never !== null && each.members[0] === member && state.values[each.name] === Infinity);
  const found: Line[] = [];
  for (const [table, key, literal, member, unit] of scene.tables) {
    if (literal !== null) found.push({ table, key, text: literal });
    else if (isNever(member!) || (key === "poisson_ratio" && isNever("particles_youngs_modulus"))) continue;
    else found.push({ table, key, text: unit ? `"${law.entry(member!)} ${unit}"` : plainNumber(law.entry(member!)) });
  }
  const speedKnob = scene.knobs.find((each) => each.name === "impact.speed")!;
  const given = state.speed === "stokes" ? state.values["impact.speed"]! : si(speedKnob, state.values["impact.speed"]!);
  found.push({ table: "impact", key: state.speed, text: state.speed === "stokes" ? plainNumber(given) : `"${given} m/s"` });
  const impact = law.impact(state.values, state.speed);
  found.push({ table: "impact", key: "angle", text: `"${impact.angle} rad"` });
  if (!scene.strings) {
    found.push({ table: "impact", key: "spin", text: `"${impact.spin} rad/s"` });
    if (!scene.wall) found.push({ table: "impact", key: "partner_spin", text: `"${impact.partner_spin} rad/s"` });
  }
  return found;
}

/** A number that TOML and Python read. */
const plainNumber = (x: number): string => (Number.isInteger(x) && Math.abs(x) < 1e15 ? `${x}.0` : String(x).replace(/^(-?\d+)e/, "$1.0e"));

export function toml(state: State, scene: Scene, law: Law): string {
  let text = scene.own_model ? "# with --model FOLDER, the model that this page was made with\n" : "";
  text += `name = ${JSON.stringify(scene.name)}\n`;
  let last = "";
  for (const line of lines(state, scene, law)) {
    if (line.table !== last) text += `\n[${line.table}]\n`;
    last = line.table;
    text += `${line.key} = ${line.text}\n`;
  }
  return text;
}

export function python(state: State, scene: Scene, law: Law): string {
  if (scene.own_model) return 'import wetdoublet as wd; print(wd.collide(wd.Scene.load("scene.toml", model="FOLDER")))  # the TOML, and the model';
  const tables: Record<string, string[]> = {};
  for (const { table, key, text } of lines(state, scene, law))
    (tables[table] ??= []).push(`"${key}": ${text === "true" ? "True" : text}`);
  const inner = Object.entries(tables).map(([table, entries]) => `"${table}": {${entries.join(", ")}}`);
  return `import wetdoublet as wd; print(wd.collide(wd.Scene.from_dict({${inner.join(", ")}})))`;
}
