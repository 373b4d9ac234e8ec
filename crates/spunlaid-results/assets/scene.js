// Drawing the box, its axes and the fibre on the canvas.

const AXES = ["x", "y", "z"];
const FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, Arial, sans-serif";

/** Colours of a picture that is saved. */
const PAPER = {
  ink: "#000000", muted: "#444444", rule: "#cccccc", stage: "#ffffff", fibre: "#000000",
  trail: "#d55e00", ghost: "#999999", shadow: "#dddddd", air: "#0072b2", belt: "#f3eee0", mark: "#c9bfa3",
};

/** Round numbers from low to high, about so many. */
function roundTicks(low, high, count) {
  const rough = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((f) => f * power >= 0.7 * rough) ?? 10);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) ticks.push(i * step);
  return { ticks, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** A number with a proper minus. */
function written(value, decimals) {
  return value.toFixed(decimals).replace(/^-(?=.*[1-9])/, "−").replace(/^-/, "");
}

class Scene {
  constructor(canvas, camera) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.camera = camera;
    this.readColours();
  }

  /** The colours of the page's style, which follow its light or dark scheme. */
  readColours() {
    const style = getComputedStyle(this.canvas);
    const colour = (name) => style.getPropertyValue(`--${name}`).trim();
    this.colours = Object.fromEntries(
      ["ink", "muted", "rule", "stage", "fibre", "trail", "ghost", "shadow", "air", "belt", "mark", "y", "z"].map((n) => [n, colour(n)]),
    );
  }

  /** Draws once at so many pixels across and in colours for paper; the canvas stays so until it is resized. */
  onPaper(pixels, draw) {
    const { fineness, colours } = this;
    this.fineness = pixels / this.camera.width;
    const [w, h] = [pixels, Math.round(this.camera.height * this.fineness)];
    Object.assign(this.canvas, { width: w, height: h });
    this.colours = { ...colours, ...PAPER };
    draw();
    Object.assign(this, { fineness, colours });
  }

  /** Makes the canvas as fine as the screen; says whether anything changed. */
  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const fineness = Math.min(window.devicePixelRatio || 1, 3);
    const [w, h] = [Math.round(width * fineness), Math.round(height * fineness)];
    if (w === this.canvas.width && h === this.canvas.height) return false;
    Object.assign(this.canvas, { width: w, height: h });
    this.fineness = fineness;
    this.camera.resize(width, height);
    return true;
  }

  /** Draws one picture: `{ shape, belt, ghosts, trail, box, captions, arrows, held }`. */
  draw(picture) {
    const { context: c, camera } = this;
    c.setTransform(this.fineness, 0, 0, this.fineness, 0, 0);
    c.fillStyle = this.colours.stage;
    c.fillRect(0, 0, camera.width, camera.height);
    c.lineJoin = c.lineCap = "round";
    camera.fit({ left: 58, right: 36, top: 104, bottom: 56 });
    this.labels = [];
    const faces = this.facing(picture.box);
    this.drawBox(picture.box, faces);
    this.drawShadows(picture.box, faces, picture.shape);
    if (picture.belt) this.drawBelt(picture.box, picture.belt);
    for (const ghost of picture.ghosts) this.drawLine(ghost, this.colours.ghost, 1.1, 0.8);
    this.drawTrail(picture.trail);
    this.drawLine(picture.shape, this.colours.fibre, 2.6, 1);
    this.drawNodes(picture);
    this.drawAxes(picture.box, faces);
    this.drawCaptions(picture.captions);
    this.drawArrows(picture.arrows);
  }

  /** For each coordinate, whether its low and its high face turn their inside to the viewer. */
  facing(box) {
    const { camera } = this;
    return AXES.map((_, k) =>
      [box.low[k], box.high[k]].map((value, side) => {
        const inward = [0, 0, 0];
        inward[k] = side ? -1 : 1;
        const centre = [...camera.middle];
        centre[k] = value;
        const towards = camera.direction(inward);
        const eye = [0, 0, camera.radius * (camera.perspective ? DISTANCE : 1e6)];
        const at = camera.seen(centre);
        return towards.reduce((sum, t, i) => sum + t * (eye[i] - at[i]), 0) > 0;
      }),
    );
  }

  drawBox(box, faces) {
    const { context: c } = this;
    c.strokeStyle = this.colours.rule;
    c.lineWidth = 1;
    faces.forEach((sides, k) =>
      sides.forEach((open, side) => {
        if (!open) return;
        const value = side ? box.high[k] : box.low[k];
        const [i, j] = [0, 1, 2].filter((n) => n !== k);
        const point = (a, b) => {
          const p = [0, 0, 0];
          [p[k], p[i], p[j]] = [value, a, b];
          return p;
        };
        c.beginPath();
        for (const a of [box.low[i], ...this.ticksOf(box, i).ticks, box.high[i]]) {
          this.trace([point(a, box.low[j]), point(a, box.high[j])]);
        }
        for (const b of [box.low[j], ...this.ticksOf(box, j).ticks, box.high[j]]) {
          this.trace([point(box.low[i], b), point(box.high[i], b)]);
        }
        c.stroke();
      }),
    );
  }

  /** Ticks of a coordinate, as many as its length in the picture has room for. */
  ticksOf(box, k) {
    const { camera } = this;
    const length = (box.high[k] - box.low[k]) * (k > 0 ? camera.stretch : 1);
    const pixels = length * camera.fitted.scale * camera.zoom;
    return roundTicks(box.low[k], box.high[k], Math.min(Math.max(pixels / 60, 2), 12));
  }

  /** The belt, with lines across that move with it, and the fibre that it carries. */
  drawBelt(box, { height, marks, laid }) {
    const { context: c } = this;
    const [low, high] = [box.low, box.high];
    const corners = [[low[1], low[2]], [high[1], low[2]], [high[1], high[2]], [low[1], high[2]]];
    c.save();
    c.fillStyle = this.colours.belt;
    c.beginPath();
    this.trace(corners.map(([y, z]) => [height, y, z]));
    c.closePath();
    c.fill();
    c.restore();
    for (const y of marks) this.drawLine([[height, y, low[2]], [height, y, high[2]]], this.colours.mark, 1, 1, "butt");
    for (const line of laid) this.drawLine(line, this.colours.fibre, 1.3, 0.85);
  }

  trace(points) {
    points.forEach((p, i) => {
      const [x, y] = this.camera.project(p);
      if (i === 0) this.context.moveTo(x, y);
      else this.context.lineTo(x, y);
    });
  }

  drawLine(points, colour, width, opacity, cap = "round") {
    const { context: c } = this;
    c.save();
    Object.assign(c, { globalAlpha: opacity, strokeStyle: colour, lineWidth: width, lineCap: cap });
    c.beginPath();
    this.trace(points);
    c.stroke();
    c.restore();
  }

  /** The fibre's shadow on the two walls behind it. */
  drawShadows(box, faces, shape) {
    for (const k of [1, 2]) {
      const side = faces[k][0] ? "low" : faces[k][1] ? "high" : null;
      if (side === null) continue;
      const flat = shape.map((p) => p.map((value, n) => (n === k ? box[side][k] : value)));
      this.drawLine(flat, this.colours.shadow, 1.4, 1);
    }
  }

  drawTrail(trail) {
    const pieces = Math.min(trail.length - 1, 60);
    for (let i = 0; i < pieces; i++) {
      const from = Math.floor((i * (trail.length - 1)) / pieces);
      const to = Math.floor(((i + 1) * (trail.length - 1)) / pieces);
      this.drawLine(trail.slice(from, to + 1), this.colours.trail, 1.5, 0.12 + (0.8 * (i + 1)) / pieces, "butt");
    }
  }

  /** The root's hold, the nodes where there are few, and the free end. */
  drawNodes({ shape, held, belt }) {
    const { context: c } = this;
    if (shape.length <= 61 && !belt) {
      c.fillStyle = this.colours.fibre;
      for (const node of shape) this.drawDot(node, 2.3);
    }
    const [x, y] = this.camera.project(shape[0]);
    c.fillStyle = this.colours.ink;
    if (held) c.fillRect(x - 4, y - 4, 8, 8);
    c.fillStyle = this.colours.trail;
    if (!belt) this.drawDot(shape.at(-1), 4.5);
  }

  drawDot(point, radius) {
    const [x, y] = this.camera.project(point);
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.context.fill();
  }

  /** Labels each axis along an edge of the box's outline. */
  drawAxes(box, faces) {
    AXES.forEach((name, k) => {
      const edge = this.outerEdge(box, faces, k);
      if (edge) this.labelEdge(box, k, name, edge);
    });
  }

  /** The edge along coordinate k that lies on the outline: the leftmost of x, the lowest of y and z. */
  outerEdge(box, faces, k) {
    const [i, j] = [0, 1, 2].filter((n) => n !== k);
    let best = null;
    for (const [si, sj] of [[0, 0], [0, 1], [1, 0], [1, 1]]) {
      if (faces[i][si] === faces[j][sj]) continue;
      const point = (value) => {
        const p = [0, 0, 0];
        [p[k], p[i], p[j]] = [value, si ? box.high[i] : box.low[i], sj ? box.high[j] : box.low[j]];
        return p;
      };
      const [a, b] = [this.camera.project(point(box.low[k])), this.camera.project(point(box.high[k]))];
      const upright = Math.abs(b[1] - a[1]) > Math.abs(b[0] - a[0]) && k === 0;
      const rank = upright ? -(a[0] + b[0]) : a[1] + b[1];
      if (best === null || rank > best.rank + 1e-6) best = { point, a, b, rank };
    }
    return best;
  }

  labelEdge(box, k, name, { point, a, b }) {
    const { context: c, camera } = this;
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(dx, dy);
    if (length < 36) return;
    const centre = camera.project(camera.middle);
    let [nx, ny] = [dy / length, -dx / length];
    if (nx * ((a[0] + b[0]) / 2 - centre[0]) + ny * ((a[1] + b[1]) / 2 - centre[1]) < 0) [nx, ny] = [-nx, -ny];
    const { ticks, decimals } = this.ticksOf(box, k);
    Object.assign(c, { fillStyle: this.colours.muted, strokeStyle: this.colours.muted, lineWidth: 1 });
    c.font = `12px ${FONT}`;
    c.textAlign = nx < -0.5 ? "right" : nx > 0.5 ? "left" : "center";
    c.textBaseline = ny < -0.7 ? "bottom" : ny > 0.7 ? "top" : "middle";
    const texts = ticks.map((tick) => written(tick, decimals));
    const widest = Math.max(0, ...texts.map((text) => c.measureText(text).width));
    const upright = Math.abs(dy) > Math.abs(dx);
    // Every so many get a label, counted from zero, so that the labels stay round and do not touch.
    const gap = (length / (box.high[k] - box.low[k])) * (ticks[1] - ticks[0] || 1);
    const every = Math.ceil((upright ? 17 : widest + 8) / gap) || 1;
    ticks.forEach((tick, i) => {
      const [x, y] = camera.project(point(tick));
      c.beginPath();
      c.moveTo(x, y);
      c.lineTo(x + 5 * nx, y + 5 * ny);
      c.stroke();
      const number = Math.round(tick / (ticks[1] - ticks[0] || 1));
      if (number % every === 0) this.label(texts[i], x + 9 * nx, y + 9 * ny);
    });
    c.font = `italic 13px ${FONT}`;
    c.fillStyle = this.colours.ink;
    const away = 16 + Math.abs(nx) * widest + Math.abs(ny) * 14;
    const middle = [(a[0] + b[0]) / 2 + away * nx, (a[1] + b[1]) / 2 + away * ny];
    const top = a[1] < b[1] ? a : b;
    const [x, y] = upright ? [top[0] + 9 * nx, top[1] - 18] : middle;
    c.fillText(`${name} / mm`, x, y);
  }

  /** A text, unless it would touch one that is there already. */
  label(text, x, y) {
    const { context: c } = this;
    const wide = c.measureText(text).width;
    const left = x - (c.textAlign === "right" ? wide : c.textAlign === "center" ? wide / 2 : 0);
    const top = y - (c.textBaseline === "bottom" ? 12 : c.textBaseline === "middle" ? 6 : 0);
    const box = [left - 2, top - 1, left + wide + 2, top + 13];
    const touches = (other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3];
    if (this.labels.some(touches)) return;
    this.labels.push(box);
    c.fillText(text, x, y);
  }

  /** What blows and what pulls, as arrows in the top right corner. */
  drawArrows(arrows) {
    const { context: c, camera } = this;
    arrows.forEach(({ label, sign, colour, along = 0 }, i) => {
      const x = camera.width - 44 - (camera.width < 520 ? 72 : 92) * (arrows.length - 1 - i);
      const [right, up, towards] = camera.direction([0, 1, 2].map((k) => (k === along ? sign : 0)));
      Object.assign(c, { strokeStyle: this.colours[colour], fillStyle: this.colours[colour], lineWidth: 2 });
      this.drawArrow(x, 34, 22 * right, -22 * up, towards);
      c.font = `12px ${FONT}`;
      Object.assign(c, { textAlign: "center", textBaseline: "top", fillStyle: this.colours.ink });
      c.fillText(label, x, 62);
    });
  }

  /** An arrow around a point; a dot or a cross in a ring where it comes towards or goes from the viewer. */
  drawArrow(x, y, dx, dy, towards) {
    const { context: c } = this;
    const length = Math.hypot(dx, dy);
    c.beginPath();
    if (length < 7) {
      c.arc(x, y, 9, 0, 2 * Math.PI);
      if (towards < 0) {
        for (const s of [-1, 1]) {
          c.moveTo(x - 5, y - 5 * s);
          c.lineTo(x + 5, y + 5 * s);
        }
      }
      c.stroke();
      if (towards > 0) {
        c.beginPath();
        c.arc(x, y, 3, 0, 2 * Math.PI);
        c.fill();
      }
      return;
    }
    const [ux, uy] = [dx / length, dy / length];
    c.moveTo(x - dx, y - dy);
    c.lineTo(x + dx - 6 * ux, y + dy - 6 * uy);
    c.stroke();
    c.beginPath();
    c.moveTo(x + dx, y + dy);
    c.lineTo(x + dx - 10 * ux - 4.5 * uy, y + dy - 10 * uy + 4.5 * ux);
    c.lineTo(x + dx - 10 * ux + 4.5 * uy, y + dy - 10 * uy - 4.5 * ux);
    c.fill();
  }

  drawCaptions(captions) {
    const { context: c } = this;
    // Beside the arrows there is less room on a phone.
    const small = this.camera.width < 420;
    Object.assign(c, { textAlign: "left", textBaseline: "top" });
    captions.forEach((text, i) => {
      const y = 12 + 19 * i;
      c.font = `${i === 0 ? "600 " : ""}${small ? 11.5 : 14 - Math.min(i, 1)}px ${FONT}`;
      // Readable on whatever is drawn behind.
      Object.assign(c, { globalAlpha: 0.8, fillStyle: this.colours.stage });
      c.fillRect(12, y - 2, c.measureText(text).width + 4, 18);
      Object.assign(c, { globalAlpha: 1, fillStyle: i === 0 ? this.colours.ink : this.colours.muted });
      c.fillText(text, 14, y);
    });
  }
}
