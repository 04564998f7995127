// The doublet as a drawing to scale, as `wetdoublet collide --plot` has it.
import { quantity } from "./text";
import { wettedRadius, type Frame, type Trajectory } from "./trajectory";

const NS = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT] = [420, 300];
const THINNEST = 1.5; // px: a film is seen however thin

type Point = [number, number];

export class Doublet {
  readonly svg = make("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": "The two particles" });
  private readonly liquid = make("g", { fill: "var(--liquid)" }, this.svg);
  private readonly films = [make("circle", {}, this.liquid), make("circle", {}, this.liquid)];
  private readonly wallFilm = make("rect", {}, this.liquid);
  private readonly neck = make("path", {}, this.liquid);
  private readonly wall = make("rect", { fill: "var(--second)", stroke: "var(--ink)" }, this.svg);
  private readonly balls = [0, 1].map((k) => make("circle", { fill: k ? "var(--second)" : "var(--first)", stroke: "var(--ink)" }, this.svg));
  private readonly marks = [0, 1].map(() => make("path", { stroke: "var(--ink)", "stroke-width": "2", fill: "none" }, this.svg));
  private readonly arrows = [0, 1].map(() => make("path", { stroke: "var(--accent)", "stroke-width": "3", fill: "none" }, this.svg));
  private readonly clock = make("text", { x: "8", y: "18", class: "note" }, this.svg);
  private readonly gapText = make("text", { x: "8", y: `${HEIGHT - 8}`, class: "note" }, this.svg);
  private readonly bar = make("path", { stroke: "var(--ink)", "stroke-width": "2" }, this.svg);
  private readonly barText = make("text", { x: `${WIDTH - 8}`, y: "28", class: "note", "text-anchor": "end" }, this.svg);

  constructor(parent: HTMLElement) {
    parent.append(this.svg);
  }

  show(path: Trajectory, frame: Frame): void {
    const g = path.geometry;
    const wall = g.partner === 0;
    const reach = wall ? 2.9 * g.radius : 2.25 * (g.radius + g.partner) + g.film;
    const scale = Math.min(HEIGHT / reach, WIDTH / (1.25 * reach));
    const distance = path.distance(frame.gap);
    const [c, s] = wall ? [1, 0] : [Math.cos(frame.angle), Math.sin(frame.angle)];
    const share = wall ? 0.5 : g.share;
    const at = (x: number, y: number): Point => [WIDTH / 2 + scale * (c * x - s * y), HEIGHT / 2 - scale * (s * x + c * y)];
    const centres: Point[] = [at(-share * distance, 0), at((1 - share) * distance, 0)];
    const coat = Math.max((scale * g.film) / 2, THINNEST);
    [g.radius, g.partner].forEach((radius, k) => {
      const [x, y] = centres[k]!;
      const there = radius > 0;
      for (const [circle, size] of [[this.films[k]!, scale * radius + coat], [this.balls[k]!, scale * radius]] as const)
        set(circle, { cx: x, cy: y, r: there ? size : 0 });
      const turn = frame.turned[k]! + (k ? Math.PI : 0);
      const [rimX, rimY] = [x + scale * radius * Math.cos(turn), y - scale * radius * Math.sin(turn)];
      set(this.marks[k]!, { d: there ? `M${num(x)} ${num(y)}L${num(rimX)} ${num(rimY)}` : "" });
    });
    const [wallX] = centres[1]!;
    const walls = wall ? { y: 0, height: HEIGHT } : { y: 0, height: 0 };
    set(this.wall, { x: wallX, width: 40, ...walls });
    set(this.wallFilm, { x: wallX - coat, width: coat, ...walls });
    // velocities relative to the centre of mass: along the line of centres, and across (beside a wall only along it)
    const first = path.at(0);
    const fastest = Math.hypot(first.velocity, wall ? 0 : first.rate * path.distance(first.gap)) * Math.max(share, 1 - share);
    const speeds = [frame.velocity, wall ? 0 : frame.rate * distance];
    [-share, 1 - share].forEach((part, k) => {
      const long = (1.1 * g.radius * part) / fastest;
      const [x0, y0] = centres[k]!;
      const [x1, y1] = at(part * distance + long * speeds[0]!, long * speeds[1]!);
      const size = Math.hypot(x1 - x0, y1 - y0);
      const [ux, uy] = [(5 * (x1 - x0)) / size, (5 * (y1 - y0)) / size];
      const head = `M${num(x1 - 2 * ux - uy)} ${num(y1 - 2 * uy + ux)}L${num(x1)} ${num(y1)}L${num(x1 - 2 * ux + uy)} ${num(y1 - 2 * uy - ux)}`;
      set(this.arrows[k]!, { d: size > 4 && !(wall && k) ? `M${num(x0)} ${num(y0)}L${num(x1)} ${num(y1)}${head}` : "" });
    });
    set(this.neck, { d: frame.apart ? "" : this.outline(path, frame, at, share, distance) });
    this.clock.textContent = `t = ${quantity(frame.time, "s")}${frame.apart ? ", apart" : ""}`;
    this.gapText.textContent = `gap ${quantity(frame.gap, "m")}`;
    set(this.bar, { d: `M${num(WIDTH - 8 - scale * g.radius)} 12H${WIDTH - 8}` });
    this.barText.textContent = quantity(g.radius, "m");
  }

  /** The liquid between the surfaces: along the first and back along the other. */
  private outline(path: Trajectory, frame: Frame, at: (x: number, y: number) => Point, share: number, distance: number): string {
    const g = path.geometry;
    const half = wettedRadius(g, frame.gap);
    if (!(half > 0)) return "";
    const rises = Array.from({ length: 17 }, (_, k) => half * (k / 8 - 1));
    const near = rises.map((y) => at(-share * distance + Math.sqrt(Math.max(g.radius ** 2 - y * y, 0)), y));
    const back = rises.map((y) => at((1 - share) * distance - (g.partner ? Math.sqrt(Math.max(g.partner ** 2 - y * y, 0)) : 0), y));
    return `M${[...near, ...back.reverse()].map(([x, y]) => `${num(x)} ${num(y)}`).join("L")}Z`;
  }
}

const num = (x: number): string => x.toFixed(2);

function make<K extends keyof SVGElementTagNameMap>(name: K, attributes: Record<string, string>, parent?: Element): SVGElementTagNameMap[K] {
  const made = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent?.append(made);
  return made;
}

function set(element: Element, attributes: Record<string, number | string>): void {
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, typeof value === "number" ? num(value) : value);
}
