// The legend: names of the classes with the colours of the shown style. Each class of roads and
// each layer can be hidden.
import { make } from "./dom.js";

/**
 * @param {(change: Record<string, unknown>) => void} set
 * @returns {import("./controls.js").Control & { list: (classes: { label: string, color: string }[]) => void }}
 */
export function makeLegend(set) {
  const element = make("ul", { class: "legend", "aria-label": "Classes of roads" });
  /** @type {any[]} */
  let inputs = [];
  /** @type {any[]} */
  let swatches = [];
  let labels = "";

  function list(/** @type {{ label: string, color: string }[]} */ classes) {
    const now = classes.map((one) => one.label).join("\n");
    if (now !== labels) {
      labels = now;
      swatches = classes.map(() => make("span", { class: "swatch" }));
      inputs = classes.map(() =>
        make("input", { type: "checkbox", onchange: () => set({ classes: inputs.map((input) => input.checked) }) }),
      );
      element.replaceChildren(
        ...classes.map((one, k) => make("li", {}, make("label", { class: "check" }, inputs[k], swatches[k], make("span", {}, one.label)))),
      );
    }
    classes.forEach((one, k) => {
      swatches[k].style.backgroundColor = one.color;
    });
  }

  return {
    element,
    list,
    show: (settings) =>
      inputs.forEach((input, k) => {
        input.checked = settings.classes[k] !== false;
      }),
  };
}

/**
 * The layers of the map, with their classes in the colours of the shown style.
 *
 * @param {(change: Record<string, unknown>) => void} set
 * @returns {import("./controls.js").Control & { list: (layers: import("./corniche-map.js").About["layers"]) => void }}
 */
export function makeLayers(set) {
  const element = make("ul", { class: "legend", "aria-label": "Layers" });
  /** @type {Map<string, any>} */
  const inputs = new Map();
  /** @type {Map<string, HTMLElement>} */
  const rows = new Map();

  function change() {
    const shown = [...inputs].flatMap(([id, input]) => (input.checked ? [id] : []));
    set({ layers: shown.length === inputs.size ? null : shown });
  }

  return {
    element,
    list(layers) {
      if (layers.map((layer) => layer.id).join() !== [...inputs.keys()].join()) {
        inputs.clear();
        rows.clear();
        for (const { id } of layers) {
          inputs.set(id, make("input", { type: "checkbox", onchange: change }));
          rows.set(id, make("ul", { class: "legend" }));
        }
        element.replaceChildren(
          ...layers.map(({ id, title }) => make("li", {}, make("label", { class: "check" }, inputs.get(id), make("span", {}, title)), rows.get(id))),
        );
      }
      for (const { id, geometry, classes } of layers) {
        rows.get(id)?.replaceChildren(
          ...classes.map((one) => {
            const swatch = make("span", { class: geometry === "line" ? "line-swatch" : `swatch ${geometry}-swatch` });
            swatch.style[geometry === "line" ? "color" : "backgroundColor"] = one.color;
            return make("li", { class: "named-class" }, swatch, make("span", {}, one.label));
          }),
        );
      }
    },
    show: (settings) => {
      for (const [id, input] of inputs) input.checked = settings.layers?.includes(id) ?? true;
    },
  };
}
