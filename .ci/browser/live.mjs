// What a person must see on the page of `spunlaid live`: fibres that move, a slider that changes them, numbers that follow
// and agree with a run. Prints how fast it is and what it costs.
// Started by `check`, which says where Chromium and playwright-core are.

import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { violations } from "./axe.mjs";
import { checkLine } from "./line.mjs";

const { chromium } = createRequire(join(process.env.PACKAGES, "package.json"))("playwright-core");
const { values: options, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    /** How long the fibres fly as fast as they can, for the memory. */
    seconds: { type: "string", default: "10" },
    screenshots: { type: "string" },
  },
});
const program = resolve(positionals[0]);
const cases = join(dirname(fileURLToPath(import.meta.url)), "../../cases");
const folder = mkdtempSync(join(tmpdir(), "spunlaid-live-"));

const failures = [];
const expect = (holds, message) => {
  if (!holds) failures.push(message);
};
const wait = (ms) => new Promise((done) => setTimeout(done, ms));

/** Amplitudes in y of a run that flies as the page does, over 20 s and with other turbulence [mm]: mean, standard error. */
function ofRun(velocity) {
  const page = ["run.scheme=implicit-tension", "run.time_step=auto", "run.error_tolerance=0.012"];
  const set = [...page, "run.duration=20 s", "run.spin_up=0.5 s", `air.velocity=${velocity}`];
  const options = ["--replicates", "16", "--seed", "2", "--json", "--quiet"];
  const summary = JSON.parse(
    execFileSync(program, ["run", join(cases, "table1.toml"), ...set.flatMap((s) => ["--set", s]), ...options], {
      cwd: folder,
      maxBuffer: 1 << 28,
    }),
  );
  const { mean, standard_error: error } = summary.end_node.amplitude_y_m;
  return [1e3 * mean, 1e3 * error];
}

/** Starts the program with a case of `cases/` or of another folder; returns its process and the address of its page. */
async function start(name, ...more) {
  const live = spawn(program, ["live", resolve(cases, name), "--no-open", ...more], { cwd: folder });
  const address = await new Promise((found, lost) => {
    live.stdout.once("data", (text) => found(String(text).trim()));
    live.once("exit", (code) => lost(new Error(`spunlaid live ${name} ended with code ${code}`)));
  });
  return { live, address };
}

/** Computing time of a process so far [s]. */
function computed(pid) {
  const numbers = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(numbers[11]) + Number(numbers[12])) / 100;
}

/** Resident memory [MB]. */
const resident = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;

async function open(browser, address, { scheme = "light", width = 1280, height = 860, alone = false } = {}) {
  const where = `${scheme}, ${width} px`;
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: scheme });
  page.on("pageerror", (error) => failures.push(`${where}: script error: ${error.message}`));
  page.on("console", (message) => {
    // The browser itself complains where nobody answers.
    if (message.type() === "error" && !alone) failures.push(`${where}: console error: ${message.text()}`);
  });
  page.on("request", (request) => {
    const { protocol, host } = new URL(request.url());
    const own = host === new URL(address).host || ["data:", "blob:"].includes(protocol);
    expect(own, `${where}: asks for ${request.url()}`);
  });
  await page.goto(address, { waitUntil: "load" });
  await page.waitForFunction(() => window.spunlaidLive?.seen.drawn > 0);
  return page;
}

/** Moves a slider to a notch, as a hand does. */
const slide = (page, key, notch) =>
  page.locator(`input[type=range][data-key="${key}"]`).evaluate((slider, notch) => {
    slider.value = notch;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }, notch);

/** A fingerprint of a canvas. */
const print = (page, id) =>
  page.evaluate((id) => {
    const canvas = document.getElementById(id);
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.reduce((hash, byte) => (Math.imul(hash, 31) + byte) | 0, 7);
  }, id);

async function shot(page, name) {
  if (!options.screenshots) return;
  mkdirSync(options.screenshots, { recursive: true });
  await page.screenshot({ path: join(options.screenshots, `live-${name}.png`), fullPage: true });
}

/** Amplitude in y when it has been measured for a time: value, standard error [mm]. */
async function settled(page, seconds) {
  await page.waitForFunction((least) => window.spunlaidLive.measured?.duration >= least, seconds, { timeout: 0 });
  return page.evaluate(() => {
    const { value, error } = window.spunlaidLive.measured.numbers.find((n) => n.name === "amplitude_y");
    return [value, error];
  });
}

