// The kinds of controls of the panel: each shows a value of the settings and sets it.
import { make, setText } from "./dom.js";
import { fileOf } from "./own_styles.js";

/**
 * @typedef {{ element: HTMLElement, show: (settings: any) => void }} Control
 * @typedef {(change: Record<string, unknown>) => void} Set
 */

let made = 0;
const nextId = () => `c${(made += 1)}`;

/**
 * One of a few values, as a row of buttons.
 *
 * @param {Set} set
 * @param {string} name of the setting
 * @param {string} label
 * @param {[string, string][]} choices value and text
 * @returns {Control}
 */
export function choice(set, name, label, choices) {
  const group = nextId();
  const inputs = choices.map(([value]) => make("input", { type: "radio", name: group, value, onchange: () => set({ [name]: value }) }));
  const element = make(
    "fieldset",
    { class: "choice" },
    make("legend", {}, label),
    make("div", { class: "row" }, ...choices.map(([, text], index) => make("label", {}, inputs[index], make("span", {}, text)))),
  );
  return {
    element,
    show: (settings) =>
      inputs.forEach((input) => {
        input.checked = input.value === String(settings[name]);
      }),
  };
}

/**
 * A checkbox.
 *
 * @param {Set} set
 * @param {string} name
 * @param {string} label
 * @returns {Control}
 */
export function toggle(set, name, label) {
  const input = make("input", { type: "checkbox", onchange: () => set({ [name]: input.checked }) });
  return {
    element: make("label", { class: "check" }, input, make("span", {}, label)),
    show: (settings) => {
      input.checked = Boolean(settings[name]);
    },
  };
}

/**
 * One of many values, as a list.
 *
 * @param {Set} set
 * @param {string} name
 * @param {string} label
 * @param {[string, string][]} choices
 * @param {(text: string) => unknown} [valueOf]
 * @returns {Control}
 */
export function select(set, name, label, choices, valueOf = (text) => text) {
  const id = nextId();
  const input = make(
    "select",
    { id, onchange: () => set({ [name]: valueOf(input.value) }) },
    ...choices.map(([value, text]) => make("option", { value }, text)),
  );
  return {
    element: make("div", { class: "field" }, make("label", { for: id }, label), input),
    show: (settings) => {
      const value = String(settings[name]);
      // The page may have set a value that is not in the list: a custom style.
      if (![...input.options].some((option) => option.value === value)) input.append(make("option", { value }, fileOf(value)));
      input.value = value;
    },
  };
}

/**
 * A number in a range.
 *
 * @param {Set} set
 * @param {string} name
 * @param {string} label
 * @param {{ min: number, max: number, step: number, text: (value: number) => string,
 *   of?: (settings: any) => number, change?: (value: number) => unknown }} range
 * @returns {Control}
 */
export function slider(set, name, label, range) {
  const id = nextId();
  const output = make("output", { for: id });
  const say = () => {
    const text = range.text(+input.value);
    setText(output, text);
    input.setAttribute("aria-valuetext", text);
  };
  const input = make("input", {
    id,
    type: "range",
    min: range.min,
    max: range.max,
    step: range.step,
    oninput: () => {
      say();
      set({ [name]: range.change ? range.change(+input.value) : +input.value });
    },
  });
  return {
    element: make("div", { class: "field slider" }, make("label", { for: id }, label), output, input),
    show: (settings) => {
      const value = range.of ? range.of(settings) : settings[name];
      // A slider that the user holds is not moved.
      if (+input.value !== value) input.value = value ?? range.min;
      say();
    },
  };
}

/** A button with an icon and a text. */
export function action(/** @type {SVGElement} */ icon, /** @type {string} */ text, /** @type {() => void} */ act) {
  return make("button", { type: "button", class: "action", onclick: act }, icon, make("span", {}, text));
}

/** A foldable part of the panel. */
export function section(/** @type {string} */ title, /** @type {boolean} */ open, /** @type {(Node | null)[]} */ ...children) {
  return make("details", { open }, make("summary", {}, title), make("div", { class: "inside" }, ...children));
}
