// Notices: messages of success disappear by themselves, warnings stay until they are dismissed.
import { make, sentence } from "./dom.js";
import { closeButton } from "./icons.js";

const TOLD_MS = 5000;
const MOST = 4;

export function makeNotices() {
  // The element always exists, since otherwise screen readers would not watch it.
  const element = make("div", { class: "notices", role: "log", "aria-live": "polite", "aria-label": "Notices" });
  return {
    element,
    /** @param {"warn" | "tell"} kind @param {string} text */
    add(kind, text) {
      // Messages that differ only in numbers, as for many tiles, are merged: the last of them is
      // shown, with their number.
      const key = text.replace(/\d+/g, "0");
      const same = /** @type {any} */ ([...element.children].find((one) => /** @type {any} */ (one).dataset.key === key));
      const times = same ? Number(same.dataset.times) + 1 : 1;
      same?.remove();
      const notice = make(
        "div",
        { class: `notice card ${kind}`, "data-key": key, "data-times": String(times) },
        make("span", {}, sentence(text), times > 1 ? ` (${times} times)` : null),
        closeButton("Dismiss", () => notice.remove()),
      );
      element.append(notice);
      if (kind === "tell") setTimeout(() => notice.remove(), TOLD_MS);
      while (element.children.length > MOST) element.firstChild?.remove();
    },
    /** Removes the last notice; returns whether there was one. */
    dismiss() {
      const last = element.lastElementChild;
      last?.remove();
      return last !== null;
    },
  };
}
