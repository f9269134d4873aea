// Which package the examples show: ?src=ADDRESS, else the first that lies beside the viewer.
import "../corniche-map.js";
import { packages } from "../packages.js";

const src = new URLSearchParams(location.search).get("src") ?? (await packages())[0]?.src;

/** The address of the package. Without one, the page says so. */
export function packageOfPage() {
  if (src) return src;
  const said = document.createElement("p");
  said.setAttribute("role", "alert");
  said.textContent = "No package lies beside the viewer. Name one: ?src=ADDRESS.";
  document.querySelector("main").append(said);
  return "";
}
