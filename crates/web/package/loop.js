// The loop of frames: it draws only when the view needs a frame, and never while the map is
// invisible.

/**
 * @param {Element} element the drawn element; no frames are drawn while it is out of view
 * @param {(now_s: number) => "now" | "asked" | null} draw returns when the next frame is wanted; `null` ends the loop
 */
export function makeLoop(element, draw) {
  let request = 0;
  let isSeen = true;
  let isOver = false;

  function frame() {
    request = 0;
    if (isOver) return;
    const next = draw(performance.now() / 1000);
    if (next === null) return stop();
    if (next === "now") wake();
  }

  function wake() {
    if (!isOver && isSeen && request === 0) request = requestAnimationFrame(frame);
  }

  const sight = new IntersectionObserver((entries) => {
    isSeen = entries[entries.length - 1].isIntersecting;
    if (isSeen) wake();
  });
  // The browser itself stops frames of a hidden page; the page must only be woken when it is
  // visible again.
  const shown = () => {
    if (!document.hidden) wake();
  };

  function stop() {
    isOver = true;
    cancelAnimationFrame(request);
    sight.disconnect();
    document.removeEventListener("visibilitychange", shown);
  }

  sight.observe(element);
  document.addEventListener("visibilitychange", shown);
  wake();
  return {
    wake,
    stop,
    /** Draws at once, in the turn of the caller. */
    now() {
      cancelAnimationFrame(request);
      frame();
    },
  };
}
