// FOLDER/site: each map's page with its library, as its npm package ships it or, where that is how it is used, as a bundler makes it smaller.
import { buildSync } from "esbuild";
import fs from "node:fs";
import path from "node:path";

const SHORT = { bundle: true, minify: true, format: "esm", target: "es2022", logLevel: "error", legalComments: "none" };

/** @param built the page of <corniche-map>, made by scripts/web */
export function makeSite({ folder, modules, pages, built }) {
  const site = path.join(folder, "site");
  const from = (name) => path.join(modules, name);
  const place = (file, to) => {
    const copy = path.join(site, to);
    fs.mkdirSync(path.dirname(copy), { recursive: true });
    // What is compressed beside a file is that of the file as it was.
    if (fs.existsSync(copy) && fs.statSync(file).isFile() && !fs.readFileSync(file).equals(fs.readFileSync(copy))) fs.rmSync(`${copy}.br`, { force: true });
    fs.cpSync(file, copy, { recursive: true });
  };
  const bundle = (options, to) => {
    const made = path.join(folder, "work", path.basename(to));
    buildSync({ ...SHORT, nodePaths: [modules], outfile: made, ...options });
    place(made, to);
  };

  for (const name of ["index.html", "site.js", "site.css", "packages.js", "corniche-map.js", "corniche_web.js", "corniche_web_bg.wasm", "worker.js"]) place(path.join(built, name), `corniche/${name}`);

  for (const name of ["maplibre.html", "page.js"]) place(path.join(pages, name), `maplibre/${name}`);
  for (const name of ["maplibre-gl.css", "maplibre-gl.mjs", "maplibre-gl-shared.mjs", "maplibre-gl-worker.mjs"]) place(from(`maplibre-gl/dist/${name}`), `maplibre/${name}`);

  for (const name of ["cesium.html", "bundled.html", "cesium.js", "page.js"]) place(path.join(pages, name), `cesium/${name}`);
  for (const name of ["index.js", "Assets", "ThirdParty", "Widgets", "Workers"]) place(from(`cesium/Build/Cesium/${name}`), `cesium/Cesium/${name}`);
  bundle({ entryPoints: [path.join(pages, "bundled.js")] }, "cesium/bundled.js");

  for (const name of ["rerun.html", "page.js"]) place(path.join(pages, name), `rerun/${name}`);
  // Its module imports others without their endings, which only bundlers understand.
  bundle({ entryPoints: [from("@rerun-io/web-viewer/index.js")] }, "rerun/index.js");
  place(from("@rerun-io/web-viewer/re_viewer_bg.wasm"), "rerun/re_viewer_bg.wasm");
}
