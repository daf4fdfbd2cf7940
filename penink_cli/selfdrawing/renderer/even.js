// even.js - the lines of an engraving along a field: ends that face each other are joined, lines moved to the middle between their
// neighbours. The same steps as joining.py, taking_turns.py and tracks.py in penink_cli/blasting, which say why.

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

// A function that finds lines beside a line: (i, way) => the sample met first from sample i along its normal (way 1) or against it
// (way -1); -1 for none.
function lookBeside({x, y, line}, nx, ny, spacing) {
  const count = x.length, cell = CELL_PART * spacing, near = Math.max(3, Math.round(3 * spacing));
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
  return (i, way) => {
    for (let n = 0; n < PROBES; n++) {
      const at = way * spacing * (NEAREST + n * PROBE_STEP), a = Math.floor((x[i] + at * nx[i] - left) / cell), b = Math.floor((y[i] + at * ny[i] - top) / cell);
      const hit = a >= 0 && b >= 0 && a < columns && b < rows ? there[b * columns + a] : -1;
      if (hit >= 0 && (line[hit] !== line[i] || Math.abs(hit - i) > near)) return hit;
    }
    return -1;
  };
}

// How far apart lines are at each point, how much more to the normal's side, and whether there is a line on either side.
function distancesOf(row, spacing) {
  const {x, y} = row, count = x.length, [nx, ny] = normalsAlong(row), next = lookBeside(row, nx, ny, spacing);
  const apart = new Float64Array(count).fill(spacing), more = new Float64Array(count), both = new Uint8Array(count);
  const beside = (i, way) => {
    const hit = next(i, way);
    if (hit < 0) return -1;
    const cosine = nx[i] * nx[hit] + ny[i] * ny[hit], sign = cosine < 0 ? -0.5 : 0.5;
    if (Math.abs(cosine) <= ALIKE_COSINE) return -1;
    return clamp(Math.abs((x[hit] - x[i]) * (nx[i] / 2 + sign * nx[hit]) + (y[hit] - y[i]) * (ny[i] / 2 + sign * ny[hit])), LEAST_APART * spacing, MOST_APART * spacing);
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

// Lines [xs, ys], those joined that face each other end to end, as penink_cli/blasting/joining.py joins them. A joined line has the `odd`
// of its first part, and is smoothed as evened() smooths.
function joinedUp(lines, spacing) {
  const row = inOneRow(lines), {x, y, first, ring, line} = row, nx = new Float64Array(x.length), ny = new Float64Array(x.length), tips = [];
  for (let k = 0; k < lines.length; k++) if (!ring[k] && first[k + 1] - first[k] > 2 * JOIN_BACK) for (const end of [0, 1]) {
    const at = end ? first[k + 1] - 1 : first[k], inner = end ? at - JOIN_BACK : at + JOIN_BACK, dx = x[at] - x[inner], dy = y[at] - y[inner], long = Math.max(1e-9, far(dx, dy));
    tips.push({k, end, at, inner, dx: dx / long, dy: dy / long, cut: 0});
    nx[inner] = -dy / long;
    ny[inner] = dx / long;
  }
  const next = lookBeside(row, nx, ny, spacing), reach = JOIN_APART * spacing, cells = new Map(), pairs = [];
  for (const tip of tips) tip.beside = [1, -1].map(way => { const hit = next(tip.inner, way); return hit < 0 ? -1 : line[hit]; });
  tips.forEach(tip => {
    const a = Math.floor(x[tip.at] / reach), b = Math.floor(y[tip.at] / reach);
    for (let j = b - 1; j <= b + 1; j++) for (let i = a - 1; i <= a + 1; i++) for (const other of cells.get(i + "," + j) || []) {
      const wx = x[tip.at] - x[other.at], wy = y[tip.at] - y[other.at], mx = other.dx - tip.dx, my = other.dy - tip.dy, long = Math.max(1e-9, far(mx, my));
      const along = (wx * mx + wy * my) / long, aside = Math.abs(wx * my - wy * mx) / long;
      if (-(tip.dx * other.dx + tip.dy * other.dy) <= JOIN_STRAIGHT || aside >= JOIN_ASIDE * spacing || along >= reach || along <= -JOIN_OVERLAP * spacing) continue;
      if (other.beside.some((k, side) => k >= 0 && k === tip.beside[1 - side])) pairs.push([Math.abs(along) + JOIN_WORSE * aside, other, tip, along, aside]);
    }
    const key = a + "," + b;
    if (!cells.has(key)) cells.set(key, []);
    cells.get(key).push(tip);
  });
  const root = lines.map((_, k) => k), rounds = clamp(Math.round(LINE_SMOOTHING * Math.max(spacing, 3) ** 2), 2, 40), top = k => { while (root[k] !== k) k = root[k]; return k; };
  for (const [, a, b, along, aside] of pairs.sort((p, q) => p[0] - q[0])) {
    if (a.partner || b.partner || top(a.k) === top(b.k)) continue;
    root[top(b.k)] = top(a.k);
    a.partner = b;
    b.partner = a;
    const least = Math.min(first[a.k + 1] - first[a.k], first[b.k + 1] - first[b.k]);
    a.cut = b.cut = clamp(Math.ceil((Math.max(JOIN_SLANT * aside, 2) - along) / 2), 0, Math.max(0, Math.floor(least / 2) - 2));
  }
  const done = new Uint8Array(lines.length), own = new Map(), out = [];
  for (const tip of tips) { if (!own.has(tip.k)) own.set(tip.k, []); own.get(tip.k).push(tip); }
  for (let k = 0; k < lines.length; k++) if (!done[k]) {
    done[k] = 1;
    const both = own.get(k);
    if (!both || !both[0].partner && !both[1].partner) { out.push(lines[k]); continue; }
    const across = tip => own.get(tip.k)[1 - tip.end];
    let entered = both[0];
    while (entered.partner) entered = across(entered.partner);
    const xs = [], ys = [], odd = lines[entered.k].odd;
    for (;;) {
      done[entered.k] = 1;
      const leaves = across(entered), way = entered.end ? -1 : 1;
      for (let i = entered.at + way * entered.cut; i !== leaves.at - way * leaves.cut + way; i += way) {
        if (i === entered.at + way * entered.cut && xs.length) {
          const fx = xs[xs.length - 1], fy = ys[ys.length - 1], steps = Math.max(1, Math.round(far(x[i] - fx, y[i] - fy)));
          for (let n = 1; n < steps; n++) { xs.push(fx + (x[i] - fx) * n / steps); ys.push(fy + (y[i] - fy) * n / steps); }
        }
        xs.push(x[i]);
        ys.push(y[i]);
      }
      if (!leaves.partner) break;
      entered = leaves.partner;
    }
    out.push(Object.assign([softened(xs, rounds), softened(ys, rounds)], {odd}));
  }
  return out;
}

// A line [xs, ys] so many points longer at its ends, straight on.
function longer([xs, ys], more) {
  const n = xs.length, on = (at, i, p, q, long) => Array.from({length: more}, (_, k) => at[i] + (at[p] - at[q]) * (k + 1) / long);
  if (n < 2 || !more) return [xs, ys];
  const begin = Math.max(1e-9, far(xs[1] - xs[0], ys[1] - ys[0])), end = Math.max(1e-9, far(xs[n - 1] - xs[n - 2], ys[n - 1] - ys[n - 2]));
  return [xs, ys].map(at => Float64Array.from([...on(at, 0, 0, 1, begin).reverse(), ...at, ...on(at, n - 1, n - 1, n - 2, end)]));
}

// Lines moved towards the middle between their neighbours, so many times; rings stay closed.
function moveApart(row, spacing, rounds) {
  for (let round = 0; round < rounds; round++) {
    const {more, nx, ny} = distancesOf(row, spacing), by = meanAlong(more, row, 4);
    for (let i = 0; i < by.length; i++) { row.x[i] += EVENED * by[i] * nx[i]; row.y[i] += EVENED * by[i] * ny[i]; }
    row.ring.forEach((ring, k) => {
      const a = row.first[k], b = row.first[k + 1] - 1;
      if (ring) for (const at of [row.x, row.y]) at[a] = at[b] = (at[a] + at[b]) / 2;
    });
  }
}

// Lines [xs, ys] moved to about the middle between their neighbours: {xs, ys, wide, odd}, wide being how far apart they are then, in
// parts of the spacing. Ends are prolonged between two lines that draw together. Where the phase ends two lines in one place, the one that
// is not odd ends sooner, so that the white beside an end is half as wide.
function evenedOut(lines, spacing, {width, height}) {
  if (!lines.length) return [];
  const inside = (x, y) => x > 2 && y > 2 && x < width - 2 && y < height - 2;
  lines = lines.map(line => {
    const [xs, ys] = line, n = xs.length;
    if (line.odd || n < 4 * SOONER || xs[0] === xs[n - 1] && ys[0] === ys[n - 1]) return line;
    const from = inside(xs[0], ys[0]) ? SOONER : 0, upto = n - (inside(xs[n - 1], ys[n - 1]) ? SOONER : 0);
    return Object.assign([xs.slice(from, upto), ys.slice(from, upto)], {odd: 0});
  });
  const {ring} = inOneRow(lines), odd = lines.map(line => line.odd);
  const more = lines.map((_, k) => odd[k] && !ring[k] ? PROLONGED : 0), slice = (row, k, from = row.first[k], upto = row.first[k + 1]) => [row.x.slice(from, upto), row.y.slice(from, upto)];
  let row = inOneRow(lines.map((line, k) => longer(line, more[k])));
  moveApart(row, spacing, EVENINGS);
  // of the points added those are kept that have room
  const {apart, both} = distancesOf(row, spacing), room = i => both[i] && apart[i] > ROOM * spacing;
  lines = lines.map((_, k) => {
    let from = row.first[k] + more[k], upto = row.first[k + 1] - more[k];
    while (from > row.first[k] && room(from - 1)) from--;
    while (upto < row.first[k + 1] && room(upto)) upto++;
    return slice(row, k, from, upto);
  });
  row = inOneRow(lines);
  moveApart(row, spacing, EVENINGS);
  row = inOneRow(lines.map((_, k) => slice(row, k).map(at => softened(at, 4, ring[k]))));
  const wide = meanAlong(distancesOf(row, spacing).apart, row, 2).map(d => d / spacing);
  return lines.map((_, k) => {
    const [xs, ys] = slice(row, k);
    return {xs, ys, wide: wide.slice(row.first[k], row.first[k + 1]), odd: odd[k]};
  });
}
