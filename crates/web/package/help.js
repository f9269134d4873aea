// The dialog with mouse, touch and keys.
import { make } from "./dom.js";
import { closeButton } from "./icons.js";
import { HELP } from "./keys.js";

export function makeHelp() {
  const dialog = make(
    "dialog",
    { class: "help card", "aria-labelledby": "help-title" },
    make("header", {}, make("h2", { id: "help-title" }, "Mouse, touch and keys"), closeButton("Close", () => dialog.close())),
    make(
      "dl",
      { tabIndex: 0, "aria-label": "Mouse, touch and keys" },
      ...HELP.flatMap(([what, does, when = ""]) => [make("dt", { class: when }, what), make("dd", { class: when }, does)]),
    ),
  );
  // A click outside the dialog closes it.
  dialog.addEventListener("click", (/** @type {MouseEvent} */ event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}
