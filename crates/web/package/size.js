// The size of the canvas in pixels of the screen.

/**
 * Calls back with the size at first and whenever it changes.
 *
 * @param {HTMLElement} canvas
 * @param {(width_px: number, height_px: number, pixels_per_point: number) => void} resized
 * @returns {() => void} ends it
 */
export function watchSize(canvas, resized) {
  const observer = new ResizeObserver((entries) => {
    const entry = entries[entries.length - 1];
    const ratio = window.devicePixelRatio || 1;
    const exact = entry.devicePixelContentBoxSize?.[0];
    const box = entry.contentBoxSize[0];
    const width = exact ? exact.inlineSize : Math.round(box.inlineSize * ratio);
    const height = exact ? exact.blockSize : Math.round(box.blockSize * ratio);
    if (width > 0 && height > 0) resized(width, height, ratio);
  });
  try {
    observer.observe(canvas, { box: "device-pixel-content-box" });
  } catch {
    // Safari does not know that box.
    observer.observe(canvas);
  }
  return () => observer.disconnect();
}
