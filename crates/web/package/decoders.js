// Workers that decode tiles. They all run the same compiled module.

/** A worker needs a script from the page's own host; if the element is on another host, the worker starts with a script that imports it. */
function startWorker() {
  const own = import.meta.url;
  // Bundlers recognize exactly this form, and bundle the worker with its imports.
  if (new URL(own).origin === location.origin) return new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
  const script = own.replace(/[^/]*$/, "worker.js");
  const address = URL.createObjectURL(new Blob([`import ${JSON.stringify(script)};`], { type: "text/javascript" }));
  const worker = new Worker(address, { type: "module" });
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
  return worker;
}

/** Enough to hide decoding behind the network, and few enough to leave the page a core. */
export const usualCount = () => Math.max(2, Math.min(4, (navigator.hardwareConcurrency || 4) - 1));

/**
 * @param {Promise<WebAssembly.Module>} module if it cannot be loaded, workers wait until they are ended
 * @param {number} count
 * @param {(message: any) => void} decoded
 * @param {(error: unknown) => void} failed called once at most
 */
export function startDecoders(module, count, decoded, failed) {
  let hasFailed = false;
  const fail = (/** @type {unknown} */ error) => {
    if (!hasFailed) failed(error);
    hasFailed = true;
  };
  /** @type {Worker[]} */
  const workers = [];
  const end = () => workers.forEach((worker) => worker.terminate());
  const start = () => {
    const worker = startWorker();
    workers.push(worker);
    worker.onmessage = (event) => {
      if (event.data?.failed) fail(new Error(event.data.failed));
      else decoded(event.data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      fail(new Error(event.message || "the worker's script cannot be loaded"));
    };
    module.then((module) => worker.postMessage({ module })).catch(() => {});
  };
  try {
    for (let worker = 0; worker < count; worker += 1) start();
  } catch (error) {
    end();
    throw error;
  }
  return {
    count,
    post: (/** @type {number} */ index, /** @type {object} */ message, /** @type {ArrayBuffer[]} */ transfer) =>
      workers[index].postMessage(message, transfer),
    end,
  };
}
