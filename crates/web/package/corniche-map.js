// The element <corniche-map>: one import defines it.
import { CornicheMap } from "./element.js";

if (!customElements.get("corniche-map")) customElements.define("corniche-map", CornicheMap);

export { CornicheMap };
