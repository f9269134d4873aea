// The attributes of the element that are settings of the view.

const number = (/** @type {string} */ text) => (text.trim() === "" || !Number.isFinite(Number(text)) ? undefined : Number(text));
const flag = (/** @type {string} */ text) => !/^(off|false|no|none)$/i.test(text);
/** The ids of layers; `null` for all. */
const layers = (/** @type {string} */ text) => {
  const ids = text.split(",").map((id) => id.trim());
  return ids[0] === "all" ? null : ids.filter((id) => id !== "" && id !== "none");
};
const word = (/** @type {string} */ text) => text;

/** Attribute, property, setting, and the conversion of the attribute's text to the setting's value.
 * @type {[string, string, string, (text: string) => unknown][]} */
export const SETTINGS = [
  ["roads", "roads", "roads", word],
  ["compare", "compare", "compare", word],
  ["divider", "divider", "divider", number],
  ["map-style", "mapStyle", "style", word],
  ["outline", "outline", "outline", word],
  ["exaggeration", "exaggeration", "exaggeration", number],
  ["error-px", "errorPx", "error_px", number],
  ["cell-px", "cellPx", "cell_px", number],
  ["samples", "samples", "samples", number],
  ["photo", "photo", "photo", (text) => (text === "style" ? null : flag(text) ? number(text) : 0)],
  ["layers", "layers", "layers", layers],
  ["wireframe", "wireframe", "wireframe", flag],
  ["inertia", "inertia", "inertia", flag],
];

/** The settings in the attributes of an element; invalid values are skipped. */
export function settingsOf(/** @type {Element} */ element) {
  /** @type {Record<string, unknown>} */
  const settings = {};
  for (const [attribute, , setting, valueOf] of SETTINGS) {
    const text = element.getAttribute(attribute);
    if (text === null) continue;
    const value = valueOf(text);
    if (value !== undefined) settings[setting] = value;
  }
  return settings;
}

/** The change of settings by one attribute; `null` if it is not a setting or its value is invalid. */
export function changeOf(/** @type {string} */ attribute, /** @type {string | null} */ text) {
  const known = SETTINGS.find(([name]) => name === attribute);
  const value = known && text !== null ? known[3](text) : undefined;
  return known && value !== undefined ? { [known[2]]: value } : null;
}

/** The setting of an attribute. */
export const settingOf = (/** @type {string} */ attribute) => SETTINGS.find(([name]) => name === attribute)?.[2];

const GROUPS = ["panel", "compass", "zoom", "status", "card", "notices"];

/** The groups of controls named by the attribute `controls`: all without it, none with "none". */
export function controlsOf(/** @type {string | null} */ text) {
  if (text === null || text.trim() === "") return new Set(GROUPS);
  return new Set(text.split(/\s+/).filter((name) => GROUPS.includes(name)));
}
