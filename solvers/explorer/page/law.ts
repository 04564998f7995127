// The law of a scene in WebAssembly, behind typed arrays at the places of shim.h.
import type { Knob, Layout, SpeedKind, Values } from "./scene";

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  place(which: number): number;
  size(which: number): number;
  set_material(): number;
  many(count: number, rtol: number, budget: number): number;
  follow(rtol: number, step: number, factor: number, still: number): number;
  followed_events(): number;
  message(status: number): number;
  outside(k: number): number;
}

export const ROW = 18; // numbers of a row: see shim.h
const BAD = 100; // statuses from here on are bad input

export interface Collision {
  status: number;
  message: string;
  outcome: number;
  certified: boolean;
  rebound: number;
  restitution: number;
  tangential_restitution: number;
  slip_restitution: number;
  contact_time: number;
  rotation: number;
  smallest_gap: number;
  final_gap: number;
  final_spin: number;
  final_partner_spin: number;
  final_rotation_rate: number;
  outside: string[];
}

export interface Impact {
  speed: number;
  angle: number;
  spin: number;
  partner_spin: number;
}

export class Law {
  private readonly exports: Exports;
  private readonly entries: Float64Array;
  private readonly material: Float64Array;
  private readonly impacts: Float64Array;
  private readonly integers: Int32Array; // of the collisions
  private readonly doubles: Float64Array; // of the same bytes
  private readonly stride: number;
  private readonly members: [Knob, number[]][]; // places of the entries that a knob sets
  private readonly impactKnobs: Record<keyof Impact, Knob | undefined>;
  stokesPerSpeed = NaN; // Stokes number of 1 m/s, m/(6 pi mu a^2), of the material that was set last
  private readonly offsets: Record<string, number> = {};
  readonly cells: number;

  constructor(
    module: WebAssembly.Module,
    private readonly layout: Layout,
    knobs: Knob[],
    defaults: Record<string, number>,
    private readonly limits: string[],
  ) {
    // no imports but what wasi-libc may name: nothing of it is called
    const none = new Proxy({}, { get: () => () => 0 });
    const imports = Object.fromEntries(WebAssembly.Module.imports(module).map((each) => [each.module, none]));
    const e = (this.exports = new WebAssembly.Instance(module, imports).exports as unknown as Exports);
    e._initialize();
    const buffer = e.memory.buffer;
    this.cells = e.size(5);
    this.stride = e.size(3);
    this.entries = new Float64Array(buffer, e.place(0), layout.pair_entries.length);
    this.material = new Float64Array(buffer, e.place(1), layout.material.length);
    this.impacts = new Float64Array(buffer, e.place(2), layout.impact.length * this.cells);
    this.integers = new Int32Array(buffer, e.place(3), (this.stride / 4) * this.cells);
    this.doubles = new Float64Array(buffer, e.place(3), (this.stride / 8) * this.cells);
    this.members = knobs.map((each) => [each, each.members.map((member) => this.place(member))]);
    const named = (name: string): Knob | undefined => knobs.find((each) => each.name === `impact.${name}`);
    this.impactKnobs = { speed: named("speed"), angle: named("angle"), spin: named("spin"), partner_spin: named("partner_spin") };
    let offset = 0;
    for (const [kind, name] of layout.collision) {
      const bytes = kind === "int" ? 4 : 8;
      offset = Math.ceil(offset / bytes) * bytes;
      this.offsets[name] = offset;
      offset += bytes;
    }
    if (e.size(0) !== this.entries.byteLength || e.size(1) !== this.material.byteLength || offset > this.stride)
      throw new Error("the law's layout is another");
    layout.pair_entries.forEach(([, name], k) => (this.entries[k] = defaults[name]!));
  }

  message(status: number): string {
    const bytes = new Uint8Array(this.exports.memory.buffer);
    let text = "";
    for (let at = this.exports.message(status); bytes[at]; at++) text += String.fromCharCode(bytes[at]!);
    return text;
  }

