// The page of a line: state, numbers, answers, file.

const SIDE = 0.01;
const STAGES = ["before", "sketch", "complete"];

const page = { state: null, knobs: [], patches: new Map(), settling: [], since: 0, isTurned: false };
const connection = { open: false };
const asked = { at: -Infinity };
/** The plant's numbers at the value of a slider that moves: nothing is simulated for them. */
const preview = { timer: null, at: -Infinity, stamp: 0, from: 1, plant: null, generation: -1 };
/** Time between two of them [ms]. */
const PREVIEW = 100;
/** For checks: how it goes. */
const seen = { frames: 0, sent: [], errors: [] };

const belt = new Belt(byId("belt"));
const knobs = new Knobs(byId("knobs"), byId("groups"), (name, value) => {
  ask();
  note("");
  seen.sent.push([name, value]);
  clearTimeout(preview.timer);
  return link.set(name, value);
}, moves);

/** Asks for the plant's numbers while a slider moves; none if its value does not count. */
function moves(key, value) {
  clearTimeout(preview.timer);
  if (key === undefined) {
    [preview.from, preview.plant] = [preview.stamp + 1, null];
    if (page.state) showPlant(page.state.plant);
    return;
  }
  preview.timer = setTimeout(() => {
    preview.at = performance.now();
    preview.stamp += 1;
    link.ask({ do: "preview", key, value, stamp: preview.stamp });
  }, Math.max(0, preview.at + PREVIEW - performance.now()));
}

/** Remembers that what changes next was asked for here; sends a message. */
function ask(message) {
  asked.at = performance.now();
  if (message) link.ask(message);
}

const link = new Link({
  open() {
    connection.open = true;
    document.body.classList.remove("offline");
    note("");
    status();
  },
  closed() {
    connection.open = false;
    document.body.classList.add("offline");
    knobs.forget();
    offline();
  },
  knobs({ title, knobs: all }) {
    const moved = knobs.take(all);
    page.knobs = all;
    say("title", title);
    document.title = `${title} – spunlaid live`;
    // What another page has turned; what moves along with one's own knob is no news.
    if (moved.length > 0 && performance.now() - asked.at > 3000) {
      note(`Another page has changed ${moved.map((k) => `${k.label} to ${knobs.written(k, k.value)}`).join(", ")}.`);
    }
    const first = knobs.first();
    byId("first").hidden = !first;
    if (!first) return;
    const { label, effect } = first.knob;
    say("first", `Change first: ${label} ${stepText(effect, -Math.sign(effect.change))}`);
  },
  state,
  found,
  frame(frame) {
    seen.frames += 1;
    // Of a web that is no more looked at; the map of before stays.
    const isOld = frame.generation < (page.state?.generation ?? 0);
    if (isOld && (frame.kind === 0 || frame.layer === 1)) return;
    belt.take(frame, page.state?.work?.stage === "sketch");
  },
  applied: ({ stamp }) => knobs.applied(stamp),
  preview({ stamp, generation, plant }) {
    // Of a line that has been changed since, or of which flights have to find the tension first.
    if (stamp < preview.from || generation < page.state?.generation || plant.length === 0) return;
    [preview.plant, preview.generation] = [plant, generation];
    showPlant(plant);
  },
  refused({ about, problems }) {
    const why = problems.map(({ text }) => text).join(" ");
    // Of a value that is only passed nothing is said.
    if (about.is === "preview" || (about.is === "setting" && knobs.refuse(about.stamp, why))) return;
    if (about.is === "name") saved(why, true);
    else note(why);
  },
  saved: ({ name }) => saved(`saved as ${name}`, false),
  exists({ name }) {
    if (confirm(`${name} already exists. Replace it?`)) link.ask({ do: "save", name, replace: true });
  },
}, readLineFrame);

/** A note over the belt; none for an empty text. */
function note(text) {
  byId("note").hidden = !text;
  byId("note-text").textContent = text;
}

