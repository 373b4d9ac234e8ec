// The plots: curves by uPlot, path, trace and footprint on canvases of their own.

/** Time that the motion is shown for [s]. */
const SHOWN = 1;
const MOST_SAMPLES = 2400;

/** The colours of the page, read again when its scheme changes. */
const colours = {
  read() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["ink", "muted", "rule", "stage", "panel", "fibre", "belt", "mark", "y", "z", "before", "heat"]) {
      this[name] = style.getPropertyValue(`--${name}`).trim();
    }
  },
};
colours.read();

/** An axis in the colours of the page. */
function axis(label, more = {}) {
  return {
    label,
    stroke: () => colours.muted,
    grid: { stroke: () => colours.rule, width: 1 },
    ticks: { stroke: () => colours.rule, width: 1 },
    font: "12px system-ui, sans-serif",
    labelFont: "12px system-ui, sans-serif",
    labelSize: 18,
    size: 44,
    ...more,
  };
}

const line = (colour, more = {}) => ({ stroke: () => colours[colour], width: 1.6, points: { show: false }, spanGaps: false, ...more });
const before = (dash) => line("before", { width: 1.2, dash });

/** A plot that fills its place. */
function plot(place, { x, y, series, scales = {}, axes = [{}, {}], bands, hooks }) {
  const size = () => ({ width: Math.max(place.clientWidth, 120), height: Math.max(place.clientHeight, 120) });
  const chart = new uPlot(
    {
      ...size(),
      scales: { x: { time: false }, ...scales },
      axes: [axis(x, axes[0]), axis(y, { size: 56, ...axes[1] })],
      series: [{}, ...series],
      bands,
      hooks,
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      padding: [8, 26, 0, 0],
    },
    [[], ...series.map(() => [])],
    place,
  );
  new ResizeObserver(() => chart.setSize(size())).observe(place);
  return chart;
}

/** Only powers of ten, every so many, on a logarithmic axis. */
const decades = (every) => (_, splits) => splits.map((v) => (v !== null && Math.abs(Math.log10(v) % every) < 1e-6 ? v : null));
const powers = (every) => ({
  filter: decades(every),
  grid: { stroke: () => colours.rule, width: 1, filter: decades(every) },
  ticks: { stroke: () => colours.rule, width: 1, filter: decades(every) },
  values: (_, splits) => splits.map((v) => (v === null ? null : v >= 1 && v <= 1000 ? `${v}` : `10${[...`${Math.round(Math.log10(v))}`].map((d) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(d)]).join("")}`)),
});

/** Range from zero to a little above the largest value. */
const fromZero = (_, low, high) => [0, high > 0 ? 1.1 * high : 1];
/** Range around zero. */
const around = (_, low, high) => {
  const most = 1.1 * Math.max(Math.abs(low), Math.abs(high), 1e-6);
  return [-most, most];
};

/** A canvas that is as fine as the screen; `draw(context, width, height)`. */
class Board {
  constructor(canvas, draw) {
    Object.assign(this, { canvas, paint: draw });
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  draw() {
    const { canvas } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (!width || !height) return;
    const fineness = Math.min(devicePixelRatio || 1, 3);
    const [w, h] = [Math.round(width * fineness), Math.round(height * fineness)];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    const context = canvas.getContext("2d");
    context.setTransform(fineness, 0, 0, fineness, 0, 0);
    context.clearRect(0, 0, width, height);
    this.paint(context, width, height);
  }
}

function text(c, words, x, y, align = "left", baseline = "alphabetic") {
  Object.assign(c, { fillStyle: colours.muted, font: "12px system-ui, sans-serif", textAlign: align, textBaseline: baseline });
  c.fillText(words, x, y);
}

/** Strokes straight lines, each through its points. */
function stroke(c, ...lines) {
  c.beginPath();
  for (const points of lines) points.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
  c.stroke();
}

/** A bar of a round length at the lower left; `scale` in pixels per millimetre. */
function scaleBar(c, height, scale) {
  const length = roundUp(50 / scale);
  Object.assign(c, { strokeStyle: colours.ink, lineWidth: 2 });
  stroke(c, [[10, height - 10], [10 + length * scale, height - 10]]);
  text(c, `${length >= 1000 ? `${length / 1000} m` : `${length} mm`}`, 10, height - 16);
}

/** One number of the statistics over the time that they were taken: value and band, and the value before as a line. */
class Settling {
  constructor(place, unit) {
    const band = (colour) => line(colour, { width: 0 });
    const fill = (colour) => () => `color-mix(in srgb, ${colours[colour]} 22%, transparent)`;
    this.chart = plot(place, {
      x: "Time since the change / s",
      y: unit,
      scales: { y: { range: fromZero } },
      series: [line("y"), band("y"), band("y"), line("z"), band("z"), band("z"), before([6, 4]), before([2, 3])],
      bands: [{ series: [2, 3], fill: fill("y") }, { series: [5, 6], fill: fill("z") }],
    });
    this.clear();
  }

  clear() {
    this.data = Array.from({ length: 9 }, () => []);
  }

