// Runs in each page before its scripts: notes frames and what they hand to the renderer. With `mute` nothing is drawn, so that the time of the renderer, here a program on the
// processor, is not part of what is measured.

/** @param {{ mute: boolean, leastVertices: number }} options a frame with so many vertices is one with ground; 0: the page tells it itself */
export function watch({ mute, leastVertices }) {
  const others = { told: {}, frames: 0, longest_frame_ms: 0 };
  window.others = others;
  let vertices = 0;

  function wrap(type, name, countOf) {
    const draw = type?.prototype[name];
    if (!draw) return;
    type.prototype[name] = function (...all) {
      vertices += countOf(...all);
      return mute ? undefined : draw.apply(this, all);
    };
  }
  for (const type of [window.WebGLRenderingContext, window.WebGL2RenderingContext]) {
    wrap(type, "drawArrays", (mode, first, count) => count);
    wrap(type, "drawElements", (mode, count) => count);
    wrap(type, "drawArraysInstanced", (mode, first, count, instances) => count * instances);
    wrap(type, "drawElementsInstanced", (mode, count, kind, offset, instances) => count * instances);
    wrap(type, "drawRangeElements", (mode, start, end, count) => count);
  }
  for (const type of [window.GPURenderPassEncoder, window.GPURenderBundleEncoder]) {
    wrap(type, "draw", (count, instances = 1) => count * instances);
    wrap(type, "drawIndexed", (count, instances = 1) => count * instances);
    wrap(type, "drawIndirect", () => 1);
    wrap(type, "drawIndexedIndirect", () => 1);
  }

  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) =>
    request((now) => {
      vertices = 0;
      const begun = performance.now();
      callback(now);
      if (vertices === 0) return;
      others.frames += 1;
      others.longest_frame_ms = Math.max(others.longest_frame_ms, performance.now() - begun);
      others.last_frame_ms = performance.now();
      if (leastVertices > 0 && vertices >= leastVertices) others.told.handed ??= performance.now();
    });
}
