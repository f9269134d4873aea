// Flights as text, and as the renderer takes them: `corniche fly` reads and writes the same TOML.
import { stringify } from "smol-toml";

/** The text of a flight that the renderer has recorded. */
export const flightText = (/** @type {string} */ recorded) => (recorded === "" ? "" : stringify(JSON.parse(recorded)));

/** A flight for the renderer. Fails where the text is no TOML. Few maps play flights, so what reads them is fetched when one does. */
export async function flightRecord(/** @type {string} */ text) {
  const { parse } = await import("./toml_reader.js").catch((error) => {
    console.warn(error);
    throw new Error("toml_reader.js of corniche-map is missing");
  });
  try {
    return JSON.stringify(parse(text));
  } catch (error) {
    throw new Error(`this is no flight: ${/** @type {Error} */ (error).message.split("\n")[0]}`);
  }
}
