// Mouse, wheel and fingers. One finger acts like the left button; two fingers pinch, rotate and
// tilt. With cooperative gestures, the wheel and one finger are left to the page, which scrolls:
// Ctrl and the wheel zoom, two fingers move, pinch and rotate, three tilt.

const CLICK_MOVES = 5;
const TAP_AGAIN_MS = 350;
const TAP_AGAIN_POINTS = 30;
const LONG_PRESS_MS = 600;
const LINES_PER_NOTCH = 3;
const POINTS_PER_NOTCH = 100;
/** A pinch on a touch pad arrives as a wheel event with Control and a delta of 100 ln(scale); three notches of the view halve the distance. */
const NOTCHES_PER_PINCH = 3 / (100 * Math.LN2);
const MOST_NOTCHES = 5;
/** Two fingers that first move this far sideways do not tilt. */
const SIDEWAYS = 30;

/** Notches of a wheel, positive away from the user. */
export function notchesOf(/** @type {WheelEvent} */ event) {
  const delta = -(event.deltaY || event.deltaX);
  const points = Math.abs(delta);
  let notches;
  if (event.deltaMode === WheelEvent.DOM_DELTA_LINE) notches = delta / LINES_PER_NOTCH;
  else if (event.deltaMode === WheelEvent.DOM_DELTA_PAGE) notches = delta;
  else if (event.ctrlKey && points < POINTS_PER_NOTCH / 2) notches = delta * NOTCHES_PER_PINCH;
  else notches = delta / POINTS_PER_NOTCH;
  return Math.max(-MOST_NOTCHES, Math.min(MOST_NOTCHES, notches));
}

const now = () => performance.now() / 1000;

/**
 * @param {HTMLCanvasElement} canvas
 * @param {{ view: () => any, wake: () => void, clicked: (x: number, y: number) => void, asked: (x: number, y: number) => void,
 *   isCooperative: () => boolean, hint: { show: (how: "wheel" | "finger") => void, hide: () => void } }} to
 *   `clicked` after a click or a tap, `asked` after a long press or a click of the right button; device pixels
 */
