// Icons of the buttons: lines of two units in a square of 24.
import { drawing, make } from "./dom.js";

export const icons = {
  plus: () => drawing("M12 5v14M5 12h14"),
  minus: () => drawing("M5 12h14"),
  close: () => drawing("M6 6l12 12M18 6L6 18"),
  layers: () => drawing("M12 3l9 5-9 5-9-5 9-5z", "M3 13l9 5 9-5"),
  help: () => drawing("M9 9a3 3 0 1 1 4.5 2.6c-1 .6-1.5 1.2-1.5 2.4", "M12 17.5v.5"),
  above: () => drawing("M4 4h16v16H4z", "M4 12h16M12 4v16"),
  fly: () => drawing("M3 11l18-7-7 18-3-8-8-3z"),
  home: () => drawing("M4 11l8-7 8 7", "M6 10v10h12V10"),
  link: () => drawing("M10 14a4 4 0 0 0 5.7 0l3.3-3.3a4 4 0 0 0-5.7-5.7l-1 1", "M14 10a4 4 0 0 0-5.7 0L5 13.3a4 4 0 0 0 5.7 5.7l1-1"),
  picture: () => drawing("M4 5h16v14H4z", "M4 16l5-5 4 4 3-3 4 4"),
  record: () => drawing("M12 6a6 6 0 1 0 0 12 6 6 0 0 0 0-12z"),
  stop: () => drawing("M7 7h10v10H7z"),
  play: () => drawing("M8 5l11 7-11 7z"),
  warning: () => drawing("M12 4l9 16H3z", "M12 10v5M12 17.5v.5"),
};

/** The cross that removes or closes something. */
export const closeButton = (/** @type {string} */ label, /** @type {() => void} */ onclick, /** @type {string | undefined} */ title = undefined) =>
  make("button", { type: "button", class: "icon", title, "aria-label": label, onclick }, icons.close());
