// Puts the parts of the page together.

const page = { state: null, frame: null, drawn: null, numbers: null, measured: null, before: null, connected: false, moved: false, dirty: false };
/** For checks: how it goes. */
const seen = { frames: 0, drawn: 0, latency: [], errors: [] };

const view = new View(byId("fibre"));
const plots = new Plots(byId);
const controls = new Controls(byId("settings"), change);
// A slider that was let go where it was refused goes back.
controls.watch(() => byId("refused").hidden || controls.show(page.state.values));
const asked = new Map();

/** Asks for a change, remembers when and returns its stamp; `written` is whether it was written into a box. */
function change(key, value, written = false) {
  const stamp = link.set(key, value);
  asked.set(stamp, { at: performance.now(), generation: null, key, value, written });
  if (asked.size > 100) asked.delete(asked.keys().next().value);
  return stamp;
}

const link = new Link({
  open() {
    [page.connected, page.moved] = [true, false];
    controls.answered();
    status();
  },
  closed() {
    page.connected = false;
    page.frame = null;
    status();
    findAddress();
  },
  settings: ({ settings }) => controls.build(settings),
  state,
  measured,
  frame(frame) {
    seen.frames += 1;
    view.take(frame);
    plots.take(frame);
    page.frame = frame;
  },
  applied({ stamp, generation }) {
    const change = asked.get(stamp);
    controls.answered(stamp);
    if (change) {
      change.generation = generation;
      controls.accept(change.key);
    }
    forgive();
  },
  refused({ about, problems: all }) {
    const written = about.is === "setting" ? asked.get(about.stamp) : null;
    if (written) {
      asked.delete(about.stamp);
      controls.answered(about.stamp);
      if (!controls.held) controls.show(page.state.values);
    }
    if (written?.written) return controls.refuse(written.key, written.value, all.map(({ text }) => text).join(" "));
    if (about.is === "name") return saved(all.map(({ text }) => text).join(" "), true);
    refusal(all);
    edited(byId("text").value !== page.state?.text);
    problems(all);
  },
  saved({ name }) {
    saved(`saved as ${name}`, false);
  },
  exists({ name }) {
    if (confirm(`${name} already exists. Replace it?`)) link.ask({ do: "save", name, replace: true });
  },
}, readFrame);

/** What became of a name under which the case was to be saved. */
function saved(text, wrong) {
  byId("saved").textContent = text;
  byId("saved").classList.toggle("wrong", wrong);
  byId("name").setAttribute("aria-invalid", String(wrong));
}

async function findAddress() {
  page.moved = await hasMoved();
  status();
}

/** The case and its settings, as they are now. */
function state(message) {
  const other = page.state?.generation !== message.generation;
  const fed = Boolean(message.belt);
  if (Boolean(page.state?.belt) !== fed || !page.state) {
    document.querySelectorAll(".of-fixed").forEach((e) => (e.hidden = fed));
    document.querySelectorAll(".of-fed").forEach((e) => (e.hidden = !fed));
    byId("settling-title").textContent = `Convergence of ${fed ? "σ" : "the amplitude"}, ± one standard error`;
    page.before = null;
  }
  if (other) {
    keepBefore();
    // The program begins its time anew, or has been started again.
    if (page.frame && message.generation < page.state?.generation) page.before = null;
  }
  page.state = message;
  view.state = message;
  plots.cutoff = message.cutoff;
  controls.show(message.values);
  byId("title").textContent = `· ${message.title}`;
  document.title = `${message.title} – spunlaid live`;
  byId("command").textContent = message.command;
  byId("pace").value = message.pace;
  byId("step").title = `Advance by one recorded instant (${message.instant})`;
  const play = byId("play");
  play.textContent = message.stands ? "Go" : "Pause";
  play.setAttribute("aria-pressed", String(!message.stands));
  const notes = [...(message.trouble ? [`The simulation failed: ${message.trouble}. The fibres are straight again and the time is stopped. Change the setting that caused this, then press Go.`] : []), ...message.notes];
  byId("remark").textContent = message.remark ? `${message.remark[0].toUpperCase()}${message.remark.slice(1)}.` : "";
  byId("filament").hidden = message.filament.length === 0;
  byId("filament").replaceChildren(...message.filament.map(sentence));
  byId("notes").hidden = notes.length === 0;
  byId("notes").replaceChildren(...notes.map((note) => element("li", { textContent: note })));
  if (!page.dirty) editor(message.text);
  status();
}

