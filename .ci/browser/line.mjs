// What a person must see on the page of `spunlaid live line.toml`: a web that grows, a knob that changes it, a change
// that becomes significant or stays grey, and a file that gives the numbers of the page.

import { execFileSync } from "node:child_process";
import { copyFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { violations } from "./axe.mjs";

/** A line whose web takes seconds. */
const LINE = join(dirname(fileURLToPath(import.meta.url)), "../../crates/spunlaid-cli/tests/live/line.toml");
/** The knob that is turned by hand. */
const KNOB = "slot_gap";

const knobOf = (page, part) => page.locator(`[data-knob="${KNOB}"] ${part}`);
const isReady = (what) => (page, ms = 180000) => page.waitForFunction(what, null, { timeout: ms });
const isKnown = isReady(() => spunlaidLive.judged?.before?.is_complete);
const isChanged = isReady(() => spunlaidLive.judged?.change && spunlaidLive.state.now !== spunlaidLive.state.pinned);
const isComplete = isReady(() => spunlaidLive.judged?.now?.is_complete && spunlaidLive.judged.of === spunlaidLive.state.generation);

/** Whether a page is seen, as its browser says. */
const show = (page, visible) =>
  page.evaluate((visible) => {
    for (const [name, value] of [["visibilityState", visible ? "visible" : "hidden"], ["hidden", !visible]]) {
      Object.defineProperty(document, name, { value, configurable: true });
    }
    document.dispatchEvent(new Event("visibilitychange", { bubbles: true }));
  }, visible);

/** Keeps all headlines and whether a number has ever gone. */
const watchNumbers = (page) =>
  page.evaluate(() => {
    window.headlines = new Set();
    new MutationObserver(() => window.headlines.add(document.getElementById("headline").textContent)).observe(
      document.getElementById("headline"),
      { childList: true, characterData: true, subtree: true },
    );
  });

/** Keeps for each value that is sent how long its slider has been at rest [ms]. */
const watchSlider = (page) =>
  knobOf(page, "input[type=range]").evaluate((slider) => {
    let moved = 0;
    window.rests = [];
    slider.addEventListener("input", () => (moved = performance.now()));
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
      if (JSON.parse(text).do === "set") window.rests.push(performance.now() - moved);
      send.call(this, text);
    };
  });

/** A thumb that is held is not moved and sends nothing until it rests; then the change comes, and the picture follows. */
async function turnByHand(page, { expect, print, wait }) {
  await watchSlider(page);
  const slider = knobOf(page, "input[type=range]");
  const box = await slider.boundingBox();
  const picture = await print(page, "belt");
  const value = Number(await slider.inputValue());
  const at = (share) => page.mouse.move(box.x + 8 + share * (box.width - 16), box.y + box.height / 2);
  await at(value / 400);
  await page.mouse.down();
  for (let i = 1; i <= 12; i++) {
    await at(value / 400 + 0.015 * i);
    await wait(30);
  }
  await page.waitForFunction(() => spunlaidLive.state.now !== spunlaidLive.state.pinned && window.rests.length > 0);
  const held = await slider.inputValue();
  await wait(500);
  expect((await slider.inputValue()) === held, "the program has moved a thumb that is held");
  const rests = await page.evaluate(() => window.rests);
  expect(rests.every((ms) => ms > 140), `values are sent ${rests.map(Math.round)} ms after the thumb moved`);
  await page.mouse.up();
  await isChanged(page);
  const sent = await page.evaluate(() => window.rests.length);
  expect(sent === rests.length, "the release of a thumb at rest sends its value again");
  expect((await print(page, "belt")) !== picture, "the picture does not change with the knob");
  const change = await page.locator("#change").innerText();
  const isChange = /^[+−]?[\d.]+\s±\s[\d.]+\s% against before(, not significant)?$/.test(change);
  expect(isChange, `the headline says of the change: ${change}`);
}

