// The button that shows where north is, and turns the map north up.
import { drawing, make } from "./dom.js";

/** @param {{ command: (name: string) => void }} map */
export function makeCompass(map) {
  const needle = drawing("M12 2l4 10H8z", "M12 22l4-10H8z");
  needle.classList.add("needle");
  const button = make(
    "button",
    { type: "button", class: "compass", title: "North up (N)", onclick: () => map.command("north-up") },
    needle,
  );
  let shown = "";
  return {
    element: button,
    /** @param {{ heading: number, pitch: number, above?: boolean }} view */
    show(view) {
      const heading = Math.round(((view.heading % 360) + 360) % 360) % 360;
      const now = `${view.heading.toFixed(1)} ${view.pitch.toFixed(0)}`;
      if (now === shown) return;
      shown = now;
      // A tilted map shows a tilted needle, but never a mere line.
      needle.style.transform = `scaleY(${Math.max(0.75, Math.cos((view.pitch * Math.PI) / 180))}) rotate(${-view.heading}deg)`;
      button.setAttribute("aria-label", `North up. The map looks towards ${heading}°`);
    },
  };
}
