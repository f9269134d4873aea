// The custom element: attributes, properties, methods and events around an opened package.
import { SETTINGS, changeOf, controlsOf, settingOf } from "./attributes.js";
import { Failure, failureOf } from "./engine.js";
import { makeFailure } from "./failures.js";
import { attributeText } from "./hand_made.js";
import { changesAfter, hashWith, partInHash, placeBefore, placeOf } from "./hash.js";
import { makeLayout } from "./layout.js";
import { look } from "./look.js";
import { openSession } from "./session.js";
import { Settings } from "./settings.js";

const REOPEN_AFTER_MS = 4000;
const REOPEN_TIMES = 3;
const REOPEN_WITHIN_MS = 60_000;
/** Browsers limit the rate of changes of the address, and a slider makes many. */
const WRITE_HASH_AFTER_MS = 400;
const NARROW = 560;
const WIDE = 720;
/** Points of the screen that the panel covers, including the space next to it. */
const PANEL = 314;
const USUAL_CREDIT = "© OpenStreetMap contributors";

/** The reason why something is impossible; "" if it is possible. */
function refuse(/** @type {string} */ why) {
  if (why !== "") throw new RangeError(why);
}

/** A map of a package. Attributes, properties and events are in README.md and corniche-map.d.ts. */
export class CornicheMap extends HTMLElement {
  static observedAttributes = ["src", "look-at", "label", "controls", "gestures", "hash", ...SETTINGS.map(([attribute]) => attribute)];

  /** @type {ReturnType<typeof makeLayout>} */
  #layout;
  #settings = new Settings(this, (text) => this.#layout.notices.add("warn", text));
  /** @type {any} */
  #session = null;
  /** @type {AbortController | null} */
  #opening = null;
  #isAsked = false;
  /** @type {number[]} */
  #lost = [];
  #lostTimer = 0;
  #hashTimer = 0;
  /** @type {AbortController | null} */
  #connected = null;

