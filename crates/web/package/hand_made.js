// The user's changes in links: NAME=VALUE;NAME=VALUE with the names and values of the attributes.
// Classes are the shown ones, widths are CLASS:FACTOR.
import { SETTINGS } from "./attributes.js";

const same = (/** @type {unknown} */ a, /** @type {unknown} */ b) => JSON.stringify(a) === JSON.stringify(b);
const rounded = (/** @type {number} */ value) => String(+value.toFixed(4));

/** A setting as the text of an attribute. */
export function attributeText(/** @type {unknown} */ value, /** @type {string} */ setting) {
  if (typeof value === "number") return rounded(value);
  if (setting === "layers") return value === null ? "all" : String(value) || "none";
  return value === null ? "style" : value === true ? "on" : value === false ? "off" : String(value);
}

const digits = (/** @type {string} */ text) => (/^\d(,\d)*$/.test(text) ? text.split(",").map(Number) : null);

/** @type {[string, string, (text: string, settings: any) => unknown, (value: any) => string][]} */
const LISTS = [
  [
    "classes",
    "classes",
    (text, { classes }) => {
      const shown = text === "none" ? [] : digits(text);
      return shown?.every((k) => k < classes.length) ? classes.map((/** @type {boolean} */ _, /** @type {number} */ k) => shown.includes(k)) : undefined;
    },
    (classes) => classes.flatMap((/** @type {boolean} */ isShown, /** @type {number} */ k) => (isShown ? [k] : [])).join() || "none",
  ],
  [
    "widths",
    "widths",
    (text, settings) => {
      const widths = settings.widths.map(() => 1);
      for (const part of text === "none" ? [] : text.split(",")) {
        const [, k, factor] = /^(\d):(\d+(?:\.\d+)?)$/.exec(part) ?? [];
        if (!factor || !(Number(k) in widths) || !Number.isFinite(Number(factor))) return undefined;
        widths[Number(k)] = Number(factor);
      }
      return widths;
    },
    (widths) => widths.flatMap((/** @type {number} */ factor, /** @type {number} */ k) => (factor === 1 ? [] : [`${k}:${rounded(factor)}`])).join() || "none",
  ],
];

/** @type {[string, string, (text: string, settings: any) => unknown, (value: any) => string][]} */
const NAMES = [...SETTINGS.map(([attribute, , setting, valueOf]) => /** @type {any} */ ([attribute, setting, valueOf, (/** @type {unknown} */ value) => attributeText(value, setting)])), ...LISTS];

/** Readable characters stay unescaped where an address allows them. */
const escaped = (/** @type {string} */ text) => encodeURIComponent(text).replace(/%(2C|2F|3A)/g, decodeURIComponent);

/** The settings that differ from others. */
export function changed(/** @type {any} */ settings, /** @type {any} */ from) {
  return Object.fromEntries(Object.entries(settings).filter(([setting, value]) => !same(value, from[setting])));
}

/** Changed settings as text. */
export function changesText(/** @type {Record<string, unknown>} */ changes) {
  const parts = NAMES.filter(([, setting]) => setting in changes);
  return parts.map(([name, setting, , textOf]) => `${name}=${escaped(textOf(changes[setting]))}`).join(";");
}

/**
 * The settings in a text, one each; invalid parts are reported.
 *
 * @param {string} text
 * @param {any} settings the settings before the change
 */
export function changesIn(text, settings) {
  /** @type {[string, Record<string, unknown>][]} */
  const changes = [];
  /** @type {string[]} */
  const unknown = [];
  for (const part of text.split(";").filter(Boolean)) {
    const [name, ...rest] = part.split("=");
    const known = NAMES.find(([one]) => one === name);
    let value;
    try {
      value = known?.[2](decodeURIComponent(rest.join("=")), settings);
    } catch {
      // A part that is not UTF-8 text is invalid.
    }
    if (known && value !== undefined) changes.push([part, { [known[1]]: value }]);
    else unknown.push(part);
  }
  return { changes, unknown };
}

/** Parts of a link for a notice, shortened: they may contain anything, at any length. */
export function shortList(/** @type {string[]} */ parts) {
  const [first] = parts;
  const shown = first.length > 20 ? `${first.slice(0, 19)}…` : first;
  return parts.length > 1 ? `${shown} and ${parts.length - 1} more` : shown;
}
