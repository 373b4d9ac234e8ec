// What a reader must see in a report: a fibre that is drawn and moves, or a web on its light table; every figure, also of a
// spinline; and no script errors.
// Started by `check`, which says where Chromium and playwright-core are.

import { createRequire } from "node:module";
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { parseArgs } from "node:util";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(join(process.env.PACKAGES, "package.json"))("playwright-core");

const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    "without-turbulence": { type: "boolean" },
    web: { type: "boolean" },
    spin: { type: "boolean" },
    screenshots: { type: "string" },
  },
});
const report = pathToFileURL(resolve(positionals[0])).href;
const OF_RUN = ["end_node_history", "end_node_path", "amplitude_along_fibre", "motion_spectrum", "energy_errors"];
if (!options["without-turbulence"]) OF_RUN.push("turbulence_spectrum");
const OF_WEB = ["cv", "histogram", "profiles", "clouds", "spectrum", "autocorrelation", "directions"].map((n) => `web_${n}`);
const OF_SPINLINE = ["speed_and_diameter", "temperature", "tension_and_stress", "strain_rate", "influences"].map((n) => `spinline_${n}`);
const FIGURES = options.spin ? OF_SPINLINE : options.web ? OF_WEB : OF_RUN;
// The captions of the moving fibre show a running clock.
const CANVAS = options.web ? { id: "table", top: 0 } : { id: "fibre", top: 110 };

const failures = [];
const expect = (holds, message) => {
  if (!holds) failures.push(message);
};

const browser = await chromium.launchPersistentContext(process.env.PROFILE, {
  executablePath: process.env.CHROMIUM,
  headless: false, // the flag below asks for the new headless mode
  args: [
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
  ],
  viewport: { width: 1280, height: 900 },
});

await browser.grantPermissions(["clipboard-read", "clipboard-write"]);

/** Everything the page says is wrong, and everything it asks the network for. */
function listen(page, where) {
  page.on("pageerror", (error) => failures.push(`${where}: script error: ${error.message}`));
  page.on("console", (message) => {
    if (message.type() === "error") failures.push(`${where}: console error: ${message.text()}`);
  });
  page.on("request", (request) => {
    if (!/^(file|data|blob|about):/.test(request.url())) failures.push(`${where}: asks for ${request.url()}`);
  });
}

/**
 * What is on the canvas below its captions: a fingerprint of the pixels, the share that is not background, the
 * number of colours.
 */
function pixels(page) {
  return page.evaluate((of) => {
    const canvas = document.querySelector(`canvas#${of.id}`);
    if (!canvas || !canvas.width || !canvas.height) return null;
    const top = Math.round((of.top * canvas.width) / canvas.clientWidth);
    const { data } = canvas.getContext("2d").getImageData(0, top, canvas.width, canvas.height - top);
    const counts = new Map();
    let hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      const colour = (data[i] << 24) | (data[i + 1] << 16) | (data[i + 2] << 8) | data[i + 3];
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
      hash = (Math.imul(hash, 31) + colour) | 0;
    }
    const total = data.length / 4;
    return { hash, drawn: 1 - Math.max(...counts.values()) / total, colours: counts.size };
  }, CANVAS);
}

async function changes(page, act) {
  const before = await pixels(page);
  await act();
  for (let i = 0; i < 20; i++) {
    await page.waitForTimeout(100);
    if ((await pixels(page))?.hash !== before?.hash) return true;
  }
  return false;
}

/** The fibre moves when it is played, and turns when it is dragged. */
async function checkMotion(page, where, shot) {
  await page.locator("#fibre").scrollIntoViewIfNeeded();
  const button = page.locator("#play");
  if ((await button.getAttribute("aria-pressed")) === "true") await button.click();
  await page.waitForTimeout(200);
  const still = await pixels(page);
  await page.waitForTimeout(400);
  expect((await pixels(page)).hash === still.hash, `${where}: the picture moves while it is paused`);
  expect(await changes(page, () => button.click()), `${where}: the picture does not change while it plays`);
  await shot("playing", false);
  await button.click();

  const box = await page.locator("#fibre").boundingBox();
  const turned = await changes(page, async () => {
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 40, { steps: 4 });
    await page.mouse.up();
  });
  expect(turned, `${where}: dragging does not turn the picture`);
  await shot("turned", false);
  await page.locator("#fibre").focus();
  expect(await changes(page, () => page.keyboard.press("ArrowLeft")), `${where}: the arrow keys do not turn the picture`);
}

