// The pair along one collision: rows of the law, interpolated; straight lines behind a separation.
import { Law, ROW, type Impact } from "./law";
import { eventWords } from "./text";
import type { Scene } from "./scene";

export interface Geometry {
  radius: number;
  partner: number; // 0 beside a wall
  reduced: number;
  film: number;
  volume: number; // 0 without a bridge
  share: number; // distance of the first centre from the centre of mass, of that between the centres
  masses: [number, number];
}

export interface Frame {
  time: number;
  gap: number;
  velocity: number;
  angle: number;
  rate: number;
  spins: [number, number];
  turned: [number, number];
  apart: boolean;
  motion: Energies; // J
  book: number[]; // the ledger, J; NaN without one
}

const CODE = 8; // place of it in a row; the ledger follows

export type Energies = [line: number, around: number, spins: number];

/** A share of the energy: its colour, its name, and how much. */
export type Share = [colour: string, name: string, part: number];

export interface PairEvent {
  time: number;
  words: string;
}

export function geometry(law: Law, scene: Scene): Geometry {
  const reduced = law.quantity("reduced_radius");
  const mass = law.quantity("reduced_mass");
  const or = (value: number, other: number): number => (Number.isNaN(value) ? other : value);
  const common = { reduced, film: law.quantity("film_thickness"), volume: or(law.quantity("volume"), 0) * (2 * reduced) ** 3 };
  if (scene.wall) return { ...common, radius: reduced, partner: 0, share: 0, masses: [mass, 0] };
  const k = or(law.quantity("radius_ratio"), 1);
  const q = or(law.quantity("mass_ratio"), 1);
  const masses: [number, number] = [(mass * (1 + q)) / q, mass * (1 + q)];
  return { ...common, radius: (reduced * (1 + k)) / k, partner: reduced * (1 + k), share: q / (1 + q), masses };
}

export class Trajectory {
  readonly end: number;
  readonly separated: boolean;
  readonly tau: number;
  readonly before: Energies; // at initial contact, before a rebound that is met there
  private readonly whole: number;
  readonly events: PairEvent[] = [];
  readonly columns: { time: number[]; gap: number[]; velocity: number[]; rotation: number[] };
  private readonly turned: [Float64Array, Float64Array];

  constructor(
    private readonly rows: Float64Array,
    events: Float64Array,
    readonly geometry: Geometry,
    readonly impact: Impact,
    private readonly scene: Scene,
  ) {
    const n = rows.length / ROW;
    const column = (k: number): number[] => Array.from({ length: n }, (_, i) => rows[i * ROW + k]!);
    this.columns = { time: column(0), gap: column(1), velocity: column(2), rotation: column(3) };
    this.end = n ? rows[(n - 1) * ROW]! : 0;
    this.separated = n > 0 && rows[(n - 1) * ROW + CODE]! % 10 === 3;
    this.tau = geometry.film / impact.speed;
    const before = this.motion(0, impact.speed);
    this.whole = before[0] + before[1] + before[2];
    this.before = before.map((each) => each / this.whole) as Energies;
    for (let k = 0; k < events.length; k += 3)
      this.events.push({ time: events[k]!, words: eventWords(events[k + 1]!, events[k + 2]!, scene.strings) });
    // the doublet's angle is the integrator's; only the slip is integrated here, by the trapezoidal rule
    this.turned = [new Float64Array(n), new Float64Array(n)];
    for (const s of [0, 1] as const)
      for (let i = 1; i < n; i++) {
        const slip = (j: number): number => rows[j * ROW + 5 + s]! - (scene.wall ? 0 : rows[j * ROW + 4]!);
        const turn = scene.wall ? 0 : rows[i * ROW + 3]! - rows[(i - 1) * ROW + 3]!;
        this.turned[s][i] = this.turned[s][i - 1]! + turn + ((slip(i) + slip(i - 1)) / 2) * (rows[i * ROW]! - rows[(i - 1) * ROW]!);
      }
  }

  /** Sum of the radii and a gap. */
  distance(gap: number): number {
    return this.geometry.radius + this.geometry.partner + gap;
  }

