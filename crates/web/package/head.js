// The first request for a package. It is sent before the renderer is loaded, which then takes the
// answer.

/** Enough for the tables of most packages, and their first tiles. */
export const HEAD_BYTES = 64 << 10;

/** @param {string} src @param {AbortSignal} signal */
export function askForHead(src, signal) {
  const answer = fetch(src, { headers: { Range: `bytes=0-${HEAD_BYTES - 1}` }, cache: "no-store", signal });
  // If the renderer cannot be loaded, nobody takes the answer, and that failure is reported
  // already.
  answer.catch(() => {});
  return answer;
}
