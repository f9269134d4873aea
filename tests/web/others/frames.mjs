// What the pictures of a page show, by their pixels alone, so that all maps are judged by one measure.
import jpeg from "jpeg-js";
import { PNG } from "pngjs";

export const FRAME = { width: 640, height: 400 };
const CELL_PX = 20;
/** Where all maps have ground and none has buttons: left, top, right, bottom as shares of the picture. */
const MIDDLE = [0.25, 0.35, 0.75, 0.85];
/** Ground has relief: within a cell of it, brightness varies by so many of 255 steps (root mean square). */
const LEAST_RELIEF = 3;
/** As compression leaves it, a pixel is the same. */
const SAME = 12;
const FEW_PIXELS = 0.001;

export const read = (bytes) => jpeg.decode(bytes, { useTArray: true, formatAsRGBA: true });
export const toPng = ({ width, height, data }) => PNG.sync.write(Object.assign(new PNG({ width, height }), { data: Buffer.from(data) }));

/**
 * Follows the pictures of a page by the browser's own protocol, with the time in milliseconds since 1970 when each came here, drawn. The browser's own times are those when a picture was
 * begun, which the renderer may finish seconds later.
 */
export async function follow(page) {
  const frames = [];
  const client = await page.context().newCDPSession(page);
  client.on("Page.screencastFrame", ({ data, sessionId }) => {
    frames.push({ at_ms: performance.timeOrigin + performance.now(), bytes: Buffer.from(data, "base64") });
    client.send("Page.screencastFrameAck", { sessionId }).catch(() => {});
  });
  await client.send("Page.startScreencast", { format: "jpeg", quality: 80, maxWidth: FRAME.width, maxHeight: FRAME.height, everyNthFrame: 1 });
  return frames;
}

function middleOf({ width, height }) {
  return [MIDDLE[0] * width, MIDDLE[1] * height, MIDDLE[2] * width, MIDDLE[3] * height].map(Math.round);
}

const brightness = (data, at) => 0.3 * data[at] + 0.59 * data[at + 1] + 0.11 * data[at + 2];

/** The cells in the middle that have relief, by number. */
function cellsWithRelief(picture) {
  const [left, top, right, bottom] = middleOf(picture);
  const found = new Set();
  let number = 0;
  for (let y = top; y + CELL_PX <= bottom; y += CELL_PX) {
    for (let x = left; x + CELL_PX <= right; x += CELL_PX) {
      let sum = 0;
      let squares = 0;
      for (let row = y; row < y + CELL_PX; row += 1) {
        for (let column = x; column < x + CELL_PX; column += 1) {
          const value = brightness(picture.data, 4 * (row * picture.width + column));
          sum += value;
          squares += value * value;
        }
      }
      const count = CELL_PX * CELL_PX;
      if (Math.sqrt(Math.max(0, squares / count - (sum / count) ** 2)) >= LEAST_RELIEF) found.add(number);
      number += 1;
    }
  }
  return found;
}

function isSame(one, other) {
  const [left, top, right, bottom] = middleOf(one);
  let different = 0;
  for (let y = top; y < bottom; y += 1) {
    for (let x = left; x < right; x += 1) {
      const at = 4 * (y * one.width + x);
      if ([0, 1, 2].some((k) => Math.abs(one.data[at + k] - other.data[at + k]) > SAME)) different += 1;
    }
  }
  return different <= FEW_PIXELS * (right - left) * (bottom - top);
}

/**
 * The first picture with ground: at least half of the cells that have relief in the last picture have some. And the first of those that are the same as the last to
 * the end. `null` where the last one has no ground.
 */
export function judge(frames) {
  if (frames.length === 0) return null;
  const pictures = frames.map(({ at_ms, bytes }) => ({ at_ms, ...read(bytes) }));
  const last = pictures.at(-1);
  const wanted = cellsWithRelief(last);
  const cells = cellsWithRelief(noise(last)).size;
  if (wanted.size < cells / 2) return null;
  const first = pictures.find((picture) => {
    const found = cellsWithRelief(picture);
    return [...wanted].filter((cell) => found.has(cell)).length >= wanted.size / 2;
  });
  let whole = pictures.length - 1;
  while (whole > 0 && isSame(pictures[whole - 1], last)) whole -= 1;
  return { first, whole: pictures[whole], last };
}

/** A picture of the same size with relief everywhere, to count all cells. */
function noise({ width, height }) {
  const data = new Uint8Array(4 * width * height);
  for (let at = 0; at < data.length; at += 1) data[at] = at % 8 < 4 ? 0 : 255;
  return { width, height, data };
}
