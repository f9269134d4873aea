// The settings of one map: what the page asks for, what a person changed by hand, and own styles, whose files come later.
import { settingsOf } from "./attributes.js";
import { changed, changesIn, changesText, shortList } from "./hand_made.js";
import { isAddress, readStyle } from "./own_styles.js";

/** @typedef {Record<string, unknown>} Changes */

/** Where an address leads; `null` where it is none. */
function originOf(/** @type {string} */ address) {
  try {
    return new URL(address, document.baseURI).origin;
  } catch {
    return null;
  }
}

export class Settings {
  /** @type {HTMLElement} */
  #element;
  /** @type {(text: string) => void} */
  #warn;
  /** @type {any} */
  #session = null;
  /** @type {any} */
  #glue = null;
  /** Those that were set before the package was open. @type {Changes} */
  #wanted = {};
  /** Those of them that came while it was being opened. @type {Changes} */
  #late = {};
  /** @type {Changes} */
  #usual = {};
  /** All of them as the program and the page ask for; what differs in the view was changed by hand. @type {Changes} */
  #asked = {};
  /** Counts what is asked of the style: of several files that are on their way, the last one is shown. */
  #stylings = 0;
  /** Fulfilled when no own style is on its way. @type {Promise<void>} */
  styled = Promise.resolve();

  /** @param {HTMLElement} element @param {(text: string) => void} warn */
  constructor(element, warn) {
    this.#element = element;
    this.#warn = warn;
  }

  /** Those that are shown; before there is a view, those that were asked for. */
  get shown() {
    return this.#session ? this.#session.settings() : this.wanted;
  }

  get wanted() {
    return { ...settingsOf(this.#element), ...this.#wanted };
  }

  /** Sets what the page asks for; in words, why not. An own style is shown when its file has been read. */
  set(/** @type {any} */ change) {
    const session = this.#session;
    if (!session) {
      Object.assign(this.#wanted, change);
      Object.assign(this.#late, change);
      return "";
    }
    const { style, ...others } = change;
    const now = isAddress(style) ? others : change;
    const why = session.set(now);
    if (why !== "") return why;
    for (const setting of Object.keys(now)) this.#asked[setting] = session.settings()[setting];
    if (style === undefined) return "";
    const turn = (this.#stylings += 1);
    if (now === change) return "";
    this.styled = this.#keepStyle(style, readStyle(style)).then((isKept) => {
      if (!isKept || turn !== this.#stylings || session !== this.#session) return;
      session.set({ style });
      this.#asked.style = style;
    });
    return "";
  }

  /** The usual value of a setting; `undefined` where it is not known yet, which asks for it. */
  usual(/** @type {string} */ setting) {
    return this.#usual[setting];
  }

  /** A person has changed something. */
  changedByHand(/** @type {Changes} */ change) {
    if ("style" in change) this.#stylings += 1;
  }

  /** What was changed by hand, for a link. */
  get link() {
    return this.#session ? changesText(changed(this.#session.settings(), this.#asked)) : "";
  }

  /** Shows what a link says was changed, and nothing else that was. */
  takeLink(/** @type {string} */ link) {
    const session = this.#session;
    if (!session) return;
    const turn = (this.#stylings += 1);
    this.styled = this.#changesOf(link, this.#asked).then((changes) => {
      if (turn !== this.#stylings || session !== this.#session) return;
      const others = Object.keys(changed(session.settings(), this.#asked)).map((setting) => [setting, this.#asked[setting]]);
      session.set({ ...Object.fromEntries(others), ...changes });
    });
  }

  /** What was asked for and changed in the view that ends, for the one that takes its place. */
  get kept() {
    return { settings: this.#asked, link: this.link };
  }

  /**
   * The settings with which a view is opened.
   *
   * @param {Changes} asked by the page; those that are `undefined` are the usual ones
   * @param {string} link what was changed by hand
   */
  opening(asked, link) {
    // What was set until now is asked for; a link may say otherwise, and what is set from now on has the last word.
    this.#late = {};
    const settings = Object.fromEntries(Object.entries(asked).filter(([, value]) => value !== undefined));
    const { style } = settings;
    const isNew = isAddress(style) && (!this.#glue || this.#faultOf({ style }) !== "");
    // Its file comes while the program does.
    const reading = isNew ? readStyle(String(style)) : null;
    reading?.catch(() => {});
    let byHand = {};
    return {
      /** @param {any} glue */
      of: async (glue) => {
        this.#glue = glue;
        this.#usual = JSON.parse(glue.MapView.usual_settings());
        if (reading && !(await this.#keepStyle(String(style), reading))) delete settings.style;
        byHand = await this.#changesOf(link, { ...this.#usual, ...settings });
        return { ...settings, ...byHand };
      },
      /** The view is there. What was set while it was being opened is set now; in words, why not. */
      done: (/** @type {any} */ session) => {
        this.#session = session;
        this.#asked = { ...session.settings() };
        for (const setting of Object.keys(byHand)) this.#asked[setting] = setting in settings ? settings[setting] : this.#usual[setting];
        const late = Object.entries(this.#late).map(([setting, value]) => [setting, value === undefined ? this.#usual[setting] : value]);
        this.#wanted = {};
        this.#late = {};
        return late.length > 0 ? this.set(Object.fromEntries(late)) : "";
      },
    };
  }

  closed() {
    this.#session = null;
  }

  /** Hands an own style to the renderer, under its address; whether it could be read. */
  async #keepStyle(/** @type {string} */ address, /** @type {Promise<Uint8Array>} */ reading) {
    try {
      const why = this.#glue.MapView.keep_style(await reading);
      if (why !== "") throw new Error(why);
      return true;
    } catch (error) {
      this.#warn(/** @type {Error} */ (error).message);
      return false;
    }
  }

  /** The changes of a link that can be; the others are told. */
  async #changesOf(/** @type {string} */ link, /** @type {Changes} */ settings) {
    const { changes, unknown } = changesIn(link, settings);
    const good = {};
    for (const [part, change] of changes) {
      const { style } = /** @type {any} */ (change);
      // A link may have been written by anyone: it must not make this page ask other hosts.
      const isOwn = isAddress(style) && originOf(style) === location.origin;
      if (isOwn && this.#faultOf(change) !== "" && !(await this.#keepStyle(style, readStyle(style)))) continue;
      if (this.#faultOf(change) === "") Object.assign(good, change);
      else unknown.push(part);
    }
    if (unknown.length > 0) this.#warn(`Left out of the link: ${shortList(unknown)}`);
    return good;
  }

  #faultOf(/** @type {Changes} */ change) {
    return this.#glue.MapView.fault_of(JSON.stringify(change));
  }
}