  at(time: number): Frame {
    const n = this.rows.length / ROW;
    let low = 0;
    let high = n - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.rows[middle * ROW]! <= time) low = middle;
      else high = middle;
    }
    const [from, to] = [this.rows[low * ROW]!, this.rows[high * ROW]!];
    const f = to > from ? Math.min(Math.max((time - from) / (to - from), 0), 1) : 1;
    const mix = (a: number, b: number): number => a + (b - a) * f;
    const value = (k: number): number => mix(this.rows[low * ROW + k]!, this.rows[high * ROW + k]!);
    const turned = this.turned.map((each) => mix(each[low]!, each[high]!)) as [number, number];
    const frame: Frame = {
      time, gap: value(1), velocity: value(2), angle: value(3), rate: value(4), spins: [value(5), value(6)], turned, apart: false,
      motion: this.motion(low).map((each, k) => mix(each, this.motion(high)[k]!)) as Energies,
      book: Array.from({ length: ROW - CODE - 1 }, (_, k) => value(CODE + 1 + k)),
    };
    const beyond = time - this.end;
    if (beyond <= 0 || !this.separated || this.scene.strings) return frame;
    const distance = this.distance(frame.gap);
    const [along, across] = [frame.velocity, this.scene.wall ? 0 : frame.rate * distance];
    const [x, y] = [distance + along * beyond, across * beyond];
    const far = Math.hypot(x, y);
    return {
      ...frame,
      gap: far - this.geometry.radius - this.geometry.partner,
      velocity: (along * x + across * y) / far,
      rate: (across * x - along * y) / far ** 2,
      angle: frame.angle + Math.atan2(y, x),
      turned: [turned[0] + frame.spins[0] * beyond, turned[1] + frame.spins[1] * beyond],
      apart: true,
    };
  }

  /** The energy ledger of a frame: what there is and where the rest went, as shares of the initial kinetic energy. */
  ledger(frame: Frame): Share[] {
    const { scene } = this;
    const [line, around, spins] = this.energies(frame);
    const motion: Share[] = [["e0", scene.wall ? "normal to the wall" : "line of centres", line]];
    if (scene.wall) motion.push(["e1", "along the wall, and spin", around]);
    else motion.push(["e1", "around each other", around], ["e2", "spins", spins]);
    const left = motion.reduce((sum, each) => sum + each[2], 0);
    if (!scene.ledger) return [...motion, ["e6", scene.strings ? "lost, or stored in the strings" : "lost, or stored in the bridge", 1 - left]];
    const [initial, , normal, tangential, capillary, attraction, dry, strings, own] = frame.book.map((each) => each / frame.book[0]!);
    const parts: (Share | false)[] = [
      scene.bridge && ["e3", "stored in the bridge", capillary!],
      scene.attraction && ["e4", "against attraction", attraction!],
      scene.strings && ["e5", "stored in the strings", strings!],
      ["e6", "lost squeezing the film", normal!],
      ["e7", "lost shearing the film", tangential!],
      ["e8", "lost in solid contact", dry!],
      scene.own_model && ["e9", "taken by the model's events", own!],
    ];
    return initial ? [...motion, ...parts.filter((each) => each !== false)] : motion;
  }

  /** The first time at which they part faster along the line of centres than they came; NaN if none. */
  get overtakes(): number {
    const k = this.columns.velocity.findIndex((each) => each > this.impact.speed);
    return k < 0 ? NaN : this.columns.time[k]!;
  }

  /** Shares of the initial kinetic energy: along the line of centres, around it or along the wall, of the spins. */
  energies = (frame: Frame): Energies => frame.motion.map((each) => each / this.whole) as Energies;

  /** Kinetic energies of a row, J; beside a wall the ledger's, as the law does not give the motion along it. */
  private motion(row: number, velocity = this.rows[row * ROW + 2]!): Energies {
    const { masses, radius, partner } = this.geometry;
    const number = (k: number): number => this.rows[row * ROW + k]!;
    if (this.scene.wall) {
      const line = 0.5 * masses[0] * velocity ** 2;
      return [line, number(CODE + 2) - 0.5 * masses[0] * number(2) ** 2, 0];
    }
    const mass = (masses[0] * masses[1]) / (masses[0] + masses[1]);
    const spin = (k: 0 | 1, r: number): number => 0.2 * masses[k] * (r * number(5 + k)) ** 2;
    return [0.5 * mass * velocity ** 2, 0.5 * mass * (number(4) * this.distance(number(1))) ** 2, spin(0, radius) + spin(1, partner)];
  }
}

/** Radius of the liquid between the surfaces, taken as parabolas: of the bridge, else of what the films fill. */
export function wettedRadius(g: Geometry, gap: number): number {
  const radius = 2 * g.reduced;
  if (!g.volume) return Math.sqrt(radius * Math.max(g.film - gap, 0));
  const square = radius * (Math.sqrt(gap * gap + (2 * g.volume) / (Math.PI * radius)) - gap);
  return Math.min(Math.sqrt(square), 0.9 * Math.min(g.radius, g.partner || g.radius));
}
