// The web on its belt: filaments that land, and maps of webs that are complete, before and now.

/** Pixels along a tile, on which landed filaments are drawn once; across it has those of the canvas. */
const TILE = 256;
/** Height of the picture in which the filaments come down [px]. */
const CURTAIN = 28;
/** Time in which the belt follows what has been computed [ms]. */
const FOLLOWS = 180;

/** Reads a frame; the server's `frames` describe its bytes. */
function readLineFrame(buffer) {
  const view = new DataView(buffer);
  const frame = { generation: view.getUint32(0, true), kind: view.getUint8(4), layer: view.getUint8(5) };
  const count = view.getUint16(6, true);
  if (frame.kind === 0) {
    const counts = Array.from({ length: count }, (_, i) => view.getUint16(16 + 2 * i, true));
    let at = 0;
    const numbers = new Float32Array(buffer, 16 + 4 * Math.ceil(count / 2));
    const filaments = counts.map((n) => numbers.subarray(at, (at += 2 * n)));
    return { ...frame, width: view.getFloat32(8, true), moved: view.getFloat32(12, true), filaments };
  }
  const [rows, pixel, most] = [view.getUint32(8, true), view.getFloat32(12, true), view.getFloat32(16, true)];
  return { ...frame, columns: count, rows, pixel, most, grey: new Uint8Array(buffer, 20, rows * count) };
}

/** What lies of one line: the filaments that have landed, and the map once its web is complete. */
class Laid {
  constructor() {
    this.map = null;
    this.clear(0);
  }

  /** `across` – pixels across the tiles that will come. */
  clear(across) {
    [this.generation, this.across] = [-1, across];
    this.tiles = new Map();
    this.ends = [];
    this.homes = [];
    [this.moved, this.width] = [0, 0];
    this.spread = { count: 0, sum: 0, squares: 0 };
  }

  /** Whether another web begins with these points: its belt starts again. */
  isNewWeb({ generation, width, moved, layer, filaments }) {
    const isSame = generation === this.generation && layer === this.layer && width === this.width;
    return !isSame || moved < this.moved || filaments.length !== this.ends.length;
  }

  /** Draws new points of the filaments. */
  take(frame, colour, across) {
    const { generation, layer, width, moved, filaments } = frame;
    if (this.isNewWeb(frame)) {
      this.clear(across);
      Object.assign(this, { generation, layer, width });
      this.ends = filaments.map(() => null);
      this.homes = filaments.map(() => ({ sum: 0, count: 0 }));
    }
    this.moved = moved;
    const scale = this.across / width;
    const folded = (x) => ((x % width) + width) % width;
    for (const [i, points] of filaments.entries()) {
      if (points.length === 0) continue;
      const path = this.ends[i] ? [this.ends[i]] : [];
      for (let j = 0; j < points.length; j += 2) {
        path.push([folded(points[j]), points[j + 1]]);
        const ahead = points[j + 1] - moved;
        this.spread.count += 1;
        this.spread.sum += ahead;
        this.spread.squares += ahead * ahead;
        this.homes[i].sum += points[j];
      }
      this.homes[i].count += points.length / 2;
      this.ends[i] = path.at(-1);
      this.drawPath(path, scale, colour);
    }
    const oldest = Math.floor(((this.moved - 4 * width) * scale) / TILE);
    for (const tile of this.tiles.keys()) if (tile < oldest) this.tiles.delete(tile);
  }

  /** How far filaments land ahead of the belt, all but a few of them [m]. */
  get ahead() {
    const { count, sum, squares } = this.spread;
    if (count === 0) return 0;
    const mean = sum / count;
    return mean + 2 * Math.sqrt(Math.max(0, squares / count - mean * mean));
  }

  drawPath(path, scale, colour) {
    const along = path.map((point) => point[1] * scale);
    const [first, last] = [Math.floor(Math.min(...along) / TILE), Math.floor(Math.max(...along) / TILE)];
    for (let index = first; index <= last; index++) {
      const pen = this.tile(index).getContext("2d");
      pen.strokeStyle = colour;
      pen.globalAlpha = 0.5;
      pen.lineWidth = Math.max(0.7, this.across / 700);
      pen.lineJoin = "round";
      pen.beginPath();
      path.forEach(([x, y], j) => {
        const jumps = j === 0 || Math.abs(x - path[j - 1][0]) > 0.5 * this.width;
        // The newest is on top, as on the belt.
        pen[jumps ? "moveTo" : "lineTo"](x * scale, (index + 1) * TILE - y * scale);
      });
      pen.stroke();
    }
  }

