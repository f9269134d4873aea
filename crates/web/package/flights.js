// Flights as text and as the renderer reads them: `corniche fly` reads and writes the same TOML.
import { stringify } from "smol-toml";

/** The text of a flight that the renderer recorded. */
export const flightText = (/** @type {string} */ recorded) => (recorded === "" ? "" : stringify(JSON.parse(recorded)));

/** A flight for the renderer. Fails if the text is not TOML. Few maps play flights, so the TOML parser is fetched only when one does. */
export async function flightRecord(/** @type {string} */ text) {
  const { parse } = await import("./toml_reader.js").catch((error) => {
    console.warn(error);
    throw new Error("toml_reader.js of corniche-map is missing");
  });
  try {
    return JSON.stringify(parse(text));
  } catch (error) {
    throw new Error(`invalid flight: ${/** @type {Error} */ (error).message.split("\n")[0]}`);
  }
}