async function checkFixed(browser) {
  const { live, address } = await start("table1.toml");
  const page = await open(browser, address);
  const first = await print(page, "fibre");
  await wait(300);
  expect((await print(page, "fibre")) !== first, "the fibres do not move");

  // What it costs at real time.
  const [before, since, drawn] = [computed(live.pid), performance.now(), await page.evaluate(() => spunlaidLive.seen.drawn)];
  await wait(5000);
  const wall = (performance.now() - since) / 1000;
  const share = (computed(live.pid) - before) / wall;
  const rate = ((await page.evaluate(() => spunlaidLive.seen.drawn)) - drawn) / wall;
  const speed = await page.evaluate(() => spunlaidLive.frame.speed);

  // How soon the motion follows a slider.
  for (let i = 0; i < 20; i++) {
    await slide(page, "air.velocity", 167 + (i % 2));
    await wait(150);
  }
  const latency = await page.evaluate(() => [...spunlaidLive.seen.latency].sort((a, b) => a - b));
  expect(latency.length >= 15, `only ${latency.length} of 20 changes were answered`);

  // The amplitude follows the air.
  await page.locator("#pace").selectOption("free");
  const velocities = [[10, 167], [20, 333]];
  const lines = [];
  for (const [velocity, notch] of velocities) {
    await slide(page, "air.velocity", notch);
    await page.waitForFunction((v) => spunlaidLive.state.air === v && spunlaidLive.measured?.generation === spunlaidLive.state.generation, velocity);
    const [value, error] = await settled(page, 20);
    const [wanted, of] = ofRun(`${velocity} m/s`);
    const apart = Math.abs(value - wanted) / Math.hypot(error, of);
    lines.push(`${velocity} m/s: ${value.toFixed(2)} ± ${error.toFixed(2)} mm, a run ${wanted.toFixed(2)} ± ${of.toFixed(2)} mm`);
    expect(apart < 4, `the amplitude is ${apart.toFixed(1)} standard errors off, ${lines.at(-1)}`);
  }
  expect((await page.locator("#numbers .before").first().innerText()).startsWith("before: "), "the setting before is not shown");
  await shot(page, "light");

  // Memory at full speed: nothing grows once every list is full.
  const memory = [];
  for (let i = 0; i < Number(options.seconds); i++) {
    await wait(1000);
    memory.push(resident(live.pid));
  }
  const half = Math.floor(memory.length / 2);
  const growth = Math.max(...memory.slice(half)) - Math.max(...memory.slice(0, half));
  expect(growth < 4, `the memory grew by ${growth.toFixed(1)} MB within ${options.seconds} s`);

  // The keyboard, and a case that is wrong.
  await page.locator("#fibre").focus();
  await page.keyboard.press("Space");
  await page.waitForFunction(() => spunlaidLive.state.stands);
  const stood = await print(page, "fibre");
  await page.keyboard.press("ArrowLeft");
  await wait(300);
  expect((await print(page, "fibre")) !== stood, "the arrow keys do not turn the picture");
  const text = page.locator("#text");
  await text.fill((await text.inputValue()).replace('"1 m"', '"1 mouse"'));
  await page.locator("#fly").click();
  await page.locator("#problems li").first().waitFor();
  expect((await page.locator("#problems").innerText()).includes("line 5"), "a mistake is not shown at its line");
  await page.locator("#undo").click();

  // Phone and dark scheme: nothing is cut off.
  const phone = await open(browser, address, { scheme: "dark", width: 360 });
  await wait(500);
  const wide = await phone.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  expect(wide <= 1, `the page is ${wide} px wider than a phone`);
  const unnamed = await phone.evaluate(() =>
    [...document.querySelectorAll("input, select, button, textarea, canvas")]
      .filter((e) => !e.getAttribute("aria-label") && !e.getAttribute("aria-labelledby") && !e.labels?.length && !e.innerText?.trim())
      .filter((e) => !e.closest(".uplot"))
      .map((e) => e.outerHTML),
  );
  expect(unnamed.length === 0, `without a name for a screen reader: ${unnamed.join(", ")}`);
  await shot(phone, "phone");
  for (const seen of [page, phone]) for (const violation of await violations(seen)) failures.push(violation);
  await phone.close();
  await page.close();
  live.kill();
  const between = (q) => latency[Math.floor(q * (latency.length - 1))].toFixed(0);
  return [
    ...lines,
    `real time: ${(100 * share).toFixed(1)} % of a core at ${speed.toFixed(2)} × real time, ${rate.toFixed(0)} pictures a second`,
    `from the slider to changed motion: median ${between(0.5)} ms, nine of ten within ${between(0.9)} ms`,
    `memory as fast as possible: ${memory.at(-1).toFixed(1)} MB, grew by ${growth.toFixed(1)} MB in the second half of ${options.seconds} s`,
  ];
}

