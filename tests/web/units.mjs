// Parts that need no browser: texts of cameras, lengths, wheels, names of images.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";

export function tests({ sources }) {
  // Node treats files that end in .js as modules only if a package.json says so.
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "corniche-"));
  for (const name of fs.readdirSync(sources).filter((name) => name.endsWith(".js")))
    fs.copyFileSync(path.join(sources, name), path.join(folder, name));
  fs.writeFileSync(path.join(folder, "package.json"), '{ "type": "module" }');
  after(() => fs.rmSync(folder, { recursive: true }));
  const load = (name) => import(pathToFileURL(path.join(folder, name)).href);

  test("a camera in an address is read as it was written", async () => {
    const { placeOf, textOf, partInHash, placeBefore, changesAfter, hashWith } = await load("hash.js");
    const place = { lon: 9.521234, lat: 47.141, distance: 6000, heading: -30.5, pitch: 60 };
    assert.deepEqual(placeOf(textOf(place)), place);
    const above = { lon: 9.5, lat: 47.1, heading: 12, pitch: 0, above: true, pixel_m: 2.5 };
    assert.deepEqual(placeOf(textOf(above)), above);
    assert.deepEqual(placeOf("9.5, 47"), { lon: 9.5, lat: 47 });
    for (const wrong of ["", "9.5", "x,y", "181,0", "9,91", "1,2,3,4,5,up", "9.5,47,1e9", null])
      assert.equal(placeOf(wrong), null, String(wrong));
    assert.deepEqual(placeBefore(partInHash("#part&b=9.5,47&a=8,46", "a")), { lon: 8, lat: 46 });
    assert.equal(partInHash("#9.5,47", "a"), null);
    assert.equal(placeBefore(null), null);
    assert.equal(hashWith("#part&a=8,46", "a", place), `#part&a=${textOf(place)}`);
    assert.equal(hashWith("#9,47", "", place), `#${textOf(place)}`);
    assert.equal(hashWith("#contents", "", place), `#contents&${textOf(place)}`);
    // With manual changes.
    const part = partInHash("#contents&9,47;roads=sv;layers=none", "");
    assert.deepEqual([placeBefore(part), changesAfter(part)], [{ lon: 9, lat: 47 }, "roads=sv;layers=none"]);
    assert.equal(hashWith("#contents&9,47;roads=sv", "", place, "layers=none"), `#contents&${textOf(place)};layers=none`);
    assert.equal(hashWith("#a=8,46;roads=sv&9,47", "a", place), `#9,47&a=${textOf(place)}`);
  });

  // Small in tests; CORNICHE_FUZZ_SECONDS=600 makes it a fuzz run (scripts/fuzz 600 links).
  test("no address makes the page throw, and what it reads it writes", async (context) => {
    const { placeOf, textOf, partInHash, placeBefore, changesAfter, hashWith } = await load("hash.js");
    const { changesIn } = await load("hand_made.js");
    const [classes, widths] = [Array(9).fill(true), Array(9).fill(1)];
    const usual = { roads: "geo", classes, widths, style: "road-atlas", photo: 0.5, layers: null, exaggeration: 1, divider: 0.5 };
    const words = "# & = ; , a= 9.52 47.14 -180 1e9 % %25 %zz above NaN roads=sv + . map-style= exaggeration= photo= layers= classes= widths= 0: none 0";
    const pieces = [...words.split(" "), " ", "\u202e", "\ud800", "9".repeat(400)];
    let state = 38;
    const next = (most) => (state = (state * 48271) % 2147483647) % most;
    const end = Date.now() + 1000 * Number(process.env.CORNICHE_FUZZ_SECONDS ?? 0);
    let [done, places] = [0, 0];
    for (; done < 20_000 || Date.now() < end; done++) {
      const begin = ["", "9.52,47.14,", "a=9.52,47.14;"][next(3)];
      const hash = begin + Array.from({ length: next(12) }, () => pieces[next(pieces.length)]).join("");
      const name = ["", "a", "b="][next(3)];
      const part = partInHash(hash, name);
      const place = placeBefore(part);
      if (part !== null) {
        const { changes, unknown } = changesIn(changesAfter(part), usual);
        const values = changes.flatMap(([, change]) => Object.values(change)).flat();
        assert.ok(values.every((value) => typeof value !== "number" || Number.isFinite(value)), hash);
        assert.ok(unknown.every((text) => typeof text === "string"), hash);
      }
      if (!place) continue;
      places++;
      assert.ok(Math.abs(place.lon) <= 180 && Math.abs(place.lat) <= 90, hash);
      const { above, ...numbers } = place;
      assert.ok((above === undefined || above === true) && Object.values(numbers).every(Number.isFinite), hash);
      // Numbers are rounded once.
      const text = textOf(place);
      if (placeOf(text)) assert.equal(textOf(placeOf(text)), text, hash);
      assert.ok(hashWith(hash, name, place).startsWith("#"), hash);
    }
    context.diagnostic(`${done} addresses, ${places} of them with a camera`);
  });

  test("lengths of the scale are round and no longer than asked", async () => {
    const { roundLength, lengthText } = await load("scalebar.js");
    for (const [most, length] of [
      [1, 1],
      [1.99, 1],
      [2, 2],
      [4.9, 2],
      [5, 5],
      [999, 500],
      [1000, 1000],
      [0.3, 0.2],
    ])
      assert.ok(Math.abs(roundLength(most) - length) < 1e-9, `${most}`);
    assert.deepEqual([lengthText(2000), lengthText(500), lengthText(0.2), lengthText(1)], ["2 km", "500 m", "20 cm", "1 m"]);
  });

  test("a wheel's movement is in notches, whatever its unit", async () => {
    globalThis.WheelEvent ??= { DOM_DELTA_PIXEL: 0, DOM_DELTA_LINE: 1, DOM_DELTA_PAGE: 2 };
    const { notchesOf } = await load("pointers.js");
    const notches = (event) => notchesOf({ deltaX: 0, deltaMode: 0, ctrlKey: false, ...event });
    assert.equal(notches({ deltaY: -100 }), 1);
    assert.equal(notches({ deltaY: 3, deltaMode: 1 }), -1);
    assert.equal(notches({ deltaY: -1, deltaMode: 2 }), 1);
    assert.equal(notches({ deltaY: 0, deltaX: -100 }), 1, "Shift turns a wheel sideways");
    assert.equal(notches({ deltaY: -9000 }), 5, "never more than five at once");
    // A pinch to twice the size has a delta of 100 ln 2 in all, and three notches halve the
    // distance.
    const pinch = 100 * Math.LN2;
    assert.ok(Math.abs(2 * notches({ deltaY: -pinch / 2, ctrlKey: true }) - 3) < 1e-9);
    assert.equal(notches({ deltaY: -100, ctrlKey: true }), 1, "Ctrl and the wheel of a mouse");
  });

  test("what was changed by hand is read from a link as it was written, and bad parts are told", async () => {
    const { changed, changesText, changesIn, shortList } = await load("hand_made.js");
    const usual = {
      roads: "geo",
      classes: Array(9).fill(true),
      widths: Array(9).fill(1),
      style: "road-atlas",
      photo: 0.5,
      layers: null,
      exaggeration: 1,
      divider: 0.5,
    };
    const now = {
      ...usual,
      roads: "sv",
      classes: [true, false, true, false, false, false, false, false, false],
      widths: [1, 1.5, 1, 1, 1, 1, 1, 1, 0.25],
      style: "styles/my style;2.toml",
      photo: null,
      layers: ["areas", "walls"],
      exaggeration: 1.2999999523162842,
    };
    assert.equal(changesText(changed(usual, usual)), "", "nothing was changed");
    const text = changesText(changed(now, usual));
    assert.equal(
      text,
      "roads=sv;map-style=styles/my%20style%3B2.toml;exaggeration=1.3;photo=style;layers=areas,walls;classes=0,2;widths=1:1.5,8:0.25",
    );
    const { changes, unknown } = changesIn(text, usual);
    assert.deepEqual(unknown, []);
    assert.deepEqual({ ...usual, ...Object.assign({}, ...changes.map(([, change]) => change)) }, { ...now, exaggeration: 1.3 });
    const none = { layers: [], classes: Array(9).fill(false), widths: Array(9).fill(1) };
    assert.equal(changesText(none), "layers=none;classes=none;widths=none");
    assert.deepEqual(Object.assign({}, ...changesIn("layers=none;classes=none;widths=none", usual).changes.map(([, change]) => change)), none);
    const bad = ["neon=1", "exaggeration=high", "classes=0,9", "classes=", "widths=1", "widths=1:x", "map-style=%E0", "constructor=1", "7"];
    assert.deepEqual(changesIn(bad.join(";"), usual), { changes: [], unknown: bad });
    assert.equal(shortList(["a=1", "b=2", "c=3"]), "a=1 and 2 more");
    assert.ok(shortList(["x".repeat(1e5)]).length < 30);
  });

  test("settings come from attributes, and what is no value is left out", async () => {
    const { settingsOf, changeOf, settingOf, controlsOf } = await load("attributes.js");
    const element = (attributes) => ({ getAttribute: (name) => attributes[name] ?? null });
    assert.deepEqual(
      settingsOf(
        element({ roads: "sv", "map-style": "dark", exaggeration: "2", "error-px": "x", layers: "none", wireframe: "", photo: "off" }),
      ),
      { roads: "sv", style: "dark", exaggeration: 2, layers: [], wireframe: true, photo: 0 },
    );
    assert.equal(changeOf("samples", null), null);
    assert.deepEqual(changeOf("layers", "areas, walls"), { layers: ["areas", "walls"] });
    assert.deepEqual([settingOf("error-px"), settingOf("label")], ["error_px", undefined]);
    assert.equal(changeOf("samples", " "), null);
    assert.deepEqual(changeOf("photo", "style"), { photo: null });
    assert.deepEqual([...controlsOf("none")], []);
    assert.deepEqual([...controlsOf("zoom  compass other")], ["zoom", "compass"]);
    assert.ok(controlsOf(null).has("panel") && controlsOf("").has("card"));
  });
}