function saved(text, wrong) {
  byId("saved").textContent = text;
  byId("saved").classList.toggle("wrong", wrong);
  byId("name").setAttribute("aria-invalid", String(wrong));
}

async function offline() {
  const moved = await hasMoved();
  if (connection.open) return;
  note(
    moved
      ? "The program was started again and has another address. Open the new address that it has printed."
      : "The program does not answer; the page keeps trying. The numbers are the last ones received.",
  );
  status();
}

/** Text of an element, changed only where it differs: a screen reader speaks what is new. */
function say(id, text) {
  if (byId(id).textContent !== text) byId(id).textContent = text;
}

const shownLast = new Map();

/** Whether something differs from what was shown at a place last: nothing is made again that stays. */
function isNews(place, ...what) {
  const text = JSON.stringify(what);
  const differs = shownLast.get(place) !== text;
  shownLast.set(place, text);
  return differs;
}

function state(message) {
  const last = page.state;
  page.state = message;
  if (last && message.generation < last.generation) restart();
  if (last && message.pinned !== last.pinned) pinned();
  page.isTurned = message.now !== message.pinned;
  if (!page.isTurned) for (const patch of page.patches.values()) forgetNow(patch);
  if (!last || message.generation !== last.generation) {
    [page.settling.old, page.since] = [true, performance.now()];
    belt.clearNow(message.generation);
  }
  say("command", message.command);
  if (!last || (byId("name").value === last.save_name)) byId("name").value = message.save_name;
  say("play", message.stands ? "Go" : "Pause");
  byId("play").setAttribute("aria-pressed", String(!message.stands));
  const isNew = message.trouble && message.trouble !== last?.trouble;
  if (isNew) note(message.trouble);
  if (message.generation > preview.generation) preview.plant = null;
  showPlant(preview.plant ?? message.plant);
  showAnswers(message.answers);
  showNotes(message.notes);
  showWork(message.work);
  showNumbers();
  showConfirm(message);
  status();
}

/** The program was started again, and its generations begin at zero. */
function restart() {
  page.patches.clear();
  page.settling = [];
  [preview.plant, preview.generation] = [null, -1];
  [belt.before, belt.now] = [new Laid(), new Laid()];
}

/** Nothing is known of a web that is the one before. */
const forgetNow = (patch) => (patch.now = patch.change = patch.confirmed = null);

/** What is now has become what was before. */
function pinned() {
  for (const patch of page.patches.values()) {
    if (patch.now) patch.before = patch.now;
    forgetNow(patch);
  }
  page.settling = [];
  belt.pin();
}

function found(message) {
  if (!page.state || message.generation < page.state.generation) return;
  for (const patch of message.patches) {
    const kept = page.patches.get(patch.side_m) ?? { side: patch.side_m };
    if (patch.before) kept.before = patch.before;
    // A number gives way to a newer one only.
    if (patch.now) [kept.now, kept.of] = [patch.now, message.generation];
    if (patch.change) [kept.change, kept.changeOf] = [patch.change, message.generation];
    // What was found in other turbulence belongs to one setting only.
    kept.confirmed = patch.confirmed;
    page.patches.set(patch.side_m, kept);
  }
  const shown = judged();
  const number = shown && (page.isTurned ? shown.of === message.generation && shown.now : shown.before);
  const isNew = page.settling.old || JSON.stringify(number) !== page.settling.last;
  if (number && isNew) {
    if (page.settling.old) page.settling = [];
    page.settling.push({ at: (performance.now() - page.since) / 1000, ...number });
    page.settling.last = JSON.stringify(number);
  }
  showNumbers();
  showConfirm(page.state);
  status();
  drawSettling();
}

/** The patches of the headline: those nearest 10 mm. */
function judged() {
  const off = ({ side }) => Math.abs(Math.log(side / SIDE));
  return [...page.patches.values()].reduce((best, patch) => (!best || off(patch) < off(best) ? patch : best), null);
}

