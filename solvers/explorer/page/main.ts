// The page: knobs, map, answer, doublet, curves; and what goes out of it (address, TOML, Python, pictures).
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { isBadInput, Law, unpacked, type Collision, type Impact } from "./law";
import { Curves } from "./curves";
import { Doublet } from "./doublet";
import { fromPart, Mapper, toPart, type Grid } from "./mapper";
import { axisLabel, RegimeMap, speedLabel } from "./map";
import { address, copyOf, fromAddress, initial, python, readNumber, toml } from "./state";
import { along, answer, degrees, MEANINGS, OUTCOMES, percent, pretty, quantity, short } from "./text";
import { geometry, Trajectory } from "./trajectory";
import type { Knob, Scene, SpeedKind, State, Told } from "./scene";

const SECONDS = 6; // of the animation at speed 1
const TITLE = 20; // px above a panel of a saved picture
const LISTED = 9; // events named below the curves
const AFTER = 0.3; // of that, behind a separation
const told = JSON.parse(document.getElementById("scene")!.textContent!) as Told;
const labels = told.scenes.map(({ name, about }, k) => (told.scenes.findIndex((each) => each.name === name) === k ? name : about));
let scene: Scene; // that is open
let speedKnob: Knob;
let ends: readonly [number, number];
const knobOf = (name: string): Knob => scene.knobs.find((each) => each.name === name)!;

type Found = Collision & Impact;
interface Shown {
  found: Found;
  path: Trajectory | null;
}

