// Flights as text, and as the renderer takes them: `corniche fly` reads and writes the same TOML.
import { parse, stringify } from "smol-toml";

/** The text of a flight that the renderer has recorded. */
export const flightText = (/** @type {string} */ recorded) => (recorded === "" ? "" : stringify(JSON.parse(recorded)));

/** A flight for the renderer. Throws where the text is no TOML. */
export const flightRecord = (/** @type {string} */ text) => JSON.stringify(parse(text));