export function watchPointers(canvas, to) {
  const end = new AbortController();
  const { signal } = end;
  /** @type {Map<number, { x: number, y: number }>} */
  const fingers = new Map();
  /** @type {{ x: number, y: number, button: number, isStill: boolean, isLong: boolean, finger: boolean } | null} */
  let held = null;
  /** A finger that remains after a gesture of two: it pans only once it moves, since otherwise its touch would count as a second tap. */
  let isWaiting = false;
  let isPinching = false;
  let lastTap = { x: 0, y: 0, at: -1e9 };
  let longPress = 0;

  /** The position in device pixels of the canvas, whatever transforms the page has set. */
  function at(/** @type {{ clientX: number, clientY: number }} */ event) {
    const box = canvas.getBoundingClientRect();
    return { x: ((event.clientX - box.left) * canvas.width) / box.width, y: ((event.clientY - box.top) * canvas.height) / box.height };
  }

  const perPoint = () => canvas.width / canvas.getBoundingClientRect().width || 1;
  const far = (/** @type {any} */ a, /** @type {any} */ b, /** @type {number} */ points) =>
    Math.hypot(a.x - b.x, a.y - b.y) > points * perPoint();

  function press(
    /** @type {{ x: number, y: number }} */ place,
    /** @type {number} */ button,
    /** @type {PointerEvent} */ event,
    finger = false,
  ) {
    held = { ...place, button, isStill: true, isLong: false, finger };
    to.view()?.press(button, place.x, place.y, event.shiftKey, event.ctrlKey, now());
    clearTimeout(longPress);
    if (finger) {
      longPress = setTimeout(() => {
        if (!held?.isStill) return;
        held.isLong = true;
        to.asked(place.x, place.y);
      }, LONG_PRESS_MS);
    }
    to.wake();
  }

  function move(/** @type {{ x: number, y: number }} */ place) {
    if (held?.isStill && far(held, place, CLICK_MOVES)) held.isStill = false;
    to.view()?.move_to(place.x, place.y, now());
    to.wake();
  }

  function release(isClick = true) {
    clearTimeout(longPress);
    if (!held) return;
    const was = held;
    held = null;
    to.view()?.release(was.button, now());
    to.wake();
    if (!isClick || !was.isStill || was.isLong) return;
    if (was.button === 0) to.clicked(was.x, was.y);
    else if (was.button === 2) to.asked(was.x, was.y);
  }

  function pinch() {
    const [a, b] = [...fingers.values()];
    if (!isPinching && fingers.size === 2 && to.isCooperative()) {
      // Moving two fingers up and down moves the map, as one finger does elsewhere. A step
      // sideways, undone before anything is drawn, tells the view so.
      const aside = SIDEWAYS * perPoint();
      to.view()?.two_fingers(a.x, a.y, b.x, b.y, now());
      to.view()?.two_fingers(a.x + aside, a.y, b.x + aside, b.y, now());
    }
    isPinching = true;
    to.view()?.two_fingers(a.x, a.y, b.x, b.y, now());
    to.wake();
  }

  function endPinch() {
    if (!isPinching) return;
    isPinching = false;
    to.view()?.end_two_fingers(now());
    to.wake();
  }

  function fingerDown(/** @type {PointerEvent} */ event) {
    if (fingers.size >= (to.isCooperative() ? 3 : 2)) return;
    let place = at(event);
    fingers.set(event.pointerId, place);
    if (fingers.size >= 2) {
      release(false);
      endPinch();
      to.hint.hide();
      isWaiting = false;
      pinch();
      return;
    }
    const isAgain = event.timeStamp - lastTap.at < TAP_AGAIN_MS && !far(place, lastTap, TAP_AGAIN_POINTS);
    // Fingers are less exact than a mouse: the second tap counts at the position of the first one.
    if (isAgain) place = { x: lastTap.x, y: lastTap.y };
    press(place, 0, event, true);
  }

  function fingerMove(/** @type {PointerEvent} */ event) {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const place = at(event);
    if (isWaiting && !to.isCooperative() && far(before, place, 2 * CLICK_MOVES)) {
      isWaiting = false;
      press(before, 0, event, true);
      if (held) held.isStill = false;
    }
    if (isWaiting) return;
    fingers.set(event.pointerId, place);
    if (isPinching) pinch();
    else if (to.isCooperative()) scrolled(held !== null && held.isStill && far(held, place, CLICK_MOVES));
    // The small movements of a tap must not pan.
    else if (held && (!held.isStill || far(held, place, CLICK_MOVES))) move(place);
  }

  /** One finger scrolls the page. */
  function scrolled(/** @type {boolean} */ isSo) {
    if (!isSo) return;
    clearTimeout(longPress);
    if (held) held.isStill = false;
    to.hint.show("finger");
  }

  function fingerUp(/** @type {PointerEvent} */ event, isClick = true) {
    if (!fingers.delete(event.pointerId)) return;
    // The browser takes over the finger when it begins to scroll.
    scrolled(!isClick && !isPinching && fingers.size === 0 && to.isCooperative());
    if (isPinching) {
      endPinch();
      isWaiting = fingers.size === 1;
      // Two of three fingers remain: they continue from their positions.
      if (fingers.size >= 2) pinch();
      return;
    }
    isWaiting = false;
    if (held?.isStill) lastTap = { x: held.x, y: held.y, at: event.timeStamp };
    release(isClick);
    to.view()?.leave();
  }

  const on = (/** @type {string} */ name, /** @type {(event: any) => void} */ listener, options = {}) =>
    canvas.addEventListener(name, listener, { signal, ...options });

  on("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (event.pointerType === "touch") return fingerDown(event);
    if (held || event.button > 2) return;
    press(at(event), event.button, event);
  });
  // The middle button would start the browser's own scrolling.
  on("mousedown", (event) => {
    if (event.button === 1) event.preventDefault();
  });
  on("pointermove", (event) => (event.pointerType === "touch" ? fingerMove(event) : move(at(event))));
  on("pointerup", (event) => {
    if (event.pointerType === "touch") return fingerUp(event);
    if (held?.button === event.button || event.buttons === 0) release();
  });
  on("pointercancel", (event) => (event.pointerType === "touch" ? fingerUp(event, false) : release(false)));
  on("lostpointercapture", (event) => {
    if (event.pointerType !== "touch") release(false);
  });
  on("pointerleave", (event) => {
    if (event.pointerType === "touch" || held) return;
    to.view()?.leave();
    to.wake();
  });
  // A finger that the browser may scroll with may scroll with two fingers as well.
  for (const name of ["touchstart", "touchmove"]) {
    on(
      name,
      (event) => {
        if (event.targetTouches.length > 1 && event.cancelable && to.isCooperative()) event.preventDefault();
      },
      { passive: false },
    );
  }
  on("contextmenu", (event) => event.preventDefault());
  on(
    "wheel",
    (event) => {
      if (to.isCooperative() && !event.ctrlKey && !event.metaKey) return to.hint.show("wheel");
      event.preventDefault();
      to.hint.hide();
      const place = at(event);
      to.view()?.wheel(notchesOf(event), place.x, place.y, now());
      to.wake();
    },
    { passive: false },
  );

  return {
    /** Whether a button or a finger holds the map. */
    isHeld: () => held !== null || isPinching,
    end() {
      clearTimeout(longPress);
      end.abort();
    },
  };
}
