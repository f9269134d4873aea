// A worker: decodes tiles with the module that the page compiled. The first message contains the
// module, the others contain tiles.
import { initSync, work } from "./corniche_web.js";

self.onmessage = (event) => {
  try {
    if (event.data.module) {
      initSync({ module: event.data.module });
      return;
    }
    const answer = work(event.data);
    if (answer !== undefined) self.postMessage(answer, { transfer: answer.tile ? [answer.tile.buffer] : [] });
  } catch (error) {
    // A tile that stops the decoder is lost, but the map is not.
    const { job } = event.data;
    self.postMessage(job === undefined ? { failed: String(error) } : { job, error: `the decoder stopped: ${error}` });
  }
};