/** A CV with its error, in per cent. */
function cvText({ cv, standard_error: error }) {
  const places = error > 0 ? Math.max(1, decimals(100 * error, 2)) : 1;
  return [(100 * cv).toFixed(places), error > 0 ? ` ± ${(100 * error).toFixed(places)}` : ""];
}

const changeText = (change) => changed({ change: change.value, standard_error: change.standard_error });
const verdict = (change) => (!change.is_sure ? "unsure" : change.value < 0 ? "better" : "worse");

function showNumbers() {
  const best = judged();
  if (!best) return;
  const { generation } = page.state;
  headline(best, generation);
  if (!isNews("numbers", [...page.patches.values()], generation)) return;
  document.querySelector(".of-confirmed").hidden = !best.confirmed;
  document.querySelector(".cvs").classList.toggle("has-confirmed", Boolean(best.confirmed));
  const rows = [...page.patches.values()].sort((a, b) => a.side - b.side);
  byId("patches").replaceChildren(
    ...rows.map((patch) => {
      const row = element("tr", { className: patch === best ? "judged" : "" });
      row.append(element("th", { scope: "row", textContent: `${plain(1e3 * patch.side, 3)} mm` }));
      row.append(numberCell(patch.before, false), numberCell(patch.now, patch.of !== generation));
      row.append(changeCell(patch.change, patch.changeOf !== generation));
      if (best.confirmed) row.append(changeCell(patch.confirmed, false));
      return row;
    }),
  );
}

function numberCell(number, isOld) {
  if (!number) return element("td", { textContent: "–" });
  const [value, error] = cvText(number);
  const cell = element("td", { textContent: value, className: isOld ? "old" : "" });
  cell.append(element("span", { textContent: error, className: "error" }));
  return cell;
}

function changeCell(change, isOld) {
  const className = !change ? "" : isOld ? "old" : verdict(change);
  return element("td", { textContent: change ? changeText(change).slice(0, -2) : "–", className });
}

function headline(best, generation) {
  const number = best.now ?? best.before;
  if (!number) return;
  say("headline", `CV ${cvText(number).join("")} % over ${plain(1e3 * best.side, 3)} mm`);
  byId("headline").className = best.now && best.of !== generation ? "old" : "";
  const { change } = best;
  const place = byId("change");
  const isOld = change && best.changeOf !== generation;
  const doubt = change?.is_sure || isOld ? "" : ", not significant";
  // After the last look there is none that could still come.
  const isDone = page.isTurned && !["before", "sketch"].includes(page.state.work?.stage);
  const none = isDone ? "change not known: the sample of filaments is too small" : "";
  say("change", change ? `${changeText(change)} against before${doubt}` : none);
  place.className = !change || isOld ? "old" : verdict(change);
  const { confirmed } = best;
  const unsure = confirmed?.is_sure ? "" : ", not significant";
  say("confirmed", confirmed ? `· ${changeText(confirmed)} in other turbulence${unsure}` : "");
  byId("confirmed").className = confirmed ? verdict(confirmed) : "old";
}

/** A change that has numbers can be confirmed, once. */
function showConfirm({ confirmation }) {
  const button = byId("confirm");
  const isKnown = page.isTurned && [...page.patches.values()].some((p) => p.change && p.changeOf === page.state.generation);
  button.hidden = !isKnown;
  button.disabled = Boolean(confirmation);
  const words = confirmation?.is_done ? "Simulated again with seed" : "Being simulated again with seed";
  say("confirm", confirmation ? `${words} ${confirmation.seed}` : "Confirm in other turbulence");
}

