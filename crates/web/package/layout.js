// The shadow root: the canvas, and the controls over it.
import { makeCompass } from "./compass.js";
import { makeDivider } from "./divider.js";
import { drawing, make } from "./dom.js";
import { makeHelp } from "./help.js";
import { makeHint } from "./hint.js";
import { icons } from "./icons.js";
import { makeNotices } from "./notices.js";
import { makePlaceCard } from "./place_card.js";
import { makeScaleBar } from "./scalebar.js";
import { makeStatus } from "./status.js";

const CANVAS_HELP =
  "Arrow keys move the map, Shift and arrow keys turn and tilt it, plus and minus zoom, Enter shows the road in the middle, question mark lists all keys.";

/** A line of attribution, with the address of OpenStreetMap's copyright page as a link. Nothing is fetched for it. */
function creditNodes(/** @type {string[]} */ credits) {
  const text = credits.join(", ");
  const name = "OpenStreetMap";
  const at = text.indexOf(name);
  if (at < 0) return [text];
  const link = make("a", { href: "https://www.openstreetmap.org/copyright", target: "_blank", rel: "noopener noreferrer" }, name);
  return [text.slice(0, at), link, text.slice(at + name.length)];
}

/**
 * @param {ShadowRoot} shadow
 * @param {{ command: (name: string) => void, set: (change: Record<string, unknown>) => void, zoom: (steps: number) => void }} map
 */
export function makeLayout(shadow, map) {
  const help = make("p", { id: "canvas-help", hidden: true }, CANVAS_HELP);
  const cross = drawing("M12 2v20M2 12h20");
  cross.classList.add("cross");
  const compass = makeCompass(map);
  const scale = makeScaleBar();
  scale.element.classList.add("pill");
  const status = makeStatus();
  status.element.classList.add("pill");
  const notices = makeNotices();
  const place = makePlaceCard();
  const divider = makeDivider(map.set);
  const dialog = makeHelp();
  const hint = makeHint();
  const credit = make("div", { class: "credit pill", part: "credit", hidden: true });
  const bar = make("div");
  const progress = make(
    "div",
    {
      class: "progress",
      role: "progressbar",
      "aria-label": "Loading the map",
      "aria-valuemin": "0",
      "aria-valuemax": "100",
      "aria-hidden": "true",
    },
    bar,
  );
  const opening = make("p", { class: "opening-text", hidden: true }, "Opening the map");
  const panelButton = make(
    "button",
    { type: "button", title: "Panel (M)", "aria-label": "Panel", "aria-expanded": "false", onclick: () => map.command("panel") },
    icons.layers(),
  );
  const zoom = make(
    "div",
    { class: "group card" },
    make("button", { type: "button", title: "Zoom in (+)", "aria-label": "Zoom in", onclick: () => map.zoom(1) }, icons.plus()),
    make("button", { type: "button", title: "Zoom out (−)", "aria-label": "Zoom out", onclick: () => map.zoom(-1) }, icons.minus()),
  );
  const tools = make(
    "div",
    { class: "group card" },
    panelButton,
    make(
      "button",
      {
        type: "button",
        class: "help-button",
        title: "Mouse, touch and keys (?)",
        "aria-label": "Mouse, touch and keys",
        onclick: () => map.command("help"),
      },
      icons.help(),
    ),
  );
  const compassGroup = make("div", { class: "group card" }, compass.element);
  const stack = make("div", { class: "stack" }, tools, compassGroup, zoom);
  const middle = make("div", { class: "middle" }, notices.element, place.element);
  const facts = make("div", { class: "facts" }, scale.element, status.element);
  const over = make("div", { class: "over" }, stack, middle, make("div", { class: "bar" }, facts, credit));
  const root = make("div", { class: "root" });
  /** @type {HTMLElement | null} */
  let failed = null;
  let canvas = newCanvas();
  root.append(canvas, cross, help, opening, divider.element, over, hint.element, progress, dialog);
  shadow.append(root);

  /** A canvas is bound to the device that drew on it: after the loss of a device, a new canvas is needed. */
  function newCanvas() {
    return make("canvas", { tabIndex: 0, role: "application", "aria-label": "Map", "aria-describedby": "canvas-help" });
  }

  return {
    compass,
    scale,
    status,
    notices,
    place,
    divider,
    dialog,
    hint,
    over,
    panelButton,
    canvas: () => canvas,
    renewCanvas() {
      const hadFocus = shadow.activeElement === canvas;
      const label = canvas.getAttribute("aria-label");
      const fresh = newCanvas();
      canvas.replaceWith(fresh);
      canvas = fresh;
      canvas.setAttribute("aria-label", label);
      if (hadFocus) canvas.focus({ preventScroll: true });
      return canvas;
    },
    /** Sets whether the page keeps the wheel and one finger. */
    isCooperative: () => root.classList.contains("cooperative"),
    cooperate: (/** @type {boolean} */ isSo) => root.classList.toggle("cooperative", isSo),
    label: (/** @type {string} */ text) => canvas.setAttribute("aria-label", text),
    credit(/** @type {string[]} */ credits) {
      credit.hidden = credits.length === 0;
      credit.replaceChildren(...creditNodes(credits));
    },
    opening(/** @type {boolean} */ isOpening) {
      opening.hidden = !isOpening;
      progress.classList.toggle("opening", isOpening);
      progress.setAttribute("aria-hidden", String(!isOpening));
    },
    progress(/** @type {number} */ share) {
      const text = String(Math.round(share * 100));
      if (progress.getAttribute("aria-valuenow") === text) return;
      progress.setAttribute("aria-valuenow", text);
      progress.setAttribute("aria-hidden", String(share >= 1));
      bar.style.inlineSize = `${text}%`;
    },
    /** Sets which groups of controls are shown; attribution always is. */
    controls(/** @type {Set<string>} */ shown) {
      tools.hidden = !shown.has("panel");
      compassGroup.hidden = !shown.has("compass");
      zoom.hidden = !shown.has("zoom");
      facts.hidden = !shown.has("status");
      notices.element.hidden = !shown.has("notices");
    },
    fail(/** @type {HTMLElement | null} */ element) {
      failed?.remove();
      failed = element;
      over.inert = element !== null;
      over.hidden = element !== null;
      canvas.inert = element !== null;
      if (element) root.append(element);
    },
  };
}
