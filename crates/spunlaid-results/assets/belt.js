// A fed fibre above its moving belt. Nodes are numbered in the order of feed, the newest at the inlet has the highest number.

/** Where each shape begins in the positions, and the laid points, unpacked. */
function readBelt({ belt, times, replicates }) {
  let before = 0;
  const starts = belt.counts.map((counts) =>
    counts.map((count) => {
      const start = before;
      before += 3 * count;
      return start;
    }),
  );
  if (belt.counts.length !== replicates.length || belt.newest.length !== times.length) {
    throw new Error("the numbers of the nodes do not fit the instants");
  }
  const laid = belt.laid.map(({ first, points }) => {
    const bytes = Uint8Array.from(atob(points), (c) => c.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    const numbers = Float32Array.from({ length: bytes.length / 4 }, (_, i) => view.getFloat32(4 * i, true));
    return { first, numbers };
  });
  return { starts, laid };
}

/** The shape of a replicate at an instant: a node by its number, the newest number and the oldest. */
function numbered(frames, replicate, instant) {
  const start = frames.starts[replicate][instant];
  const newest = frames.belt.newest[instant];
  const p = frames.positions;
  const at = (number) => {
    const i = start + 3 * (newest - number);
    return [p[i], p[i + 1], p[i + 2]];
  };
  return { at, newest, oldest: newest - frames.belt.counts[replicate][instant] + 1 };
}

/** The fibre in the air at a time: each node goes on its own straight way between two instants. */
function fedShapeAt(frames, replicate, time) {
  const [instant, share] = findInstant(frames.times, time);
  const next = Math.min(instant + 1, frames.times.length - 1);
  const [a, b] = [numbered(frames, replicate, instant), numbered(frames, replicate, next)];
  const since = (time - frames.times[instant]) * 1e3;
  const until = (frames.times[next] - time) * 1e3;
  const shape = [[0, 0, 0]];
  for (let n = b.newest; n >= a.oldest; n--) {
    if (n > a.newest) {
      // Born since: it comes out of the inlet at the feed speed.
      const [x, y, z] = b.at(n);
      const now = x - frames.belt.feed_speed * until;
      if (now > 0) shape.push([now, y * (now / Math.max(x, now)), z * (now / Math.max(x, now))]);
    } else if (n >= b.oldest) {
      const [p, q] = [a.at(n), b.at(n)];
      const mixed = p.map((v, k) => v + share * (q[k] - v));
      if (mixed[0] > 0) shape.push(mixed);
    } else {
      const [x, y, z] = a.at(n);
      shape.push([x, y + frames.belt.speed * since, z]);
    }
  }
  return shape;
}

/** What lies on the belt behind the shape, as far as it is in the picture: lines of points. */
function laidAt(frames, replicate, time, last) {
  const [instant] = findInstant(frames.times, time);
  const { first, numbers } = frames.laid[replicate];
  const { length_mm: height, belt } = frames;
  const run = belt.speed * time * 1e3;
  const lines = [];
  let line = [last];
  for (let n = numbered(frames, replicate, instant).oldest - 1; n >= first; n--) {
    const i = 2 * (n - first);
    if (i + 1 >= numbers.length) continue;
    const y = numbers[i] + run;
    if (y > belt.shown_mm) {
      if (line.length > 1) lines.push(line);
      line = [];
    } else {
      line.push([height, y, numbers[i + 1]]);
    }
  }
  if (line.length > 1) lines.push(line);
  return lines;
}

/** Lines across the belt that move with it, every 50 mm or so, so that its run can be seen. */
function marksAt(frames, box, time) {
  const { belt } = frames;
  const { ticks } = roundTicks(0, belt.shown_mm - box.low[1], 8);
  const apart = ticks.length > 1 ? ticks[1] - ticks[0] : belt.shown_mm;
  const marks = [];
  const phase = (((belt.speed * time * 1e3 - box.low[1]) % apart) + apart) % apart;
  for (let y = box.low[1] + phase; y <= box.high[1]; y += apart) marks.push(y);
  return marks;
}
