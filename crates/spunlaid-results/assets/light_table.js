// The light table: the whole web as a picture, single fibres where one looks closely.

/** Bytes of base64 text. */
const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** The fibres of the window as paths, in mm from its corner: [x, y, x, y, …] each. A scan has none. */
function readStrands(window) {
  if (!window) return [];
  const numbers = new Float32Array(bytesOf(window.points).buffer);
  let at = 0;
  return window.counts.map((count) => numbers.subarray(at, (at += 2 * count)));
}

/** 32-bit numbers of base64 text, so many together. */
function groupsOf(text, size) {
  const numbers = new Float32Array(bytesOf(text).buffer);
  return Array.from({ length: numbers.length / size }, (_, i) => numbers.subarray(i * size, (i + 1) * size));
}

/** The places that are worth a look, all lengths in mm; nothing on a page without them. */
function readMarks(marks) {
  if (!marks) return null;
  const strips = ([all, weakest]) => ({ all: groupsOf(all, 4), weakest: groupsOf(weakest, 4) });
  return {
    thin: groupsOf(marks.thin, 4),
    thinnest: groupsOf(marks.thinnest, 5),
    stripsMd: strips(marks.strips[0]),
    stripsCd: strips(marks.strips[1]),
    streaks: groupsOf(marks.streaks, 4),
  };
}