  tile(index) {
    if (!this.tiles.has(index)) this.tiles.set(index, element("canvas", { width: this.across, height: TILE }));
    return this.tiles.get(index);
  }

  /** Lines in another colour, where the colours of the page change. */
  recolour(colour) {
    for (const tile of this.tiles.values()) {
      const pen = tile.getContext("2d");
      pen.save();
      pen.globalCompositeOperation = "source-in";
      pen.globalAlpha = 1;
      pen.fillStyle = colour;
      pen.fillRect(0, 0, this.across, TILE);
      pen.restore();
    }
  }
}

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** The picture of a map: mass is dark on light paper, or light on a dark belt. */
function imageOf({ columns, rows, most, grey }, [paper, web]) {
  const image = new ImageData(columns, rows);
  // One scale for all webs: half grey at the mean, the ends at nothing and at twice the mean.
  const shades = Array.from({ length: 256 }, (_, i) => {
    const share = 1 / (1 + Math.exp(-4.5 * ((i / 255) * most - 1)));
    return paper.map((c, j) => Math.round(c + share * (web[j] - c)));
  });
  for (let row = 0; row < rows; row++) {
    for (let i = 0, at = 4 * (rows - 1 - row) * columns; i < columns; i++, at += 4) {
      const shade = shades[grey[row * columns + i]];
      [image.data[at], image.data[at + 1], image.data[at + 2], image.data[at + 3]] = [...shade, 255];
    }
  }
  const canvas = element("canvas", { width: columns, height: rows });
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

class Belt {
  constructor(canvas) {
    this.canvas = canvas;
    this.before = new Laid();
    this.now = new Laid();
    Object.assign(this, { split: false, at: 0, seen: 0, zoomed: 1, stale: true, drawn: 0, offset: 0 });
    new ResizeObserver(() => (this.stale = true)).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.readColours());
    this.readColours();
    this.steer();
  }

  readColours() {
    const css = getComputedStyle(document.documentElement);
    const names = ["paper", "web", "lines", "ink", "muted", "panel"];
    this.colours = Object.fromEntries(names.map((name) => [name, css.getPropertyValue(`--${name}`).trim()]));
    for (const laid of [this.before, this.now]) {
      laid.recolour(this.colours.lines);
      laid.image = null;
    }
    this.stale = true;
  }

  /** Nearer, or further away, up to the whole width. */
  zoom(factor) {
    this.zoomed = Math.min(16, Math.max(1, this.zoomed * factor));
    this.stale = true;
  }

  /** The belt stands where one looks: keys and a drag along it. */
  steer() {
    const move = (pixels) => {
      this.offset += pixels / this.canvas.clientWidth;
      this.stale = true;
    };
    const keys = {
      ArrowUp: () => move(40),
      ArrowDown: () => move(-40),
      "+": () => this.zoom(1.5),
      "-": () => this.zoom(1 / 1.5),
    };
    this.canvas.addEventListener("keydown", (e) => {
      if (!keys[e.key] || e.ctrlKey || e.metaKey) return;
      e.preventDefault();
      keys[e.key]();
    });
    this.canvas.addEventListener("pointermove", ({ buttons, pointerType, movementY }) => {
      if (buttons === 1 && pointerType === "mouse") move(movementY);
    });
  }

  /** `isNow` – whether points are those of the web as it is now; a map says it itself. */
  take(frame, isNow) {
    const laid = (frame.kind === 0 ? isNow : frame.layer === 1) ? this.now : this.before;
    if (frame.kind === 0) {
      if (laid.isNewWeb(frame)) [this.at, this.offset] = [0, 0];
      laid.take(frame, this.colours.lines, Math.max(300, this.canvas.width));
    } else [laid.map, laid.image] = [frame, null];
    this.stale = true;
  }

  /** What is now has become what was before. */
  pin() {
    if (!this.now.map && this.now.tiles.size === 0) return;
    this.before = this.now;
    this.now = new Laid();
    this.stale = true;
  }

  /** Takes what is older than a change of the knobs off the belt of now. */
  clearNow(generation) {
    if (this.now.generation < generation) this.now.clear(0);
    if (this.now.map?.generation < generation) this.now.map = null;
    this.stale = true;
  }

  /** Width that is to be seen [m]: of the sheet on which filaments land, or of a map, as much as fills the picture. */
  get width() {
    const { map, width } = this.newest;
    if (!map) return width / this.zoomed;
    const { clientWidth, clientHeight } = this.canvas;
    const filling = (map.rows * clientWidth) / Math.max(1, clientHeight - CURTAIN);
    return (Math.min(map.columns, filling) * map.pixel) / this.zoomed;
  }

  /** What of the belt lies at the top of the picture: the newest, or a part of a map [m]. */
  topOf(shown) {
    const { map } = this.newest;
    if (!map) return this.at + this.offset * this.seen;
    const long = map.rows * map.pixel;
    const top = Math.min(long, Math.max(Math.min(long, shown), long + this.offset * this.seen));
    this.offset = (top - long) / this.seen;
    return top;
  }

  get newest() {
    return this.now.tiles.size > 0 || this.now.map ? this.now : this.before;
  }

  /** Draws when there is something new, with a belt that moves evenly between what has been computed. */
  tick(now) {
    const passed = Math.min(200, now - (this.last ?? now));
    this.last = now;
    if (this.width === 0) return this.stale && this.paintEmpty();
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const left = still ? 0 : Math.exp(-passed / FOLLOWS);
    const { moved, ahead, map } = this.newest;
    const top = moved + (map ? 0 : ahead);
    const next = top + (this.at - top) * left;
    // Zooms as it moves, and stands when it is as good as there.
    const isThere = this.seen === 0 || Math.abs(this.seen / this.width - 1) < 2e-3;
    const seen = isThere ? this.width : this.width + (this.seen - this.width) * left;
    const pixels = (Math.abs(next - this.at) * this.canvas.clientWidth) / this.width;
    if (pixels < 0.2 && seen === this.seen && !this.stale) return;
    if (still && now - (this.since ?? 0) < 1000) return;
    Object.assign(this, { since: now, at: next, seen, stale: false });
    const pen = this.fit();
    if (!pen) return;
    this.paint(pen, this.canvas.clientWidth, this.canvas.clientHeight);
    this.drawn += 1;
  }

  fit() {
    const { canvas } = this;
    const [ratio, width, height] = [devicePixelRatio || 1, canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return null;
    const size = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    return pen;
  }

  paintEmpty() {
    const pen = this.fit();
    if (!pen) return;
    this.stale = false;
    pen.fillStyle = this.colours.paper;
    pen.fillRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
  }

  /** The whole picture, on the page or for a slide. */
  paint(pen, width, height) {
    const scale = width / this.seen;
    pen.fillStyle = this.colours.panel;
    pen.fillRect(0, 0, width, height);
    const view = { scale, width, height, top: this.topOf((height - CURTAIN) / scale) };
    if (!this.split || this.newest !== this.now) this.paintLaid(pen, this.newest, view);
    else {
      // Both halves show the middle of the sheet, at the same scale.
      for (const [laid, x, label] of [[this.before, 0, "before"], [this.now, width / 2, "now"]]) {
        pen.save();
        pen.beginPath();
        pen.rect(x, 0, width / 2, height);
        pen.clip();
        pen.translate(x - width / 4, 0);
        this.paintLaid(pen, laid, view);
        pen.restore();
        this.tag(pen, label, x + 8, CURTAIN + 8);
      }
      pen.fillStyle = this.colours.panel;
      pen.fillRect(width / 2 - 1.5, 0, 3, height);
    }
    this.scaleBar(pen, scale, height);
  }

  /** Where a sheet begins, its middle in the middle, and again where it ends: what leaves it there comes in again. */
  repeats(sheet, { scale, width }) {
    const wide = sheet * scale;
    const first = (width - wide) / 2;
    const before = Math.ceil(first / wide);
    return Array.from({ length: 2 * Math.max(0, before) + 1 }, (_, k) => first + (k - Math.max(0, before)) * wide);
  }

  paintLaid(pen, laid, view) {
    const { scale, width, height } = view;
    pen.save();
    pen.beginPath();
    pen.rect(0, CURTAIN, width, height - CURTAIN);
    pen.clip();
    pen.fillStyle = this.colours.paper;
    pen.fillRect(0, 0, width, height);
    // The map of before lies there until that of now is complete.
    const under = laid.map ? laid : this.before;
    this.paintMap(pen, under, view);
    if (!laid.map) {
      if (under.map) {
        pen.globalAlpha = 0.45;
        pen.fillRect(0, 0, width, height);
        pen.globalAlpha = 1;
      }
      const [wide, long] = [laid.width * scale, (TILE * laid.width * scale) / laid.across];
      for (const [index, tile] of laid.tiles) {
        // At whole pixels, so that nothing is drawn between them.
        const y = Math.round(CURTAIN + view.top * scale) - (index + 1) * long;
        if (y > height || y + long < 0) continue;
        for (const x of this.repeats(laid.width, view)) pen.drawImage(tile, x, y, wide, long);
      }
    }
    pen.restore();
    const places = laid.width > 0 ? this.repeats(laid.width, view) : [];
    if (!laid.map || places.length === 1) for (const x of places) this.paintCurtain(pen, laid, view, x);
  }

  paintMap(pen, laid, view) {
    if (!laid.map) return;
    const { scale, height, top } = view;
    laid.image ??= imageOf(laid.map, [rgb(this.colours.paper), rgb(this.colours.web)]);
    const { rows, columns, pixel } = laid.map;
    const long = rows * pixel;
    const shown = (height - CURTAIN) / scale;
    // A belt that is longer than the map has it again and again, every second time turned over: without a seam.
    for (let k = Math.floor((top - shown) / long); k * long < top; k++) {
      const y = CURTAIN + (top - (k + 1) * long) * scale;
      pen.save();
      pen.translate(0, k % 2 === 0 ? y : y + long * scale);
      pen.scale(1, k % 2 === 0 ? 1 : -1);
      for (const x of this.repeats(columns * pixel, view)) {
        pen.drawImage(laid.image, x, 0, columns * pixel * scale, long * scale);
      }
      pen.restore();
    }
  }

  /** The filaments on their way down, from about their holes to where each landed last. */
  paintCurtain(pen, { ends, homes, map, width: sheet }, { scale }, left) {
    pen.save();
    pen.strokeStyle = this.colours.lines;
    pen.globalAlpha = map ? 0.35 : 0.8;
    pen.lineWidth = 1;
    pen.beginPath();
    ends.forEach((end, i) => {
      if (!end) return;
      const mean = homes[i].sum / homes[i].count;
      const [home, x] = [mean - sheet * Math.floor(mean / sheet), end[0]].map((across) => left + across * scale);
      pen.moveTo(home, 0);
      // A filament that has left the sheet at one end lands at the other.
      if (Math.abs(x - home) < (sheet * scale) / 2) pen.bezierCurveTo(home, 0.6 * CURTAIN, x, 0.5 * CURTAIN, x, CURTAIN);
    });
    pen.stroke();
    pen.restore();
  }

  tag(pen, text, x, y) {
    pen.font = "600 12px system-ui, sans-serif";
    pen.fillStyle = this.colours.panel;
    pen.fillRect(x, y, pen.measureText(text).width + 12, 20);
    pen.fillStyle = this.colours.ink;
    pen.fillText(text, x + 6, y + 14);
  }

  scaleBar(pen, scale, height) {
    // The longest of 1, 2 or 5 times a power of ten that fits in 160 px.
    const most = 160 / scale;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = power * [5, 2, 1].find((f) => f * power <= most);
    const text = length < 1 ? `${Number((1e3 * length).toPrecision(1))} mm` : `${length} m`;
    pen.fillStyle = this.colours.panel;
    pen.globalAlpha = 0.9;
    pen.fillRect(8, height - 38, length * scale + 16, 30);
    pen.globalAlpha = 1;
    pen.fillStyle = this.colours.ink;
    pen.fillRect(16, height - 15, length * scale, 3);
    pen.font = "12px system-ui, sans-serif";
    pen.fillText(text, 16, height - 20);
  }
}
