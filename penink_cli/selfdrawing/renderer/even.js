// even.js - the lines of an engraving along a field, moved to the middle between their neighbours. The same steps as _evened_out in
// penink_cli/blasting/engraving.py and distances in taking_turns.py, which say why.

// Lines [xs, ys] one after another: {x, y, first, ring, line}.
function inOneRow(lines) {
  const first = [0], ring = [];
  for (const [xs, ys] of lines) { first.push(first[first.length - 1] + xs.length); ring.push(xs[0] === xs[xs.length - 1] && ys[0] === ys[ys.length - 1]); }
  const all = first[lines.length], x = new Float64Array(all), y = new Float64Array(all), line = new Int32Array(all);
  lines.forEach(([xs, ys], k) => { x.set(xs, first[k]); y.set(ys, first[k]); line.fill(k, first[k], first[k + 1]); });
  return {x, y, first, ring, line};
}

// Unit normals of the lines at their points.
function normalsAlong({x, y, line}) {
  const nx = new Float64Array(x.length), ny = new Float64Array(x.length);
  for (let i = 0; i < x.length; i++) {
    const p = line[i - 1] === line[i] ? i - 1 : i, q = line[i + 1] === line[i] ? i + 1 : i, dx = x[q] - x[p], dy = y[q] - y[p], long = Math.max(1e-9, far(dx, dy));
    nx[i] = -dy / long;
    ny[i] = dx / long;
  }
  return [nx, ny];
}

// How far apart lines are at each point, how much more to the normal's side, and whether there is a line on either side.
function distancesOf(row, spacing) {
  const {x, y, line} = row, count = x.length, [nx, ny] = normalsAlong(row), cell = CELL_PART * spacing, near = Math.max(3, Math.round(3 * spacing));
  let left = Infinity, top = Infinity, right = -Infinity, bottom = -Infinity;
  for (let i = 0; i < count; i++) { left = Math.min(left, x[i]); right = Math.max(right, x[i]); top = Math.min(top, y[i]); bottom = Math.max(bottom, y[i]); }
  left -= cell;
  top -= cell;
  const columns = Math.floor((right - left) / cell) + 2, rows = Math.floor((bottom - top) / cell) + 2, there = new Int32Array(columns * rows).fill(-1);
  for (let i = 0; i < count; i++) {
    const after = line[i + 1] === line[i] ? i + 1 : i;
    let before = -1, beside = -1;                             // cells edge to edge, so that no ray slips through a corner
    for (let n = 0; n < (after === i ? 1 : 5); n++) {
      const a = (x[i] + n / 4 * (x[after] - x[i]) - left) / cell | 0, b = (y[i] + n / 4 * (y[after] - y[i]) - top) / cell | 0;
      if (a < 0 || b < 0 || a >= columns || b >= rows) continue;
      if (n < 4) there[b * columns + a] = n < 2 ? i : after;
      if (before >= 0 && before !== a && beside !== b) there[b * columns + before] = n < 2 ? i : after;
      before = a;
      beside = b;
    }
  }
  const apart = new Float64Array(count).fill(spacing), more = new Float64Array(count), both = new Uint8Array(count);
  const beside = (i, way) => {
    for (let n = 0; n < PROBES; n++) {
      const at = way * spacing * (NEAREST + n * PROBE_STEP), a = Math.floor((x[i] + at * nx[i] - left) / cell), b = Math.floor((y[i] + at * ny[i] - top) / cell);
      const hit = a >= 0 && b >= 0 && a < columns && b < rows ? there[b * columns + a] : -1;
      if (hit < 0 || line[hit] === line[i] && Math.abs(hit - i) <= near) continue;
      const cosine = nx[i] * nx[hit] + ny[i] * ny[hit], sign = cosine < 0 ? -0.5 : 0.5;
      if (Math.abs(cosine) <= ALIKE_COSINE) return -1;
      const away = Math.abs((x[hit] - x[i]) * (nx[i] / 2 + sign * nx[hit]) + (y[hit] - y[i]) * (ny[i] / 2 + sign * ny[hit]));
      return clamp(away, LEAST_APART * spacing, MOST_APART * spacing);
    }
    return -1;
  };
  for (let i = 0; i < count; i++) {
    const one = beside(i, 1), other = one < 0 ? -1 : beside(i, -1);
    if (other < 0) continue;
    apart[i] = (one + other) / 2;
    more[i] = one - other;
    both[i] = 1;
  }
  return {apart, more, both, nx, ny};
}

// Means over so many points each way along each line.
function meanAlong(values, {first, line}, reach) {
  const total = new Float64Array(values.length + 1), out = new Float64Array(values.length);
  for (let i = 0; i < values.length; i++) total[i + 1] = total[i] + values[i];
  for (let i = 0; i < values.length; i++) {
    const low = Math.max(i - reach, first[line[i]]), high = Math.min(i + reach + 1, first[line[i] + 1]);
    out[i] = (total[high] - total[low]) / (high - low);
  }
  return out;
}

// Lines [xs, ys] so many points longer at the ends of those that are no rings.
function longer([xs, ys], by) {
  const n = xs.length, on = (at, i, p, q, long) => Array.from({length: by}, (_, k) => at[i] + (at[p] - at[q]) * (k + 1) / long);
  if (n < 2 || xs[0] === xs[n - 1] && ys[0] === ys[n - 1]) return [xs, ys];
  const begin = Math.max(1e-9, far(xs[1] - xs[0], ys[1] - ys[0])), end = Math.max(1e-9, far(xs[n - 1] - xs[n - 2], ys[n - 1] - ys[n - 2]));
  return [xs, ys].map(at => Float64Array.from([...on(at, 0, 0, 1, begin).reverse(), ...at, ...on(at, n - 1, n - 1, n - 2, end)]));
}

// Lines [xs, ys] moved to about the middle between their neighbours, ends prolonged between two that close up; and `wide`, how far
// apart they are then, in parts of the spacing.
function evenedOut(lines, spacing) {
  let row = inOneRow(lines.map(line => longer(line, PROLONGED)));
  const move = () => {
    const {more, nx, ny} = distancesOf(row, spacing), by = meanAlong(more, row, 4);
    for (let i = 0; i < by.length; i++) { row.x[i] += EVENED * by[i] * nx[i]; row.y[i] += EVENED * by[i] * ny[i]; }
    row.ring.forEach((ring, k) => {                           // a ring stays closed
      const a = row.first[k], b = row.first[k + 1] - 1;
      if (ring) for (const at of [row.x, row.y]) at[a] = at[b] = (at[a] + at[b]) / 2;
    });
  };
  const split = (from, upto) => [row.x.slice(from, upto), row.y.slice(from, upto)];
  if (!lines.length) return [];
  for (let round = 0; round < EVENINGS; round++) move();
  // of what was added that is kept which has room
  const {apart, both} = distancesOf(row, spacing), kept = [];
  row.ring.forEach((ring, k) => {
    let from = row.first[k], upto = row.first[k + 1];
    if (!ring) {
      const room = i => both[i] && apart[i] > ROOM * spacing;
      from += PROLONGED;
      upto -= PROLONGED;
      while (from > row.first[k] && room(from - 1)) from--;
      while (upto < row.first[k + 1] && room(upto)) upto++;
    }
    kept.push(split(from, upto));
  });
  row = inOneRow(kept);
  for (let round = 0; round < EVENINGS; round++) move();
  const wide = meanAlong(distancesOf(row, spacing).apart, row, 2).map(d => d / spacing);
  return kept.map((_, k) => [...split(row.first[k], row.first[k + 1]), wide.slice(row.first[k], row.first[k + 1])]);
}
