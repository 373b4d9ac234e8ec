// Time: what is shown when, and the picture made of it.

/** Times the sideways scale and the speed may be multiplied by. */
const STEPS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];

class Player {
  constructor(frames, scene) {
    Object.assign(this, { frames, scene, playing: false, replicate: 0, ghosts: false, draws: 0 });
    this.start = frames.times[0];
    this.end = frames.times.at(-1);
    this.time = this.start;
    this.bounds = boundsOf(frames);
    this.speeds = STEPS.slice(0, 10).map((s) => 1 / s).reverse().concat([2, 5, 10, 20]);
    this.speed = this.usualSpeed();
    this.stretches = STEPS.filter((s) => s <= Math.max(20 * this.usualStretch(), 100));
    this.trails = this.trailChoices();
    this.trail = this.trails[Math.min(3, this.trails.length - 1)];
    this.stretch = 0;
    this.setStretch(this.usualStretch());
  }

  /** About one swing a second, but not faster than real; without swings the whole in ten seconds. */
  usualSpeed() {
    const { belt, length_mm: length } = this.frames;
    // A fed fibre comes down in about two seconds.
    const falling = belt ? length / 1e3 / belt.feed_speed / 2 : 0;
    const wanted = belt ? falling : this.frames.frequency > 0 ? Math.min(1 / this.frames.frequency, 1) : (this.end - this.start) / 10;
    const off = (speed) => Math.abs(Math.log(speed / Math.max(wanted, 1e-9)));
    return this.speeds.reduce((best, s) => (off(s) < off(best) ? s : best));
  }

  /** Sideways motion drawn up to as wide as the fibre is long, but never shrunk. */
  usualStretch() {
    if (this.frames.belt) return 1;
    const { low, high } = this.bounds;
    const sideways = Math.max(...[1, 2].map((k) => Math.max(Math.abs(low[k]), Math.abs(high[k]))));
    if (sideways < 1e-6 * this.frames.length_mm) return 1;
    const wanted = (0.5 * this.frames.length_mm) / sideways;
    return STEPS.filter((s) => s <= wanted && s <= 1000).at(-1) ?? 1;
  }

  /** Lengths of the trail [s]: none, and up to the whole. */
  trailChoices() {
    const whole = this.end - this.start;
    const swing = this.frames.frequency > 0 ? 1 / this.frames.frequency : whole / 10;
    const some = [0.5, 1, 2, 5, 10, 20].map((n) => n * swing).filter((t) => t < whole);
    return [0, ...some, whole];
  }

  setStretch(stretch) {
    this.stretch = stretch;
    const { camera } = this.scene;
    camera.stretch = stretch;
    this.box = this.boxAround(stretch);
    camera.frame(this.box);
  }

  /** A box of round numbers around all shapes, wide enough to be seen. */
  boxAround(stretch) {
    const { low, high } = this.bounds;
    const { length_mm: length, held } = this.frames;
    const box = { low: [...low], high: [...high] };
    if (held) {
      box.low[0] = Math.min(low[0], 0);
      box.high[0] = Math.max(high[0], length > 4 * (high[0] - low[0]) ? high[0] : length);
    }
    for (const k of [0, 1, 2]) {
      const least = (k > 0 ? 0.1 / stretch : 0.1) * length;
      if (k > 0 && held) {
        box.low[k] = Math.min(box.low[k], 0);
        box.high[k] = Math.max(box.high[k], 0);
      }
      const lacking = least - (box.high[k] - box.low[k]);
      if (lacking > 0) {
        box.low[k] -= lacking / 2;
        box.high[k] += lacking / 2;
      }
      const { ticks } = roundTicks(box.low[k], box.high[k], 6);
      const step = ticks.length > 1 ? ticks[1] - ticks[0] : box.high[k] - box.low[k];
      box.low[k] = Math.floor(box.low[k] / step + 0.02) * step;
      box.high[k] = Math.ceil(box.high[k] / step - 0.02) * step;
    }
    return box;
  }

  /** Goes on by so many seconds on the clock, from the end back to the start. */
  advance(seconds) {
    const span = this.end - this.start;
    if (!(span > 0)) return;
    this.seek(this.start + ((this.time - this.start + seconds * this.speed) % span));
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
  }

  /** One kept instant on or back. */
  step(by) {
    const { times } = this.frames;
    const [instant, share] = findInstant(times, this.time);
    const near = Math.round(instant + share);
    this.time = times[Math.min(Math.max(near + by, 0), times.length - 1)];
  }

  speedText(speed = this.speed) {
    if (speed === 1) return "real speed";
    return speed < 1 ? `1/${Math.round(1 / speed)} of real speed` : `${speed} × real speed`;
  }

  timeText(time = this.time) {
    const span = this.end - this.start;
    const decimals = Math.min(Math.max(Math.ceil(3 - Math.log10(span || 1)), 0), 9);
    return `${time.toFixed(decimals)} s`;
  }

  arrows() {
    const { air_velocity: air, gravity } = this.frames;
    const arrows = [];
    if (air !== 0) arrows.push({ label: `air ${Number(Math.abs(air).toPrecision(3))} m/s`, sign: Math.sign(air), colour: "air" });
    // Three arrows have no room beside the captions of a narrow picture.
    const crowded = this.frames.belt && air !== 0 && this.scene.camera.width < 520;
    if (gravity !== 0 && !crowded) arrows.push({ label: "gravity", sign: Math.sign(gravity), colour: "ink" });
    if (this.frames.belt) arrows.push({ label: `belt ${Number(this.frames.belt.speed.toPrecision(3))} m/s`, along: 1, sign: 1, colour: "trail" });
    return arrows;
  }

  /** Draws the present moment, with more captions below the usual ones. */
  draw(captions = []) {
    const { frames, replicate, time } = this;
    const others = this.ghosts ? frames.replicates.map((_, r) => r).filter((r) => r !== replicate) : [];
    const shape = shapeAt(frames, replicate, time);
    const belt = frames.belt && {
      height: frames.length_mm,
      marks: marksAt(frames, this.box, time),
      laid: laidAt(frames, replicate, time, shape.at(-1)),
    };
    const scale = this.stretch === 1 ? "True to scale" : `Sideways stretched × ${this.stretch}`;
    this.scene.draw({
      box: this.box,
      shape,
      belt,
      ghosts: others.map((r) => shapeAt(frames, r, time)),
      trail: this.trail > 0 && !belt ? trailOf(frames, replicate, Math.max(time - this.trail, this.start), time) : [],
      captions: [
        scale,
        `t = ${this.timeText()}, ${this.speedText()}`,
        `replicate ${frames.replicates[replicate]}${this.ghosts ? ", the others in grey" : ""}`,
        ...captions,
      ],
      arrows: this.arrows(),
      held: frames.held,
    });
    this.draws += 1;
  }
}