/** The plant's numbers follow a thumb that moves, at most ten times a second and before anything is simulated. */
async function followThumb(page, { expect, wait }) {
  const slider = page.locator('[data-knob="throughput"] input[type=range]');
  const plant = () => page.locator("#plant").innerText();
  const [before, sent] = [await plant(), await page.evaluate(() => spunlaidLive.seen.sent.length)];
  await page.evaluate(() => {
    window.asked = 0;
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (text) {
      if (JSON.parse(text).do === "preview") window.asked += 1;
      send.call(this, text);
    };
  });
  // In the page itself, where no pause is longer than meant: a thumb that rests sends its value.
  const took = await slider.evaluate(async (thumb) => {
    const began = performance.now();
    thumb.dispatchEvent(new PointerEvent("pointerdown"));
    for (let i = 1; i <= 25; i++) {
      thumb.value = 200 + 4 * i;
      thumb.dispatchEvent(new Event("input"));
      await new Promise((done) => setTimeout(done, 40));
    }
    [window.moved, window.sent] = [document.getElementById("plant").innerText, spunlaidLive.seen.sent.length];
    thumb.dispatchEvent(new KeyboardEvent("keydown", { key: "Escape", bubbles: true }));
    return performance.now() - began;
  });
  const { moved, asked, sent: sentNow } = await page.evaluate(() => ({ moved: window.moved, asked: window.asked, sent: window.sent }));
  const most = 1 + took / 100;
  expect(moved !== before, "the numbers of the plant do not follow a thumb that moves");
  expect(asked > 1 && asked <= most, `${asked} numbers of the plant are asked for, of ${most.toFixed(1)}`);
  expect(sentNow === sent, "a thumb that moves sends its value");
  await wait(300);
  expect((await plant()) === before, "Escape does not bring the numbers of the plant back");
  await page.evaluate(() => dispatchEvent(new Event("pointerup")));
}

/** The change is found again in other turbulence, with its own error, next to the first one. */
async function confirmChange(page, { expect, shot }) {
  const first = await page.locator("#change").innerText();
  await page.locator("#confirm").click();
  await page.waitForFunction(() => spunlaidLive.state.confirmation?.is_done, null, { timeout: 180000 });
  const text = await page.locator("#confirmed").innerText();
  expect(/[+−]?[\d.]+\s±\s[\d.]+\s% in other turbulence/.test(text), `the headline says of other turbulence: ${text}`);
  expect((await page.locator("#change").innerText()) === first, "a confirmation changes the change");
  const columns = await page.locator("#patches tr").first().locator("th, td").count();
  expect(columns === 5, `the table has ${columns} columns with a confirmation`);
  await shot(page, "line-confirmed");
}

/** The filament of the line flies on a tab, and its sliders do something. */
async function openTab(page, { expect, shot, wait }) {
  await page.getByRole("link", { name: "Fibre" }).click();
  await page.waitForFunction(() => window.spunlaidLive?.frame && spunlaidLive.state);
  const slider = page.locator('input[type=range][data-key="feed.speed"]');
  const speed = await page.evaluate(() => spunlaidLive.state.belt.feed);
  await slider.focus();
  for (let i = 0; i < 5; i++) await page.keyboard.press("ArrowRight");
  await page.waitForFunction((speed) => spunlaidLive.state.belt.feed > speed, speed);
  expect(await page.locator("#refused").isHidden(), `the page of the filament refuses its feed speed: ${await page.locator("#refused").innerText()}`);
  await wait(1500);
  for (const violation of await violations(page)) expect(false, `the tab of the fibre: ${violation}`);
  await shot(page, "line-fibre");
  await page.getByRole("link", { name: "Web" }).click();
  await page.waitForFunction(() => window.spunlaidLive?.judged?.before);
}