/** An entry of a list that begins with a capital and ends with a full stop. */
function sentence(text) {
  const textContent = `${text[0].toUpperCase()}${text.slice(1)}${text.endsWith(".") ? "" : "."}`;
  return element("li", { textContent });
}

/** Keeps the numbers and curves of the setting that ends, if they had been taken for a while. */
function keepBefore() {
  const { measured } = page;
  const least = page.state?.belt ? 0.05 : 0.5;
  if (measured && measured.duration >= least) {
    page.before = new Map(measured.numbers.map((n) => [n.name, n]));
    plots.keep();
  }
  page.measured = null;
  plots.clear();
  if (page.state?.belt) view.laid.clear();
}

const shown = (value, digits) => (value == null ? "–" : Number(value.toPrecision(digits)).toString().replace("-", "−"));

/** A value and its error, with the digits that the error allows. */
function withError({ value, error, unit: of }) {
  const unit = of === "m^-0.5" ? "1/√m" : of;
  if (value == null) return "–";
  if (!(error > 0)) return `${shown(value, 3)} ${unit}`;
  const decimals = Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(error))));
  return `${value.toFixed(decimals)} ± ${error.toFixed(decimals)} ${unit}`;
}

function measured(message) {
  if (!page.state || message.generation !== page.state.generation) return;
  page.measured = message;
  const since = byId("since");
  since.textContent =
    message.settling > 0
      ? `The fibres are settling: another ${message.settling.toFixed(2)} s are left out.`
      : `${message.duration.toFixed(2)} s of eight fibres.`;
  const list = byId("numbers");
  if (list.children.length !== message.numbers.length) {
    list.replaceChildren(
      ...message.numbers.map(({ label, meaning }) => {
        const card = element("div", { title: meaning });
        card.append(element("dt", { textContent: label }), element("dd", { className: "now" }), element("dd", { className: "before" }));
        return card;
      }),
    );
  }
  message.numbers.forEach((number, i) => {
    const [, now, old] = list.children[i].children;
    now.textContent = withError(number);
    const last = page.before?.get(number.name);
    old.textContent = last ? `before: ${withError(last)}` : "";
  });
  plots.measured(message, page.before);
}

function status() {
  const { state, frame, connected } = page;
  const line = byId("status");
  line.classList.toggle("trouble", !connected || Boolean(frame?.behind) || Boolean(state?.trouble));
  let [text, pace] = [line.textContent, ""];
  if (!connected) {
    text = page.moved
      ? "The program was started again and has another address. Open the new address that it has printed."
      : "The program does not answer. It may have ended; the page keeps trying. If you have started it again, open the new address that it has printed.";
  } else if (!state) {
    text = "Connecting …";
  } else if (state.stands && state.trouble) {
    text = "Paused, because the simulation failed. Press Go to continue.";
  } else if (state.stands) {
    text = `Paused. Steps of ${state.step}, ${state.scheme}.`;
  } else if (frame) {
    const speed = shown(frame.speed, 2);
    text = `Eight fibres, steps of ${state.step}, ${state.scheme}.`;
    pace = frame.behind ? `${speed} of real time: this computer is too slow for this pace.` : `${speed} × real time.`;
  }
  // A screen reader speaks what is new in this line; the pace, which always changes, stands beside it.
  if (line.textContent !== text) line.textContent = text;
  byId("pace-now").textContent = pace;
}

// The case as text

/** Shows a text with the numbers of its lines, those with problems marked. */
function editor(text, wrong = new Map()) {
  const area = byId("text");
  if (text !== null && area.value !== text) area.value = text;
  const lines = byId("lines");
  lines.replaceChildren(
    ...area.value.split("\n").map((_, i) => {
      const number = i + 1;
      if (!wrong.has(number)) return element("span", { textContent: `${number}\n` });
      return element("span", { textContent: `▸ ${number}\n`, className: "wrong", title: wrong.get(number) });
    }),
  );
  lines.scrollTop = area.scrollTop;
}

function problems(all) {
  const list = byId("problems");
  list.hidden = all.length === 0;
  list.replaceChildren(
    ...all.map(({ line, text }) => {
      const item = element("li");
      if (line) {
        const go = element("button", { type: "button", textContent: `line ${line}` });
        go.addEventListener("click", () => mark(line));
        item.append(go);
      }
      item.append(text);
      return item;
    }),
  );
  byId("text").setAttribute("aria-invalid", String(all.length > 0));
  editor(null, new Map(all.filter((p) => p.line).map((p) => [p.line, p.text])));
}

