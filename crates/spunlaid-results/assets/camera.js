// How the fibre's space is seen: x (flow, gravity) runs down the picture, y to the right, z to the viewer.

/**
 * Directions to look from: turned about the vertical, and raised above the horizontal [rad]. Straight views
 * are parallel projections, from which lengths can be read.
 */
const VIEWS = {
  oblique: { yaw: -0.62, pitch: 0.3, perspective: true },
  y: { yaw: 0, pitch: 0, perspective: false },
  z: { yaw: Math.PI / 2, pitch: 0, perspective: false },
  below: { yaw: 0, pitch: -Math.PI / 2, perspective: false },
};

/** How far off the viewer is, in radii of the box. */
const DISTANCE = 5;

class Camera {
  constructor() {
    this.stretch = 1;
    this.fitted = { scale: 1, x: 0, y: 0 };
    this.look("oblique");
    this.frame({ low: [0, -1, -1], high: [1, 1, 1] });
    this.resize(1, 1);
  }

  look(view) {
    Object.assign(this, VIEWS[view], { zoom: 1, shift: [0, 0] });
  }

  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -Math.PI / 2), Math.PI / 2);
  }

  /** Zooms, keeping in place what is at a point of the picture [px], the middle if none is given. */
  zoomBy(factor, x = this.width / 2, y = this.height / 2) {
    const zoom = Math.min(Math.max(this.zoom * factor, 0.3), 60);
    const still = [x - this.width / 2 - this.fitted.x, y - this.height / 2 - this.fitted.y];
    this.shift = this.shift.map((s, i) => still[i] + (s - still[i]) * (zoom / this.zoom));
    this.zoom = zoom;
  }

  /** Moves the picture by so many pixels. */
  move(x, y) {
    this.shift = [this.shift[0] + x, this.shift[1] + y];
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
  }

  /** Looks at the middle of a box given in millimetres. */
  frame(box) {
    this.box = box;
    this.middle = [0, 1, 2].map((k) => 0.5 * (box.low[k] + box.high[k]));
    const half = [0, 1, 2].map((k) => 0.5 * (box.high[k] - box.low[k]) * (k > 0 ? this.stretch : 1));
    this.radius = Math.hypot(...half);
  }

  /** A point seen from the camera: to the right, up, towards the viewer [mm, the sideways ones stretched]. */
  seen([x, y, z]) {
    const a = (y - this.middle[1]) * this.stretch;
    const b = -(x - this.middle[0]);
    const c = (z - this.middle[2]) * this.stretch;
    return this.turned(a, b, c);
  }

  turned(a, b, c) {
    const [cosY, sinY] = [Math.cos(this.yaw), Math.sin(this.yaw)];
    const [cosP, sinP] = [Math.cos(this.pitch), Math.sin(this.pitch)];
    const right = a * cosY + c * sinY;
    const front = c * cosY - a * sinY;
    return [right, b * cosP - front * sinP, b * sinP + front * cosP];
  }

  /** Picture of a direction of length 1 in x, y, z: right, up, towards. */
  direction([x, y, z]) {
    return this.turned(y, -x, z);
  }

  /** Where a point is in the picture [px]. */
  project(point) {
    const { scale, x, y } = this.fitted;
    const [right, up] = this.flat(this.seen(point), scale * this.zoom);
    return [this.width / 2 + x + this.shift[0] + right, this.height / 2 + y + this.shift[1] - up];
  }

  /** Right and up of the middle as drawn, at a scale for the middle of the box [px/mm]. */
  flat([right, up, towards], scale) {
    const distance = DISTANCE * this.radius;
    const near = this.perspective ? distance / Math.max(distance - towards, 0.05 * distance) : 1;
    return [scale * near * right, scale * near * up];
  }

  /** Fits the box into the picture, leaving margins for the labels, at zoom 1. */
  fit(margins) {
    const corners = cornersOf(this.box).map((c) => this.flat(this.seen(c), 1));
    const range = (k) => [Math.min(...corners.map((c) => c[k])), Math.max(...corners.map((c) => c[k]))];
    const [[left, right], [bottom, top]] = [range(0), range(1)];
    const wide = Math.max(this.width - margins.left - margins.right, 60);
    const tall = Math.max(this.height - margins.top - margins.bottom, 60);
    const scale = Math.min(wide / Math.max(right - left, 1e-9), tall / Math.max(top - bottom, 1e-9));
    this.fitted = {
      scale,
      x: (margins.left - margins.right) / 2 - (scale * (left + right)) / 2,
      y: (margins.top - margins.bottom) / 2 + (scale * (top + bottom)) / 2,
    };
  }
}

/** The eight corners of a box; bit k of the index says whether coordinate k is the high one. */
function cornersOf(box) {
  return [...Array(8).keys()].map((i) => [0, 1, 2].map((k) => ((i >> k) & 1 ? box.high[k] : box.low[k])));
}

/**
 * Turns, moves and zooms by mouse, touch and keys on a canvas. `changed` is called after each change; `zooms(event)` says whether the
 * wheel zooms, or scrolls the page; `keys` says what further keys do.
 */
function steer(canvas, camera, { changed, zooms, keys }) {
  const pointers = new Map();
  const apart = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
  });
  canvas.addEventListener("pointermove", (e) => {
    const last = pointers.get(e.pointerId);
    if (!last) return;
    const gap = pointers.size === 2 ? apart() : 0;
    const [dx, dy] = [e.clientX - last.x, e.clientY - last.y];
    pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    // Two fingers pinch and turn; one turns sideways only, since up and down it scrolls the page.
    const gain = 0.008 / pointers.size;
    if (e.shiftKey || e.buttons === 4) camera.move(dx, dy);
    else camera.turn(-dx * gain, dy * gain);
    if (pointers.size === 2) camera.zoomBy(apart() / Math.max(gap, 1));
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (e) => pointers.delete(e.pointerId));
  canvas.addEventListener(
    "wheel",
    (e) => {
      if (!zooms(e)) return;
      e.preventDefault();
      camera.zoomBy(Math.exp(-e.deltaY * (e.deltaMode === 1 ? 0.05 : 0.0015)), e.offsetX, e.offsetY);
      changed();
    },
    { passive: false },
  );
  const acts = {
    ArrowLeft: () => camera.turn(0.1, 0),
    ArrowRight: () => camera.turn(-0.1, 0),
    ArrowUp: () => camera.turn(0, -0.1),
    ArrowDown: () => camera.turn(0, 0.1),
    "+": () => camera.zoomBy(1.2),
    "=": () => camera.zoomBy(1.2),
    "-": () => camera.zoomBy(1 / 1.2),
    ...keys,
  };
  canvas.addEventListener("keydown", (e) => {
    const act = acts[e.key] ?? acts[e.key.toLowerCase()];
    if (!act || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault();
    act();
    changed();
  });
}