/** Shows the picture on the canvas, where it can be moved; without a script the picture stands alone. */
function startTable(canvas, image, data) {
  const strands = readStrands(data.window);
  const pen = canvas.getContext("2d");
  const byId = (id) => document.getElementById(id);
  // Middle of the view [mm] and pixels per mm.
  const view = { x: 0, y: 0, scale: 1 };
  const chance = byId("chance");
  // Pixels of the pictures for one of the page while they are saved; else as many as the screen has.
  let sharpness = 0;
  const ratio = () => sharpness || devicePixelRatio || 1;
  const size = () => [canvas.clientWidth, canvas.clientHeight];
  /** Scales at which the whole web is in the frame, and at which it fills the frame. */
  const whole = () => Math.min(size()[0] / data.width, size()[1] / data.length);
  const full = () => Math.max(size()[0] / data.width, size()[1] / data.length);

  function drawFibres() {
    if (!data.window) return;
    const { corner, sides, diameter } = data.window;
    const [width, height] = size();
    const x = width / 2 + (corner[0] - view.x) * view.scale;
    const y = height / 2 + (corner[1] - view.y) * view.scale;
    const drawn = diameter * view.scale;
    // Single fibres appear as one comes closer.
    const shown = Math.min(1, Math.max(0, (view.scale * Math.max(...sides)) / Math.min(width, height) - 0.15) * 3);
    pen.save();
    pen.strokeStyle = "#8a7f63";
    pen.lineWidth = 1;
    pen.strokeRect(x, y, sides[0] * view.scale, sides[1] * view.scale);
    if (shown > 0) {
      pen.beginPath();
      pen.rect(x, y, sides[0] * view.scale, sides[1] * view.scale);
      pen.clip();
      pen.globalAlpha = shown;
      pen.fillStyle = "#fdfaf0";
      pen.fillRect(x, y, sides[0] * view.scale, sides[1] * view.scale);
      pen.globalAlpha = shown * Math.min(0.85, Math.max(0.3, drawn));
      pen.strokeStyle = "#1a1a1a";
      pen.lineJoin = "round";
      pen.lineWidth = Math.max(drawn, 0.6);
      for (const strand of strands) {
        pen.beginPath();
        for (let i = 0; i < strand.length; i += 2) pen.lineTo(x + strand[i] * view.scale, y + strand[i + 1] * view.scale);
        pen.stroke();
      }
    }
    pen.restore();
  }

  const marks = readMarks(data.marks);
  // Which marks are shown.
  const chosen = {};

  /** Rectangles on the picture, never thinner than can be seen. */
  function drawRectangles(rectangles, colour, isFilled) {
    const [width, height] = size();
    pen.strokeStyle = pen.fillStyle = colour;
    for (const [x, y, across, along] of rectangles) {
      const at = [width / 2 + (x - view.x) * view.scale, height / 2 + (y - view.y) * view.scale];
      const sides = [Math.max(across * view.scale, 1.5), Math.max(along * view.scale, 1.5)];
      if (isFilled) pen.fillRect(...at, ...sides);
      else pen.strokeRect(...at, ...sides);
    }
  }

  function drawMarks() {
    if (!marks) return;
    pen.save();
    pen.lineWidth = 1;
    if (chosen.streaks) {
      drawRectangles(marks.streaks, "rgba(204, 121, 167, 0.28)", true);
      drawRectangles(marks.streaks, "#cc79a7", false);
    }
    for (const strips of [chosen.stripsMd && marks.stripsMd, chosen.stripsCd && marks.stripsCd]) {
      if (!strips) continue;
      drawRectangles(strips.all, "#0072b2", false);
      drawRectangles(strips.weakest, "rgba(213, 94, 0, 0.55)", true);
    }
    if (chosen.thin) {
      drawRectangles(marks.thin, "rgba(213, 94, 0, 0.5)", true);
      drawRectangles(marks.thinnest, "#d55e00", false);
    }
    pen.restore();
  }

  /** A button for each kind of mark that the web has. */
  function offerMarks() {
    if (!marks) return;
    for (const label of byId("marks").querySelectorAll("label")) {
      const kind = label.dataset.marks;
      const box = label.querySelector("input");
      const count = (marks[kind].all ?? marks[kind]).length;
      label.hidden = count === 0;
      chosen[kind] = box.checked && count > 0;
      box.addEventListener("change", () => {
        chosen[kind] = box.checked;
        requestAnimationFrame(draw);
      });
      if (count > 0) byId("marks").hidden = false;
    }
  }

  /** The thinnest places as small pictures, each of which shows its place. */
  function offerThinnest() {
    if (!marks || marks.thinnest.length === 0) return;
    const AROUND = 6;
    byId("thumbs").hidden = false;
    for (const [x, y, across, along, weight] of marks.thinnest) {
      const button = document.createElement("button");
      button.type = "button";
      const small = document.createElement("canvas");
      [small.width, small.height] = [144, 144];
      const brush = small.getContext("2d");
      const middle = [x + across / 2, y + along / 2];
      const side = AROUND * across;
      brush.fillStyle = "#e9e5d8";
      brush.fillRect(0, 0, 144, 144);
      const scale = 144 / side;
      const pixel = data.pixel * scale;
      const corner = middle.map((at) => 72 - at * scale);
      brush.imageSmoothingEnabled = false;
      brush.drawImage(image, ...corner, image.naturalWidth * pixel, image.naturalHeight * pixel);
      brush.strokeStyle = "#d55e00";
      brush.lineWidth = 2;
      brush.strokeRect(72 - (across * scale) / 2, 72 - (along * scale) / 2, across * scale, along * scale);
      const words = document.createElement("span");
      words.textContent = `${(100 * weight).toPrecision(3)} % at ${middle.map((at) => Number(at.toPrecision(5))).join(", ")} mm`;
      button.append(small, words);
      button.addEventListener("click", () => show(...middle, Math.min(...size()) / side));
      byId("thumbs").append(button);
    }
  }

  function drawScale() {
    const [, height] = size();
    const rough = 120 / view.scale;
    const power = 10 ** Math.floor(Math.log10(rough));
    const bar = [5, 2, 1].find((step) => step * power <= rough) * power;
    const text = bar >= 1000 ? `${bar / 1000} m` : bar >= 1 ? `${bar} mm` : `${Number((bar * 1000).toPrecision(2))} µm`;
    pen.fillStyle = "rgba(253, 250, 240, 0.85)";
    pen.fillRect(10, height - 42, bar * view.scale + 20, 34);
    pen.fillStyle = "#1a1a1a";
    pen.fillRect(20, height - 18, bar * view.scale, 3);
    pen.font = "14px system-ui, sans-serif";
    pen.fillText(text, 20, height - 24);
  }

  function draw() {
    const [width, height] = size();
    [canvas.width, canvas.height] = [width * ratio(), height * ratio()];
    pen.setTransform(ratio(), 0, 0, ratio(), 0, 0);
    pen.fillStyle = "#e9e5d8";
    pen.fillRect(0, 0, width, height);
    const x = width / 2 - view.x * view.scale;
    const y = height / 2 - view.y * view.scale;
    const pixel = data.pixel * view.scale;
    pen.drawImage(image, x, y, image.naturalWidth * pixel, image.naturalHeight * pixel);
    drawFibres();
    drawMarks();
    drawScale();
    drawChance();
  }

  /** What chance alone makes, at the same scale; the piece goes on at all of its edges. */
  function drawChance() {
    if (!chance) return;
    const [width, { height }] = [chance.clientWidth, canvas.getBoundingClientRect()];
    chance.style.height = `${height}px`;
    [chance.width, chance.height] = [width * ratio(), height * ratio()];
    const brush = chance.getContext("2d");
    const pattern = brush.createPattern(byId("tile"), "repeat");
    const pixel = data.pixel * view.scale;
    pattern.setTransform(new DOMMatrix([pixel, 0, 0, pixel, -view.x * view.scale, -view.y * view.scale]));
    brush.setTransform(ratio(), 0, 0, ratio(), 0, 0);
    brush.fillStyle = pattern;
    brush.fillRect(0, 0, width, height);
  }

  /** What is seen, sharp enough for a slide: the pictures with their scale, what they are, and the name of the line. */
  function save() {
    const [GAP, HEAD, FOOT] = [24, 90, 66];
    sharpness = 3;
    draw();
    const panes = [canvas, chance].filter((one) => one && one.width > 0);
    const slide = document.createElement("canvas");
    slide.width = panes.reduce((sum, one) => sum + one.width + GAP, GAP);
    slide.height = HEAD + canvas.height + FOOT;
    const brush = slide.getContext("2d");
    brush.fillStyle = "#fff";
    brush.fillRect(0, 0, slide.width, slide.height);
    brush.fillStyle = "#1a1a1a";
    const { name } = document.body.dataset;
    brush.font = "600 48px system-ui, sans-serif";
    brush.fillText(name, GAP, 62, slide.width - 2 * GAP);
    brush.font = "36px system-ui, sans-serif";
    panes.reduce((left, one) => {
      brush.drawImage(one, left, HEAD);
      brush.fillText(one.parentElement.querySelector("p").textContent, left, slide.height - 22, one.width);
      return left + one.width + GAP;
    }, GAP);
    slide.toBlob((blob) => download(`${name || "web"}.png`, blob));
    sharpness = 0;
    draw();
  }

  const within = (scale) => Math.min(Math.max(scale, whole()), 2000);

  /** Shows a place of the web in the middle of the frame, or as near to it as the web reaches. */
  function show(x, y, scale) {
    view.scale = within(scale);
    const place = (at, side, shown) => (side <= shown ? side / 2 : Math.min(Math.max(at, shown / 2), side - shown / 2));
    const [width, height] = size();
    view.x = place(x, data.width, width / view.scale);
    view.y = place(y, data.length, height / view.scale);
    requestAnimationFrame(draw);
  }

  /** Zooms about a place of the canvas, which stays where it is. */
  function zoom(factor, px = size()[0] / 2, py = size()[1] / 2) {
    const [dx, dy] = [px - size()[0] / 2, py - size()[1] / 2];
    const before = view.scale;
    const after = within(before * factor);
    show(view.x + dx / before - dx / after, view.y + dy / before - dy / after, after);
  }

  const showWhole = () => show(data.width / 2, data.length / 2, whole());
  const fibres = () => {
    const { corner, sides } = data.window;
    show(corner[0] + sides[0] / 2, corner[1] + sides[1] / 2, 1.02 * Math.max(size()[0] / sides[0], size()[1] / sides[1]));
  };
  byId("closer").addEventListener("click", () => zoom(1.6));
  byId("farther").addEventListener("click", () => zoom(1 / 1.6));
  byId("whole").addEventListener("click", showWhole);
  byId("save").addEventListener("click", save);
  byId("fibres")?.addEventListener("click", fibres);
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    zoom(Math.exp(-0.0015 * e.deltaY), e.offsetX, e.offsetY);
  }, { passive: false });

  // One finger moves, two zoom.
  const fingers = new Map();
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
  });
  const lift = (e) => fingers.delete(e.pointerId);
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("pointermove", (e) => {
    const before = fingers.get(e.pointerId);
    if (!before) return;
    const now = [e.offsetX, e.offsetY];
    const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
    if (other) {
      const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      zoom(apart(now) / Math.max(apart(before), 1), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
    } else {
      show(view.x - (now[0] - before[0]) / view.scale, view.y - (now[1] - before[1]) / view.scale, view.scale);
    }
    fingers.set(e.pointerId, now);
  });
  canvas.addEventListener("keydown", (e) => {
    const step = 60 / view.scale;
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    if (moves[e.key]) show(view.x + moves[e.key][0], view.y + moves[e.key][1], view.scale);
    else if (e.key === "+" || e.key === "=") zoom(1.3);
    else if (e.key === "-") zoom(1 / 1.3);
    else if (e.key === "0") showWhole();
    else return;
    e.preventDefault();
  });
  const start = () => {
    offerMarks();
    offerThinnest();
    image.hidden = true;
    canvas.hidden = byId("moves").hidden = false;
    if (chance) byId("beside").hidden = false;
    show(data.width / 2, data.length / 2, Math.max(full(), Math.max(...size()) / data.piece));
    // A frame of another width shows the same part of the web.
    let before = size()[0];
    new ResizeObserver(() => {
      const now = size()[0];
      if (now > 0) show(view.x, view.y, (view.scale * now) / before);
      before = now || before;
    }).observe(canvas);
  };
  Promise.all([image.decode(), byId("tile")?.decode()]).then(start, start);
}

{
  const byId = (id) => document.getElementById(id);
  startTable(byId("table"), byId("sheet"), JSON.parse(byId("web-data").textContent));
}