/** A value that is not possible turns red with its reason; Escape takes it back, and only it. */
async function refuse(page, { expect, isRed, wait }) {
  const box = knobOf(page, ".top input");
  const [before, now] = [await box.inputValue(), await page.evaluate(() => spunlaidLive.state.now)];
  await box.fill("10 g");
  await box.press("Enter");
  const beside = knobOf(page, ".wrong");
  await beside.waitFor();
  expect((await isRed(box, "borderTopColor")) && (await isRed(beside, "color")), "a knob that is refused is not red");
  await box.press("Escape");
  await wait(200);
  expect((await box.inputValue()) === before && (await beside.isHidden()), "Escape does not take a refused value back");
  expect((await page.evaluate(() => spunlaidLive.state.now)) === now, "Escape on a refused value resets the line");
}

/** The saved line, laid by the program, has the numbers of the page. */
async function save(page, { expect, program, folder }) {
  await page.locator("#name").fill("turned.toml");
  await page.locator("#save").click();
  await page.waitForFunction(() => document.getElementById("saved").textContent.includes("turned.toml"));
  const run = ["web", "turned.toml", "--json", "--no-advice", "--quiet"];
  const { web } = JSON.parse(execFileSync(program, run, { cwd: folder, maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] }));
  const shown = await page.evaluate(() => [...spunlaidLive.patches.values()].map(({ side, now }) => [side, now?.cv, now?.standard_error]));
  const known = shown.filter(([, cv]) => cv !== undefined);
  expect(known.length > 1, `the page knows the CV of ${known.length} patches only`);
  for (const [side, cv, error] of known) {
    const patch = web.patches.find(({ patch_m: other }) => Math.abs(other / side - 1) < 1e-6);
    const same = patch?.cv === cv && (patch.cv_total_error ?? patch.cv_standard_error) === error;
    expect(same, `over ${1e3 * side} mm the page says ${cv} ± ${error}, the saved line ${JSON.stringify(patch)}`);
  }
  return known.length;
}

/** Escape resets, Ctrl+Z brings the answer back. */
async function undo(page, { expect, wait }) {
  const now = await page.evaluate(() => spunlaidLive.state.now);
  await page.locator("#belt").focus();
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => spunlaidLive.state.now === spunlaidLive.state.pinned);
  await wait(200);
  expect((await page.locator("#change").innerText()) === "", "after a reset there is a change");
  await page.locator(`#answers [data-to="${now}"]`).click();
  await page.waitForFunction((number) => spunlaidLive.state.now === number, now);
  await page.keyboard.press("Control+z");
  await page.waitForFunction((number) => spunlaidLive.state.now !== number, now);
}

/** While no page can be seen nothing is computed; a page that is seen again goes on. */
async function hide(page, other, { expect, live, computed, wait }) {
  await show(other, false);
  const slider = knobOf(page, "input[type=range]");
  await slider.focus();
  // A small web may be complete before the page is hidden.
  let hasGoneOn = false;
  for (let tries = 0; tries < 8 && !hasGoneOn; tries++) {
    for (let i = 0; i < 8; i++) await page.keyboard.press("ArrowLeft");
    await page.waitForFunction(() => spunlaidLive.state.work !== null, null, { polling: 10, timeout: 5000 }).catch(() => null);
    await show(page, false);
    await wait(1500);
    const drawn = await page.evaluate(() => spunlaidLive.seen.drawn);
    const before = computed(live.pid);
    await wait(2000);
    const used = computed(live.pid) - before;
    expect(used < 0.1, `while no page can be seen, ${used.toFixed(2)} s are computed in 2 s`);
    expect((await page.evaluate(() => spunlaidLive.seen.drawn)) === drawn, "a hidden page draws");
    await show(page, true);
    await wait(2000);
    hasGoneOn = computed(live.pid) > before + 0.2;
  }
  expect(hasGoneOn, "work does not go on once the page is seen again");
}

