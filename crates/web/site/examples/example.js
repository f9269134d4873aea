// The package of the examples: ?src=ADDRESS, else the first one next to the viewer.
import "../corniche-map.js";
import { packages } from "../packages.js";

const src = new URLSearchParams(location.search).get("src") ?? (await packages())[0]?.src;

/** The address of the package. If there is none, the page says so. */
export function packageOfPage() {
  if (src) return src;
  const said = document.createElement("p");
  said.setAttribute("role", "alert");
  said.textContent = "There is no package next to the viewer. Name one: ?src=ADDRESS.";
  document.querySelector("main").append(said);
  return "";
}
