// Cooperative gestures: in a page that scrolls, the wheel and one finger scroll the page.
import assert from "node:assert/strict";
import path from "node:path";
import { test } from "node:test";
import { addMap, ask, checkFaults, openPage, settled, touches } from "./browser.mjs";
import { someOf } from "./tier.mjs";

const VIEW = { "look-at": "9.51,46.91,4000,30,50", inertia: "off" };

/** A page with text above and below a map. */
async function longPage(browser, server, attributes, options = {}) {
  server.behave();
  const page = await openPage(browser, server, "/blank.html", { width: 800, height: 600, ...options });
  await page.evaluate(() => {
    const main = document.querySelector("main");
    for (const where of ["beforebegin", "afterend"]) {
      const text = document.createElement("div");
      Object.assign(text.style, { height: where === "beforebegin" ? "100px" : "2000px" });
      main.insertAdjacentElement(where, text);
    }
  });
  const { ready } = await addMap(page, { src: "/packages/pass.pmtiles", samples: "1", controls: "none", ...VIEW, ...attributes }, { height: "400px" });
  assert.ok(ready);
  await settled(page);
  return page;
}

const camera = (page) => ask(page, (map) => map.camera);
const scrolled = (page) => page.evaluate(() => Math.round(scrollY));
/** Scrolls back to the top until the page rests there: a fling continues for a while, longer on a slow machine. */
async function toTop(page) {
  for (let rests = 0; rests < 5; ) {
    await page.evaluate(() => scrollTo(0, 0));
    await page.waitForTimeout(100);
    rests = (await scrolled(page)) === 0 ? rests + 1 : 0;
  }
}
const hint = (page) => page.locator("corniche-map .hint");
const shownHint = (page) => page.locator("corniche-map .hint.shown");
const isHinted = (page) => hint(page).evaluate((element) => element.classList.contains("shown"));
const moved = (a, b) => Math.abs(a.lon - b.lon) + Math.abs(a.lat - b.lat) + Math.abs(a.distance - b.distance) / 1e5;

async function wheel(page, delta, key) {
  if (key) await page.keyboard.down(key);
  await page.mouse.wheel(0, delta);
  await page.waitForTimeout(300);
  if (key) await page.keyboard.up(key);
  await settled(page);
}

