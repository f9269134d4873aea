// Reads TOML, for playing a flight.
export { parse } from "smol-toml";