/** By keyboard alone: arrow keys move a slider notch by notch, a number beyond its range keeps the place, and no number ticks for a screen reader. */
async function checkKeyboard(browser) {
  const { live, address } = await start("table1.toml");
  const page = await open(browser, address);
  await page.evaluate(() => {
    window.spoken = 0;
    for (const place of document.querySelectorAll("output, [role=status], [role=alert], [aria-live]")) {
      new MutationObserver((changes) => (window.spoken += changes.length)).observe(place, { childList: true, characterData: true, subtree: true });
    }
  });
  await wait(3000);
  const spoken = await page.evaluate(() => window.spoken);
  expect(spoken < 3, `${spoken} changes are spoken in 3 s in which nothing happens`);
  const slider = page.locator('input[type=range][data-key="air.velocity"]');
  for (const first of [120, 500, 900]) {
    await slide(page, "air.velocity", first);
    await slider.focus();
    for (let i = 0; i < 10; i++) {
      await page.keyboard.press("ArrowRight");
    }
    await wait(600);
    const notch = Number(await slider.inputValue());
    expect(notch === first + 10, `ten arrow keys from notch ${first} lead to ${notch}`);
  }
  await page.locator("#settings details summary").first().click();
  const box = page.locator('input[data-key="air.velocity"]:not([type=range])');
  await box.fill("90 m/s");
  await box.press("Enter");
  await page.waitForFunction(() => spunlaidLive.state.air === 90);
  await wait(200);
  const focused = await page.evaluate(() => document.activeElement.dataset.key);
  expect(focused === "air.velocity", `after a number beyond the slider the focus is on ${focused}`);
  expect((await page.locator("#settings details[open]").count()) > 0, "a number beyond the slider closes what was open");
  await page.close();
  live.kill();
  return ["by keyboard: sliders, numbers beyond them, and quiet for a screen reader"];
}

/** A fed fibre lays its loops, and the spread settles. */
async function checkFed(browser) {
  const { live, address } = await start("spunbond.toml");
  const page = await open(browser, address);
  await page.locator("#pace").selectOption("free");
  await page.waitForFunction(() => window.spunlaidLive.measured?.duration >= 0.2, null, { timeout: 0 });
  const numbers = await page.evaluate(() => spunlaidLive.measured.numbers);
  const sigma = numbers.find((n) => n.name === "sigma_md");
  expect(sigma?.value > 1 && sigma.error > 0, `the spread is ${JSON.stringify(sigma)}`);
  const laid = await print(page, "trace");
  await wait(400);
  expect((await print(page, "trace")) !== laid, "the laid fibre does not move");
  expect((await page.evaluate(() => spunlaidLive.measured.footprint.counts.length)) > 100, "the footprint is empty");
  await shot(page, "fed");
  await page.close();
  live.kill();
  return [`a fed fibre: σ ${sigma?.value?.toFixed(1)} ± ${sigma?.error?.toFixed(1)} mm in machine direction`];
}

/** Whether an element is red: its border, or its text. */
const isRed = (place, property) =>
  place.evaluate((element, property) => {
    const [r, g, b] = getComputedStyle(element)[property].match(/\d+/g).map(Number);
    return r > 1.5 * g && r > 1.5 * b;
  }, property);

/** A fibre in the air of a record with a gust of 45 km/s, which no flight survives. */
function wildCase() {
  const velocity = (i) => (i >= 400 && i < 420 ? 1e5 : 10 + ((i * i) % 101) * 0.01);
  const rows = Array.from({ length: 2000 }, (_, i) => `${i * 1e-3},${velocity(i)}\n`);
  writeFileSync(join(folder, "gust.csv"), `time_s,u_m_s\n${rows.join("")}`);
  const fibre = "[fibre]\nlength='0.2 m'\ndiameter='50 µm'\ndensity='950 kg/m³'\nyoungs_modulus='2 GPa'\nelement_length='50 mm'\n";
  const air = "[air]\nrecord='gust.csv'\nvelocity='10 m/s'\nturbulence_intensity=450\nlength_scale='0.2 m'\n";
  writeFileSync(join(folder, "gust.toml"), `version=1\n${fibre}${air}[run]\nduration='50 ms'\ntime_step='20 µs'\n`);
  return join(folder, "gust.toml");
}