  constructor() {
    super();
    const shadow = this.attachShadow({ mode: "open", delegatesFocus: true });
    shadow.adoptedStyleSheets = [look()];
    this.#layout = makeLayout(shadow, {
      command: (name) => void this.#act(name),
      set: (change) => this.#session?.setByHand(change),
      zoom: (steps) => this.#session?.zoom(steps),
    });
  }

  connectedCallback() {
    this.#takeEarlyProperties();
    this.#connected = new AbortController();
    const { signal } = this.#connected;
    window.addEventListener("hashchange", () => this.#followHash(), { signal });
    // Escape closes what is open, wherever the focus is in the map.
    this.shadowRoot?.addEventListener(
      "keydown",
      (event) => {
        // The browser closes an open dialog.
        const isEscape = /** @type {KeyboardEvent} */ (event).key === "Escape" && !event.defaultPrevented && !this.#layout.dialog.open;
        if (isEscape && this.#act("close")) event.preventDefault();
      },
      { signal },
    );
    matchMedia("(prefers-reduced-motion: reduce)").addEventListener("change", () => this.#session && this.#settings.set(this.#motion()), {
      signal,
    });
    document.addEventListener("fullscreenchange", () => this.#gestures(), { signal });
    this.#label();
    this.#controls();
    this.#gestures();
    this.#open();
  }

  disconnectedCallback() {
    this.#connected?.abort();
    clearTimeout(this.#hashTimer);
    this.#close();
  }

  /** @param {string} name @param {string | null} _before @param {string | null} text */
  attributeChangedCallback(name, _before, text) {
    if (!this.isConnected) return;
    if (name === "src") this.#open();
    else if (name === "label") this.#label();
    else if (name === "controls") this.#controls();
    else if (name === "gestures") this.#gestures();
    else if (name === "look-at") {
      const place = placeOf(text);
      if (place && this.#session) this.#session.lookAt(place);
    } else {
      const setting = settingOf(name);
      const change = setting && (text === null || setting === "inertia") ? this.#without(setting) : changeOf(name, text);
      if (change) this.settings = change;
    }
  }

  /** The address of the package; an invalid address stays unchanged, as with images. */
  get src() {
    const text = this.getAttribute("src") ?? "";
    return text !== "" && URL.canParse(text, document.baseURI) ? new URL(text, document.baseURI).href : text;
  }

  set src(address) {
    this.setAttribute("src", address);
  }

  /** All settings; assigned settings are changed, the others stay. */
  get settings() {
    return structuredClone(this.#settings.shown);
  }

  set settings(change) {
    refuse(this.#settings.set(change));
  }

  /** Facts about the package; `null` before it is open. */
  get about() {
    return this.#session ? structuredClone(this.#session.about()) : null;
  }

  /** The report of the last frame; `null` before the first one. */
  get report() {
    return this.#session?.report() ?? null;
  }

  /** The current view: the place in the middle, the distance to it and the direction. An assignment jumps there. */
  get camera() {
    return this.report?.view ?? null;
  }

  set camera(place) {
    if (place) this.lookAt(place, { jump: true });
  }

  /** Moves to a place. @param {any} place @param {{ jump?: boolean }} [options] */
  lookAt(place, options = {}) {
    refuse(this.#need().lookAt(place, options.jump ?? false));
  }

  /** Moves to "lon,lat". @param {string} text */
  goTo(text) {
    refuse(this.#need().goTo(text));
  }

  /** "north-up", "reset", "toggle-fly" or "toggle-above". @param {string} name */
  command(name) {
    this.#need().command(name);
  }

  /** The place and the road at a position in CSS pixels from the corner of the element. @param {number} x @param {number} y */
  pick(x, y) {
    return this.#need().pick(x, y);
  }

  startRecording() {
    this.#need().actions.startRecording();
  }

  /** Ends the recording and returns the flight as TOML. */
  stopRecording() {
    return this.#need().actions.stopRecording();
  }

  /** Plays a recorded flight. @param {string} flight */
  async play(flight) {
    refuse(await this.#need().actions.play(flight));
  }

  /** The map as a PNG with its attribution. */
  picture() {
    return this.#need().actions.picture();
  }

  /** The pixels of the map as shown last, RGBA, rows from the top. */
  readPixels() {
    return this.#need().readPixels();
  }

  /** Fulfilled when nothing moves, all tiles of the view are loaded, and a custom style has been read. */
  settled() {
    const session = this.#need();
    return this.#settings.styled.then(() => session.settled());
  }

  /** Properties that were assigned before this class was defined hide those of the class. */
  #takeEarlyProperties() {
    const own = /** @type {any} */ (this);
    for (const name of ["src", "settings", ...SETTINGS.map(([, property]) => property)]) {
      if (!Object.hasOwn(this, name)) continue;
      const value = own[name];
      delete own[name];
      own[name] = value;
    }
  }

  #need() {
    if (!this.#session) throw new DOMException("the map is not open yet: wait for its event `ready`", "InvalidStateError");
    return this.#session;
  }

  #hashName() {
    const name = this.getAttribute("hash");
    return name === null || name === "off" ? null : name;
  }

  #label() {
    this.#layout.label(this.getAttribute("label") ?? "Map");
  }

  /** The groups of controls that are shown. */
  #shown() {
    return controlsOf(this.getAttribute("controls"));
  }

  #controls() {
    const shown = this.#shown();
    this.#layout.controls(shown);
    if (!shown.has("panel")) this.#showPanel(false);
  }

  /** A full-screen map has no page to scroll. */
  #gestures() {
    this.#layout.cooperate(this.getAttribute("gestures") === "cooperative" && document.fullscreenElement === null);
  }

  /** Whether the panel is open at first: if there is space next to it. */
  #opensPanel() {
    const wish = this.getAttribute("panel");
    return (
      this.#shown().has("panel") &&
      (wish === null ? this.clientWidth >= WIDE : wish !== "closed" && this.clientWidth > NARROW)
    );
  }

  #motion() {
    return {
      inertia:
        !matchMedia("(prefers-reduced-motion: reduce)").matches && changeOf("inertia", this.getAttribute("inertia"))?.inertia !== false,
    };
  }

  /** The default value of a setting, which applies when its attribute is removed. */
  #without(/** @type {string} */ setting) {
    return setting === "inertia" ? this.#motion() : { [setting]: this.#settings.usual(setting) };
  }

  /** Several attributes that are set in one turn open the package only once. */
  #open() {
    if (this.#isAsked) return;
    this.#isAsked = true;
    queueMicrotask(() => {
      this.#isAsked = false;
      if (!this.isConnected) return;
      const part = this.#partOfHash();
      const place = placeBefore(part) ?? placeOf(this.getAttribute("look-at"));
      this.#close();
      void this.#start({ ...this.#motion(), ...this.#settings.wanted }, place, changesAfter(part ?? ""));
    });
  }

  /** @param {Record<string, unknown>} settings the page's settings @param {any} place @param {string} link the user's changes, as text */
  async #start(settings, place, link) {
    const { src } = this;
    if (src === "") return;
    const opening = new AbortController();
    this.#opening = opening;
    const layout = this.#layout;
    layout.fail(null);
    layout.opening(true);
    const asked = this.#settings.opening(settings, link);
    /** @type {any} */
    let session = null;
    try {
      session = await openSession({
        src,
        layout,
        signal: opening.signal,
        settings: asked.of,
        changed: (change) => {
          this.#settings.changedByHand(change);
          clearTimeout(this.#hashTimer);
          this.#hashTimer = setTimeout(() => this.#writeHash(), WRITE_HASH_AFTER_MS);
        },
        place,
        covered: this.#opensPanel() ? PANEL : 0,
        workers: Number(this.getAttribute("workers")) || null,
        memory: Number(this.getAttribute("memory")) || null,
        hashName: () => this.#hashName(),
        hash: () => this.#hash(),
        failed: (failure, from) => this.#lose(failure, from),
        emit: (name, detail, cancelable) => this.#emit(name, detail, cancelable),
        showCard: () => this.#shown().has("card"),
        command: (name) => this.#act(name),
      });
    } catch (error) {
      if (!opening.signal.aborted) this.#fail(failureOf(error));
      return;
    }
    if (opening.signal.aborted || !session) return;
    this.#session = session;
    const why = asked.done(session);
    if (why !== "") session.tell("warn", why);
    layout.opening(false);
    this.#showPanel(this.#opensPanel());
    // With the first frame, the camera is known.
    session.draw();
    if (this.#session === session) this.#emit("ready", this.about);
  }

  #close() {
    clearTimeout(this.#lostTimer);
    this.#opening?.abort();
    this.#opening = null;
    this.#session = null;
    this.#settings.closed();
    const layout = this.#layout;
    layout.opening(false);
    layout.fail(null);
    layout.place.hide();
    layout.credit([]);
    layout.renewCanvas();
  }

  /** The view has failed. If the device was lost, the view is reopened in its last state, but not again and again. */
  #lose(/** @type {import("./engine.js").Failure} */ failure, /** @type {any} */ session) {
    const { settings, link } = this.#settings.kept;
    const place = session.report()?.view ?? null;
    this.#close();
    const now = performance.now();
    this.#lost = this.#lost.filter((at) => now - at < REOPEN_WITHIN_MS);
    if (failure.kind !== "device-lost") return this.#fail(failure);
    if (this.#lost.length >= REOPEN_TIMES) {
      return this.#fail(
        new Failure(
          "device-lost",
          "The graphics device keeps being lost.",
          "Close other programs and pages that use the GPU, and try again.",
        ),
      );
    }
    const last = this.#lost.at(-1) ?? -Infinity;
    this.#lost.push(now);
    this.#layout.notices.add("tell", "The graphics device was lost. The map is reopened.");
    this.#lostTimer = setTimeout(() => void this.#start(settings, place, link), Math.max(0, last + REOPEN_AFTER_MS - now));
  }

  #fail(/** @type {import("./engine.js").Failure} */ failure) {
    const { src } = this;
    this.#close();
    this.#layout.fail(
      makeFailure(failure, {
        src,
        still: this.getAttribute("still"),
        credit: this.getAttribute("credit") ?? USUAL_CREDIT,
        again: () => this.#open(),
      }),
    );
    const { kind, message, advice } = failure;
    this.#emit("error", { kind, message, advice });
  }

  #emit(/** @type {string} */ name, /** @type {any} */ detail, cancelable = false) {
    if (name === "moveend") this.#writeHash();
    return this.dispatchEvent(new CustomEvent(name, { detail, cancelable }));
  }

  /** The part of the page's address that belongs to this map. */
  #partOfHash() {
    const name = this.#hashName();
    return name === null ? null : partInHash(location.hash, name);
  }

  /** The fragment with the camera and the user's changes; `null` if the page does not keep them. */
  #hash() {
    const name = this.#hashName();
    const place = this.camera;
    if (name === null || !place) return null;
    return hashWith(location.hash, name, place, this.#settings.link);
  }

  #writeHash() {
    const hash = this.#hash();
    if (hash !== null && hash !== location.hash) history.replaceState(history.state, "", hash);
  }

  #followHash() {
    const part = this.#partOfHash();
    const place = placeBefore(part);
    if (place) this.#session?.lookAt(place, true);
    // A link with a place only leaves the settings unchanged.
    const link = changesAfter(part ?? "");
    if (link !== "") this.#settings.takeLink(link);
  }

  #showPanel(/** @type {boolean} */ isShown) {
    const panel = this.#session?.panel;
    const { panelButton, place } = this.#layout;
    if (panel) panel.hidden = !isShown;
    panelButton.setAttribute("aria-expanded", String(Boolean(panel) && isShown));
    panelButton.setAttribute("aria-pressed", String(Boolean(panel) && isShown));
    if (isShown && this.clientWidth <= NARROW) place.hide();
  }

  /** Executes the command of a button or a key; returns whether it did something. */
  #act(/** @type {string} */ name) {
    const session = this.#session;
    const { notices, place, dialog, panelButton } = this.#layout;
    const shown = this.#shown();
    if (!session) return false;
    if (name === "close") {
      if (!session.panel.hidden && session.panel.contains(this.shadowRoot?.activeElement)) {
        this.#showPanel(false);
        panelButton.focus();
        return true;
      }
      return place.hide() || notices.dismiss();
    }
    if (name === "panel" || name === "help") {
      if (!shown.has("panel")) return false;
      if (name === "help") dialog.showModal();
      else {
        const hadFocus = session.panel.contains(this.shadowRoot?.activeElement);
        this.#showPanel(session.panel.hidden);
        if (hadFocus) panelButton.focus();
      }
      return true;
    }
    if (name === "pick") session.pickMiddle();
    else if (name in session.actions.byHand) {
      session.actions.byHand[name]().catch((/** @type {unknown} */ error) => session.tell("warn", failureOf(error).message));
      session.wake();
    } else session.command(name);
    return true;
  }
}

// Properties of the same names as the attributes.
for (const [attribute, property, setting] of SETTINGS) {
  Object.defineProperty(CornicheMap.prototype, property, {
    configurable: true,
    enumerable: true,
    get() {
      return this.settings[setting];
    },
    set(value) {
      this.setAttribute(attribute, typeof value === "number" ? String(value) : attributeText(value, setting));
    },
  });
}