/** What is computed, how far it is, and what that means for the numbers. */
function showWork(work) {
  for (const item of byId("stages").children) {
    const order = STAGES.indexOf(item.dataset.stage);
    // Testing the effect of each setting when all is complete; a confirmation comes between sketch and complete, or after all.
    const isBetween = work?.stage === "confirm" && !judged()?.now?.is_complete;
    const at = isBetween ? 1.5 : STAGES.includes(work?.stage) ? STAGES.indexOf(work.stage) : STAGES.length;
    item.hidden = item.dataset.stage === "sketch" && !page.isTurned;
    const share = order < at ? 1 : order === at ? work.share : 0;
    item.querySelector("b").style.width = `${100 * share}%`;
    item.className = order === at ? "is-now" : "";
  }
  say("share", work ? `${Math.round(100 * work.share)} %` : "");
}

function status() {
  const { state: now } = page;
  if (!connection.open) return say("status", "No connection to the program.");
  if (!now) return say("status", "Connecting …");
  const best = judged();
  const isComplete = page.isTurned ? best?.now?.is_complete && best.of === now.generation : best?.before?.is_complete;
  const parts = [isComplete ? "Complete: spunlaid web gives bit-identical numbers for this line." : ""];
  if (now.stands) parts.push("Paused: press Go.");
  else if (now.work) parts.push(`${now.work.words}.`);
  if (now.price) parts.push(`This value ${now.price}.`);
  say("status", parts.filter(Boolean).join(" "));
}

function showPlant(plant) {
  if (!isNews("plant", plant)) return;
  byId("plant").replaceChildren(
    ...plant.map(({ label, now, was }) => {
      const isMoved = was !== null && now !== was;
      const place = element("div", { className: isMoved ? "moved" : "" });
      const value = element("dd", { textContent: now });
      // Where both have one unit it is written once.
      const unit = now.slice(now.indexOf(" "));
      const short = isMoved && was.endsWith(unit) ? was.slice(0, -unit.length) : was;
      if (isMoved) value.prepend(element("span", { className: "was", textContent: `${short} → ` }));
      place.append(element("dt", { textContent: capital(label) }), value);
      return place;
    }),
  );
}

function showAnswers(answers) {
  const place = byId("answers");
  byId("back").disabled = previous() === null;
  if (!isNews("answers", answers)) return;
  const focused = document.activeElement?.dataset.to;
  place.replaceChildren(
    ...answers.map((answer) => {
      const { number, label, is_complete: isComplete, is_now: isNow } = answer;
      const textContent = `${label} · ${isComplete ? "" : "about "}${cvText(answer).join("")} %`;
      const button = element("button", { type: "button", textContent });
      button.dataset.to = number;
      if (isNow) button.setAttribute("aria-current", "true");
      button.addEventListener("click", () => ask({ do: "back", to: number }));
      return button;
    }),
  );
  place.querySelector(`[data-to="${focused}"]`)?.focus();
  place.scrollLeft = place.scrollWidth;
}

/** The answer before the present one. */
function previous() {
  const { answers } = page.state ?? { answers: [] };
  const at = answers.findIndex((answer) => answer.is_now);
  const target = at < 0 ? answers.at(-1) : answers[at - 1];
  return target ? target.number : null;
}

function goBack() {
  const to = previous();
  if (to !== null) ask({ do: "back", to });
}

function showNotes(notes) {
  if (!isNews("notes", notes)) return;
  const place = byId("notes");
  place.hidden = notes.length === 0;
  place.firstElementChild.textContent = notes.length === 1 ? "One note" : `${notes.length} notes`;
  place.lastElementChild.replaceChildren(...notes.map((textContent) => element("li", { textContent })));
}

