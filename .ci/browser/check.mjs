// What a reader must see in a report: a fibre that is drawn and moves, a web on its light table, or webs beside each other; every figure,
// also of a spinline; every number of every table, also on a phone; and no script errors.
// Started by `check`, which says where Chromium and playwright-core are.

import { createRequire } from "node:module";
import { mkdirSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { parseArgs } from "node:util";
import { pathToFileURL } from "node:url";
import { violations } from "./axe.mjs";

const { chromium } = createRequire(join(process.env.PACKAGES, "package.json"))("playwright-core");

const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    "without-turbulence": { type: "boolean" },
    web: { type: "boolean" },
    spin: { type: "boolean" },
    compare: { type: "boolean" },
    page: { type: "boolean" },
    screenshots: { type: "string" },
  },
});
const report = pathToFileURL(resolve(positionals[0])).href;
const OF_RUN = ["end_node_history", "end_node_path", "amplitude_along_fibre", "motion_spectrum", "energy_errors"];
if (!options["without-turbulence"]) OF_RUN.push("turbulence_spectrum");
const OF_WEB = ["cv", "histogram", "profiles", "clouds", "spectrum", "autocorrelation", "directions"].map((n) => `web_${n}`);
const OF_SPINLINE = ["speed_and_diameter", "temperature", "tension_and_stress", "strain_rate", "influences"].map((n) => `spinline_${n}`);
const OF_COMPARISON = ["web_cv", "web_spectrum"];
const FIGURES = options.compare ? OF_COMPARISON : options.spin ? OF_SPINLINE : options.web ? OF_WEB : OF_RUN;
/** What is drawn where the light table shows no web. */
const BARE_TABLE = [0xe9, 0xe5, 0xd8];
// The captions of the moving fibre show a running clock.
const CANVAS = options.web ? { id: "table", top: 0 } : { id: "fibre", top: 110 };

const failures = [];
const expect = (holds, message) => {
  if (!holds) failures.push(message);
};

const LAUNCH = {
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
};
const browser = await chromium.launchPersistentContext(process.env.PROFILE, { ...LAUNCH, hasTouch: true });

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

/** How much of the light table shows no web. */
function bareShare(page) {
  return page.evaluate((bare) => {
    const canvas = document.querySelector("canvas#table");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (bare.every((part, k) => data[i + k] === part)) count++;
    return (4 * count) / data.length;
  }, BARE_TABLE);
}

/** Two fingers on the light table, from some distance apart to another [px]. */
async function pinch(page, [x, y], from, to) {
  const client = await page.context().newCDPSession(page);
  const touch = (type, apart) =>
    client.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: apart === null ? [] : [{ x: x - apart / 2, y, id: 0 }, { x: x + apart / 2, y, id: 1 }],
    });
  await touch("touchStart", from);
  for (let step = 1; step <= 5; step++) await touch("touchMove", from + ((to - from) * step) / 5);
  await touch("touchEnd", null);
  await client.detach();
}

/** What chance alone makes is drawn as high as the web, and a picture of both can be saved, wider than they are on the page. */
async function checkSaved(page, where) {
  const chance = await page.locator("#chance").evaluate((one) => {
    const { data } = one.getContext("2d").getImageData(0, 0, one.width, one.height);
    return { colours: new Set(data.filter((_, i) => i % 4 === 0)).size, height: one.clientHeight, table: document.getElementById("table").clientHeight };
  });
  expect(chance.colours > 3 && Math.abs(chance.height - chance.table) <= 1, `${where}: no picture of chance beside the web (${JSON.stringify(chance)})`);
  const [saved] = await Promise.all([page.waitForEvent("download"), page.locator("#save").click()]);
  const file = readFileSync(await saved.path());
  const both = await page.locator(".panes").boundingBox();
  const [width, height] = [file.readUInt32BE(16), file.readUInt32BE(20)];
  expect(saved.suggestedFilename().endsWith(".png") && width > 2 * both.width && height > both.height, `${where}: the saved picture is ${width} × ${height} px`);
}

