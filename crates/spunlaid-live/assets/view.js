// The fibres in three dimensions, drawn by the scene of the report.

const STRETCHES = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
/** Samples of the trail behind the free end. */
const TRAIL = 160;

/** Reads a frame; src/live/frame.rs describes its bytes. */
function readFrame(buffer) {
  const view = new DataView(buffer);
  const bits = view.getUint8(4);
  const count = view.getUint8(5);
  const nodes = Array.from({ length: count }, (_, i) => view.getUint16(22 + 2 * i, true));
  const numbers = new Float32Array(buffer, 48);
  let at = 0;
  const take = (length) => numbers.subarray(at, (at += length));
  return {
    generation: view.getUint32(0, true),
    stands: Boolean(bits & 1),
    behind: Boolean(bits & 2),
    fed: Boolean(bits & 4),
    time: view.getFloat64(8, true),
    speed: view.getFloat32(16, true),
    firstSample: view.getUint32(40, true),
    firstPoint: view.getUint32(44, true),
    shapes: nodes.map((n) => take(3 * n)),
    samples: take(4 * view.getUint16(6, true)),
    points: take(2 * view.getUint16(20, true)),
  };
}

/** The smallest of 1, 2 or 5 times a power of ten that is not below a value. */
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-6)));
  return power * [1, 2, 5, 10].find((f) => f * power >= value * (1 - 1e-9));
}

/** The nodes of a fibre: `[x, y, z]` each. */
function nodesOf(shape) {
  return Array.from({ length: shape.length / 3 }, (_, i) => [shape[3 * i], shape[3 * i + 1], shape[3 * i + 2]]);
}

class View {
  constructor(canvas) {
    this.camera = new Camera();
    this.scene = new Scene(canvas, this.camera);
    this.state = null;
    this.trail = [];
    this.reach = 0;
    this.laid = new Belt();
    this.draws = 0;
    new ResizeObserver(() => this.scene.resize() && this.changed?.()).observe(canvas);
    this.scene.resize();
  }

  /** Takes what is new in a frame, whether it will be drawn or not. */
  take(frame) {
    const { samples } = frame;
    for (let i = 0; i < samples.length; i += 4) this.trail.push([samples[i + 1], samples[i + 2], samples[i + 3]]);
    if (this.trail.length > TRAIL) this.trail.splice(0, this.trail.length - TRAIL);
    if (frame.fed && this.state?.belt) this.laid.take(frame, this.state.belt.speed);
  }

  /** A box around all fibres that changes in large steps only. */
  box(shapes) {
    const { length_mm: length, held, belt } = this.state;
    let wide = 0;
    for (const shape of shapes) {
      for (const [, y, z] of shape) wide = Math.max(wide, Math.abs(y), Math.abs(z));
    }
    if (!Number.isFinite(wide)) wide = 1;
    // Grows at once, and shrinks when the motion has been much smaller for a while.
    this.reach = Math.max(wide, this.reach * 0.9995);
    const side = roundUp(Math.max(1.05 * this.reach, (belt ? 0.1 : 1e-3) * length));
    const xs = held || belt ? [0, length] : this.around(shapes, length);
    // What is laid runs out of the picture with the belt.
    const box = { low: [xs[0], -side, -side], high: [xs[1], belt ? 3 * side : side, side] };
    const stretch = belt ? 1 : (STRETCHES.filter((s) => s <= (0.5 * length) / side).at(-1) ?? 1);
    const name = JSON.stringify([box, stretch]);
    if (name !== this.framed) {
      this.framed = name;
      this.camera.stretch = stretch;
      this.camera.frame(box);
    }
    return box;
  }

  /** A free fibre is carried along: the picture follows in steps. */
  around(shapes, length) {
    const x = shapes[0][0][0];
    const start = Math.floor((2 * x) / length) * 0.5 * length;
    return [start - 0.5 * length, start + 2 * length];
  }

