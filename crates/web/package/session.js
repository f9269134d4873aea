// An opened package: the view, its workers, its frames and its input.
import { makeActions } from "./actions.js";
import { startDecoders, usualCount } from "./decoders.js";
import { Failure, checkBrowser, failureOf, loadEngine } from "./engine.js";
import { HEAD_BYTES, askForHead } from "./head.js";
import { watchKeys } from "./keys.js";
import { makeLoop } from "./loop.js";
import { makePanel } from "./panel.js";
import { watchPointers } from "./pointers.js";
import { watchSize } from "./size.js";

const MOVE_ENDS_MS = 200;
const MIB = 1 << 20;

/** The name of a package: its file name. For a local file, the name follows the address of its blob. */
function nameOf(/** @type {string} */ src) {
  if (!URL.canParse(src)) return src;
  const { hash, pathname, protocol } = new URL(src);
  const name = protocol === "blob:" ? hash.slice(1) : (pathname.split("/").pop() ?? "");
  try {
    return decodeURIComponent(name).replace(/\.pmtiles$/, "") || "Map";
  } catch {
    return name || "Map";
  }
}
const now = () => performance.now() / 1000;

/** The size of the canvas, once it has one: a view is opened for an image of a given size. */
function firstSize(/** @type {HTMLCanvasElement} */ canvas, /** @type {AbortSignal} */ signal) {
  return new Promise((resolve) => {
    const end = watchSize(canvas, (...size) => {
      end();
      resolve(size);
    });
    signal.addEventListener("abort", end);
  });
}

/**
 * Opens a package.
 *
 * @param {{ src: string, settings: (glue: any) => Promise<Record<string, unknown>>, changed: (change: Record<string, unknown>) => void, place: any, covered: number, workers: number | null, memory: number | null,
 *   layout: ReturnType<typeof import("./layout.js").makeLayout>, signal: AbortSignal, hashName: () => string | null, hash: () => string | null, failed: (failure: Failure, session: any) => void, emit: (name: string, detail: any, cancelable?: boolean) => boolean,
 *   showCard: () => boolean, command: (name: string) => boolean }} from
 */
