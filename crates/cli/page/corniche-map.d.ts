/** Types of the module corniche-map: the element <corniche-map> and the details of its events. */

/** A place to look at. Omitted fields stay unchanged. */
export interface Target {
  /** Longitude, WGS84 degrees. */
  lon: number;
  /** Latitude, WGS84 degrees. */
  lat: number;
  /** Metres from the eye. */
  distance?: number;
  /** Degrees clockwise from north. */
  heading?: number;
  /** Degrees from straight down: 0 looks down, 90 at the horizon. */
  pitch?: number;
  /** Straight from above with parallel rays. */
  above?: boolean;
  /** From above, instead of the distance: metres per pixel. */
  pixel_m?: number;
}

/** The current view. */
export interface Place extends Target {
  /** Height of the ground in the middle, metres; absent if there is no ground. */
  height?: number;
  heading: number;
  pitch: number;
}

export interface Settings {
  /** The drawing method of roads: as geometry (GEO), by shadow volumes (SV), or not at all. */
  roads: "geo" | "sv" | "none";
  compare: "off" | "split" | "difference";
  /** The position of the divider between GEO and SV, 0 left to 1 right. */
  divider: number;
  /** Whether each class is shown, in the order of `About.classes`. */
  classes: boolean[];
  /** A factor on the width of each class. */
  widths: number[];
  outline: "style" | "none" | "3" | "5";
  /** One of `About.styles`, or the address of a custom style: a text with a slash or that ends in `.toml`. A custom style appears here once its file has been read. */
  style: string;
  /** The opacity of photos, 0 to 1; `null` for that of the style. */
  photo: number | null;
  /** The ids of the layers that are drawn; `null` for all. */
  layers: string[] | null;
  /** A factor on heights. */
  exaggeration: number;
  /** The largest error of the ground on the screen, pixels. */
  error_px: number;
  cell_px: number | null;
  /** Samples per pixel along each side. */
  samples: number;
  wireframe: boolean;
  inertia: boolean;
}

export interface About {
  name: string;
  src: string;
  attribution: string[];
  /** West, south, east, north in degrees. */
  bounds: [number, number, number, number];
  /** Lowest and highest ground, metres. */
  heights: [number, number];
  tiles: number;
  levels: number;
  styles: string[];
  /** Names of the classes of roads, and their colours in the style shown. */
  classes: { label: string; color: string }[];
  /** The layers of the map, the highest first, and the classes that are drawn, with their colours in the style shown. */
  layers: { id: string; title: string; geometry: "line" | "area" | "point"; classes: { label: string; color: string }[] }[];
  has: { photo: boolean };
  adapter: string;
  /** Whether the CPU draws. */
  is_software: boolean;
  max_side_px: number;
  format_version: number;
  bytes: number;
}

export interface FrameReport {
  next: "now" | "asked";
  is_settled: boolean;
  view: Place | null;
  cursor: { lon: number; lat: number; height: number } | null;
  /** In the middle, per pixel of the screen and per CSS pixel. */
  metres_per_pixel: number | null;
  metres_per_point: number | null;
  mode: "map" | "fly";
  tiles: { drawn: number; missing: number; loading: number; full: boolean };
  triangles: number;
  segments: number;
  /** Used and allowed bytes. */
  gpu_bytes: [number, number];
  requests: number;
  bytes: number;
  progress: number;
  recording_s: number | null;
  is_playing: boolean;
  notices: { kind: "warn" | "tell"; text: string }[];
}

export interface Pick {
  lon: number;
  lat: number;
  height: number;
  /** The road at the place. `way` is the id of the way in OpenStreetMap. */
  road: null | { way: number; class: number; label: string; attributes: Record<string, string> };
}

export interface Failure {
  kind:
    | "no-webgpu"
    | "no-adapter"
    | "limits"
    | "network"
    | "not-found"
    | "cors"
    | "no-ranges"
    | "compressed"
    | "changed"
    | "damaged"
    | "foreign"
    | "old-format"
    | "no-ground"
    | "off-ground"
    | "out-of-memory"
    | "device-lost"
    | "files"
    | "other";
  message: string;
  /** What the user can do; may be empty. */
  advice: string;
}

export interface CornicheMapEventMap {
  /** The package is open. */
  ready: CustomEvent<About>;
  /** The camera came to rest. */
  moveend: CustomEvent<Place>;
  /** A click, a tap, a long press or Enter: the place there, or `null` over the sky. `preventDefault()` suppresses the element's own card. */
  pick: CustomEvent<Pick | null>;
  /** The map cannot be shown. */
  error: CustomEvent<Failure>;
}

/** The element <corniche-map>. */
export class CornicheMap extends HTMLElement {
  /** The address of the package. */
  src: string;
  roads: Settings["roads"];
  compare: Settings["compare"];
  divider: number;
  /** As `Settings.style`. Assigning it again reads the file of a custom style again. */
  mapStyle: string;
  outline: Settings["outline"];
  exaggeration: number;
  errorPx: number;
  cellPx: number | null;
  samples: number;
  photo: number | null;
  layers: Settings["layers"];
  wireframe: boolean;
  inertia: boolean;
  /** All settings. An assigned object changes the settings that it contains; an invalid value throws a RangeError. A notice reports a style file that cannot be read. */
  get settings(): Settings;
  set settings(change: Partial<Settings>);
  /** Facts about the package; `null` before `ready`. */
  readonly about: About | null;
  /** The report of the last frame; `null` before the first. */
  readonly report: FrameReport | null;
  /** The current view; an assignment jumps there. `null` before `ready`. */
  get camera(): Place | null;
  set camera(target: Target | null);
  /** Moves to a place; with `jump` at once. */
  lookAt(target: Target, options?: { jump?: boolean }): void;
  /** Moves to "lon,lat". */
  goTo(text: string): void;
  command(name: "north-up" | "reset" | "toggle-fly" | "toggle-above"): void;
  /** The place at a position, in CSS pixels from the corner of the element; `null` over the sky. Rejects, with `kind` and `message`, if the roads there cannot be fetched. */
  pick(x: number, y: number): Promise<Pick | null>;
  startRecording(): void;
  /** Ends the recording and returns the flight as TOML. */
  stopRecording(): string;
  /** Plays a flight; fulfilled when it has begun. */
  play(flight: string): Promise<void>;
  /** The map as a PNG with its attribution. */
  picture(): Promise<Blob>;
  /** The pixels as shown last: RGBA, rows from the top, without attribution. */
  readPixels(): Promise<{ width: number; height: number; data: Uint8Array }>;
  /** Fulfilled when nothing moves, all tiles of the view are loaded, and the file of a custom style has been read. */
  settled(): Promise<void>;

  addEventListener<K extends keyof CornicheMapEventMap>(
    type: K,
    listener: (this: CornicheMap, event: CornicheMapEventMap[K]) => unknown,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject | null, options?: boolean | AddEventListenerOptions): void;
  removeEventListener<K extends keyof CornicheMapEventMap>(
    type: K,
    listener: (this: CornicheMap, event: CornicheMapEventMap[K]) => unknown,
    options?: boolean | EventListenerOptions,
  ): void;
  removeEventListener(type: string, listener: EventListenerOrEventListenerObject | null, options?: boolean | EventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "corniche-map": CornicheMap;
  }
}
