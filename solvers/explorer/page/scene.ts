// What Python tells the page of a scene (page_of_scene.py and knobs.py).

export interface Knob {
  name: string;
  label: string;
  unit: string;
  factor: number;
  value: number | null;
  low: number;
  high: number;
  logarithmic: boolean;
  members: string[];
  never: number | null;
  first: boolean;
  hint: string; // what the label means
}

export type SpeedKind = "stokes" | "speed" | "relative_speed";
export type Layout = Record<"pair_entries" | "material" | "impact" | "collision", [string, string][]>;

export interface Scene {
  name: string;
  rtol: number;
  title: string;
  about: string;
  module: string; // digest of its law's
  layout: Layout;
  entries: Record<string, number>;
  knobs: Knob[];
  speed: SpeedKind;
  own_model: boolean;
  wall: boolean;
  strings: boolean;
  ledger: boolean;
  attraction: boolean;
  bridge: boolean;
  tables: [string, string, string | null, string | null, string | null][];
  limits: string[]; // of the model, in words
  outcomes: string[];
  criteria: string[];
  colours: string[];
}

/** What the page is told: modules in base64 under their digests. */
export interface Told {
  worker: string;
  modules: Record<string, string>;
  scenes: Scene[];
}

/** Numbers of all knobs in their units; Infinity is a limit that is never met. */
export type Values = Record<string, number>;

export interface State {
  values: Values;
  speed: SpeedKind;
  across: string;
  upward: string;
}
