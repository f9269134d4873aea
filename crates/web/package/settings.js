// The settings of one map: those of the page, the user's changes, and custom styles, whose files
// arrive later.
import { settingsOf } from "./attributes.js";
import { changed, changesIn, changesText, shortList } from "./hand_made.js";
import { isAddress, readStyle } from "./own_styles.js";

/** @typedef {Record<string, unknown>} Changes */

/** The URL of an address; `null` if it is invalid. */
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
  /** Settings from before the package was open. @type {Changes} */
  #wanted = {};
  /** Settings that were assigned while the package was being opened. @type {Changes} */
  #late = {};
  /** @type {Changes} */
  #usual = {};
  /** All settings of the program and the page; differences in the view are the user's changes. @type {Changes} */
  #asked = {};
  /** Counts the requests for styles: of several files being loaded, the last one is shown. */
  #stylings = 0;
  /** Fulfilled when no custom style is being loaded. @type {Promise<void>} */
  styled = Promise.resolve();

  /** @param {HTMLElement} element @param {(text: string) => void} warn */
  constructor(element, warn) {
    this.#element = element;
    this.#warn = warn;
  }

  /** The shown settings; before there is a view, the requested ones. */
  get shown() {
    return this.#session ? this.#session.settings() : this.wanted;
  }

  get wanted() {
    return { ...settingsOf(this.#element), ...this.#wanted };
  }

  /** Applies settings of the page; returns an error message. A custom style is shown when its file has been read. */
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

  /** The default value of a setting; `undefined` while it is unknown, which requests it. */
  usual(/** @type {string} */ setting) {
    return this.#usual[setting];
  }

  /** Notes a change by the user. */
  changedByHand(/** @type {Changes} */ change) {
    if ("style" in change) this.#stylings += 1;
  }

  /** The user's changes, for a link. */
  get link() {
    return this.#session ? changesText(changed(this.#session.settings(), this.#asked)) : "";
  }

  /** Shows the user's changes of a link, and drops all others. */
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

  /** The requested and changed settings of the view that ends, for its successor. */
  get kept() {
    return { settings: this.#asked, link: this.link };
  }

  /**
   * The settings for opening a view.
   *
   * @param {Changes} asked the page's settings; `undefined` ones have their default values
   * @param {string} link the user's changes
   */
  opening(asked, link) {
    // The settings until now are the requested ones; a link overrides them, and settings from now
    // on override the link.
    this.#late = {};
    const settings = Object.fromEntries(Object.entries(asked).filter(([, value]) => value !== undefined));
    const { style } = settings;
    const isNew = isAddress(style) && (!this.#glue || this.#faultOf({ style }) !== "");
    // The style's file is loaded while the program is.
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
      /** The view exists. Applies the settings that were assigned while it was being opened; returns an error message. */
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

  /** Passes a custom style to the renderer, under its address; returns whether it could be read. */
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

  /** The valid changes of a link; the others are reported. */
  async #changesOf(/** @type {string} */ link, /** @type {Changes} */ settings) {
    const { changes, unknown } = changesIn(link, settings);
    const good = {};
    for (const [part, change] of changes) {
      const { style } = /** @type {any} */ (change);
      // Anyone may have written a link: it must not make this page send requests to other hosts.
      const isOwn = isAddress(style) && originOf(style) === location.origin;
      if (isOwn && this.#faultOf(change) !== "" && !(await this.#keepStyle(style, readStyle(style)))) continue;
      if (this.#faultOf(change) === "") Object.assign(good, change);
      else unknown.push(part);
    }
    if (unknown.length > 0) this.#warn(`Skipped in the link: ${shortList(unknown)}`);
    return good;
  }

  #faultOf(/** @type {Changes} */ change) {
    return this.#glue.MapView.fault_of(JSON.stringify(change));
  }
}
