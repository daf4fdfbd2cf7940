// engrave.js - lines evenly far apart whose width is the tone (penink_cli/blasting/engraving.py says why; engrave.ps has the
// same straight lines and rings).

// The middle lines of an engraving where the window needs them: {xs, ys, wide, odd}. wide: how far lines are from one another at each
// point, in parts of the spacing. across: the lines of the second set are wanted.
function tracksOf(sheet, every, across) {
  const {layer, width, height, blocks, unit} = sheet, {engraving, field} = layer, out = [];
  const spacing = engraving.lines ? width / engraving.lines : engraving.spacing;
  if (field) {
    // every second line is one on which the phase is 0, the others are half way
    const density = new Float32Array(sheet.tone.length).fill(1 / spacing / 2), walls = wallsOf(sheet);
    const found = linesAlong(sheet, +across, across ? CROSS_ANGLE : 0, density, null, every, walls, Math.max(spacing, 3), [0, 0.5]);
    found.forEach((lines, odd) => { for (const line of lines) line.odd = odd; });
    // in haste they stay where the phase has them
    if (every > 1) return {tracks: found.flat().map(([xs, ys], k) => ({xs, ys, odd: k < found[0].length ? 0 : 1})), spacing};
    return {tracks: evenedOut(joinedUp(found.flat(), spacing), spacing, sheet), spacing};
  }
  const left = blocks.x0 / unit - 2, top = blocks.y0 / unit - 2, right = blocks.x1 / unit + 2, bottom = blocks.y1 / unit + 2;
  if (engraving.centre && !across) {
    const cx = engraving.centre[0] * width, cy = engraving.centre[1] * height, nearX = clamp(cx, left, right), nearY = clamp(cy, top, bottom);
    const near = far(nearX - cx, nearY - cy), farthest = Math.max(...[left, right].map(x => Math.max(far(x - cx, top - cy), far(x - cx, bottom - cy))));
    // the angles at which the window is seen from the centre
    let from = 0, upto = 2 * Math.PI;
    if (near > 0) {
      const middle = Math.atan2((top + bottom) / 2 - cy, (left + right) / 2 - cx);
      const off = [[left, top], [right, top], [left, bottom], [right, bottom]].map(([x, y]) => { const a = Math.atan2(y - cy, x - cx) - middle; return a - 2 * Math.PI * Math.round(a / 2 / Math.PI); });
      from = middle + Math.min(...off);
      upto = middle + Math.max(...off);
    }
    for (let k = Math.max(0, Math.ceil(near / spacing - 1)); (k + 0.5) * spacing < farthest + spacing; k++) {
      const radius = (k + 0.5) * spacing, per = 2 * Math.PI / Math.max(8, Math.ceil(2 * Math.PI * radius)), xs = [], ys = [];
      for (let i = Math.floor(from / per); i <= Math.ceil(upto / per); i++) { xs.push(cx + radius * Math.cos(i * per)); ys.push(cy + radius * Math.sin(i * per)); }
      if (!near) { xs[xs.length - 1] = xs[0]; ys[ys.length - 1] = ys[0]; }
      out.push({xs, ys, odd: k & 1});
    }
    return {tracks: out, spacing};
  }
  const angle = (engraving.angle + (across ? CROSS_ANGLE : 0)) * Math.PI / 180, c = Math.cos(angle), s = Math.sin(angle), us = [], vs = [], {waver} = engraving, turn = 2 * Math.PI / GRAIN;
  for (const [x, y] of [[left, top], [right, top], [left, bottom], [right, bottom]]) { us.push(x * c + y * s); vs.push(y * c - x * s); }
  const away = waver * WAVER_PT + spacing;
  for (let k = Math.floor((Math.min(...vs) - away) / spacing); k * spacing < Math.max(...vs) + away; k++) {
    const xs = [], ys = [], wide = waver ? [] : null, v = (k + 0.5) * spacing;
    for (let u = Math.floor(Math.min(...us)); u <= Math.max(...us) + 1; u++) {
      let w = v;
      if (waver) {
        const a = turn * (u + v / WAVE[1]), b = turn * (WAVE[3] * u - v / WAVE[4]), by = waver * WAVER_PT;
        w += by * (WAVE[0] * Math.sin(a) + WAVE[2] * Math.sin(b));
        const along = by * turn * (WAVE[0] * Math.cos(a) + WAVE[2] * WAVE[3] * Math.cos(b));
        wide.push((1 + by * turn * (WAVE[0] * Math.cos(a) / WAVE[1] - WAVE[2] * Math.cos(b) / WAVE[4])) / Math.sqrt(1 + along * along));
      }
      const x = u * c - w * s, y = u * s + w * c;
      if (x < left || y < top || x > right || y > bottom) { if (wide) wide.pop(); if (xs.length) break; continue; }
      xs.push(x);
      ys.push(y);
    }
    if (xs.length > 1) out.push({xs, ys, wide, odd: k & 1});
  }
  return {tracks: out, spacing};
}

