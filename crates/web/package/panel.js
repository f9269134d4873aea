// The panel: all settings of the map, its legend, and actions of the camera.
import { action, choice, section, select, slider, toggle } from "./controls.js";
import { make, setText } from "./dom.js";
import { closeButton, icons } from "./icons.js";
import { makeLayers, makeLegend } from "./legend.js";

const percent = (/** @type {number} */ value) => `${Math.round(value * 100)} %`;
const times = (/** @type {number} */ value) => `× ${value.toFixed(2)}`;
const mega = (/** @type {number} */ bytes) => `${(bytes / 1e6).toFixed(1)} MB`;
/** Widths and heights are set in steps of equal factors. */
const power = (/** @type {(settings: any) => number} */ of, /** @type {(value: number) => unknown} */ change) => ({
  min: -3,
  max: 3,
  step: 0.1,
  text: (/** @type {number} */ value) => times(2 ** value),
  of: (/** @type {any} */ settings) => Math.log2(of(settings)),
  change: (/** @type {number} */ value) => change(+(2 ** value).toFixed(3)),
});

/** A field for a place, which shows below itself what is wrong with the text. */
function makeGoTo(/** @type {(text: string) => string} */ goTo) {
  const wrong = make("p", { class: "wrong", id: "go-to-wrong", role: "status" });
  const input = make("input", {
    type: "text",
    placeholder: "lon, lat",
    autocomplete: "off",
    spellcheck: false,
    inputMode: "text",
    "aria-label": "Go to: longitude, latitude in degrees",
    "aria-describedby": "go-to-wrong",
  });
  return make(
    "form",
    {
      class: "go-to",
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        const why = goTo(input.value);
        setText(wrong, why);
        input.setAttribute("aria-invalid", String(why !== ""));
      },
    },
    input,
    make("button", { type: "submit", class: "plain" }, "Go to"),
    wrong,
  );
}

/** The figures of the current view, for advanced users. */
function makeFigures() {
  const list = make("dl", { class: "figures" });
  /** @type {Map<string, HTMLElement>} */
  const values = new Map();
  return {
    element: list,
    /** @param {Record<string, string>} figures */
    show(figures) {
      for (const [name, value] of Object.entries(figures)) {
        let shown = values.get(name);
        if (!shown) {
          shown = /** @type {HTMLElement} */ (make("dd"));
          values.set(name, shown);
          list.append(make("dt", {}, name), shown);
        }
        setText(shown, value);
      }
    },
  };
}

/**
 * @param {{ set: (change: Record<string, unknown>) => void, command: (name: string) => void, goTo: (text: string) => string, hasLink: boolean }} map
 * @param {import("./corniche-map.js").About} about
 * @param {() => void} close
 */