  draw(frame) {
    if (!this.state) return;
    const shapes = frame.shapes.map(nodesOf);
    const box = this.box(shapes);
    const { belt, length_mm: height } = this.state;
    const own = belt ? shapes[0].filter(([x]) => x >= 0) : shapes[0];
    if (belt) own.unshift([0, 0, 0]);
    const { stretch } = this.camera;
    this.scene.draw({
      box,
      shape: own,
      belt: belt && { height, marks: this.marks(box, frame.time, belt), laid: this.laid.lines(height, box, own.at(-1)) },
      ghosts: shapes.slice(1).map((shape) => (belt ? shape.filter(([x]) => x >= 0) : shape)),
      trail: belt || this.trail.length < 2 ? [] : this.trail,
      captions: [stretch === 1 ? "True to scale" : `Sideways stretched × ${stretch}`, `t = ${frame.time.toFixed(3)} s`],
      arrows: this.arrows(),
      held: this.state.held,
    });
    this.draws += 1;
  }

  /** Lines across the belt that move with it. */
  marks(box, time, belt) {
    const apart = roundUp((box.high[1] - box.low[1]) / 10);
    const phase = (((belt.speed * time * 1e3 - box.low[1]) % apart) + apart) % apart;
    const marks = [];
    for (let y = box.low[1] + phase; y <= box.high[1]; y += apart) marks.push(y);
    return marks;
  }

  arrows() {
    const { air, gravity, belt } = this.state;
    const arrows = [];
    const shown = (v) => Number(Math.abs(v).toPrecision(3));
    if (air !== 0) arrows.push({ label: `air ${shown(air)} m/s`, sign: Math.sign(air), colour: "air" });
    const crowded = belt && air !== 0 && this.camera.width < 520;
    if (gravity !== 0 && !crowded) arrows.push({ label: "gravity", sign: Math.sign(gravity), colour: "ink" });
    if (belt) arrows.push({ label: `belt ${shown(belt.speed)} m/s`, along: 1, sign: 1, colour: "trail" });
    return arrows;
  }

  /** Turning and zooming with mouse, touch and keys; `act` has further keys. */
  listen(act) {
    this.changed = act.changed;
    const { canvas } = this.scene;
    steer(canvas, this.camera, {
      changed: act.changed,
      // The wheel scrolls the page; with the control key, or a pinch, it zooms.
      zooms: (e) => e.ctrlKey || document.activeElement === canvas,
      keys: { r: () => this.camera.look("oblique"), " ": act.play, ".": act.step },
    });
  }
}

/** What the first fibre has laid, in the frame of the belt. */
class Belt {
  constructor() {
    this.clear();
  }

  clear() {
    this.points = [];
    this.next = null;
    this.run = 0;
  }

  /** `speed` – of the belt [m/s] */
  take(frame, speed) {
    this.run = 1e3 * speed * frame.time;
    const { points, firstPoint } = frame;
    // A gap: the line begins anew.
    if (points.length && this.next !== null && firstPoint !== this.next) this.points.push(null);
    for (let i = 0; i < points.length; i += 2) this.points.push([points[i] - this.run, points[i + 1]]);
    if (points.length) this.next = firstPoint + points.length / 2;
    if (this.points.length > 30000) this.points.splice(0, 10000);
  }

  /** The lines on the belt within a box, from the newest point on. */
  lines(height, box, last) {
    const lines = [];
    let line = last ? [last] : [];
    for (let i = this.points.length - 1; i >= 0 && this.points.length - i < 12000; i--) {
      const point = this.points[i];
      const y = point && point[0] + this.run;
      if (point && y <= box.high[1] && y >= box.low[1] && Math.abs(point[1]) <= box.high[2]) {
        line.push([height, y, point[1]]);
      } else {
        if (line.length > 1) lines.push(line);
        line = [];
        if (point && y > 3 * box.high[1]) break;
      }
    }
    if (line.length > 1) lines.push(line);
    return lines;
  }
}
