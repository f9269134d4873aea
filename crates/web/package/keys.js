// Keys on the map. Keys of commands are recognized by their labels, keys for flying by their
// positions.

/** Commands of the view and of the page, by `KeyboardEvent.key`. */
export const COMMANDS = {
  f: "toggle-fly",
  t: "toggle-above",
  n: "north-up",
  r: "reset",
  Home: "reset",
  c: "record",
  v: "link",
  p: "picture",
  m: "panel",
  "?": "help",
  Enter: "pick",
  Escape: "close",
};

/** The rows of the help dialog; the third entry limits a row to one kind of gestures. */
export const HELP = [
  ["Drag", "move the map with the pointer"],
  ["Right drag, Ctrl and drag", "turn and tilt about the middle"],
  ["Middle drag", "turn and tilt about the ground under the pointer"],
  ["Wheel, double click", "zoom at the pointer; with Shift, a double click zooms out", "greedy"],
  ["Ctrl (⌘) and wheel, double click", "zoom at the pointer; with Shift, a double click zooms out", "cooperative"],
  ["One finger", "move the map", "greedy"],
  ["Two fingers", "pinch to zoom, turn, move up and down to tilt", "greedy"],
  ["Two fingers", "move the map, pinch to zoom, turn", "cooperative"],
  ["Three fingers", "move up and down to tilt", "cooperative"],
  ["Click, tap, Enter", "shows the road there; Enter: the road in the middle"],
  ["Right click, long press", "coordinates and height of the place"],
  ["Arrows", "move; with Shift turn and tilt"],
  ["+ −", "zoom; with Shift twice as far"],
  ["F", "fly mode and back: W A S D, Q down, E up, Shift faster, wheel sets the speed"],
  ["T", "straight from above and back"],
  ["N", "north up"],
  ["R, Home", "back to the first view"],
  ["C", "start and stop recording a flight"],
  ["P", "save a picture"],
  ["V", "copy a link to this view"],
  ["M", "show and hide the panel"],
  ["?", "this list"],
];

/** Plus and minus have other positions on foreign keyboards, and the view identifies them by their position. */
function zoomCode(/** @type {KeyboardEvent} */ event) {
  if (/^(Equal|Minus|Numpad|Shift)/.test(event.code)) return null;
  if (event.key === "+") return ["NumpadAdd", false];
  return event.key === "-" ? ["NumpadSubtract", false] : null;
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {{ view: () => any, wake: () => void, command: (name: string) => boolean }} to `command` says whether it did something
 */
export function watchKeys(canvas, to) {
  const end = new AbortController();
  const { signal } = end;
  const now = () => performance.now() / 1000;

  function key(/** @type {KeyboardEvent} */ event, /** @type {boolean} */ isDown) {
    // Shortcuts of the browser are not intercepted, and neither is the key to the next control.
    if (event.altKey || event.metaKey || event.ctrlKey || event.key === "Tab") return;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const command = isDown && /** @type {Record<string, string>} */ (COMMANDS)[name];
    if (command) {
      if (event.repeat || to.command(command)) event.preventDefault();
      return;
    }
    const [code, shift] = zoomCode(event) ?? [event.code, event.shiftKey];
    if (to.view()?.key(code, isDown, shift, event.ctrlKey, now())) {
      event.preventDefault();
      to.wake();
    }
  }

  canvas.addEventListener("keydown", (event) => key(event, true), { signal });
  canvas.addEventListener("keyup", (event) => key(event, false), { signal });
  canvas.addEventListener(
    "blur",
    () => {
      to.view()?.let_go(now());
      to.wake();
    },
    { signal },
  );
  return () => end.abort();
}