export function tests({ browser, server, pictures }) {
  test("cooperative: the wheel scrolls the page, with Ctrl or ⌘ it zooms", async () => {
    const page = await longPage(browser, server, { gestures: "cooperative" });
    await page.mouse.move(300, 300);
    const before = await camera(page);
    await page.mouse.wheel(0, 150);
    await shownHint(page).waitFor();
    await page.waitForFunction(() => scrollY === 150);
    await settled(page);
    assert.deepEqual(await camera(page), before, "the map stays");
    assert.match(await hint(page).textContent(), /^Hold (Ctrl|⌘) and scroll to zoom the map$/);
    await shownHint(page).waitFor({ state: "detached" });
    for (const key of ["Control", "Meta"]) {
      const far = await camera(page);
      await wheel(page, -200, key);
      assert.ok((await camera(page)).distance < 0.8 * far.distance, `${key} and the wheel`);
      assert.equal(await scrolled(page), 150, "the page stays");
      assert.ok(!(await isHinted(page)));
    }
    // The mouse still drags.
    const still = await camera(page);
    await page.mouse.down();
    await page.mouse.move(400, 330, { steps: 4 });
    await page.mouse.up();
    await settled(page);
    assert.ok(moved(await camera(page), still) > 1e-4);
    // Back to the default behaviour of maps.
    await ask(page, (map) => map.removeAttribute("gestures"));
    const greedy = await camera(page);
    await wheel(page, 100);
    assert.ok((await camera(page)).distance > 1.1 * greedy.distance);
    assert.equal(await scrolled(page), 150);
    checkFaults(page);
    await page.end();
  });

  test("the hint is read aloud once, and not with each turn of the wheel", async () => {
    const page = await longPage(browser, server, { gestures: "cooperative" });
    await ask(page, (map) => {
      window.spoken = 0;
      const status = map.shadowRoot.querySelector(".hint [role=status]");
      new MutationObserver((records) => {
        window.spoken += records.length;
      }).observe(status, { childList: true, characterData: true, subtree: true });
    });
    await page.mouse.move(300, 300);
    for (const delta of [40, -40, 40, -40]) await wheel(page, delta);
    await page.waitForTimeout(2000);
    await wheel(page, 40);
    assert.equal(await page.evaluate(() => window.spoken), 1);
    await page.end();
  });

  test("cooperative: one finger scrolls the page, two move, pinch and turn the map, three tilt it", async () => {
    const page = await longPage(browser, server, { gestures: "cooperative" }, { hasTouch: true, isMobile: true });
    const finger = await touches(page);
    const before = await camera(page);
    await finger.down([400, 400]);
    for (let step = 1; step <= 8; step += 1) await finger.move([400, 400 - 20 * step]);
    await finger.up();
    await shownHint(page).waitFor();
    assert.match(await hint(page).textContent(), /two fingers/);
    await page.waitForTimeout(500);
    const down = await scrolled(page);
    assert.ok(down > 80, `the page scrolled by ${down}`);
    assert.deepEqual(await camera(page), before, "the map stays");
    await toTop(page);

    // Up and down with two fingers: the ground between them follows.
    const ground = await ask(page, (map) => map.pick(400, 200));
    await finger.down([350, 300]);
    await finger.down([350, 300], [450, 300]);
    for (let step = 1; step <= 8; step += 1) await finger.move([350, 300 + 8 * step], [450, 300 + 8 * step]);
    await settled(page);
    const panned = await camera(page);
    assert.equal(await scrolled(page), 0, "the page stays");
    assert.ok(Math.abs(panned.pitch - before.pitch) < 0.5, "it is not tilted");
    assert.ok(moved(panned, before) > 1e-4, "it is moved");
    const kept = await ask(page, (map) => map.pick(400, 264));
    assert.ok(Math.hypot(kept.lon - ground.lon, kept.lat - ground.lat) < 1e-4, `${JSON.stringify(kept)} ${JSON.stringify(ground)}`);
    assert.ok(!(await isHinted(page)));
    await finger.up();

    const far = await camera(page);
    await finger.down([300, 300]);
    await finger.down([300, 300], [500, 300]);
    for (let step = 1; step <= 8; step += 1) await finger.move([300 - 8 * step, 300 + 3 * step], [500 + 8 * step, 300 - 3 * step]);
    await finger.up();
    await settled(page);
    const near = await camera(page);
    assert.ok(near.distance < 0.8 * far.distance && Math.abs(near.heading - far.heading) > 3, "pinched and turned");
    assert.equal(await scrolled(page), 0);

    const places = (y) => [300, 400, 500].map((x) => [x, y]);
    await finger.down(...places(300).slice(0, 1));
    await finger.down(...places(300).slice(0, 2));
    await finger.down(...places(300));
    for (let step = 1; step <= 8; step += 1) await finger.move(...places(300 - 8 * step));
    await finger.up();
    await settled(page);
    assert.ok(Math.abs((await camera(page)).pitch - near.pitch) > 5, "tilted");
    assert.equal(await scrolled(page), 0);

    // A tap still queries the point, and a double tap zooms.
    const picked = ask(page, (map) => new Promise((resolve) => map.addEventListener("pick", () => resolve(true), { once: true })));
    await finger.down([400, 350]);
    await finger.up();
    assert.ok(await picked);
    const there = await camera(page);
    await page.waitForTimeout(600);
    for (let tap = 0; tap < 2; tap += 1) {
      await finger.down([400, 350]);
      await finger.up();
      await page.waitForTimeout(60);
    }
    await settled(page);
    assert.ok((await camera(page)).distance < 0.7 * there.distance);
    checkFaults(page);
    await page.end();
  });

  test("cooperative: what two fingers do is kept from the browser, what one does is not", async () => {
    for (const [gestures, kept] of [
      ["cooperative", [false, true]],
      ["greedy", [false, false]],
    ]) {
      const page = await longPage(browser, server, { gestures }, { hasTouch: true, isMobile: true });
      const isKept = await ask(page, (map) => {
        const target = map.shadowRoot.querySelector("canvas");
        const touch = (identifier) => new Touch({ identifier, target, clientX: 100 * identifier, clientY: 200 });
        return [[touch(1)], [touch(1), touch(2)]].map(
          (touches) => !target.dispatchEvent(new TouchEvent("touchmove", { cancelable: true, touches, targetTouches: touches })),
        );
      });
      assert.deepEqual(isKept, kept, gestures);
      const action = await page.locator("corniche-map canvas").evaluate((canvas) => getComputedStyle(canvas).touchAction);
      assert.equal(action, gestures === "greedy" ? "none" : "pan-x pan-y");
      await page.end();
    }
  });

  test("greedy, as without the attribute: the wheel and one finger move the map", async () => {
    const page = await longPage(browser, server, { gestures: "greedy" }, { hasTouch: true, isMobile: true });
    const before = await camera(page);
    const finger = await touches(page);
    await finger.down([400, 400]);
    for (let step = 1; step <= 8; step += 1) await finger.move([400, 400 - 20 * step]);
    await finger.up();
    await settled(page);
    assert.ok(moved(await camera(page), before) > 1e-4);
    assert.equal(await scrolled(page), 0);
    assert.ok(!(await isHinted(page)));
    await page.end();
  });

  test("a cooperative map that fills the screen is greedy", async () => {
    const page = await longPage(browser, server, { gestures: "cooperative" });
    for (const of of ["map", "parent"]) {
      const isFull = await ask(
        page,
        async (map, of) => {
          await (of === "map" ? map : map.parentElement).requestFullscreen();
          return document.fullscreenElement !== null;
        },
        of,
      );
      assert.ok(isFull);
      await page.waitForTimeout(300);
      await settled(page);
      const before = await camera(page);
      await page.mouse.move(300, 200);
      await wheel(page, -200);
      assert.ok((await camera(page)).distance < 0.9 * before.distance, of);
      assert.ok(!(await isHinted(page)));
      await page.evaluate(() => document.exitFullscreen());
      await page.waitForTimeout(300);
      await settled(page);
      const after = await camera(page);
      await page.mouse.move(300, 300);
      await wheel(page, 60);
      assert.equal((await camera(page)).distance, after.distance, "and cooperative again");
      await page.evaluate(() => scrollTo(0, 0));
    }
    await page.end();
  });

  test("the help tells the gestures that there are", async () => {
    const page = await longPage(browser, server, { gestures: "cooperative", controls: "" });
    const said = () => page.locator("corniche-map dialog dt:visible").allTextContents();
    await page.locator("corniche-map canvas").focus();
    await page.keyboard.press("?");
    assert.ok((await said()).includes("Three fingers") && !(await said()).includes("One finger"), String(await said()));
    await ask(page, (map) => map.setAttribute("gestures", "greedy"));
    assert.ok(!(await said()).includes("Three fingers") && (await said()).includes("One finger"));
    await page.end();
  });

  const screens = [
    ["desktop", { width: 1000, height: 600 }],
    ["phone", { width: 360, height: 640, hasTouch: true, isMobile: true, deviceScaleFactor: 2 }],
  ];
  for (const [screen, options] of someOf(screens, 2)) {
    test(`pictures: the hint, ${screen}`, async () => {
      for (const colorScheme of ["light", "dark"]) {
        const page = await longPage(browser, server, { gestures: "cooperative", controls: "" }, { ...options, colorScheme });
        if (screen === "desktop") {
          await page.mouse.move(400, 300);
          await page.mouse.wheel(0, 60);
        } else {
          const finger = await touches(page);
          await finger.down([200, 350]);
          for (let step = 1; step <= 5; step += 1) await finger.move([200, 350 - 10 * step]);
          await finger.up();
        }
        await shownHint(page).waitFor();
        await page.waitForTimeout(300);
        const [width, most] = await hint(page).evaluate((element) => [element.firstChild.getBoundingClientRect().width, element.clientWidth]);
        assert.ok(width < most, "it fits");
        await page.screenshot({ path: path.join(pictures, `hint-${screen}-${colorScheme}.png`) });
        await page.end();
      }
    });
  }
}