// Draws the lines of a layer: calls fill(layer, xs, ys) with their outlines, in units. Their width is the tone; where there is other
// ink, the tone is less by as much.
function engrave(sheet, every, fill) {
  const {layer, blocks} = sheet;
  if (blocks.bare.some(part => part < 1)) {
    const lack = sheet.lacking(true);
    lack.forEach((more, k) => { blocks.bare[k] *= 1 - sheet.own[k]; });
    sheet.correct(lack);
  }
  for (const across of layer.engraving.crosses < 1 ? [false, true] : [false]) {
    const {tracks, spacing} = tracksOf(sheet, every, across), walls = wallsOf(sheet);
    for (const track of tracks) {
      track.across = across;
      cutAtWalls(sheet, track, walls);
      const {cuts} = track;
      for (let from = 0, upto; from < cuts.length; from = upto + 1) {
        for (upto = from; upto + 1 < cuts.length && cuts[upto] < 0;) upto++;
        stretch(sheet, track, spacing, from, upto, (xs, ys) => fill(layer, xs, ys));
      }
    }
  }
}

// The part of a tone that one of two sets of lines makes: above the tone `crosses` both sets grow.
function partOf(t, crosses, across) {
  if (t <= crosses) return across ? 0 : t;
  const first = crosses + (t - crosses) / 2;
  return across ? 1 - (1 - t) / Math.max(1e-3, 1 - first) : first;
}

// Keeps with a line where walls cut it between one point and the next.
function cutAtWalls(sheet, track, walls) {
  const {xs, ys} = track;
  track.cuts = new Float32Array(xs.length).fill(-1);
  if (sheet.layer.picture.count) for (let i = 0; i + 1 < xs.length; i++) track.cuts[i] = wallBetween(sheet, walls, xs[i], ys[i], xs[i + 1], ys[i + 1]);
  track.begin = chance(xs[0] * 7.3, ys[0] * 5.1);
  track.walls = walls;
}

// The tone that a line is to make of tone t: in light tones every second line leaves off, and the others do its part.
function takenUp(t, finest, odd) {
  const [none, all] = LEAVES_OFF, left = clamp((t - none * finest) * all / (all - none), 0, t);
  return t >= all * finest ? t : odd ? left : 2 * t - left;
}

