// What a map shows, says and tells where its data is missing or nothing can be drawn: a picture, the texts of the page, and the console.
import path from "node:path";

const WAIT_MS = 15_000;

/** As in a browser that has neither WebGL nor WebGPU. */
function withoutDrawing() {
  for (const type of [HTMLCanvasElement, window.OffscreenCanvas].filter(Boolean)) {
    const get = type.prototype.getContext;
    type.prototype.getContext = function (kind, ...all) {
      return /webgl|webgpu/.test(kind) ? null : get.call(this, kind, ...all);
    };
  }
  withoutWebGpu();
}

function withoutWebGpu() {
  Object.defineProperty(Navigator.prototype, "gpu", { get: () => undefined });
}

/** Where the data lies, and what is taken from the browser. */
const FAULTS = {
  "data is missing": { data: "missing" },
  "no WebGL, no WebGPU": { data: "data", prepare: withoutDrawing },
  "no WebGPU": { data: "data", prepare: withoutWebGpu },
};

export async function showFaults({ openBrowser, watch, server, name, map, view, pictures }) {
  for (const [fault, { data, prepare }] of Object.entries(FAULTS)) {
    const { browser, page } = await openBrowser(async (page) => {
      await page.addInitScript(watch, { mute: false, leastVertices: map.leastVertices ?? 0 });
      if (prepare) await page.addInitScript(prepare);
    });
    const said = [];
    page.on("console", (message) => /error|warning/.test(message.type()) && said.push(`${message.type()}: ${message.text()}`));
    page.on("pageerror", (error) => said.push(`not caught: ${error?.message ?? error}`));
    server.behave();
    server.state.compresses = true;
    await page.goto(`${server.origin}${map.address(view, data)}`, { waitUntil: "commit" });
    await page.waitForTimeout(WAIT_MS);
    const texts = await page.evaluate(() => {
      const roots = [document.body, ...[...document.querySelectorAll("*")].map((element) => element.shadowRoot).filter(Boolean)];
      return roots.map((root) => root.innerText ?? [...root.querySelectorAll("[role=alert], [role=status], .notice, p")].map((element) => element.innerText).join(" ")).join(" | ");
    });
    await page.screenshot({ path: path.join(pictures, `${name}-${fault}.png`.replace(/[^a-zA-Z0-9.]+/g, "-")), timeout: 60_000 });
    console.log(`${name}, ${fault}\n  the page says: ${texts.replace(/\s+/g, " ").slice(0, 400) || "nothing"}\n  the console: ${said.length} lines`);
    for (const line of new Set(said)) console.log(`    ${line.replace(/\s+/g, " ").slice(0, 240)}`);
    await browser.close();
  }
}
