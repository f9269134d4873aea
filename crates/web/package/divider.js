// The line between GEO and SV, which can be dragged and moved with the arrow keys.
import { make } from "./dom.js";

const STEP = 0.02;

/** @param {(change: Record<string, unknown>) => void} set */
export function makeDivider(set) {
  const element = make(
    "div",
    {
      class: "divider",
      role: "slider",
      tabIndex: 0,
      hidden: true,
      "aria-label": "Divider between GEO and SV",
      "aria-valuemin": "0",
      "aria-valuemax": "100",
    },
    make("span", { "aria-hidden": "true" }, "GEO"),
    make("span", { "aria-hidden": "true" }, "SV"),
  );
  let share = 0.5;

  function place(/** @type {number} */ now) {
    share = Math.max(0, Math.min(1, now));
    element.style.insetInlineStart = "";
    element.style.left = `${share * 100}%`;
    element.setAttribute("aria-valuenow", String(Math.round(share * 100)));
    element.setAttribute("aria-valuetext", `GEO ${Math.round(share * 100)} %, SV ${Math.round(100 - share * 100)} %`);
  }

  function move(/** @type {number} */ now) {
    place(now);
    set({ divider: share });
  }

  element.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => element.setPointerCapture(event.pointerId));
  element.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
    if (!element.hasPointerCapture(event.pointerId)) return;
    const box = element.parentElement.getBoundingClientRect();
    move((event.clientX - box.left) / box.width);
  });
  element.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
    const steps = { ArrowLeft: -STEP, ArrowDown: -STEP, ArrowRight: STEP, ArrowUp: STEP, Home: -1, End: 1 };
    const step = /** @type {Record<string, number>} */ (steps)[event.key];
    if (step === undefined) return;
    event.preventDefault();
    move(share + step);
  });
  return {
    element,
    show(/** @type {any} */ settings) {
      element.hidden = settings.compare !== "split";
      place(settings.divider);
    },
  };
}
