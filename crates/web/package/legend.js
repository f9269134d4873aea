// The legend: names of the classes with the colours of the shown style. Each class of roads can be
// hidden; boundaries are listed.
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

/** The boundaries of the map, with the colours of the shown style. */
export function makeLines() {
  const element = make("ul", { class: "legend", "aria-label": "Boundaries" });
  return {
    element,
    list(/** @type {{ label: string, color: string }[]} */ lines) {
      element.hidden = lines.length === 0;
      element.replaceChildren(
        ...lines.map((one) => {
          const swatch = make("span", { class: "line-swatch" });
          swatch.style.color = one.color;
          return make("li", { class: "named-line" }, swatch, make("span", {}, one.label));
        }),
      );
    },
  };
}