/** The light table shows single fibres, can be moved, and goes back to the whole web. */
async function checkTable(page, where, shot) {
  const canvas = page.locator("#table");
  await canvas.scrollIntoViewIfNeeded();
  for (const id of ["fibres", "farther", "whole", "closer"]) {
    expect(await changes(page, () => page.locator(`#${id}`).click()), `${where}: the button ${id} does nothing`);
    await shot(id, false);
  }
  const box = await canvas.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const dragged = await changes(page, async () => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 40, { steps: 4 });
    await page.mouse.up();
  });
  expect(dragged, `${where}: dragging does not move the web`);
  expect(await changes(page, () => page.mouse.wheel(0, -300)), `${where}: the wheel does not zoom`);
  await canvas.focus();
  expect(await changes(page, () => page.keyboard.press("ArrowLeft")), `${where}: the arrow keys do not move the web`);
}

/** The paragraph of methods is there, and its button copies all of it. */
async function checkMethods(page, where, shot) {
  const text = await page.locator("#methods-text").innerText();
  expect(/spunlaid \d/.test(text) && /The spunlaid authors/.test(text), `${where}: the methods do not name the program: ${text}`);
  const button = page.locator('[data-copy="methods-text"]');
  await button.scrollIntoViewIfNeeded();
  await shot("methods", false);
  await button.click();
  await page.waitForFunction((b) => b.textContent !== "Copy", await button.elementHandle());
  const copied = (await button.innerText()) === "Copied" ? await page.evaluate(() => navigator.clipboard.readText()) : await page.evaluate(() => `${getSelection()}`);
  expect(copied.trim() === text.trim(), `${where}: copied is not what the methods say: ${copied}`);
}

async function check(scheme, width) {
  const where = `${scheme}, ${width} px`;
  const page = await browser.newPage();
  listen(page, where);
  await page.emulateMedia({ colorScheme: scheme });
  await page.setViewportSize({ width, height: 900 });
  await page.goto(report, { waitUntil: "load" });
  await page.waitForTimeout(500);
  const shot = async (name, full) => {
    if (!options.screenshots) return;
    mkdirSync(options.screenshots, { recursive: true });
    await page.screenshot({ path: join(options.screenshots, `${scheme}-${width}-${name}.png`), fullPage: full });
  };
  await shot("page", true);

  if (!options.spin) {
    const drawn = await pixels(page);
    expect(drawn !== null, `${where}: there is no canvas`);
    if (drawn === null) return page.close();
    expect(drawn.drawn > 0.002 && drawn.colours > 3, `${where}: the canvas is empty (${JSON.stringify(drawn)})`);
    await (options.web ? checkTable : checkMotion)(page, where, shot);
  }

  for (const name of FIGURES) {
    const svg = page.locator(`figure[data-name="${name}"] svg`);
    if ((await svg.count()) !== 1) {
      failures.push(`${where}: the figure ${name} is missing`);
      continue;
    }
    const size = await svg.boundingBox();
    expect(size && size.width > 200 && size.height > 150, `${where}: the figure ${name} has no size`);
    expect((await svg.locator("path, circle").count()) > 10, `${where}: the figure ${name} is empty`);
    expect(!/NaN|Infinity/.test(await svg.innerHTML()), `${where}: the figure ${name} holds numbers that are none`);
  }
  const [table, file] = options.web ? ["#verdict", "#file code"] : options.spin ? ["#results", "#file pre"] : ["#results", "#case-toml"];
  expect((await page.locator(`${table} tbody tr`).count()) >= 5, `${where}: the table of results is missing`);
  expect((await page.locator(file).innerText()).trim() !== "", `${where}: the case is missing`);
  await checkMethods(page, where, shot);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(overflow <= 1, `${where}: the page is ${overflow} px wider than the window`);
  await page.close();
}

try {
  await check("light", 1280);
  await check("dark", 1280);
  await check("light", 390);
} catch (error) {
  failures.push(`the check itself: ${error.message}`);
} finally {
  await browser.close();
}
if (failures.length > 0) {
  console.error(`${positionals[0]}:\n${failures.map((f) => `  ${f}`).join("\n")}`);
  process.exit(1);
}
const seen = options.spin ? "the spinline is shown" : options.web ? "the web lies on its table" : "the fibre is drawn and moves";
console.log(`${positionals[0]}: ${seen}, ${FIGURES.length} figures, no script errors`);