  /** `pair` – the two numbers; `last` – those before, if there are any */
  add(time, pair, last) {
    if (!(time > 0) || pair.some((n) => n?.value == null)) return;
    const { data } = this;
    data[0].push(time);
    pair.forEach(({ value, error }, i) => {
      data[1 + 3 * i].push(value);
      data[2 + 3 * i].push(value + (error ?? 0));
      data[3 + 3 * i].push(value - (error ?? 0));
    });
    [7, 8].forEach((k, i) => data[k].push(last?.[i]?.value ?? null));
    // Every second of many, so that the curve goes on for any time.
    if (data[0].length > 1200) this.data = data.map((column) => column.filter((_, i) => i % 2 === 1));
    this.chart.setData(this.data);
  }
}

class Plots {
  constructor(byId) {
    this.samples = [];
    this.next = null;
    this.curves = null;
    this.ghost = null;
    this.cutoff = null;
    this.motion = plot(byId("motion"), {
      x: "Time / s",
      y: "mm",
      scales: { y: { range: around } },
      series: [line("y"), line("z")],
    });
    this.along = plot(byId("along"), {
      x: "Distance from the root / mm",
      y: "mm",
      scales: { y: { range: fromZero } },
      series: [line("y"), line("z"), before([6, 4]), before([2, 3])],
    });
    const range = (_, low, high) => [low > 0 ? Math.max(low, high * 1e-9) : 1e-9, high > 0 ? 2 * high : 1];
    this.spectrum = plot(byId("spectrum"), {
      x: "Frequency / Hz",
      y: "mm²/Hz",
      scales: { x: { time: false, distr: 3 }, y: { distr: 3, range } },
      axes: [powers(1), powers(2)],
      series: [line("y"), line("z"), before([6, 4]), before([2, 3])],
      hooks: { draw: [(chart) => this.markCutoff(chart)] },
    });
    this.settling = new Settling(byId("settling"), "mm");
    this.rate = new Settling(byId("rate"), "Hz");
    this.path = new Board(byId("path"), (c, w, h) => this.drawPath(c, w, h));
    this.trace = new Board(byId("trace"), (c, w, h) => this.drawTrace(c, w, h));
    this.footprint = new Board(byId("footprint"), (c, w, h) => this.drawFootprint(c, w, h));
    this.belt = null;
    this.map = null;
  }

  /** Takes the samples of a frame. */
  take(frame) {
    const { samples, firstSample, time } = frame;
    const count = samples.length / 4;
    if (count === 0) return;
    const start = time - samples[0];
    // A gap, or a time that begins anew.
    const last = this.samples.at(-1);
    if (last && start < last[0] - 1e-9) this.samples = [];
    else if (last && firstSample !== this.next) this.samples.push([(last[0] + start) / 2, null, null]);
    this.next = firstSample + count;
    for (let i = 0; i < samples.length; i += 4) this.samples.push([time - samples[i], samples[i + 2], samples[i + 3]]);
    const from = this.samples.at(-1)[0] - SHOWN;
    const old = this.samples.findIndex(([t]) => t >= from);
    this.samples.splice(0, Math.max(old, this.samples.length - MOST_SAMPLES));
  }

  /** Draws what moves with every frame. */
  drawMoving(frame, belt) {
    if (frame.fed) {
      this.belt = { laid: belt, time: frame.time };
      return this.trace.draw();
    }
    this.motion.setData([0, 1, 2].map((k) => this.samples.map((s) => s[k])));
    this.path.draw();
  }

  /** Keeps what is there as the setting before. */
  keep() {
    if (this.curves) this.ghost = { ...this.curves, path: this.samples.map(([, y, z]) => [y, z]) };
  }

  clear() {
    this.curves = null;
    this.map = null;
    this.settling.clear();
    this.rate.clear();
  }

  /** Takes the statistics; `last` – the numbers of the setting before by name. */
  measured(message, last) {
    const of = (name) => message.numbers.find((n) => n.name === name);
    const pair = (...names) => [names.map(of), names.map((name) => last?.get(name))];
    const [wide, wideBefore] = message.curves || !message.footprint ? pair("amplitude_y", "amplitude_z") : pair("sigma_md", "sigma_cd");
    this.settling.add(message.duration, wide, wideBefore);
    if (message.footprint) {
      this.map = message.footprint;
      this.footprint.draw();
      return;
    }
    this.rate.add(message.duration, ...pair("frequency_y", "frequency_z"));
    if (!message.curves) return;
    this.curves = message.curves;
    const { along, spectrum } = message.curves;
    const onto = (x, of, k) => (of && of[0].length === x.length && of[0].at(-1) === x.at(-1) ? of[k] : x.map(() => null));
    const ghost = this.ghost;
    this.along.setData([...along, onto(along[0], ghost?.along, 1), onto(along[0], ghost?.along, 2)]);
    if (spectrum[0].length) {
      this.spectrum.setData([...spectrum, onto(spectrum[0], ghost?.spectrum, 1), onto(spectrum[0], ghost?.spectrum, 2)]);
    }
  }

