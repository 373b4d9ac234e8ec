// The kept shapes of the fibre, unpacked from the page.

/**
 * Reads the shapes: 16-bit levels of x, y, z per replicate, instant and node, in millimetres once unpacked.
 */
function readFrames(element) {
  const data = JSON.parse(element.textContent);
  const bytes = Uint8Array.from(atob(data.positions), (c) => c.charCodeAt(0));
  const levels = new DataView(bytes.buffer);
  const positions = new Float32Array(bytes.length / 2);
  for (let i = 0; i < positions.length; i++) {
    positions[i] = data.origin_mm[i % 3] + data.step_mm[i % 3] * levels.getUint16(2 * i, true);
  }
  if (data.belt) return { ...data, positions, ...readBelt(data) };
  const expected = data.replicates.length * data.times.length * data.nodes * 3;
  if (positions.length !== expected) {
    throw new Error(`${positions.length} coordinates of the fibre instead of ${expected}`);
  }
  return { ...data, positions };
}

/** Index of the last instant at or before a time, and how far on towards the next it is, from 0 to 1. */
function findInstant(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const span = times[high] - times[low];
  const share = span > 0 ? Math.min(Math.max((time - times[low]) / span, 0), 1) : 0;
  return [low, share];
}

/** The shape of a replicate at a time, linear between instants: `[x, y, z]` per node. */
function shapeAt(frames, replicate, time) {
  if (frames.belt) return fedShapeAt(frames, replicate, time);
  const [instant, share] = findInstant(frames.times, time);
  const next = Math.min(instant + 1, frames.times.length - 1);
  const start = (i) => (replicate * frames.times.length + i) * frames.nodes * 3;
  const [a, b] = [start(instant), start(next)];
  const p = frames.positions;
  const shape = [];
  for (let n = 0; n < 3 * frames.nodes; n += 3) {
    const mix = (k) => p[a + n + k] + share * (p[b + n + k] - p[a + n + k]);
    shape.push([mix(0), mix(1), mix(2)]);
  }
  return shape;
}

/** Where the free end of a replicate was between two times, the second included. */
function trailOf(frames, replicate, from, to) {
  const trail = [];
  const first = findInstant(frames.times, from)[0];
  const last = findInstant(frames.times, to)[0];
  const stride = Math.max(1, Math.ceil((last - first) / 2000));
  for (let i = first; i <= last; i += stride) {
    const at = ((replicate * frames.times.length + i + 1) * frames.nodes - 1) * 3;
    trail.push([frames.positions[at], frames.positions[at + 1], frames.positions[at + 2]]);
  }
  trail.push(shapeAt(frames, replicate, to).at(-1));
  return trail;
}

/** Least and largest x, y and z over all shapes. */
function boundsOf(frames) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, frames.belt ? frames.belt.shown_mm : -Infinity, -Infinity];
  frames.positions.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  // Nodes above the inlet are not drawn.
  if (frames.belt) [low[0], high[0]] = [0, frames.length_mm];
  return { low, high };
}