/** The light table is full of web, shows single fibres, can be moved, and goes back to the whole web; its words are those of the web. */
async function checkTable(page, where, shot) {
  const canvas = page.locator("#table");
  await canvas.scrollIntoViewIfNeeded();
  const bare = await bareShare(page);
  expect(bare < 0.005, `${where}: the web leaves ${(100 * bare).toFixed(1)} % of its frame empty`);
  const words = await page.locator("figure.view").innerText();
  const shownWidth = Number(/is ([\d,.]+) mm wide/.exec(words)?.[1].replace(/,/g, ""));
  const width = await page.evaluate(() => JSON.parse(document.getElementById("web-data").textContent).width);
  expect(Math.abs(shownWidth / width - 1) < 0.01, `${where}: the web is ${width} mm wide, and the page shows ${shownWidth} mm`);
  for (const id of ["fibres", "farther", "whole", "closer"]) {
    expect(await changes(page, () => page.locator(`#${id}`).click()), `${where}: the button ${id} does nothing`);
    await shot(id, false);
  }
  await checkSaved(page, where);
  const box = await canvas.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const drag = async (right, down) => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + right, y + down, { steps: 4 });
    await page.mouse.up();
  };
  expect(await changes(page, () => drag(60, 40)), `${where}: dragging does not move the web`);
  expect(await changes(page, () => page.mouse.wheel(0, -300)), `${where}: the wheel does not zoom`);
  expect(await changes(page, () => pinch(page, [x, y], 60, 120)), `${where}: two fingers do not zoom`);
  await canvas.focus();
  expect(await changes(page, () => page.keyboard.press("ArrowLeft")), `${where}: the arrow keys do not move the web`);
  for (let i = 0; i < 12; i++) await drag(box.width / 2 - 5, box.height / 2 - 5);
  await page.waitForTimeout(200);
  expect((await bareShare(page)) < 0.005, `${where}: dragging moves the web out of its frame`);
  await shot("corner", false);
  expect(await changes(page, () => page.keyboard.press("0")), `${where}: the key 0 does not show the whole web`);
  // Every kind of mark that is offered is drawn, and the thinnest places are shown.
  const boxes = page.locator("#marks label:visible input[type=checkbox]");
  for (let i = 0; i < (await boxes.count()); i++) {
    expect(await changes(page, () => boxes.nth(i).click()), `${where}: mark ${i + 1} of the light table does nothing`);
    await boxes.nth(i).click();
  }
  expect((await page.locator("#thumbs button").count()) > 0, `${where}: the thinnest places are not shown`);
  expect(await changes(page, () => page.locator("#thumbs button").first().click()), `${where}: a thinnest place is not shown`);
  await shot("thinnest", false);
  expect((await page.locator("figure.view").innerText()) === words, `${where}: words of the light table change with the view`);
}