// The runs of a line between two walls.
function stretch(sheet, track, spacing, from, upto, fill) {
  const {tone, perX, perY, x0, y0, wide: across, tall, gain, layer: {engraving, pen}} = sheet, {xs, ys, cuts, wide} = track, many = upto - from + 1, n = xs.length;
  if (many < 2) return;
  const got = new Float64Array(many), widths = new Float64Array(many), drawn = new Uint8Array(many), added = gain * pen;
  for (let i = 0; i < many; i++)
    got[i] = partOf(tone[clamp(Math.floor(ys[from + i] * perY) - y0, 0, tall - 1) * across + clamp(Math.floor(xs[from + i] * perX) - x0, 0, across - 1)] / 255, engraving.crosses, track.across);
  for (let round = 0; round < 2; round++) for (let i = 0, before = got[0]; i < many; i++) {
    const here = got[i];
    got[i] = (before + 2 * here + got[Math.min(i + 1, many - 1)]) / 4;
    before = here;
  }
  let saw = track.begin;
  for (let i = 0; i < many; i++) {
    const k = Math.min(from + i, upto - 1), dx = xs[k + 1] - xs[k], dy = ys[k + 1] - ys[k], long = Math.max(1e-6, far(dx, dy)), share = wide ? wide[from + i] : 1;
    const gained = added * FILLED * (Math.abs(dx) + Math.abs(dy)) / long, apart = spacing * share, finest = (engraving.finest + gained) / apart, t = takenUp(got[i], finest, track.odd), duty = t / finest;
    saw += long / clamp(DASH_PT / Math.max(duty, 1e-3), SHORTEST_PERIOD_PT, LONGEST_PERIOD_PT);
    drawn[i] = duty >= 1 || saw - Math.floor(saw) < duty && t > LEAST_TONE ? 1 : 0;
    const width = clamp(t, finest, MOST_TONE) * apart - gained;
    widths[i] = Math.max(0.02, width + clamp((t - MOST_TONE) / (1 - MOST_TONE), 0, 1) * (CLOSED * apart - width));
  }
  for (let a = 0, b; a < many; a = b + 1) {
    if (!drawn[a]) { b = a; continue; }
    for (b = a; b + 1 < many && drawn[b + 1];) b++;
    // an end is bounded at a wall, at the frame, and where a ring closes; others are free and taper
    const walledA = a === 0 && from > 0, walledB = b === many - 1 && cuts[upto] >= 0, long = b - a + 1, ring = xs[0] === xs[n - 1] && ys[0] === ys[n - 1];
    const bounded = k => ring || xs[k] < 1 || ys[k] < 1 || xs[k] > sheet.width - 1 || ys[k] > sheet.height - 1;
    const freeA = a > 0 || !walledA && !bounded(from), freeB = b < many - 1 || !walledB && !bounded(upto);
    const leftX = [], leftY = [], rightX = [], rightY = [], dash = !engraving.blunt && (freeA || freeB) && long < DASHES * DASH_PT;
    const tapers = engraving.blunt ? 0 : dash ? DASH_TAPER * long : Math.min(TAPER_PT, TAPER_SHARE * long), even = dash ? 1 / (1 - DASH_TAPER * (freeA + freeB) / 2) : 1;
    const tip = (k, way, side, w) => {
      const i = way < 0 ? Math.max(from, k - 1) : Math.min(upto, k + 1), ux = (xs[i] - xs[k]) / 2, uy = (ys[i] - ys[k]) / 2, d = Math.max(1e-6, far(ux, uy)) * way;
      return i === k ? [xs[k], ys[k]] : [xs[k] + ux + side * uy / d * w, ys[k] + uy - side * ux / d * w];
    };
    for (let i = a; i <= b; i += i < b && i + 2 > b ? 1 : 2) {
      const k = from + i, p = Math.max(from, k - 1), q = Math.min(upto, k + 1), dx = xs[q] - xs[p], dy = ys[q] - ys[p], d = Math.max(1e-6, far(dx, dy));
      let w = widths[i] * even;
      if (tapers) {
        const inward = Math.min(freeA ? (i - a + 0.5) / tapers : 1, freeB ? (b - i + 0.5) / tapers : 1);
        const full = Math.max(inward, clamp((w / spacing - BLUNT) / (1 - BLUNT), 0, 1));
        if (full < 1) w = Math.min(TIP_PT, w) * (1 - full) + w * full;
      }
      w /= 2;
      leftX.push(xs[k] + dy / d * w); leftY.push(ys[k] - dx / d * w);
      rightX.push(xs[k] - dy / d * w); rightY.push(ys[k] + dx / d * w);
    }
    for (const [free, k, way, last] of [[freeA, from + a, -1, 0], [freeB, from + b, 1, leftX.length - 1]]) if (free) {
      const w = far(leftX[last] - xs[k], leftY[last] - ys[k]) * (engraving.blunt ? 1 : 0.5);
      for (const [sx, sy, side] of [[leftX, leftY, 1], [rightX, rightY, -1]]) {
        const [x, y] = tip(k, way, side, w);
        if (way < 0) { sx.unshift(x); sy.unshift(y); } else { sx.push(x); sy.push(y); }
      }
    }
    // ends at walls are cut as the wall runs
    const {walls} = track;
    for (const [walled, end, cut] of [[walledA, a, cuts[from - 1]], [walledB, b, cuts[upto]]]) if (walled) {
      const k = from + end, [k0, k1] = end === a && walledA ? [from - 1, from] : [upto, upto + 1], ux = xs[k1] - xs[k0], uy = ys[k1] - ys[k0];
      const last = end === a && walledA ? 0 : leftX.length - 1, put = last ? "push" : "unshift", inwards = end === a && walledA ? 1 - cut : cut;
      for (const [sx, sy] of [[leftX, leftY], [rightX, rightY]]) {
        const x = sx[last], y = sy[last], way = end === a && walledA ? -1 : 1;
        let t = wallBetween(sheet, walls, x, y, x + way * ux, y + way * uy);
        if (t < 0) t = wallBetween(sheet, walls, x, y, x - way * ux, y - way * uy) >= 0 ? 0 : inwards;
        sx[put](x + way * t * ux);
        sy[put](y + way * t * uy);
      }
    }
    fill(leftX.concat(rightX.reverse()), leftY.concat(rightY.reverse()));
  }
}
