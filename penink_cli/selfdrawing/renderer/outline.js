// outline.js - outline strokes: smooth curves along chains of edges that swell as a hand's do and keep clear of one another.
// The same steps as outline.ps; penink_cli/blasting/outlines.py says why.

// Outlines of a layer in the part of the picture that matters, in its units: [xs, ys, pen]. Their ink is added to the blocks.
function outlinesOf({picture, outlines, outlinePen, magnification: unit}, blocks) {
  const {side, bare} = blocks, width = blocks.width / unit, height = blocks.height / unit, found = [], ink = new Float64Array(bare.length);
  const x0 = blocks.x0 / unit, y0 = blocks.y0 / unit, x1 = blocks.x1 / unit, y1 = blocks.y1 / unit;
  // which cells, of half the distance to keep, are near ink
  const cell = Math.max(CLEAR / 2 * outlinePen, Math.max(x1 - x0, y1 - y0) / 2000), columns = Math.ceil((x1 - x0) / cell) + 6;
  const taken = new Uint8Array(columns * (Math.ceil((y1 - y0) / cell) + 6)), inside = (x, y) => x >= x0 && y >= y0 && x < x1 && y < y1;
  const cellAt = (x, y) => (Math.floor((y - y0) / cell) + 3) * columns + Math.floor((x - x0) / cell) + 3;
  outlines.forEach(({xs, ys, pressure}, number) => {
    const pen = outlinePen * (pressure || 255) / 255, [px, py, along] = curve(xs.map(x => (x + 0.5) * width / picture.w),
      ys.map(y => (y + 0.5) * height / picture.h), width / picture.w / 10, x0, y0, x1, y1), last = px.length - 1;
    const free = px.map((x, k) => !inside(x, py[k]) || !taken[cellAt(x, py[k])]), ring = free.every(is => is) && closed(px, py);
    px.forEach((x, k) => {
      if (inside(x, py[k])) for (let j = -2; j <= 2; j++) for (let i = -2; i <= 2; i++)
        if (i * i + j * j <= 5) taken[cellAt(x, py[k]) + j * columns + i] = 1;
    });
    for (let from = 0, to; from <= last; from = to + 1) {
      for (to = from; to < last && free[from] && free[to + 1];) to++;
      const long = along[to] - along[from];
      if (!free[from] || to === from || (to - from < last && long < SHORTEST * outlinePen)) continue;
      // pieces that the pen's pressure leaves of equal width are one stroke
      let start = from, wide = 0, state = SEED + SEED_STEP * number, knot = -1, before, index = -1;
      const random = () => (state = (state * CHAIN_FACTOR + CHAIN_STEP) % 65536, (state >> 8) / 128 - 1);
      const put = upto => found.push([px.slice(start, upto + 1), py.slice(start, upto + 1), wide]);
      let after = random();
      for (let k = from + 1; k <= to; k++) {
        if (index !== Math.floor(along[k] / PIECE)) {
          index = Math.floor(along[k] / PIECE);
          const middle = (index + 0.5) * PIECE, at = middle / PRESSURE_LONG;
          while (knot < Math.floor(at)) { before = after; after = random(); knot++; }
          const t = ring ? 1 : clamp(Math.min(middle - along[from], along[to] - middle) / Math.min(TAPER, long / 2), 0, 1);
          const swell = (THIN + (1 - THIN) * t * (2 - t)) * (1 + PRESSURE * (before + (after - before) * smooth(at - knot)));
          const now = pressure ? pen * Math.max(0.3, Math.floor(20 * swell + 0.5) / 20) : pen + WIDENED / unit;
          if (now !== wide) {
            if (wide) put(k - 1);
            start = k - 1;
            wide = now;
          }
        }
        const x = (px[k] + px[k - 1]) / 2, y = (py[k] + py[k - 1]) / 2;
        if (inside(x, y)) ink[(Math.floor(y * unit / side) - blocks.top) * blocks.across + Math.floor(x * unit / side) - blocks.left] +=
          wide * (along[k] - along[k - 1]);
      }
      put(to);
    }
  });
  blocks.cover(ink.map(area => area * unit * unit));
  return found;
}

const closed = (xs, ys) => xs.length > 3 && xs[0] === xs[xs.length - 1] && ys[0] === ys[ys.length - 1];

// Which way a curve turns at each point, and a third of its direction there; none at corners and ends.
function turns(xs, ys) {
  const last = xs.length - 1, ring = closed(xs, ys);
  return xs.map((x, i) => {
    const a = i ? i - 1 : ring ? last - 1 : 0, b = i < last ? i + 1 : ring ? 1 : last;
    const ax = x - xs[a], ay = ys[i] - ys[a], bx = xs[b] - x, by = ys[b] - ys[i], dot = ax * bx + ay * by;
    // a corner turns by more than 50 degrees
    return dot > 0 && 2.42 * dot * dot >= (ax * ax + ay * ay) * (bx * bx + by * by) ? [(ax + bx) / 6, (ay + by) / 6, (bx - ax) / 4, (by - ay) / 4] : [0, 0, 0, 0];
  });
}

// Points about a unit apart on a smooth curve through the given ones, where it is in or near the window, and the way up to
// each. The given points are no more exact than `slack`: by so much at the most they give way to a smoother course.
function curve(xs, ys, slack, x0, y0, x1, y1) {
  const eased = turns(xs, ys).map(([, , x, y]) => { const by = 1 / Math.max(1, far(x, y) / slack); return [x * by, y * by]; });
  xs = xs.map((x, i) => x + eased[i][0]);
  ys = ys.map((y, i) => y + eased[i][1]);
  const px = [xs[0]], py = [ys[0]], along = [0], last = xs.length - 1, lean = turns(xs, ys);
  for (let i = 1, way = 0; i <= last; i++) {
    const ax = xs[i - 1], ay = ys[i - 1], bx = xs[i], by = ys[i], long = far(bx - ax, by - ay), [lx, ly] = lean[i - 1], [mx, my] = lean[i];
    const away = Math.max(ax, bx) < x0 - long || Math.min(ax, bx) > x1 + long || Math.max(ay, by) < y0 - long || Math.min(ay, by) > y1 + long;
    const parts = away ? 1 : Math.max(1, Math.ceil(long));
    for (let k = 1; k <= parts; k++) {
      const t = k / parts, r = 1 - t, a = r * r * r, b = 3 * r * r * t, c = 3 * r * t * t, d = t * t * t;
      px.push(k < parts ? a * ax + b * (ax + lx) + c * (bx - mx) + d * bx : bx);
      py.push(k < parts ? a * ay + b * (ay + ly) + c * (by - my) + d * by : by);
      along.push(way + long * t);
    }
    way += long;
  }
  return [px, py, along];
}