/** The answers stand on the first screen, before anything that is folded, and each command has a button that copies it. */
async function checkAnswers(page, where) {
  const cards = await page.locator(".card").evaluateAll((all) => all.map((one) => [one.id, one.getBoundingClientRect().top + scrollY]));
  const ids = cards.map(([id]) => id);
  for (const id of ["web", "scale", "change", "line", "buyer", "measure"]) expect(ids.includes(id), `${where}: the answer ${id} is missing`);
  const below = cards.filter(([, top]) => top > 900).map(([id]) => id);
  expect(innerWidthOf(where) < 1000 || below.length === 0, `${where}: ${below} are below the first screen`);
  const [change, table] = [await page.locator("#change").boundingBox(), await page.locator("#table").boundingBox()];
  const isFirst = change.x > table.x + table.width && change.y < 200 && change.y + change.height < 800;
  expect(innerWidthOf(where) < 1000 || isFirst, `${where}: what to change first does not stand at the top right (${JSON.stringify(change)})`);
  expect(innerWidthOf(where) < 1000 || table.width >= 500, `${where}: the picture is ${table.width} px wide`);
  const folded = await page.locator("details.fold").evaluateAll((all) => all.map((one) => [one.open, one.querySelector("summary span").textContent]));
  expect(folded.length >= 4 && folded.every(([open]) => !open), `${where}: what is folded is open`);
  expect(folded.every(([, contents]) => contents.trim() !== ""), `${where}: a fold does not say what is in it`);
  for (const button of await page.locator(".card [data-command]").all()) {
    await button.click();
    await page.waitForFunction((one) => one.textContent === "Copied", await button.elementHandle());
    const [copied, command] = [await page.evaluate(() => navigator.clipboard.readText()), await button.getAttribute("data-command")];
    expect(copied === command && command.includes(" --out "), `${where}: copied is ${copied} and not ${command}`);
  }
}

const innerWidthOf = (where) => Number(/(\d+) px/.exec(where)[1]);

/** On paper the web keeps its shape, and all that is folded is open. */
async function checkPaper(page, where) {
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  const image = await page.locator("#sheet").evaluate((one) => {
    const { width, height } = one.getBoundingClientRect();
    return [width / height, one.naturalWidth / one.naturalHeight];
  });
  expect(Math.abs(image[0] / image[1] - 1) < 0.01, `${where}: on paper the web has the shape ${image[0]}, and it is ${image[1]}`);
  expect((await page.locator("details:not([open])").count()) === 0, `${where}: on paper something is folded`);
  await page.emulateMedia({ media: "screen" });
}

/** The pictures of all webs have one size, on the screen and in pixels, so one scale. */
async function checkPictures(page, where) {
  const sizes = await page.locator(".beside img").evaluateAll((pictures) =>
    pictures.map((one) => {
      const { width, height } = one.getBoundingClientRect();
      return [Math.round(width), Math.round(height), one.naturalWidth, one.naturalHeight];
    }),
  );
  expect(sizes.length >= 2 && sizes[0][0] > 100, `${where}: there are no two pictures (${JSON.stringify(sizes)})`);
  if (sizes.length === 0) return;
  expect(sizes.every((size) => `${size}` === `${sizes[0]}`), `${where}: the pictures have different scales (${JSON.stringify(sizes)})`);
  const [width, height, columns, rows] = sizes[0];
  expect(Math.abs((width * rows) / (height * columns) - 1) < 0.02, `${where}: the pictures are stretched (${sizes[0]})`);
  const bars = await page.locator(".beside .bar").evaluateAll((bars) => bars.map((bar) => Math.round(bar.getBoundingClientRect().width)));
  expect(bars.length === sizes.length && bars.every((bar) => bar === bars[0] && bar > 20), `${where}: the scales differ (${bars})`);
}

/** Every number of every table can be seen: in the window, or by scrolling in a frame that says so. On a wide screen its shadows say it. */
async function checkTables(page, where) {
  const hidden = await page.evaluate(() => {
    document.querySelectorAll("details").forEach((details) => (details.open = true));
    const cut = [];
    for (const cell of document.querySelectorAll("main td, main tbody th")) {
      const frame = cell.closest(".points");
      const shadows = innerWidth > 640 && cell.closest(".wide") && getComputedStyle(cell.closest(".wide")).overflowX === "auto";
      const says = shadows || frame?.previousElementSibling?.textContent.includes("Scroll inside the table");
      const { left, right, width } = cell.getBoundingClientRect();
      const room = (cell.closest(".wide") ?? document.body).getBoundingClientRect();
      const isCut = width > 0 && (left < room.left - 1 || right > room.right + 1);
      if (cell.textContent.trim() !== "" && !says && isCut) cut.push(cell.textContent.trim());
    }
    return cut;
  });
  expect(hidden.length === 0, `${where}: ${hidden.length} cells of tables are cut off: ${hidden.slice(0, 3).join("; ")}`);
}