  /** A number of the material that was set last; NaN if it has no such number. */
  quantity(name: string): number {
    return this.material[this.layout.material.findIndex((each) => each[1] === name)] ?? NaN;
  }

  /** Sets the entries of the knobs and the material of them; returns the status. */
  set(values: Values): number {
    for (const [knob, places] of this.members) for (const place of places) this.entries[place] = si(knob, values[knob.name]!);
    const status = this.exports.set_material();
    this.stokesPerSpeed = this.quantity("reduced_mass") / (6 * Math.PI * this.quantity("viscosity") * this.quantity("reduced_radius") ** 2);
    return status;
  }

  entry(member: string): number {
    return this.entries[this.place(member)]!;
  }

  private place(member: string): number {
    return this.layout.pair_entries.findIndex((each) => each[1] === member);
  }

  /** The impact that the knobs give, in SI, for the material that was set last. */
  impact(values: Values, kind: SpeedKind): Impact {
    const of = (knob: Knob | undefined): number => (knob ? si(knob, values[knob.name]!) : 0);
    const [speed, angle, spin, partner_spin] = [of(this.impactKnobs.speed), of(this.impactKnobs.angle), of(this.impactKnobs.spin), of(this.impactKnobs.partner_spin)];
    if (kind === "stokes") return { speed: values["impact.speed"]! / this.stokesPerSpeed, angle, spin, partner_spin };
    return { speed: kind === "speed" ? speed : speed * Math.cos(angle), angle, spin, partner_spin };
  }

  put(k: number, impact: Impact): void {
    this.impacts[4 * k] = impact.speed;
    this.impacts[4 * k + 1] = impact.angle;
    this.impacts[4 * k + 2] = impact.spin;
    this.impacts[4 * k + 3] = impact.partner_spin;
  }

  run(count: number, rtol: number, budget: number): void {
    this.exports.many(count, rtol, budget);
  }

  status = (k: number): number => this.integers[(k * this.stride + this.offsets.status!) / 4]!;
  outcome = (k: number): number => this.integers[(k * this.stride + this.offsets.outcome!) / 4]!;
  restitution = (k: number): number => this.doubles[(k * this.stride + this.offsets.restitution!) / 8]!;

  /** Bits of the limits that a collision has exceeded. */
  outside = (k: number): number => this.exports.outside(k);

  /** One collision with all that is known of it. */
  collide(values: Values, kind: SpeedKind, rtol: number): Collision & Impact {
    let status = this.set(values);
    const impact = this.impact(values, kind);
    const found: Record<string, number> = {};
    this.put(0, impact);
    this.run(1, rtol, 0);
    for (const [type, name] of this.layout.collision) {
      const at = this.offsets[name]!;
      found[name] = type === "int" ? this.integers[at / 4]! : this.doubles[at / 8]!;
    }
    if (!status) status = found["status"]!;
    const message = status ? this.message(status) : "";
    const bits = status ? 0 : this.outside(0);
    const outside = this.limits.filter((_, bit) => bits & (1 << bit));
    return { ...(found as unknown as Collision), ...impact, outside, certified: !!found["certified"], status, message };
  }

  /** Rows of the collision that `collide` was asked for last (see shim.h), and its events. */
  follow(rtol: number, step: number, still: number): { rows: Float64Array; events: Float64Array } {
    const count = this.exports.follow(rtol, step, 1.02, still);
    const buffer = this.exports.memory.buffer;
    const rows = new Float64Array(buffer, this.exports.place(4), count * ROW).slice();
    return { rows, events: new Float64Array(buffer, this.exports.place(5), 3 * this.exports.followed_events()).slice() };
  }
}

/** The number of a knob in SI. */
export function si(knob: Knob, value: number): number {
  return value === Infinity ? (knob.never ?? value) : value * knob.factor;
}

export const isBadInput = (status: number): boolean => status >= BAD;

/** The module that a page carries: gzip in base64. */
export async function unpacked(text: string): Promise<WebAssembly.Module> {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}
