// The card of a place: its coordinates, its height, and the road with its attributes.
import { make } from "./dom.js";
import { closeButton } from "./icons.js";
import { coordinatesText } from "./status.js";

export function makePlaceCard() {
  const body = make("div", { class: "scroll", tabIndex: 0, "aria-label": "Attributes" });
  const title = make("h2", {});
  const element = make(
    "section",
    { class: "place-card card", hidden: true, "aria-label": "Place", "aria-live": "polite" },
    make("header", {}, title, closeButton("Close", () => hide())),
    body,
  );

  function hide() {
    const wasShown = !element.hidden;
    element.hidden = true;
    return wasShown;
  }

  /** @param {import("./corniche-map.js").Pick} pick */
  function show(pick) {
    const { road } = pick;
    const attributes = Object.entries(road?.attributes ?? {});
    const named = road?.attributes?.name;
    title.textContent = road ? String(named || road.label) : "Place";
    /** @type {[string, string][]} */
    const rows = [];
    if (road) rows.push(["class", road.label], ["way", String(road.way)]);
    for (const [name, value] of attributes) if (value !== null && value !== "") rows.push([name, String(value)]);
    rows.push(["place", coordinatesText(pick)], ["height", `${pick.height.toFixed(1)} m`]);
    body.replaceChildren(make("dl", {}, ...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)])));
    element.hidden = false;
  }

  return { element, show, hide };
}