  markCutoff(chart) {
    if (!(this.cutoff > 0)) return;
    const x = chart.valToPos(this.cutoff, "x", true);
    const { left, top, width, height } = chart.bbox;
    if (!(x > left && x < left + width)) return;
    const c = chart.ctx;
    c.save();
    Object.assign(c, { strokeStyle: colours.muted, lineWidth: devicePixelRatio });
    c.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
    stroke(c, [[x, top], [x, top + height]]);
    Object.assign(c, { fillStyle: colours.muted, font: `${12 * devicePixelRatio}px system-ui, sans-serif`, textAlign: "left" });
    c.fillText("cut-off", x + 4 * devicePixelRatio, top + 14 * devicePixelRatio);
    c.restore();
  }

  drawPath(c, width, height) {
    const now = this.samples.map(([, y, z]) => [y, z]);
    const old = this.ghost?.path ?? [];
    const reach = [...now, ...old].reduce((most, [y, z]) => Math.max(most, Math.abs(y ?? 0), Math.abs(z ?? 0)), 1e-3);
    const scale = (0.46 * Math.min(width, height)) / roundUp(reach);
    const [cx, cy] = [width / 2, height / 2];
    Object.assign(c, { strokeStyle: colours.rule, lineWidth: 1, lineJoin: "round" });
    stroke(c, [[0, cy], [width, cy]], [[cx, 0], [cx, height]]);
    const trace = (points) => {
      c.beginPath();
      let on = false;
      for (const [y, z] of points) {
        if (y === null) on = false;
        else if (on) c.lineTo(cx + scale * y, cy - scale * z);
        else c.moveTo(cx + scale * y, cy - scale * z);
        on = y !== null;
      }
      c.stroke();
    };
    Object.assign(c, { strokeStyle: colours.before, globalAlpha: 0.5 });
    trace(old);
    c.strokeStyle = colours.y;
    const pieces = 8;
    for (let i = 0; i < pieces; i++) {
      c.globalAlpha = 0.2 + (0.8 * (i + 1)) / pieces;
      c.lineWidth = 1.3;
      const at = (k) => Math.floor((k * now.length) / pieces);
      trace(now.slice(at(i), at(i + 1) + 1));
    }
    c.globalAlpha = 1;
    const last = now.at(-1);
    if (last && last[0] !== null) {
      c.fillStyle = colours.z;
      c.beginPath();
      c.arc(cx + scale * last[0], cy - scale * last[1], 4, 0, 2 * Math.PI);
      c.fill();
    }
    text(c, "y", width - 12, cy - 6);
    text(c, "z", cx + 6, 14);
    scaleBar(c, height, scale);
  }

  drawTrace(c, width, height) {
    if (!this.belt) return;
    const { laid } = this.belt;
    const scale = Math.min(width / 600, height / 300);
    const [cx, cy] = [width * 0.15, height / 2];
    c.fillStyle = colours.belt;
    c.fillRect(0, 0, width, height);
    Object.assign(c, { strokeStyle: colours.fibre, lineWidth: 1, lineJoin: "round", globalAlpha: 0.8 });
    const box = { low: [0, -cx / scale, -1e9], high: [0, (width - cx) / scale, cy / scale] };
    for (const points of laid.lines(0, box, null)) {
      stroke(c, points.map(([, y, z]) => [cx + scale * y, cy - scale * z]));
    }
    c.globalAlpha = 1;
    text(c, "belt direction →", width - 10, 16, "right");
    scaleBar(c, height, scale);
  }

  drawFootprint(c, width, height) {
    if (!this.map) return text(c, "The fibres have not settled yet.", 12, 24);
    const { cell, columns, corner, counts } = this.map;
    const rows = counts.length / columns;
    const reach = Math.max(-corner[0], -corner[1], corner[0] + columns * cell, corner[1] + rows * cell);
    const scale = (0.48 * Math.min(width, height)) / reach;
    const most = counts.reduce((a, b) => Math.max(a, b), 1);
    const [cx, cy, side] = [width / 2, height / 2, cell * scale];
    counts.forEach((count, i) => {
      if (!count) return;
      const x = cx + scale * (corner[0] + (i % columns) * cell);
      const y = cy - scale * (corner[1] + (Math.floor(i / columns) + 1) * cell);
      c.fillStyle = `rgba(${colours.heat}, ${0.08 + (0.92 * count) / most})`;
      c.fillRect(x, y, side + 0.5, side + 0.5);
    });
    Object.assign(c, { strokeStyle: colours.muted, lineWidth: 1 });
    stroke(c, [[cx - 6, cy], [cx + 6, cy]], [[cx, cy - 6], [cx, cy + 6]]);
    text(c, "MD →", width - 10, height - 10, "right");
    text(c, "CD ↑", 10, 16);
    scaleBar(c, height, scale);
  }

  redraw() {
    colours.read();
    for (const chart of [this.motion, this.along, this.spectrum, this.settling.chart, this.rate.chart]) chart.redraw();
    for (const board of [this.path, this.trace, this.footprint]) board.draw();
  }
}