/** The number and its error over the seconds since the change. */
function drawSettling() {
  const canvas = byId("settling");
  const [ratio, width, height] = [devicePixelRatio || 1, canvas.clientWidth, canvas.clientHeight];
  const { settling } = page;
  if (!width || settling.length === 0 || document.hidden) return;
  [canvas.width, canvas.height] = [width * ratio, height * ratio];
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  const css = getComputedStyle(document.documentElement);
  const colour = (name) => css.getPropertyValue(`--${name}`).trim();
  const before = judged()?.before;
  const all = before ? [...settling, before] : settling;
  const band = ({ cv, standard_error: error }) => [100 * (cv - error), 100 * (cv + error)];
  let [low, high] = [Math.min(...all.map((n) => band(n)[0])), Math.max(...all.map((n) => band(n)[1]))];
  const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20].find((s) => (high - low) / s <= 4) ?? 50;
  [low, high] = [step * Math.floor(low / step), step * Math.ceil(high / step)];
  const end = Math.max(4, settling.at(-1).at);
  const [left, bottom] = [36, height - 18];
  const x = (at) => left + (width - left - 8) * Math.sqrt(at / end);
  const y = (value) => 6 + ((bottom - 6) * (high - value)) / (high - low || 1);
  pen.font = "11px system-ui, sans-serif";
  [pen.fillStyle, pen.strokeStyle] = [colour("muted"), colour("rule")];
  const line = (...points) => {
    pen.beginPath();
    points.forEach((point) => pen.lineTo(...point));
    pen.stroke();
  };
  for (let value = low; value <= high + 1e-9; value += step) {
    const hasRoom = bottom > 60 || value === low || value + step > high;
    if (hasRoom) pen.fillText(`${Number(value.toFixed(1))} %`, 0, y(value) + 4);
    line([left, y(value)], [width - 8, y(value)]);
  }
  let free = left - 8;
  for (const at of [0.5, 1, 2, 5, 10, 20, 60, 120, 300, 600, 1200].filter((at) => at <= end && x(at) < width - 30)) {
    if (x(at) - 8 < free) continue;
    pen.fillText(`${at} s`, x(at) - 8, height - 3);
    free = x(at) + 30;
  }
  pen.fillStyle = pen.strokeStyle = colour(settling.old ? "muted" : "accent");
  pen.globalAlpha = 0.22;
  pen.beginPath();
  settling.forEach((n) => pen.lineTo(x(n.at), y(band(n)[1])));
  [...settling].reverse().forEach((n) => pen.lineTo(x(n.at), y(band(n)[0])));
  pen.fill();
  pen.globalAlpha = 1;
  pen.lineWidth = 2;
  line(...settling.map((n) => [x(n.at), y(100 * n.cv)]));
  for (const n of settling) {
    pen.fillRect(x(n.at) - 2, y(100 * n.cv) - 2, 4, 4);
    pen.fillRect(x(n.at) - 0.5, y(band(n)[1]), 1, y(band(n)[0]) - y(band(n)[1]));
  }
  if (!before || !page.isTurned) return;
  pen.fillStyle = pen.strokeStyle = colour("trail");
  pen.setLineDash([5, 4]);
  pen.lineWidth = 1.5;
  line([left, y(100 * before.cv)], [width - 8, y(100 * before.cv)]);
  pen.setLineDash([]);
  pen.fillText("before", width - 46, Math.max(12, y(100 * before.cv) - 4));
}

