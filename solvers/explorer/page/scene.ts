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
}

/** A number that says how far the model may be trusted; null where there is no bound. */
export interface Limit {
  words: string;
  least: number | null;
  most: number | null;
}

export type SpeedKind = "stokes" | "speed" | "relative_speed";
export type Layout = Record<"pair_entries" | "material" | "impact" | "collision", [string, string][]>;

export interface Scene {
  name: string;
  rtol: number;
  wasm: string;
  worker: string;
  layout: Layout;
  entries: Record<string, number>;
  knobs: Knob[];
  speed: SpeedKind;
  own_model: boolean;
  wall: boolean;
  strings: boolean;
  tables: [string, string, string | null, string | null, string | null][];
  limits: Limit[];
  outcomes: string[];
  criteria: string[];
  colours: string[];
}

/** Numbers of all knobs in their units; Infinity is a limit that is never met. */
export type Values = Record<string, number>;

export interface State {
  values: Values;
  speed: SpeedKind;
  across: string;
  upward: string;
}