/** What goes wrong is said where it was done, with the way out. */
async function checkMistakes(browser) {
  const { live, address } = await start("table1.toml");
  let page = await open(browser, address);

  // A wrong unit: the box is red and keeps it, and the message stands beside it.
  const box = page.locator('input[data-key="air.velocity"]:not([type=range])');
  const before = await box.inputValue();
  await box.fill("10 g");
  await box.press("Tab");
  const beside = page.locator(".setting", { has: box }).locator(".wrong");
  await beside.waitFor();
  expect((await isRed(box, "borderTopColor")) && (await isRed(beside, "color")), "a box with a wrong unit and its message are not red");
  expect((await beside.innerText()).includes("m/s"), `the message does not say what is allowed: ${await beside.innerText()}`);
  await page.locator("#forget").click();
  await wait(300);
  expect((await box.inputValue()) === "10 g", "what was written has gone from the box");
  expect(await page.locator("#refused").isHidden(), "the message stands over the picture too");
  await shot(page, "wrong-unit");
  await box.press("Escape");
  expect((await box.inputValue()) === before && (await beside.isHidden()), "Escape does not bring the value back");
  await box.fill("12 m/s");
  await box.press("Enter");
  await page.waitForFunction(() => spunlaidLive.state.air === 12);

  // A name that leads elsewhere.
  await page.locator("#name").fill("../x.toml");
  await page.locator("#save").click();
  await page.waitForFunction(() => document.getElementById("saved").textContent !== "");
  const name = await page.locator("#saved").innerText();
  expect(/no \/ or \\/.test(name) && /letters, digits/.test(name), `a wrong name is not explained: ${name}`);
  expect(await isRed(page.locator("#saved"), "color"), "the message about a name is not red");
  await page.close();
  live.kill();

  // Fibres that are lost: the page says how to go on.
  const wild = await start(wildCase());
  page = await open(browser, wild.address);
  await page.locator("#pace").selectOption("free");
  await page.waitForFunction(() => spunlaidLive.state.stands && spunlaidLive.state.trouble);
  expect(/press Go/i.test(await page.locator("#status").innerText()), `after lost fibres: ${await page.locator("#status").innerText()}`);
  expect(/press Go/.test(await page.locator("#notes").innerText()), `after lost fibres: ${await page.locator("#notes").innerText()}`);
  expect((await page.locator("#play").innerText()) === "Go", "there is no button Go");
  await shot(page, "lost");
  await page.close();
  wild.live.kill();

  // A program that was started again has another address.
  const old = await start("table1.toml");
  page = await open(browser, old.address, { alone: true });
  const port = new URL(old.address).port;
  const says = (text) => page.waitForFunction((text) => document.getElementById("status").textContent.includes(text), text, { timeout: 20000 });
  const ended = new Promise((done) => old.live.once("exit", done));
  old.live.kill();
  await ended;
  await says("does not answer");
  const other = await start("table1.toml", "--port", port);
  await says("Open the new address");
  await shot(page, "restarted");
  await page.close();
  other.live.kill();
  return ["mistakes are reported where they are made, with the remedy"];
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  headless: false, // the flag below asks for the new headless mode
  args: ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars"],
});
let lines = [];
try {
  lines = await checkLine(browser, { program, folder, expect, start, open, print, shot, wait, computed, isRed });
  lines = [...lines, ...(await checkMistakes(browser)), ...(await checkKeyboard(browser)), ...(await checkFixed(browser)), ...(await checkFed(browser))];
} catch (error) {
  failures.push(`the check itself: ${error.stack}`);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
console.log(lines.map((line) => `  ${line}`).join("\n"));
if (failures.length > 0) {
  console.error(`spunlaid live:\n${failures.map((f) => `  ${f}`).join("\n")}`);
  process.exit(1);
}
console.log("spunlaid live: the fibres fly, and follow the sliders");
process.exit(0);