/** Another page shows the same line, and says which knob was turned here. */
async function twoPages(page, other, { expect }) {
  const box = knobOf(page, ".top input");
  const label = await knobOf(page, "label").innerText();
  await box.fill("12 mm");
  await box.press("Enter");
  await other.waitForFunction(() => !document.getElementById("note").hidden);
  const note = await other.locator("#note-text").innerText();
  expect(note.toLowerCase().includes(label.toLowerCase()) && note.includes("12 mm"), `the other page says: ${note}`);
  expect(await page.locator("#note").isHidden(), "a page speaks of its own knob as of another page's");
}

/** Where the program has ended, the page says so, and its numbers stay. */
async function alone(page, { expect }) {
  const headline = await page.locator("#headline").innerText();
  await page.waitForFunction(() => document.getElementById("note-text").textContent.includes("does not answer"));
  expect((await page.locator("#headline").innerText()) === headline, "without the program the headline changes");
}

async function looks(page, other, phone, { expect }) {
  for (const [seen, where] of [[page, "1280 px"], [other, "dark"], [phone, "400 px"]]) {
    for (const violation of await violations(seen)) expect(false, `${where}: ${violation}`);
    const beyond = await seen.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    expect(beyond <= 0, `${where}: the page is ${beyond} px wider than its window`);
  }
  const below = await page.evaluate(() => document.documentElement.scrollHeight - innerHeight);
  expect(below <= 0, `at 1280 × 800 the page is ${below} px longer than its window`);
  await phone.evaluate(() => scrollTo(0, 600));
  const top = await phone.locator("#headline").evaluate((e) => e.getBoundingClientRect().top);
  expect(top >= 0 && top < 60, "on a phone the headline does not stay on top");
}

/** `tools` are those of `live.mjs`. */
export async function checkLine(browser, tools) {
  const { expect, start, open, print, shot, wait, folder } = tools;
  copyFileSync(LINE, join(folder, "line.toml"));
  const began = performance.now();
  const { live, address } = await start(join(folder, "line.toml"));
  const page = await open(browser, address, { height: 800 });
  await watchNumbers(page);
  const first = await print(page, "belt");
  await isReady(() => spunlaidLive.judged?.before)(page);
  const seconds = ((performance.now() - began) / 1000).toFixed(1);
  expect((await print(page, "belt")) !== first, "nothing comes down on the belt");
  await isKnown(page);
  await turnByHand(page, tools);
  await shot(page, "line-sketch");
  for (const violation of await violations(page)) expect(false, `with a change: ${violation}`);
  const answer = await page.locator("h1").innerText();
  await refuse(page, tools);
  await followThumb(page, tools);
  await confirmChange(page, tools);
  await isComplete(page);
  await shot(page, "line-complete");
  const patches = await save(page, tools);
  const headlines = await page.evaluate(() => [...window.headlines]);
  expect(headlines.every((text) => /^CV [\d.]+( ± [\d.]+)? % over/.test(text)), `a number flickers: ${headlines.join("; ")}`);
  const whole = await print(page, "belt");
  await page.locator("#split").click();
  await wait(300);
  expect((await print(page, "belt")) !== whole, "before does not come beside it");
  const [slide] = await Promise.all([page.waitForEvent("download"), page.locator("#picture").click()]);
  expect(slide.suggestedFilename().endsWith(".png"), `the picture is ${slide.suggestedFilename()}`);
  await undo(page, tools);
  await openTab(page, tools);

  const other = await open(browser, address, { scheme: "dark", height: 800, alone: true });
  const phone = await open(browser, address, { width: 400 });
  await wait(500);
  await looks(page, other, phone, tools);
  await shot(other, "line-dark");
  await shot(phone, "line-phone");
  await phone.close();
  await wait(3100);
  await twoPages(page, other, tools);
  await hide(page, other, { ...tools, live });
  await page.close();
  await show(other, true);
  await isKnown(other);
  live.kill();
  await alone(other, tools);
  await other.close();
  return [`a line: first number after ${seconds} s, ${answer.replace(/\s+/g, " ")}; ${patches} numbers as those of the saved file`];
}
