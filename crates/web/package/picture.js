// The map as a PNG, with its attribution.

const LINE = 1.4;

/** Texts broken at spaces, none wider than the limit. */
function linesOf(/** @type {OffscreenCanvasRenderingContext2D} */ paint, /** @type {string[]} */ texts, /** @type {number} */ most) {
  const lines = [];
  let line = "";
  for (const word of texts.join(", ").split(" ")) {
    const longer = line === "" ? word : `${line} ${word}`;
    if (line !== "" && paint.measureText(longer).width > most) {
      lines.push(line);
      line = word;
    } else line = longer;
  }
  return [...lines, line];
}

/**
 * @param {Uint8Array} rgba rows from the top
 * @param {number} width_px
 * @param {number} height_px
 * @param {string[]} credits
 * @param {number} pixels_per_point
 * @returns {Promise<Blob>}
 */
export function pictureOf(rgba, width_px, height_px, credits, pixels_per_point) {
  const canvas = new OffscreenCanvas(width_px, height_px);
  const paint = canvas.getContext("2d");
  if (!paint) throw new Error("the browser has no memory for a picture of this size");
  paint.putImageData(new ImageData(new Uint8ClampedArray(rgba), width_px, height_px), 0, 0);
  const size = 11 * pixels_per_point;
  paint.font = `${size}px system-ui, sans-serif`;
  paint.textBaseline = "middle";
  const pad = size * 0.6;
  const lines = linesOf(paint, credits, width_px - 2 * pad);
  const wide = Math.max(...lines.map((line) => paint.measureText(line).width)) + 2 * pad;
  const high = lines.length * size * LINE + pad;
  paint.fillStyle = "rgb(255 255 255 / 80%)";
  paint.fillRect(width_px - wide, height_px - high, wide, high);
  paint.fillStyle = "#222";
  lines.forEach((line, k) => paint.fillText(line, width_px - wide + pad, height_px - high + pad / 2 + (k + 0.5) * size * LINE));
  return canvas.convertToBlob({ type: "image/png" });
}
