// Actions of buttons and keys other than moving the camera: flights, images, links.
import { flightRecord, flightText } from "./flights.js";
import { askForFile, download } from "./dom.js";
import { pictureOf } from "./picture.js";

const now = () => performance.now() / 1000;
const fileName = (/** @type {string} */ name) => name.replace(/[^\p{L}\p{N}._-]+/gu, "-") || "map";

/**
 * @param {{ view: any, about: import("./corniche-map.js").About, canvas: HTMLCanvasElement, report: () => import("./corniche-map.js").FrameReport | null,
 *   wake: () => void, tell: (kind: "warn" | "tell", text: string) => void, hash: () => string | null }} map `hash`: the fragment with the current view
 */
export function makeActions(map) {
  const { view, about, canvas, tell } = map;

  async function picture() {
    const { width, height } = canvas;
    const rgba = await view.read_pixels();
    return pictureOf(rgba, width, height, about.attribution, width / (canvas.getBoundingClientRect().width || width));
  }

  const isRecording = () => (map.report()?.recording_s ?? null) !== null;

  function startRecording() {
    if (!isRecording()) view.command("start-recording", now());
    map.wake();
  }

  /** Ends the recording; returns the flight as text, "" if there is none. */
  function stopRecording() {
    const flight = flightText(view.command("stop-recording", now()));
    map.wake();
    return flight;
  }

  /** Plays a flight; returns an error message. */
  async function play(/** @type {string} */ flight) {
    let record;
    try {
      record = await flightRecord(flight);
    } catch (error) {
      return /** @type {Error} */ (error).message;
    }
    const why = view.play(record, now());
    map.wake();
    return why;
  }

  /** The address of the page with this view; `null` if the page does not keep views. */
  function link() {
    const hash = map.hash();
    return hash === null ? null : new URL(hash, location.href).href;
  }

  /** The same for the user: files are saved and reported. */
  const byHand = {
    async picture() {
      download(await picture(), `${fileName(about.name)}.png`);
      tell("tell", "The image was saved.");
    },
    async record() {
      if (!isRecording()) {
        startRecording();
        // There are no flights from above; the view reports this itself.
        if (!map.report()?.view?.above) tell("tell", "A flight is being recorded.");
        return;
      }
      const flight = stopRecording();
      if (flight === "") return;
      download(new Blob([flight], { type: "application/toml" }), `${fileName(about.name)}-flight.toml`);
      tell("tell", "The flight was saved.");
    },
    async play() {
      const file = await askForFile(".toml");
      if (!file) return;
      const why = await play(await file.text());
      if (why !== "") tell("warn", `${file.name}: ${why}`);
    },
    async link() {
      const address = link();
      if (address === null) return;
      try {
        await navigator.clipboard.writeText(address);
        tell("tell", "The link to this view was copied.");
      } catch {
        // Without the right to write to the clipboard, the link can still be copied by hand.
        tell("warn", address);
      }
    },
  };
  return { picture, startRecording, stopRecording, play, link, byHand };
}