export function makePanel(map, about, close) {
  const { set } = map;
  /** @type {import("./controls.js").Control[]} */
  const controls = [];
  const use = (/** @type {import("./controls.js").Control} */ control) => {
    controls.push(control);
    return control.element;
  };
  const legend = makeLegend(set);
  const layers = makeLayers(set);
  const figures = makeFigures();
  const record = action(icons.record(), "Record flight", () => map.command("record"));
  record.classList.add("record");
  const fly = action(icons.fly(), "Fly", () => map.command("toggle-fly"));
  const above = action(icons.above(), "From above", () => map.command("toggle-above"));
  const widths = about.classes.map((one, k) =>
    use(
      slider(
        set,
        "widths",
        one.label,
        power(
          (settings) => settings.widths[k] ?? 1,
          (value) => (last?.widths ?? []).map((/** @type {number} */ width, /** @type {number} */ other) => (other === k ? value : width)),
        ),
      ),
    ),
  );
  /** @type {any} */
  let last = null;

  const element = make(
    "section",
    { class: "panel card", "aria-label": "Map settings" },
    make("header", {}, make("h2", {}, about.name), closeButton("Hide the panel", close, "Hide the panel (M)")),
    make(
      "div",
      { class: "scroll" },
      section(
        "Roads",
        true,
        use(legend),
        use(
          choice(set, "roads", "Drawn as", [
            ["geo", "GEO"],
            ["sv", "SV"],
            ["none", "None"],
          ]),
        ),
        use(
          choice(set, "compare", "Compare GEO and SV", [
            ["off", "Off"],
            ["split", "Split"],
            ["difference", "Difference"],
          ]),
        ),
      ),
      section(
        "Map",
        true,
        use(
          select(
            set,
            "style",
            "Style",
            about.styles.map((style) => [style, style]),
          ),
        ),
        use(slider(set, "exaggeration", "Heights", { min: 0, max: 4, step: 0.1, text: times })),
        about.has.photo
          ? use(
              slider(set, "photo", "Photo", {
                min: -0.05,
                max: 1,
                step: 0.05,
                text: (value) => (value < 0 ? "as in the style" : percent(value)),
                of: (settings) => settings.photo ?? -0.05,
                change: (value) => (value < 0 ? null : value),
              }),
            )
          : null,
        about.layers.length > 0 ? use(layers) : null,
      ),
      section(
        "View",
        true,
        makeGoTo(map.goTo),
        make(
          "div",
          { class: "actions" },
          fly,
          above,
          action(icons.home(), "First view", () => map.command("reset")),
          map.hasLink ? action(icons.link(), "Copy link", () => map.command("link")) : null,
          action(icons.picture(), "Save image", () => map.command("picture")),
          record,
          action(icons.play(), "Play flight", () => map.command("play")),
        ),
      ),
      section(
        "Advanced",
        false,
        use(
          select(set, "outline", "Outlines", [
            ["style", "As in the style"],
            ["none", "None"],
            ["3", "3 × 3"],
            ["5", "5 × 5"],
          ]),
        ),
        use(
          slider(set, "error_px", "Ground error", {
            min: -1,
            max: 4,
            step: 0.5,
            text: (value) => `${+(2 ** value).toFixed(1)} px`,
            of: (settings) => Math.log2(settings.error_px),
            change: (value) => 2 ** value,
          }),
        ),
        use(
          select(
            set,
            "samples",
            "Samples",
            [
              ["1", "1 × 1"],
              ["2", "2 × 2"],
              ["3", "3 × 3"],
              ["4", "4 × 4"],
            ],
            Number,
          ),
        ),
        use(toggle(set, "wireframe", "Edges of triangles")),
        use(toggle(set, "inertia", "Inertia")),
        widths.length > 0 ? make("h3", {}, "Widths of roads") : null,
        ...widths,
      ),
      section("Figures", false, figures.element),
    ),
  );

  return {
    element,
    show(/** @type {any} */ settings, /** @type {import("./corniche-map.js").About} */ now) {
      last = settings;
      legend.list(now.classes);
      layers.list(now.layers);
      for (const control of controls) control.show(settings);
    },
    /** @param {import("./corniche-map.js").FrameReport} report */
    report(report) {
      fly.setAttribute("aria-pressed", String(report.mode === "fly"));
      above.setAttribute("aria-pressed", String(Boolean(report.view?.above)));
      const isRecording = report.recording_s !== null;
      record.setAttribute("aria-pressed", String(isRecording));
      setText(record.querySelector("span"), isRecording ? `Stop, ${report.recording_s?.toFixed(0)} s` : "Record flight");
      if (!element.querySelector("details:last-of-type")?.open) return;
      figures.show({
        Tiles: `${report.tiles.drawn} drawn, ${report.tiles.loading} loading`,
        Triangles: report.triangles.toLocaleString("en"),
        Segments: report.segments.toLocaleString("en"),
        "Graphics memory": `${mega(report.gpu_bytes[0])} of ${mega(report.gpu_bytes[1])}`,
        Requests: `${report.requests}, ${mega(report.bytes)}`,
        Package: `${mega(about.bytes)}, ${about.tiles} tiles, ${about.levels} levels, format ${about.format_version}`,
        Device: about.is_software ? `${about.adapter} (the CPU draws)` : about.adapter,
      });
    },
  };
}
