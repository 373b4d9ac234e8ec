// The page's controls.

const byId = (id) => document.getElementById(id);

/** Saves the moving fibre as it stands: dark on white, 3000 pixels wide (25 cm at 300 dpi), named after the case. */
function savePicture(player) {
  const { scene } = player;
  const name = document.body.dataset.name;
  scene.onPaper(3000, () => player.draw([name]));
  const file = `${name.replace(/[^\p{L}\p{N}._-]+/gu, "_")}_fibre.png`;
  scene.canvas.toBlob((blob) => download(file, blob));
  scene.resize();
  player.draw();
}

/** Connects the moving fibre with its controls; returns the player. */
function startMotion(canvas) {
  const frames = readFrames(byId("frames"));
  const camera = new Camera();
  const scene = new Scene(canvas, camera);
  const player = new Player(frames, scene);
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  let visible = true;
  let stale = true;
  let before = null;
  const refresh = () => (stale = true);

  // Choices
  const fill = (select, choices, chosen) =>
    choices.forEach(([value, text]) => select.add(new Option(text, value, false, value === chosen)));
  fill(byId("speed"), player.speeds.map((s) => [s, player.speedText(s)]), player.speed);
  fill(byId("replicate"), frames.replicates.map((n, i) => [i, `${n}`]), 0);
  const [scale, trail, scrub] = [byId("scale"), byId("trail"), byId("scrub")];
  scale.max = player.stretches.length - 1;
  trail.max = player.trails.length - 1;
  const show = () => {
    scale.value = player.stretches.indexOf(player.stretch);
    trail.value = player.trails.indexOf(player.trail);
    byId("scale-value").textContent = `× ${player.stretch}`;
    byId("trail-value").textContent = player.trail > 0 ? `${Number(player.trail.toPrecision(2))} s` : "none";
    byId("speed").value = player.speed;
    byId("replicate").value = player.replicate;
    byId("ghosts").checked = player.ghosts;
    byId("projection").value = camera.perspective ? "perspective" : "orthographic";
    byId("play").textContent = player.playing ? "Pause" : "Play";
    byId("play").setAttribute("aria-pressed", String(player.playing));
    refresh();
  };
  const on = (id, event, act) =>
    byId(id).addEventListener(event, (e) => {
      act(e.target);
      show();
    });
  const play = (playing) => {
    player.playing = playing;
    before = null;
    show();
  };
  const look = (view) => {
    camera.look(view);
    show();
  };
  const reset = () => {
    player.setStretch(player.usualStretch());
    look("oblique");
  };
  on("speed", "change", (t) => (player.speed = Number(t.value)));
  on("replicate", "change", (t) => (player.replicate = Number(t.value)));
  on("ghosts", "change", (t) => (player.ghosts = t.checked));
  on("scale", "input", (t) => player.setStretch(player.stretches[t.value]));
  on("trail", "input", (t) => (player.trail = player.trails[t.value]));
  on("projection", "change", (t) => (camera.perspective = t.value === "perspective"));
  on("play", "click", () => play(!player.playing));
  on("reset", "click", reset);
  on("scrub", "input", (t) => {
    player.playing = false;
    player.seek(player.start + Number(t.value) * (player.end - player.start));
  });
  document.querySelectorAll("[data-view]").forEach((b) => b.addEventListener("click", () => look(b.dataset.view)));
  byId("snapshot").addEventListener("click", () => savePicture(player));
  byId("ghosts").closest("label").hidden = frames.replicates.length < 2;
  // A fed fibre has no free end to follow.
  trail.closest("label").hidden = Boolean(frames.belt);

  // A page that is being scrolled past the picture goes on scrolling.
  let scrolled = -Infinity;
  addEventListener("scroll", () => (scrolled = performance.now()), { passive: true });
  steer(canvas, camera, {
    changed: refresh,
    zooms: (e) => performance.now() - scrolled >= 300 || e.ctrlKey,
    keys: {
      " ": () => play(!player.playing),
      ",": () => play(false) || player.step(-1),
      ".": () => play(false) || player.step(1),
      r: reset,
    },
  });

  // The clock
  const tick = (now) => {
    if (player.playing && visible) {
      if (before !== null) player.advance(Math.min((now - before) / 1000, 0.1));
      before = now;
      refresh();
    } else {
      before = null;
    }
    if (stale) {
      stale = false;
      player.draw();
      scrub.value = player.end > player.start ? (player.time - player.start) / (player.end - player.start) : 0;
      scrub.setAttribute("aria-valuetext", player.timeText());
      byId("clock").textContent = `${player.timeText()} of ${player.timeText(player.end)}`;
    }
    requestAnimationFrame(tick);
  };
  new ResizeObserver(() => scene.resize() && refresh()).observe(canvas);
  new IntersectionObserver(([entry]) => (visible = entry.isIntersecting)).observe(canvas);
  for (const query of ["(prefers-color-scheme: dark)", "print"]) {
    matchMedia(query).addEventListener("change", () => {
      scene.readColours();
      player.draw();
    });
  }
  scene.resize();
  // Without leave to move: an instant at which the fibre is no longer as straight as it starts.
  if (still.matches) player.seek(player.start + 0.4 * (player.end - player.start));
  play(!still.matches && player.end > player.start);
  player.draw();
  requestAnimationFrame(tick);
  return player;
}

const canvas = byId("fibre");
if (canvas) {
  try {
    const player = startMotion(canvas);
    // For checks: what is on show, and how often it has been drawn.
    window.spunlaidReport = {
      get playing() { return player.playing; },
      get time() { return player.time; },
      get draws() { return player.draws; },
    };
  } catch (error) {
    const message = byId("fibre-error");
    message.textContent = `The animation cannot be shown: ${error.message}`;
    message.hidden = false;
    throw error;
  }
}
