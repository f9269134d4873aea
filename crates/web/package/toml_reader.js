// Reads TOML, where a flight is played.
export { parse } from "smol-toml";