/** Without scripts the web is a picture, and nothing stands there that does nothing. */
async function checkWithoutScripts() {
  const plain = await chromium.launchPersistentContext(`${process.env.PROFILE}-plain`, { ...LAUNCH, javaScriptEnabled: false });
  const page = await plain.newPage();
  await page.goto(report, { waitUntil: "load" });
  const [picture, frame] = [await page.locator("#sheet").boundingBox(), await page.locator("figure.view").boundingBox()];
  expect(picture && picture.width > frame.width - 4 && picture.height > 50, "without scripts: there is no picture of the web");
  expect((await page.locator("button:visible").count()) === 0, "without scripts: there are buttons that do nothing");
  await plain.close();
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
  for (const violation of await violations(page)) failures.push(`${where}: ${violation}`);

  if (options.web) await checkAnswers(page, where);
  await checkTables(page, where);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(overflow <= 1, `${where}: the page is ${overflow} px wider than the window`);
  if (options.compare) await checkPictures(page, where);
  if (options.web) await checkPaper(page, where);
  if (!options.spin && !options.compare && !options.page) {
    const drawn = await pixels(page);
    expect(drawn !== null, `${where}: there is no canvas`);
    if (drawn === null) return page.close();
    expect(drawn.drawn > 0.002 && drawn.colours > 3, `${where}: the canvas is empty (${JSON.stringify(drawn)})`);
    await (options.web ? checkTable : checkMotion)(page, where, shot);
  }

  const figures = options.page ? await page.locator("figure.chart").evaluateAll((all) => all.map((one) => one.dataset.name)) : FIGURES;
  for (const name of figures) {
    const svg = page.locator(`figure[data-name="${name}"] svg`);
    if ((await svg.count()) !== 1) {
      failures.push(`${where}: the figure ${name} is missing`);
      continue;
    }
    const size = await svg.boundingBox();
    const [height, marks] = options.page ? [60, 2] : [150, 10];
    expect(size && size.width > 200 && size.height > height, `${where}: the figure ${name} has no size`);
    expect((await svg.locator("path, circle").count()) > marks, `${where}: the figure ${name} is empty`);
    expect(!/NaN|Infinity/.test(await svg.innerHTML()), `${where}: the figure ${name} holds numbers that are none`);
  }
  if (options.compare) {
    expect((await page.locator("table tbody tr").count()) >= 5, `${where}: the table of differences is missing`);
    return page.close();
  }
  if (options.page) {
    expect((await page.locator("main section").count()) >= 2, `${where}: the page is empty`);
    return page.close();
  }
  const [table, file] = options.web ? ["#verdict", "#file code"] : options.spin ? ["#results", "#file pre"] : ["#results", "#case-toml"];
  expect((await page.locator(`${table} tbody tr`).count()) >= 5, `${where}: the table of results is missing`);
  expect((await page.locator(file).innerText()).trim() !== "", `${where}: the case is missing`);
  await checkMethods(page, where, shot);
  await page.close();
}

try {
  await check("light", 1280);
  await check("dark", 1280);
  await check("light", 390);
  await check("dark", 390);
  if (options.web) await checkWithoutScripts();
} catch (error) {
  failures.push(`the check itself: ${error.stack}`);
} finally {
  await browser.close();
}
if (failures.length > 0) {
  console.error(`${positionals[0]}:\n${failures.map((f) => `  ${f}`).join("\n")}`);
  process.exit(1);
}
const seen = options.page ? "the page is whole" : options.compare ? "the webs lie beside each other" : options.spin ? "the spinline is shown" : options.web ? "the web lies on its table" : "the fibre is drawn and moves";
console.log(`${positionals[0]}: ${seen}, ${options.page ? "all" : FIGURES.length} figures, no script errors`);
