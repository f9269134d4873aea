// A worker: decodes tiles with the module that the page compiled. The first message brings it, the others bring tiles.
import { decode, initSync } from "./corniche_web.js";

self.onmessage = (event) => {
  try {
    if (event.data.module) return void initSync({ module: event.data.module });
    const { message, transfer } = decode(event.data);
    self.postMessage(message, { transfer });
  } catch (error) {
    self.postMessage({ failed: String(error) });
  }
};
