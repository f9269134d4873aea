// The size of the canvas in device pixels.

/**
 * Calls back with the size at first and whenever it changes.
 *
 * @param {HTMLElement} canvas
 * @param {(width_px: number, height_px: number, pixels_per_point: number) => void} resized
 * @returns {() => void} ends the calls
 */
export function watchSize(canvas, resized) {
  const observer = new ResizeObserver((entries) => {
    const entry = entries[entries.length - 1];
    const ratio = window.devicePixelRatio || 1;
    const exact = entry.devicePixelContentBoxSize?.[0];
    const box = entry.contentBoxSize[0];
    const [width, height] = [
      [exact?.inlineSize, box.inlineSize * ratio],
      [exact?.blockSize, box.blockSize * ratio],
    ].map(([told, computed]) =>
      // If a browser emulates another screen, its exact sizes are still those of the real one.
      told !== undefined && Math.abs(told - Number(computed)) < 2 ? told : Math.round(Number(computed)),
    );
    if (width > 0 && height > 0) resized(width, height, ratio);
  });
  try {
    observer.observe(canvas, { box: "device-pixel-content-box" });
  } catch {
    // Safari does not support that box.
    observer.observe(canvas);
  }
  return () => observer.disconnect();
}