/** The belt with its scale, the CV and the settings of the line, for a slide. */
function slide() {
  const canvas = element("canvas", { width: 1920, height: 1080 });
  const pen = canvas.getContext("2d");
  const { ink, muted, panel } = belt.colours;
  pen.fillStyle = panel;
  pen.fillRect(0, 0, 1920, 1080);
  pen.save();
  pen.translate(60, 60);
  pen.beginPath();
  pen.rect(0, 0, 900, 960);
  pen.clip();
  pen.scale(1.8, 1.8);
  if (belt.width > 0) belt.paint(pen, 500, 960 / 1.8);
  pen.restore();
  const write = (text, x, y, font, colour) => {
    [pen.font, pen.fillStyle] = [`${font} system-ui, sans-serif`, colour];
    pen.fillText(text, x, y, 1860 - x);
  };
  write(byId("headline").textContent, 1010, 120, "700 44px", ink);
  write(`${byId("change").textContent} ${byId("confirmed").textContent}`, 1010, 176, "600 34px", getComputedStyle(byId("change")).color);
  write(`${byId("title").textContent} · ${byId("status").textContent}`, 1010, 224, "24px", muted);
  const step = Math.min(52, 700 / Math.max(1, page.knobs.length));
  page.knobs.forEach((knob, i) => {
    const moved = knob.value !== knob.was;
    const weight = moved ? "700 " : "";
    write(knob.label, 1010, 290 + i * step, `${weight}${0.6 * step}px`, ink);
    const text = `${knobs.written(knob, knob.value)}${moved ? `, before ${knobs.written(knob, knob.was)}` : ""}`;
    write(text, 1440, 290 + i * step, `${weight}${0.6 * step}px`, ink);
  });
  write("spunlaid live", 1010, 1014, "22px", muted);
  canvas.toBlob((blob) => {
    const file = element("a", { href: URL.createObjectURL(blob), download: `${byId("title").textContent}_live.png` });
    file.click();
    setTimeout(() => URL.revokeObjectURL(file.href), 10000);
  });
}

byId("play").addEventListener("click", () => link.ask({ do: page.state?.stands ? "go" : "pause" }));
byId("split").addEventListener("click", () => {
  belt.split = !belt.split;
  belt.stale = true;
  byId("split").setAttribute("aria-pressed", String(belt.split));
});
byId("nearer").addEventListener("click", () => belt.zoom(1.5));
byId("further").addEventListener("click", () => belt.zoom(1 / 1.5));
byId("picture").addEventListener("click", slide);
byId("confirm").addEventListener("click", () => ask({ do: "confirm" }));
byId("pin").addEventListener("click", () => ask({ do: "pin" }));
byId("reset").addEventListener("click", () => ask({ do: "reset" }));
byId("back").addEventListener("click", goBack);
byId("first").addEventListener("click", () => knobs.turnFirst());
byId("note-close").addEventListener("click", () => note(""));
byId("save").addEventListener("click", () => {
  saved("", false);
  link.ask({ do: "save", name: byId("name").value, replace: false });
});
copies(byId("copy"), byId("command"));

addEventListener("keydown", (e) => {
  // Escape takes back what is not done yet; where there is nothing, all knobs go back to before.
  if (e.key === "Escape" && e.target !== byId("name") && !knobs.takeBack()) ask({ do: "reset" });
  const undoes = (e.ctrlKey || e.metaKey) && !e.shiftKey && e.key.toLowerCase() === "z";
  if (!undoes || e.target === byId("name") || knobs.isEdited(e.target)) return;
  e.preventDefault();
  goBack();
});

addEventListener("visibilitychange", drawSettling);
new ResizeObserver(drawSettling).observe(byId("settling"));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawSettling);

/** What lies on the belt. */
function onBelt() {
  const { newest, now, split } = belt;
  if (split && newest === now) return "before | now";
  if (newest.map) {
    const { columns, rows, pixel } = newest.map;
    return `complete, ${plain(1e3 * columns * pixel, 3)} × ${plain(1e3 * rows * pixel, 3)} mm`;
  }
  const area = newest.width * Math.max(newest.moved, 0);
  return area > 0 ? `${newest.ends.length} filaments, ${plain(area, 2)} m²` : "";
}

let last = 0;
function tick(now) {
  requestAnimationFrame(tick);
  // Twenty pictures a second: the belt is no film.
  if (document.hidden || now - last < 45) return;
  last = now;
  belt.tick(now);
  say("shown", onBelt());
}
requestAnimationFrame(tick);

addEventListener("error", (e) => seen.errors.push(String(e.message)));
window.spunlaidLive = {
  seen: Object.defineProperty(seen, "drawn", { get: () => belt.drawn }),
  belt,
  knobs,
  get state() { return page.state; },
  get patches() { return page.patches; },
  get judged() { return judged(); },
};