export async function openSession(from) {
  const { layout, signal, emit } = from;
  const canvas = layout.canvas();
  /** @type {any} */
  let view = null;
  /** @type {any} */
  let loop = null;
  let isOver = false;
  const ends = /** @type {(() => void)[]} */ ([]);
  const end = () => {
    if (isOver) return;
    isOver = true;
    for (const stop of ends.reverse()) {
      try {
        stop();
      } catch (error) {
        // A renderer that stopped cannot be freed; everything else can.
        console.warn(error);
      }
    }
  };
  signal.addEventListener("abort", end);

  checkBrowser();
  // The package's first bytes, the workers and the module are all loaded at the same time.
  const size = firstSize(canvas, signal);
  const head = askForHead(from.src, signal);
  const engine = loadEngine();
  /** @type {any} */
  let glue = null;
  /** @type {(error: unknown) => void} */
  let stopOpening = () => {};
  // Rejected if a worker fails before the map is open.
  const stopped = new Promise((_, reject) => {
    stopOpening = reject;
  });
  stopped.catch(() => {});
  const failed = (/** @type {unknown} */ error) => {
    stopOpening(error);
    if (isOver || !view) return;
    const failure = failureOf(error);
    from.failed(failure, session);
  };
  const noWorkers = (/** @type {any} */ error) =>
    failed(
      new Failure(
        "files",
        `A worker cannot decode tiles: ${error.message}.`,
        "Check that worker.js is next to corniche-map.js, and that the page's security policy (worker-src) allows it.",
      ),
    );
  /** @type {ReturnType<typeof startDecoders>} */
  let decoders;
  try {
    decoders = startDecoders(engine.module, from.workers ?? usualCount(), (message) => glue.decoded(message), noWorkers);
  } catch (error) {
    throw new Failure(
      "files",
      `Workers cannot be started: ${/** @type {Error} */ (error).message}.`,
      "Check the page's security policy (worker-src).",
    );
  }
  ends.push(decoders.end);
  let asked;
  try {
    glue = await Promise.race([engine.ready, stopped]);
    asked = await Promise.race([from.settings(glue), stopped]);
  } catch (error) {
    end();
    throw error;
  }
  const [width, height, ratio] = await size;
  if (signal.aborted) return null;
  canvas.width = width;
  canvas.height = height;
  const host = {
    wake: () => loop?.wake(),
    /** @type {typeof decoders.post} */
    post(worker, message, transfer) {
      if (!isOver) decoders.post(worker, message, transfer);
      // An opening in progress must not wait for workers that have ended.
      else queueMicrotask(() => glue.decoded({ job: /** @type {any} */ (message).job, error: "the map was closed" }));
    },
    workers: decoders.count,
    head,
    head_bytes: HEAD_BYTES,
    get is_over() {
      return isOver;
    },
  };
  // Pending jobs of ended workers are reported as failed, since otherwise their callers would wait
  // forever.
  ends.push(() => Array.from({ length: host.workers }, (_, worker) => glue.worker_failed(host, worker, "the map was closed")));
  const options = {
    settings: asked,
    view: from.place ?? undefined,
    size_px: [width, height],
    pixels_per_point: ratio,
    covered_px: Math.round(from.covered * ratio),
    gpu_bytes: from.memory === null ? undefined : Math.round(from.memory * MIB),
  };
  const opened = glue.MapView.open(canvas, from.src, JSON.stringify(options), host);
  // If a worker fails first, the view is still freed once it exists.
  opened.then(
    (/** @type {any} */ one) => {
      if (isOver) one.free();
    },
    () => {},
  );
  try {
    view = await Promise.race([opened, stopped]);
  } catch (error) {
    end();
    throw error;
  }
  if (isOver) return null;
  ends.push(() => {
    const was = view;
    view = null;
    was.free();
  });

  /** @type {import("./corniche-map.js").About} */
  let about = { name: nameOf(from.src), ...JSON.parse(view.about()) };
  /** @type {any} */
  let settings = JSON.parse(view.settings());
  /** @type {import("./corniche-map.js").FrameReport | null} */
  let report = null;
  let place = "";
  let moveTimer = 0;
  const tell = (/** @type {"warn" | "tell"} */ kind, /** @type {string} */ text) => layout.notices.add(kind, text);

  /** Changes settings; returns an error message. */
  function set(/** @type {Record<string, unknown>} */ change) {
    if (!view) return "";
    const why = view.set(JSON.stringify(change));
    settings = JSON.parse(view.settings());
    if ("style" in change) about = { name: about.name, ...JSON.parse(view.about()) };
    show();
    loop?.wake();
    return why;
  }

  function setByHand(/** @type {Record<string, unknown>} */ change) {
    const why = set(change);
    if (why !== "") tell("warn", why);
    else from.changed(change);
  }

  function command(/** @type {string} */ name) {
    view?.command(name, now());
    loop?.wake();
  }

  function lookAt(/** @type {object} */ target, isJump = false) {
    const why = view?.look_at(JSON.stringify(completed(target)), now(), isJump) ?? "";
    loop?.wake();
    return why;
  }

  /** A place whose omitted fields are filled with the current values. */
  function completed(/** @type {any} */ target) {
    const { distance, heading, pitch, above, pixel_m } = report?.view ?? {};
    const isAbove = target.above ?? (above && target.distance === undefined && target.pitch === undefined);
    return isAbove
      ? { heading, pixel_m, ...target, above: true }
      : { distance, heading, pitch, ...target, above: undefined, pixel_m: undefined };
  }

  function goTo(/** @type {string} */ text) {
    const why = view?.go_to(text, now()) ?? "";
    loop?.wake();
    return why;
  }

  function show() {
    panel.show(settings, about);
    layout.divider.show(settings);
  }

  function endMove() {
    if (pointers.isHeld()) {
      moveTimer = setTimeout(endMove, MOVE_ENDS_MS);
      return;
    }
    moveTimer = 0;
    if (report?.view) emit("moveend", report.view);
  }

  function watchMoves(/** @type {import("./corniche-map.js").FrameReport} */ now) {
    const next = JSON.stringify(now.view);
    if (next === place) return;
    const isFirst = place === "";
    place = next;
    if (isFirst) return;
    clearTimeout(moveTimer);
    moveTimer = setTimeout(endMove, MOVE_ENDS_MS);
  }

  function draw(/** @type {number} */ now_s) {
    if (!view) return null;
    /** @type {import("./corniche-map.js").FrameReport} */
    let now;
    try {
      now = JSON.parse(view.frame(now_s));
    } catch (error) {
      failed(error);
      return null;
    }
    report = now;
    if (now.view) layout.compass.show(now.view);
    layout.scale.show(now.metres_per_point);
    layout.status.show(now);
    layout.progress(now.progress);
    panel.report(now);
    for (const { kind, text } of now.notices) tell(kind, text);
    watchMoves(now);
    if (now.is_settled) settle();
    return now.next;
  }

  /** @type {(() => void)[]} */
  let waiting = [];
  function settle() {
    const done = waiting;
    waiting = [];
    for (const resolve of done) resolve();
  }

  /** The place and the road at a pixel of the canvas. */
  async function pick(/** @type {number} */ x, /** @type {number} */ y) {
    const text = await view.pick(x, y);
    return /** @type {import("./corniche-map.js").Pick | null} */ (JSON.parse(text));
  }

  let picks = 0;
  async function pickByHand(/** @type {number} */ x, /** @type {number} */ y, /** @type {boolean} */ always) {
    const turn = (picks += 1);
    let found;
    try {
      found = await pick(x, y);
    } catch (error) {
      if (isOver || turn !== picks) return;
      layout.place.hide();
      tell("warn", `The road here cannot be fetched: ${failureOf(error).message}`);
      return;
    }
    if (isOver || turn !== picks) return;
    const isWanted = emit("pick", found, true) && from.showCard();
    if (isWanted && found && (found.road || always)) layout.place.show(found);
    else layout.place.hide();
  }

  const panel = makePanel({ set: setByHand, command: from.command, goTo, hasLink: from.hashName() !== null }, about, () =>
    from.command("panel"),
  );
  layout.over.prepend(panel.element);
  ends.push(() => panel.element.remove());
  const wake = () => loop.wake();
  const input = { view: () => view, wake };
  const pointers = watchPointers(canvas, {
    ...input,
    isCooperative: layout.isCooperative,
    hint: layout.hint,
    clicked: (x, y) => void pickByHand(x, y, false),
    asked: (x, y) => void pickByHand(x, y, true),
  });
  ends.push(pointers.end);
  ends.push(watchKeys(canvas, { ...input, command: from.command }));
  loop = makeLoop(canvas, draw);
  // The next frame reports a device that was lost while the map was at rest; nothing else would
  // request this frame.
  const watching = setInterval(() => {
    if (view && !document.hidden && !view.is_well()) wake();
  }, 1000);
  ends.push(loop.stop, () => clearTimeout(moveTimer), () => clearInterval(watching));
  ends.push(
    watchSize(canvas, (...size) => {
      view?.resize(...size);
      // The map is drawn before the page is painted, since otherwise it would flicker during a
      // resize.
      loop.now();
    }),
  );
  layout.credit(about.attribution);
  show();

  const actions = makeActions({ view, about, canvas, report: () => report, wake, tell, hash: from.hash });
  if (about.is_software) tell("tell", "No GPU was found: the CPU draws");
  const session = {
    end,
    set,
    setByHand,
    command,
    lookAt,
    goTo,
    actions,
    panel: panel.element,
    tell,
    wake,
    draw: loop.now,
    about: () => about,
    settings: () => settings,
    report: () => report,
    pick: (/** @type {number} */ x, /** @type {number} */ y) => {
      const scale = canvas.width / canvas.getBoundingClientRect().width;
      return pick(x * scale, y * scale);
    },
    pickMiddle: () => void pickByHand(canvas.width / 2, canvas.height / 2, true),
    readPixels: async () => ({ width: canvas.width, height: canvas.height, data: await view.read_pixels() }),
    zoom(/** @type {number} */ steps) {
      view.wheel(steps, canvas.width / 2, canvas.height / 2, now());
      wake();
    },
    settled: () =>
      new Promise((/** @type {(value?: any) => void} */ resolve) => {
        waiting.push(resolve);
        wake();
      }),
  };
  return session;
}
