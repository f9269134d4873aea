// The page of the viewer: ?src=ADDRESS names the package, &layers=NAMES the layers that are shown
// at first. Without an address, the page offers the packages next to it, and accepts a file.
import { packages } from "./packages.js";

const map = document.getElementById("map");
const chooser = document.getElementById("chooser");
const said = document.getElementById("said");
const drop = document.getElementById("drop");

/** Shows a package, at first with these layers; without them, with all. */
function show(src, title, layers) {
  chooser.hidden = true;
  map.hidden = false;
  document.title = `${title} – Corniche`;
  if (layers == null) map.removeAttribute("layers");
  else map.setAttribute("layers", layers);
  map.src = src;
}

/** The name of a package: its file name. An address that cannot be parsed is shown as it is. */
function nameOf(src) {
  try {
    return decodeURIComponent(new URL(src, location.href).pathname.split("/").pop()).replace(/\.pmtiles$/, "") || src;
  } catch {
    return src;
  }
}

/** Shows a local file: a blob's address answers range requests like a server. */
function showFile(file) {
  if (file) show(`${URL.createObjectURL(file)}#${encodeURIComponent(file.name)}`, file.name.replace(/\.pmtiles$/, ""));
}

async function begin() {
  const query = new URLSearchParams(location.search);
  const src = query.get("src");
  if (src) return show(src, nameOf(src), query.get("layers"));
  const known = await packages();
  if (known.length === 1) return show(known[0].src, known[0].name, known[0].layers);
  said.textContent =
    known.length > 1 ? "Choose a map." : "There is no map next to this page. Name one in its address, ?src=ADDRESS, or open a file.";
  document.getElementById("list").append(
    ...known.map(({ name, ...rest }) => {
      const item = document.createElement("li");
      const link = document.createElement("a");
      link.href = `?${new URLSearchParams(rest)}`;
      link.textContent = name;
      item.append(link);
      return item;
    }),
  );
}

document.getElementById("file").addEventListener("change", (event) => showFile(event.target.files[0]));
const hasFile = (event) => event.dataTransfer?.types.includes("Files");
addEventListener("dragover", (event) => {
  if (!hasFile(event)) return;
  event.preventDefault();
  drop.hidden = false;
});
addEventListener("dragleave", (event) => {
  if (!event.relatedTarget) drop.hidden = true;
});
addEventListener("drop", (event) => {
  drop.hidden = true;
  if (!hasFile(event)) return;
  event.preventDefault();
  showFile(event.dataTransfer.files[0]);
});
void begin();
