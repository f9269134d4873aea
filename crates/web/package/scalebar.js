// The bar that shows a round length on the ground, valid in the middle of the map.
import { make, setText } from "./dom.js";

const WIDEST = 90;

/** The largest of 1, 2 and 5 times a power of ten that is not larger than the number. */
export function roundLength(/** @type {number} */ most) {
  const power = 10 ** Math.floor(Math.log10(most));
  const digit = most / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/** A length in the unit of the text. */
export function lengthText(/** @type {number} */ metres) {
  if (metres >= 1000) return `${+(metres / 1000).toPrecision(6)} km`;
  return metres >= 1 ? `${+metres.toPrecision(6)} m` : `${+(metres * 100).toPrecision(3)} cm`;
}

export function makeScaleBar() {
  const text = make("span");
  const bar = make("div", { class: "bar" });
  const element = make("div", { class: "scale", hidden: true, title: "Scale in the middle of the map" }, text, bar);
  return {
    element,
    /** @param {number | null} metresPerPoint */
    show(metresPerPoint) {
      const isKnown = metresPerPoint !== null && metresPerPoint > 0 && Number.isFinite(metresPerPoint);
      element.hidden = !isKnown;
      if (!isKnown) return;
      const length = roundLength(WIDEST * metresPerPoint);
      setText(text, lengthText(length));
      bar.style.width = `${(length / metresPerPoint).toFixed(1)}px`;
    },
  };
}