/** An element from its name, attributes and children. */
function el<K extends keyof HTMLElementTagNameMap>(
  name: K,
  attributes: Record<string, string> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

const button = (text: string, click: () => void, attributes: Record<string, string> = {}): HTMLButtonElement => {
  const made = el("button", { type: "button", ...attributes }, text);
  made.addEventListener("click", click);
  return made;
};

class Page {
  private state: State;
  private pinnedState: State | null;
  private shown!: Shown;
  private pinned: Shown | null = null;
  private clock = 0; // parts of the collision's length
  private playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  private pace = 1;
  private stretched = true;
  private last = 0;
  private stale = false; // the pictures are of an older state
  private hashTimer = 0;
  private rows = new Map<string, { slider: HTMLInputElement; field: HTMLInputElement; hint: HTMLElement }>();
  private readonly mapper: Mapper;
  private readonly map: RegimeMap;
  private readonly curves: Curves;
  private readonly doublet: Doublet;
  private readonly pinnedDoublet: Doublet;
  private readonly title = el("strong");
  private readonly said = el("span");
  private readonly note = el("p", { class: "note", role: "alert" });
  private readonly energy = el("div", { class: "energy" });
  private readonly events = el("ol", { class: "events" });
  private readonly compare = el("div", { class: "compare", hidden: "" });
  private readonly code = el("textarea", { readonly: "", rows: "12", spellcheck: "false", hidden: "", "aria-label": "Scene or Python" });
  private readonly scrub = el("input", { type: "range", min: "0", max: "1000", step: "1", "aria-label": "Time of the collision" });
  private readonly playButton = button("", () => this.play(!this.playing));
  private readonly timing = el("span");
  private readonly beyond = el("span");
  private readonly leaving = new AbortController();
  readonly ready: number;
  gridCount = 0;
  refined = false;

  constructor(
    private readonly law: Law,
    module: WebAssembly.Module,
    private readonly place: number, // of the scene
  ) {
    const read = fromAddress(location.hash.slice(1), scene, told.scenes.length);
    [this.state, this.pinnedState] = [read.state, read.pinned];
    const [mapBox, doubletBox, curvesBox] = [el("div", { class: "map", tabindex: "0", role: "application", "aria-label": "Map of outcomes: arrow keys move the chosen impact, with Shift farther" }), el("div", { class: "doublets" }), el("div", { class: "curves" })];
    this.layout(mapBox, doubletBox, curvesBox);
    this.doublet = new Doublet(doubletBox);
    this.pinnedDoublet = new Doublet(doubletBox);
    this.pinnedDoublet.svg.classList.add("pinned");
    this.curves = new Curves(curvesBox, (time) => this.goTo(time));
    this.map = new RegimeMap(mapBox, scene, () => this.state, () => this.pinnedState, (x, y) => this.choose(x, y));
    const [legend] = document.getElementsByClassName("legend");
    OUTCOMES.forEach((name, k) => {
      const made = button("", () => this.map.find(k), { title: "Choose an impact of this outcome" });
      made.append(this.map.legend(k), ` ${name.toLowerCase()}: ${MEANINGS[k]}`);
      legend!.append(made);
    });
    // one core is left to what is seen
    this.mapper = new Mapper(scene, module, told.worker, (grid) => this.onGrid(grid), Math.min(Math.max((navigator.hardwareConcurrency || 2) - 1, 1), 4));
    this.setKind(this.state.speed);
    this.tell(read.ignored);
    if (this.pinnedState) this.pinned = this.follow(this.pinnedState);
    this.mapper.first(this.state, law);
    this.changed(false);
    this.repaint();
    this.play(this.playing);
    const { signal } = this.leaving;
    addEventListener("hashchange", () => this.onAddress(), { signal });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.repaint(), { signal });
    this.ready = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  close(): void {
    this.leaving.abort();
    clearTimeout(this.hashTimer);
    this.mapper.close();
    document.querySelector("main")!.remove();
  }

  // ---- what the page is made of

  private layout(mapBox: HTMLElement, doubletBox: HTMLElement, curvesBox: HTMLElement): void {
    const first = scene.knobs.filter((each) => each.first).map((each) => this.row(each));
    const rest = scene.knobs.filter((each) => !each.first).map((each) => this.row(each));
    const controls = el(
      "section",
      { class: "card controls", "aria-label": "Knobs" },
      ...(told.scenes.length > 1 ? [this.sceneChoice()] : []),
      ...first,
      ...(rest.length ? [el("details", {}, el("summary", {}, "More knobs"), ...rest)] : []),
      el("div", { class: "buttons" }, button("Reset", () => this.reset()), button("Pin to compare", () => this.pin(), { id: "pin" })),
    );
    const status = el("p", { class: "answer", role: "status", "aria-live": "polite" }, this.title, " ", this.said);
    const mapCard = el(
      "section",
      { class: "card mapcard", "aria-label": "Map" },
      el("div", { class: "axes" }, this.axisChoice("upward", "Up"), this.axisChoice("across", "Across")),
      mapBox,
      el("div", { class: "legend buttons", role: "group", "aria-label": "Choose an impact by its outcome" }),
      el("p", { class: "note" }, "The cross is the impact that you see: click, drag, use the arrow keys or press an outcome. Deeper colour: they part faster (normal restitution); chequered: faster than they came. ", this.beyond, " ", this.timing),
    );
    const answerCard = el("section", { class: "card answercard", "aria-label": "Answer" }, status, this.note, this.compare);
    this.scrub.addEventListener("input", () => {
      this.play(false);
      this.clock = Number(this.scrub.value) / 1000 * (1 + this.after());
      this.frame();
    });
    const pace = el("select", { "aria-label": "Speed of the animation" }, ...[0.25, 0.5, 1, 2, 4].map((k) => el("option", { value: `${k}`, ...(k === 1 ? { selected: "" } : {}) }, `${k}×`)));
    pace.addEventListener("change", () => (this.pace = Number(pace.value)));
    const stretch = el("input", { type: "checkbox", checked: "" });
    stretch.addEventListener("change", () => {
      const time = this.time();
      this.stretched = stretch.checked;
      this.drawCurves();
      this.goTo(time, false);
    });
    const doubletCard = el(
      "section",
      { class: "card doubletcard", "aria-label": "The particles" },
      doubletBox,
      el("div", { class: "player" }, this.playButton, this.scrub, pace),
      el("label", { class: "note" }, stretch, " slow down the fast beginning"),
      el("p", { class: "note" }, "Drawn to scale. ", scene.wall ? "Arrow: velocity. The line on the particle turns with it." : "Arrows: velocities, seen from the centre of mass. The line on each particle turns with it."),
      this.energy,
      ...(scene.strings ? [el("p", { class: "note" }, "The free flight after the films part is not drawn for particles on strings.")] : []),
      ...(scene.ledger ? [] : [el("p", { class: "note" }, "With friction of the solid contact the losses are not told apart: wetdoublet collide does.")]),
      ...(scene.wall ? [el("p", { class: "note" }, "The motion along the wall is not drawn: the exported law does not give it during contact.")] : []),
    );
    const curvesCard = el("section", { class: "card curvescard", "aria-label": "Curves in time" }, curvesBox, this.events);
    const share = el(
      "section",
      { class: "card share", "aria-label": "Take it with you" },
      el("div", { class: "buttons" },
        button("Copy link", () => this.copy(location.href)),
        button("Scene file (TOML)", () => this.copy(toml(this.state, scene, this.law), true)),
        button("Line of Python", () => this.copy(python(this.state, scene, this.law), true)),
        button("Picture, SVG", () => void this.picture("svg")),
        button("Picture, PNG", () => void this.picture("png"))),
      this.code,
    );
    document.body.append(el("main", {}, controls, el("div", { class: "column middle" }, mapCard, answerCard, share), el("div", { class: "column" }, doubletCard, curvesCard)));
  }

  private row(knob: Knob): HTMLElement {
    const id = `k-${knob.name.replace(".", "-")}`;
    const hint = el("small", { id: `${id}-hint` }, knob.hint);
    const field = el("input", { id, "aria-describedby": hint.id, type: "text", inputmode: "decimal", autocomplete: "off", size: "9", name: knob.name });
    const slider = el("input", { type: "range", min: "0", max: "1000", step: "1", "aria-label": knob.label, "data-knob": knob.name });
    slider.addEventListener("input", () => this.set(knob, Number(fromPart(knob, Number(slider.value) / 1000).toPrecision(4))));
    field.addEventListener("change", () => {
      const value = readNumber(field.value, knob);
      field.setAttribute("aria-invalid", String(Number.isNaN(value)));
      if (Number.isNaN(value)) this.tell([`${knob.label}: “${field.value.slice(0, 40)}” is not a number that it can have`], false);
      else this.set(knob, value);
    });
    this.rows.set(knob.name, { slider, field, hint });
    const unit = knob.name === "impact.speed" ? this.kindChoice() : el("span", { class: "unit" }, pretty(knob.unit));
    return el("div", { class: knob === speedKnob ? "row speed" : "row" }, el("label", { for: id }, knob.label), el("span", { class: "value" }, field, unit), hint, slider);
  }

  private sceneChoice(): HTMLElement {
    const made = el("select", { id: "preset" }, ...labels.map((text, k) => el("option", { value: `${k}`, ...(k === this.place ? { selected: "" } : {}) }, text)));
    made.addEventListener("change", () => void open(Number(made.value), this.state).then(() => document.getElementById("preset")!.focus()));
    return el("label", { class: "row speed" }, "Scene ", made);
  }

  private kindChoice(): HTMLSelectElement {
    const options = [["stokes", "Stokes number"], ["speed", `m/s ${along(scene)}`], ["relative_speed", "m/s in all"]] as const;
    const made = el("select", { id: "kind", "aria-label": "What the speed is" }, ...options.map(([value, text]) => el("option", { value }, text.replace("m/s", pretty(speedKnob.unit || "m/s")))));
    made.addEventListener("change", () => {
      this.setKind(made.value as SpeedKind);
      this.changed(true);
    });
    return made;
  }

  private axisChoice(axis: "across" | "upward", text: string): HTMLElement {
    const made = el("select", { id: axis }, ...scene.knobs.map((each) => el("option", { value: each.name }, each.label)));
    made.addEventListener("change", () => {
      const other = axis === "across" ? "upward" : "across";
      if (made.value === this.state[other]) this.state[other] = this.state[axis];
      this.state[axis] = made.value;
      this.changed(true);
    });
    return el("label", {}, `${text} `, made);
  }

  // ---- changes

  /** Gives the speed in another way, the impact as it is; the slider's ends are the scene's. */
  private setKind(kind: SpeedKind): void {
    const convert = (state: State, value: number): number => {
      this.law.set(state.values);
      const impact = this.law.impact({ ...state.values, "impact.speed": value }, state.speed);
      if (kind === state.speed) return value;
      const scale = kind === "stokes" ? this.law.stokesPerSpeed : (kind === "speed" ? 1 : 1 / Math.cos(impact.angle)) / speedKnob.factor;
      return impact.speed * scale;
    };
    const plain = initial(scene);
    [speedKnob.low, speedKnob.high] = ends.map((each) => Number(convert(plain, each).toPrecision(1))) as [number, number];
    this.state.values["impact.speed"] = convert(this.state, this.state.values["impact.speed"]!);
    this.state.speed = kind;
  }

  private set(knob: Knob, value: number): void {
    this.state.values[knob.name] = value;
    this.tell([]);
    this.changed(knob.name !== this.state.across && knob.name !== this.state.upward);
  }

  private choose(across: number, upward: number): void {
    const { values } = this.state;
    values[this.state.across] = Number(across.toPrecision(5));
    values[this.state.upward] = Number(upward.toPrecision(5));
    this.changed(false);
  }

  private reset(): void {
    this.state = initial(scene);
    this.setKind(scene.speed);
    this.unpin();
    this.tell([]);
    this.changed(true);
  }

  private pin(): void {
    if (this.pinned) return this.unpin(true);
    this.pinnedState = copyOf(this.state);
    this.pinned = this.shown;
    this.changed(false);
  }

  private unpin(update = false): void {
    [this.pinned, this.pinnedState] = [null, null];
    if (update) this.changed(false);
  }

  private onAddress(): void {
    if (location.hash.slice(1) === this.address()) return;
    if (placeOf(location.hash) !== this.place) return void open(placeOf(location.hash));
    const read = fromAddress(location.hash.slice(1), scene, told.scenes.length);
    this.state = { ...read.state };
    this.setKind(read.state.speed);
    this.pinnedState = read.pinned;
    this.pinned = read.pinned ? this.follow(read.pinned) : null;
    this.tell(read.ignored);
    this.changed(true);
  }

  private address = (): string => [this.place ? `scene=${this.place}` : "", address(this.state, this.pinnedState, scene)].filter(Boolean).join("&");

  private tell(ignored: string[], ofAddress = true): void {
    this.note.textContent = ignored.length ? (ofAddress ? `Not understood in the address, and left out: ${ignored.slice(0, 4).join("; ")}` : ignored[0]!) : "";
  }

  private follow(state: State): Shown {
    const found = this.law.collide(state.values, state.speed, scene.rtol);
    if (found.status) return { found, path: null };
    const shape = geometry(this.law, scene);
    const { rows, events } = this.law.follow(scene.rtol, shape.film / found.speed / 50, 2e-3 * found.speed);
    return { found, path: rows.length ? new Trajectory(rows, events, shape, found, scene) : null };
  }

  private changed(newMap: boolean): void {
    this.shown = this.follow(this.state);
    for (const knob of scene.knobs) {
      const { slider, field, hint } = this.rows.get(knob.name)!;
      const value = this.state.values[knob.name]!;
      const text = short(value, 5);
      slider.value = String(Math.round(1000 * (value === Infinity ? 1 : toPart(knob, value))));
      slider.setAttribute("aria-valuetext", `${text} ${pretty(knob.unit)}`);
      if (document.activeElement !== field || field.getAttribute("aria-invalid") !== "true") field.value = text;
      if (knob === speedKnob) hint.textContent = this.shown.found.status ? "" : this.state.speed === "stokes" ? `inertia/viscosity; ${quantity(this.shown.found.speed, "m/s")} ${along(scene)}` : `Stokes number ${short(this.stokes())}`;
    }
    for (const option of document.querySelectorAll('.axes option[value="impact.speed"]')) option.textContent = speedLabel(speedKnob, this.state.speed).replace(/,.*/, "");
    (document.getElementById("kind") as HTMLSelectElement).value = this.state.speed;
    for (const axis of ["across", "upward"] as const) (document.getElementById(axis) as HTMLSelectElement).value = this.state[axis];
    document.getElementById("pin")!.textContent = this.pinned ? "Unpin" : "Pin to compare";
    this.say();
    if (!this.playing && this.clock > 1 + this.after()) this.clock = 1;
    this.stale = true;
    if (newMap) {
      this.refined = false;
      this.mapper.request(this.state);
    }
    this.code.hidden = true;
    clearTimeout(this.hashTimer);
    this.hashTimer = window.setTimeout(() => {
      const hash = this.address();
      try {
        history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
      } catch {
        // a frame without an address of its own, as in a notebook
      }
      if (parent !== window) parent.postMessage({ wetdoublet: { address: hash, toml: this.shown.found.status ? "" : toml(this.state, scene, this.law) } }, "*");
    }, 250);
  }

  private onGrid(grid: Grid): void {
    this.map.show(grid);
    this.gridCount++;
    this.refined = grid.refined;
    document.querySelectorAll<HTMLButtonElement>(".legend button").forEach((each, k) => (each.disabled = this.map.widest(k) < 0));
    const n = grid.across.length ** 2;
    const beyond = scene.limits.filter((_, bit) => grid.outside.some((each) => each & (1 << bit)));
    this.beyond.textContent = beyond.length ? `Dotted: outside the model's range (${[...new Set(beyond)].join("; ")}).` : "";
    const bad = grid.outcome.filter((each) => each < 0).length;
    const { coarse, fine } = this.mapper.timings;
    this.timing.textContent = grid.refined || fine ? `${n.toLocaleString("en")} collisions in ${(grid.refined ? fine : coarse).toFixed(0)} ms${bad ? `, ${bad} without an answer (grey)` : ""}.` : "";
  }

  // ---- what is shown

  private say(): void {
    const [title, said] = answer(this.shown.found, scene, this.stokes());
    this.title.textContent = `${title}.`;
    this.said.textContent = said + this.gain(this.shown);
    if (this.shown.found.status && isBadInput(this.shown.found.status)) this.said.textContent = `${said} Change that knob.`;
    const events = this.shown.path?.events ?? [];
    this.events.replaceChildren(
      ...events.slice(0, LISTED).map((each) => el("li", {}, button(`${quantity(each.time, "s")}: ${each.words}`, () => this.goTo(each.time)))),
      ...(events.length > LISTED ? [el("li", {}, `and ${events.length - LISTED} more`)] : []),
    );
    this.compare.hidden = !this.pinned;
    if (this.pinned) this.compare.replaceChildren(this.comparison(this.pinned.found, this.shown.found));
  }

  /** Why a normal restitution exceeds 1, from the energies at its beginning and end. */
  private gain({ found, path }: Shown): string {
    if (!(found.restitution > 1) || !path || (scene.wall && !scene.ledger)) return "";
    const [first, last] = [path.before, path.energies(path.at(path.end))];
    const turning = (each: number[]): number => each[1]! + each[2]!;
    return ` It leaves faster along the line of centres than it came, with ${percent(last[0])} of the kinetic energy before in place of ${percent(first[0])}: rotation gave up ${percent(turning(first) - turning(last))}, more than liquid and contact took.`;
  }

  private stokes = (): number => this.law.stokesPerSpeed * this.shown.found.speed;

  private comparison(pinned: Found, now: Found): HTMLElement {
    const rows: [string, (f: Found) => string][] = [
      ["Outcome", (f) => (f.status ? "no answer" : OUTCOMES[f.outcome]!)],
      ["Normal restitution", (f) => short(f.restitution, 4)],
      ["Tangential restitution", (f) => short(f.tangential_restitution, 4)],
      ["Contact time", (f) => quantity(f.contact_time, "s")],
      ["Rotation", (f) => (Number.isFinite(f.rotation) ? degrees(f.rotation) : "–")],
      ["Smallest gap", (f) => quantity(f.smallest_gap, "m")],
    ];
    const differing = scene.knobs.filter((each) => this.pinnedState!.values[each.name] !== this.state.values[each.name]);
    const body = [
      ...differing.map((each) => [axisLabel(each, this.state), short(this.pinnedState!.values[each.name]!, 5), short(this.state.values[each.name]!, 5)]),
      ...rows.map(([name, of]) => [name, of(pinned), of(now)]),
    ].map(([head, ...cells]) => el("tr", {}, el("th", { scope: "row" }, head!), ...cells.map((each) => el("td", {}, each))));
    const head = el("tr", {}, el("td"), el("th", { scope: "col" }, "pinned"), el("th", { scope: "col" }, "now"));
    return el("table", {}, el("thead", {}, head), el("tbody", {}, ...body));
  }

  private drawCurves(): void {
    this.curves.show(this.shown.path, this.pinned?.path ?? null, this.stretched);
  }

  /** Draws all but the words; several changes between two frames of the screen are drawn once. */
  private repaint(): void {
    this.stale = false;
    this.map.redraw();
    this.drawCurves();
    this.frame();
  }

  // ---- time

  private after = (): number => (this.shown.path?.separated && !scene.strings ? AFTER : 0);

  /** The time of a place of the clock; stretched, it runs with asinh(t/tau), tau the time of the film at the approach speed. */
  private timeAt(path: Trajectory, clock: number): number {
    if (clock > 1) return path.end * (1 + 1.2 * (clock - 1));
    return this.stretched ? path.tau * Math.sinh(clock * Math.asinh(path.end / path.tau)) : clock * path.end;
  }

  private time = (): number => (this.shown.path ? this.timeAt(this.shown.path, this.clock) : 0);

  private goTo(time: number, stop = true): void {
    const path = this.shown.path;
    if (!path) return;
    if (stop) this.play(false);
    const within = Math.min(time, path.end);
    this.clock = this.stretched ? Math.asinh(within / path.tau) / Math.asinh(path.end / path.tau) : within / path.end;
    this.frame();
  }

  private play(on: boolean): void {
    if (on && this.clock >= 1 + this.after()) this.clock = 0;
    this.playing = on;
    this.playButton.textContent = on ? "Pause" : "Play";
  }

  private tick(now: number): void {
    if (this.stale) this.repaint();
    const step = Math.min(now - this.last, 100) / 1000;
    this.last = now;
    if (this.playing && this.shown.path) {
      this.clock += (step * this.pace) / SECONDS;
      if (this.clock > 1 + this.after()) this.clock = 0;
      this.frame();
    }
    if (!this.leaving.signal.aborted) requestAnimationFrame((next) => this.tick(next));
  }

  private frame(): void {
    const { path } = this.shown;
    this.doublet.svg.style.visibility = path ? "visible" : "hidden";
    this.pinnedDoublet.svg.style.display = this.pinned?.path ? "" : "none";
    this.scrub.value = String(Math.round((1000 * this.clock) / (1 + this.after())));
    if (this.pinned?.path) this.pinnedDoublet.show(this.pinned.path, this.pinned.path.at(this.timeAt(this.pinned.path, this.clock)));
    if (!path) return this.energy.replaceChildren();
    const time = this.time();
    const frame = path.at(time);
    this.scrub.setAttribute("aria-valuetext", quantity(time, "s"));
    this.doublet.show(path, frame);
    this.curves.mark(time);
    this.showEnergy(path, time);
  }

  /** The ledger as it fills: what is there, what is stored, what is lost; and why they may part faster than they came. */
  private showEnergy(path: Trajectory, time: number): void {
    if (scene.wall && !scene.ledger) return;
    const shares = path.ledger(path.at(Math.min(time, path.end)));
    const gains = Number.isFinite(path.overtakes);
    if (this.energy.childElementCount !== (gains ? 4 : 3) || this.energy.querySelectorAll("li").length !== shares.length + 1)
      this.energy.replaceChildren(
        el("p", { class: "note" }, "Where the initial kinetic energy is now. In colour: in motion, or stored (below 0: given); striped: lost."),
        el("div", { class: "bar", "aria-hidden": "true" }, ...shares.map(([colour]) => el("i", { class: colour }))),
        el("ul", {}, ...shares.map(([colour, name]) => el("li", {}, el("i", { class: colour }), `${name} `, el("b"))), el("li", {}, "sum ", el("b"))),
        ...(gains ? [el("p", { class: "note" })] : []),
      );
    const whole = shares.reduce((sum, [, , part]) => sum + Math.max(part, 0), 0);
    const bars = this.energy.querySelectorAll<HTMLElement>(".bar i");
    const numbers = [...this.energy.querySelectorAll("b")];
    if (gains) this.energy.lastElementChild!.textContent = path.overtakes <= time ? "Now faster along the line of centres than it came: rotation has become normal motion." : "";
    shares.forEach(([, , part], k) => {
      bars[k]!.style.width = `${(100 * Math.max(part, 0)) / whole}%`;
      numbers[k]!.textContent = percent(part);
    });
    numbers.at(-1)!.textContent = percent(shares.reduce((sum, [, , part]) => sum + part, 0));
  }

  // ---- out of the page

  private copy(text: string, show = false): void {
    this.code.hidden = !show;
    this.code.value = text;
    if (show) this.code.select();
    navigator.clipboard?.writeText(text).catch(() => undefined);
  }

  /** Map, doublet, curves and answer in one picture. */
  private async picture(kind: "svg" | "png"): Promise<void> {
    const canvases = [this.map.canvas, ...this.curves.canvases];
    const titles = ["", ...[...document.querySelectorAll(".u-title")].map((each) => each.textContent!)];
    const styled = this.doublet.svg.cloneNode(true) as SVGSVGElement;
    const names = ["--liquid", "--first", "--second", "--ink", "--accent"];
    const style = getComputedStyle(document.documentElement);
    const resolve = (text: string): string => names.reduce((all, each) => all.replaceAll(`var(${each})`, style.getPropertyValue(each).trim()), text);
    const sizes = canvases.map((each) => [each.width / devicePixelRatio, each.height / devicePixelRatio] as const);
    const right = sizes.slice(1).reduce((sum, each) => sum + each[1] + TITLE, 0) + 320;
    const width = sizes[0]![0] + Math.max(sizes[1]?.[0] ?? 0, 420) + 30;
    const height = Math.max(sizes[0]![1] + 140, right) + 70;
    const ink = style.getPropertyValue("--ink").trim();
    const write = (text: string, x: number, y: number, weight = "normal"): string =>
      `<text x="${x}" y="${y}" font-family="sans-serif" font-size="13" font-weight="${weight}" fill="${ink}">${el("p", {}, text).innerHTML}</text>`;
    styled.setAttribute("x", `${sizes[0]![0] + 20}`);
    styled.setAttribute("y", "40");
    styled.setAttribute("width", "420");
    styled.setAttribute("height", "300");
    const words = `${this.title.textContent} ${this.said.textContent}`.match(new RegExp(`.{1,${Math.floor(sizes[0]![0] / 7)}}(\\s|$)`, "g")) ?? [];
    let y = 350;
    const images = canvases.map((each, k) => {
      const [w, h] = sizes[k]!;
      const place = k ? [sizes[0]![0] + 20, y] : [10, 40];
      if (k) y += h + TITLE;
      return `${k ? write(titles[k]!, sizes[0]![0] + 70, place[1]! - 4, "bold") : ""}<image x="${place[0]}" y="${place[1]}" width="${w}" height="${h}" href="${each.toDataURL()}"/>`;
    });
    const lines = words.map((each, k) => write(each, 14, sizes[0]![1] + 64 + 18 * k)).join("");
    const head = `<rect width="100%" height="100%" fill="${style.getPropertyValue("--card")}"/>${write(`wetdoublet: ${scene.name}`, 14, 24, "bold")}${lines}`;
    const drawn = resolve(styled.outerHTML).replaceAll('class="note"', `font-family="sans-serif" font-size="12" fill="${ink}"`);
    const svg = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">${head}${images.join("")}${drawn}</svg>`;
    let blob = new Blob([svg], { type: "image/svg+xml" });
    if (kind === "png") {
      const image = new Image();
      image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
      await image.decode();
      const canvas = el("canvas", { width: `${2 * width}`, height: `${2 * height}` });
      canvas.getContext("2d")!.drawImage(image, 0, 0, 2 * width, 2 * height);
      blob = await new Promise((resolve) => canvas.toBlob((made) => resolve(made!), "image/png"));
    }
    const link = el("a", { href: URL.createObjectURL(blob), download: `${scene.name}.${kind}` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  /** What tests read and do. */
  readonly handle = {
    state: (): State => copyOf(this.state),
    collide: (state: State, rtol = scene.rtol): Found => this.law.collide(state.values, state.speed, rtol),
    toml: (state: State): string => toml(state, scene, this.law),
    python: (state: State): string => python(state, scene, this.law),
    shown: (): Shown => this.shown,
    ledger: (part: number): [string, string, number][] => this.shown.path!.ledger(this.shown.path!.at(part * this.shown.path!.end)),
    energies: (): number[][] => (this.shown.path ? [this.shown.path.before, this.shown.path.energies(this.shown.path.at(this.shown.path.end))] : []),
    map: () => ({ idle: this.mapper.idle, count: this.gridCount, refined: this.refined, ...this.mapper.timings }),
    grid: (): Grid | null => (this.map as unknown as { grid: Grid | null }).grid,
    ready: (): number => this.ready,
    set: (name: string, value: number): void => this.set(knobOf(name), value),
  };
}

declare global {
  interface Window {
    wetdoublet: Page["handle"];
  }
}

const compiled = new Map<string, Promise<WebAssembly.Module>>();
let page: Page | null = null;

/** The place of the scene that an address names; the first if it names none. */
function placeOf(hash: string): number {
  const name = new URLSearchParams(hash.slice(1, 4000)).get("scene") ?? "0";
  return /^\d{1,3}$/.test(name) && Number(name) < told.scenes.length ? Number(name) : 0;
}

/** Opens a scene: as its address says, or after another state. One of the same name, with another law, keeps what both have. */
async function open(place: number, after?: State): Promise<void> {
  const next = told.scenes[place]!;
  const digest = next.module;
  if (!compiled.has(digest)) compiled.set(digest, unpacked(told.modules[digest]!));
  const module = await compiled.get(digest)!;
  if (after) {
    const kept = next.name === scene.name ? { ...after, values: { ...initial(next).values, ...after.values } } : initial(next);
    const hash = [`scene=${place}`, address(kept, null, next)].filter(Boolean).join("&");
    try {
      history.replaceState(null, "", `#${hash}`);
    } catch {
      location.hash = hash;
    }
  }
  page?.close();
  scene = next;
  speedKnob = knobOf("impact.speed");
  ends = (ranges[place] ??= [speedKnob.low, speedKnob.high]);
  document.querySelector("h1")!.textContent = scene.title;
  document.querySelector("header span")!.textContent = scene.about;
  document.title = `wetdoublet: ${scene.name}`;
  page = new Page(new Law(module, scene.layout, scene.knobs, scene.entries, scene.limits), module, place);
  window.wetdoublet = page.handle;
}
const ranges: (readonly [number, number])[] = []; // of the speed's slider, as the scenes have it

open(placeOf(location.hash))
  .catch((error: unknown) => document.body.prepend(el("p", { role: "alert", class: "card" }, `This browser cannot run the page: ${String(error)}`)));