/** Says beside the sliders what cannot be done; what flies stays. */
function refusal(all) {
  const box = byId("refused");
  box.hidden = all.length === 0;
  const lines = all.map(({ text }) => element("p", { textContent: text }));
  const kept = element("p", { textContent: "The previous setting stays in effect." });
  box.replaceChildren(...lines, kept);
}

/** Takes back what was said of a case or a value that could not be simulated. */
function forgive() {
  problems([]);
  refusal([]);
}

/** Marks a line of the case. */
function mark(line) {
  const area = byId("text");
  const lines = area.value.split("\n");
  const start = lines.slice(0, line - 1).reduce((sum, l) => sum + l.length + 1, 0);
  area.focus();
  area.setSelectionRange(start, start + lines[line - 1].length);
}

function edited(dirty) {
  page.dirty = dirty;
  byId("fly").disabled = byId("undo").disabled = !dirty;
}

byId("text").addEventListener("input", () => {
  edited(byId("text").value !== page.state?.text);
  editor(null);
});
byId("text").addEventListener("scroll", () => (byId("lines").scrollTop = byId("text").scrollTop));
byId("fly").addEventListener("click", () => {
  edited(false);
  forgive();
  link.ask({ do: "case", text: byId("text").value });
});
byId("undo").addEventListener("click", () => {
  edited(false);
  forgive();
  editor(page.state.text);
});
byId("save").addEventListener("click", () => {
  saved("", false);
  link.ask({ do: "save", name: byId("name").value, replace: false });
});
copies(byId("copy"), byId("command"));

// Time

const play = () => link.ask({ do: page.state?.stands ? "go" : "pause" });
const step = () => link.ask({ do: "step" });
byId("play").addEventListener("click", play);
byId("step").addEventListener("click", step);
byId("pace").addEventListener("change", (e) => link.ask({ do: "pace", pace: e.target.value }));
byId("reset").addEventListener("click", () => link.ask({ do: "reset" }));
byId("forget").addEventListener("click", () => link.ask({ do: "forget" }));
byId("seed").addEventListener("click", () => {
  const now = page.state?.values.find((v) => v.key === "run.seed");
  change("run.seed", (Number(now?.si) || 0) + 1);
});

let stale = false;
view.listen({ play, step, changed: () => (stale = true) });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  view.scene.readColours();
  plots.redraw();
  stale = true;
});

/** Those who want less motion get a picture a second. */
const still = matchMedia("(prefers-reduced-motion: reduce)");
let last = 0;
let counted = { at: performance.now(), drawn: 0, rate: 0 };

function tick(now) {
  requestAnimationFrame(tick);
  const { frame } = page;
  if (!frame || (frame === page.drawn && !stale)) return;
  if (still.matches && frame !== page.drawn && !frame.stands && now - last < 1000) return;
  last = now;
  const isNew = frame !== page.drawn;
  stale = false;
  view.draw(frame);
  if (isNew) {
    seen.drawn += 1;
    counted.drawn += 1;
    for (const [stamp, change] of asked) {
      if (change.generation === null || frame.generation < change.generation) continue;
      seen.latency.push(performance.now() - change.at);
      asked.delete(stamp);
    }
    // Curves every second frame: the eye does not follow them faster.
    if (seen.drawn % 2 === 0 || frame.stands) plots.drawMoving(frame, view.laid);
    byId("clock").textContent = `t = ${frame.time.toFixed(3)} s`;
  }
  page.drawn = frame;
  if (now - counted.at > 1000) {
    counted = { at: now, drawn: 0, rate: (1000 * counted.drawn) / (now - counted.at) };
    const delay = seen.latency.length ? `, ${Math.round(seen.latency.at(-1))} ms from slider to picture` : "";
    byId("cost").textContent = `${Math.round(counted.rate)} pictures per second${delay}`;
    status();
  }
}
requestAnimationFrame(tick);

addEventListener("error", (e) => seen.errors.push(String(e.message)));
window.spunlaidLive = {
  seen,
  get state() { return page.state; },
  get measured() { return page.measured; },
  get frame() { return page.frame; },
  get rate() { return counted.rate; },
};
