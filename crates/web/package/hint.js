// Shows how to move a map in a page that scrolls, while the user scrolls over the map.
import { make, setText } from "./dom.js";

const SHOWN_MS = 2000;
const KEY = /Mac|iPhone|iPad/.test(navigator.platform) ? "⌘" : "Ctrl";
const TEXTS = { wheel: `Hold ${KEY} and scroll to zoom the map`, finger: "Use two fingers to move the map" };

export function makeHint() {
  // The hidden text stays in place: if it were set again with each turn of the wheel, it would be
  // read aloud each time.
  const text = make("span", { class: "card", role: "status" });
  const element = make("div", { class: "hint" }, text);
  let timer = 0;
  const hide = () => element.classList.remove("shown");
  return {
    element,
    hide,
    show(/** @type {"wheel" | "finger"} */ how) {
      setText(text, TEXTS[how]);
      element.classList.add("shown");
      clearTimeout(timer);
      timer = setTimeout(hide, SHOWN_MS);
    },
  };
}
