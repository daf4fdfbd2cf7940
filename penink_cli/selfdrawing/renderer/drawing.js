// drawing.js - strokes from tone: each stroke is drawn wherever the tone exceeds its threshold.
// The same steps as texture.ps and drawing.ps, which say why.

// Blocks around the window that are reconstructed and corrected with it: tone that lies farther moves no stroke in it visibly.
const MARGIN = 4;

// The fresh ink of a point of a stroke that enters where its screen covers so much.
function freshInk(cover, covers, fresh) {
  let k = 0;
  while (k < covers.length - 1 && covers[k] <= cover) k++;
  return fresh[k];
}

function interpolate(x, xs, ys) {
  if (x <= xs[0]) return ys[0];
  for (let k = 1; k < xs.length; k++)
    if (x <= xs[k]) return ys[k - 1] + (x - xs[k - 1]) / (xs[k] - xs[k - 1]) * (ys[k] - ys[k - 1]);
  return ys[ys.length - 1];
}

const RANK = Array.from({length: LINES}, (_, k) => parseInt(k.toString(2).padStart(8, "0").split("").reverse().join(""), 2));

// How far a line moves aside for those that have entered beside it, for each 64th of the lines.
const WAY = new Float64Array(64 * LINES);
for (let r = 0; r < 64; r++) {
  const there = [...RANK.keys()].filter(k => RANK[k] < 4 * r + 2), home = there.map(k => (k + 0.5) * ACROSS / LINES), n = home.length;
  let at = home;
  for (let round = 0; round < 3; round++)
    at = at.map((v, i) => v / 2 + ((i ? at[i - 1] : at[n - 1] - ACROSS) + (i < n - 1 ? at[i + 1] : at[0] + ACROSS)) / 4);
  there.forEach((k, i) => { WAY[64 * k + r] = (clamp(Math.floor(128.5 + WAY_STEPS * (at[i] - home[i])), 0, 255) - 128) / WAY_STEPS; });
}

// Strokes lie in one array, STROKE numbers each: length, four coefficients of a cubic in u, four in v, limit, weight (the ink of a
// unit of length), line (-1 for none).
const STROKE = 12;
// A table of sines: a call of Math.sin for each sample took half of all the time.
const TURN = 4096, SINE = Float32Array.from({length: TURN}, (_, k) => Math.sin(k * 2 * Math.PI / TURN)), STEPS = TURN / 2 / Math.PI;

// A screen of lines.
function lines(number, angle, low, high, wave, turn, widens) {
  let state = SEED + SEED_STEP * number;
  const random = () => (state = (state * CHAIN_FACTOR + CHAIN_STEP) % 65536) >> 8, spread = () => random() / 128 - 1;
  const strokes = [], span = (high - low) / (1 - low);
  const slopes = PARTS.slice(1).map((part, k) => (COVERS[k + 1] - COVERS[k]) / (part - PARTS[k]) * ACROSS / LINES);
  for (let line = 0; line < LINES; line++) {
    const home = (line + 0.5) * ACROSS / LINES, cover = interpolate((RANK[line] + 0.5) / LINES, PARTS, COVERS);
    const limit = 255 * (low + (1 - low) * cover), weight = freshInk(cover, COVERS.slice(1), slopes);
    let u0 = random() * ALONG / 256;
    for (let left = ALONG; left > 0;) {
      let long = LONG + random() / 8;
      if (left < long + LONG_REST) long = left;
      const a = home + TILT * spread(), b = home + TILT * spread(), push = 3 * BOW * spread();
      if (cover < span) strokes.push(long, u0, long, 0, 0, a, b - a + push, -push, 0, limit, weight, line);
      u0 += long;
      left -= long;
    }
  }
  const level = Uint8Array.from({length: 256}, (_, t) =>
    Math.min(63, Math.floor(64 * interpolate(clamp((t / 255 - low) / (1 - low), 0, 1), COVERS, PARTS))));
  return {angle, strokes: Float64Array.from(strokes), level, tile: [ALONG, ACROSS], whole: false, wave, turn, widens};
}

// A screen of the same strokes half a tile away: from tone low on they cover paper that the screen leaves bare.
function again(screen, low) {
  const move = [0, screen.tile[0] / 2, 0, 0, 0, screen.tile[1] / 2];
  return {...screen, strokes: screen.strokes.map((x, k) => k % STROKE === 9 ? 255 * low + (1 - low) * x : x + (move[k % STROKE] || 0))};
}

// The blocks that all layers share: squares of `side` points of paper, in which ink is compared with tone. They cover the part of
// the picture that matters: the window and a margin around it.
class Blocks {
  constructor(width, height, window, side) {
    const from = x => Math.max(0, Math.floor(x / side) - MARGIN);
    const upto = (x, most) => Math.ceil(Math.min(x / side + MARGIN, most / side) - 1e-9);
    Object.assign(this, {width, height, side, left: from(window[0]), top: from(window[1])});
    this.across = Math.max(0, upto(window[2], width) - this.left);
    this.down = Math.max(0, upto(window[3], height) - this.top);
    this.bare = new Float64Array(this.across * this.down).fill(1);      // the part of each that is still paper
    this.x0 = this.left * side;
    this.y0 = this.top * side;
    this.x1 = Math.min(width, this.x0 + this.across * side);
    this.y1 = Math.min(height, this.y0 + this.down * side);
  }
  area(k) {                                                   // of a block, square points
    const x = this.x0 + k % this.across * this.side, y = this.y0 + Math.floor(k / this.across) * this.side;
    return Math.min(this.side, this.width - x) * Math.min(this.side, this.height - y);
  }
  cover(ink) { ink.forEach((area, k) => { this.bare[k] *= 1 - Math.min(1, area / this.area(k)); }); }     // square points laid on each block
}

// A layer in the part of the picture that matters. Its tone lies on a grid of its own of about a cell a unit.
class Sheet {
  constructor(layer, blocks, gain) {
    const {picture, magnification: unit} = layer, width = blocks.width / unit, height = blocks.height / unit;
    const n = Math.max(picture.w, Math.round(width)), m = Math.max(picture.h, Math.round(height)), perX = n / width, perY = m / height;
    const x0 = Math.floor(blocks.x0 / unit * perX), y0 = Math.floor(blocks.y0 / unit * perY);
    const x1 = Math.min(n, Math.ceil(blocks.x1 / unit * perX)), y1 = Math.min(m, Math.ceil(blocks.y1 / unit * perY));
    Object.assign(this, {layer, blocks, gain: gain / unit / layer.pen, unit, width, height, n, m, perX, perY, x0, y0, wide: x1 - x0, tall: y1 - y0});
    this.tone = picture.tone(n, m, x0, y0, x1, y1);
    if (layer.curve) for (let k = 0; k < this.tone.length; k++) this.tone[k] = layer.curve[this.tone[k]];
    lighten(this, tellingOf(layer, blocks.width, blocks.height, true));
    this.sum = this.tone;                                     // of this layer and those below
  }

  // The tone that another layer's grid has in the cells of this one.
  looked(other, values) {
    const cell = (k, from, per, count) => clamp(Math.floor((k + 0.5) * per) - from, 0, count - 1), out = new Uint8Array(this.tone.length);
    for (let q = 0; q < this.tall; q++) {
      const row = other.wide * cell(this.y0 + q, other.y0, other.m / this.m, other.tall);
      for (let p = 0; p < this.wide; p++) out[q * this.wide + p] = values[row + cell(this.x0 + p, other.x0, other.n / this.n, other.wide)];
    }
    return out;
  }

  // What is darker than black is filled, a row of cells at a time, but for the cells at its border, which strokes draw.
  solid(fill) {
    const {tone, wide, tall, x0, y0, perX, perY, unit, layer} = this, black = 255 * layer.black;
    for (let q = 1; q < tall - 1; q++) for (let p = 1, k = q * wide + 1, first = -1; p < wide; p++, k++) {
      if (p < wide - 1 && tone[k] > black && tone[k - wide] >= black && tone[k + wide] >= black) { if (first < 0) first = p; continue; }
      if (first >= 0 && p - first > 2) {
        const left = (x0 + first + 1) / perX * unit, right = (x0 + p - 1) / perX * unit, top = (y0 + q) / perY * unit, bottom = (y0 + q + 1.06) / perY * unit;  // no seams
        fill(layer, [left, right, right, left], [top, top, bottom, bottom]);
      }
      first = -1;
    }
  }

  // The greatest tone in and around patches.
  patches() {
    const {tone, wide, tall} = this, patchX = this.patchX = Math.floor(wide / this.perX / PATCH), patchY = this.patchY = Math.floor(tall / this.perY / PATCH);
    const here = new Uint8Array((patchX + 1) * (patchY + 1)), column = new Int32Array(wide);
    for (let p = 0; p < wide; p++) column[p] = Math.min(patchX, Math.floor((p + 0.5) / this.perX / PATCH));
    for (let q = 0; q < tall; q++) {
      const row = Math.min(patchY, Math.floor((q + 0.5) / this.perY / PATCH)) * (patchX + 1), start = q * wide;
      for (let p = 0; p < wide; p++) {
        const k = row + column[p];
        if (tone[start + p] > here[k]) here[k] = tone[start + p];
      }
    }
    return here.map((_, k) => {
      const i = k % (patchX + 1), j = Math.floor(k / (patchX + 1));
      let top = 0;
      for (let b = Math.max(0, j - 1); b <= Math.min(patchY, j + 1); b++)
        for (let a = Math.max(0, i - 1); a <= Math.min(patchX, i + 1); a++) top = Math.max(top, here[b * (patchX + 1) + a]);
      return top;
    });
  }

  // The runs of a screen's strokes: each as paint(count), its points being the first of alongX and alongY; or without paint
  // their ink to the blocks.
  hatch(screen, most, paint) {
    const {tone, width, height, perX, perY, x0, y0, wide, tall, patchX, patchY, blocks, unit} = this, {strokes, level, wave, turn, whole} = screen;
    const c = Math.cos(screen.angle * Math.PI / 180), s = Math.sin(screen.angle * Math.PI / 180), [tileU, tileV] = screen.tile;
    const ink = new Float64Array(blocks.bare.length);
    // the strokes that can reach what has been reconstructed
    const ox = x0 / perX, oy = y0 / perY, ex = (x0 + wide) / perX, ey = (y0 + tall) / perY;
    const left = Math.max(-4, ox), top = Math.max(-4, oy), right = Math.min(width + 4, ex), bottom = Math.min(height + 4, ey);
    const us = [], vs = [];
    for (const [x, y] of [[left, top], [right, top], [left, bottom], [right, bottom]]) { us.push(x * c + y * s); vs.push(y * c - x * s); }
    const lowU = Math.min(...us), highU = Math.max(...us), lowV = Math.min(...vs), highV = Math.max(...vs), away = wave + 4;
    for (let o = 0; o < strokes.length; o += STROKE) {
      const long = strokes[o], u0 = strokes[o + 1], u1 = strokes[o + 2], u2 = strokes[o + 3], u3 = strokes[o + 4];
      const v0 = strokes[o + 5], v1 = strokes[o + 6], v2 = strokes[o + 7], v3 = strokes[o + 8], limit = strokes[o + 9], line = strokes[o + 11];
      const steps = clamp(Math.ceil(long / SAMPLE), 1, 4094), step = long / steps, reach = long / 2 + away, row = 64 * line;
      const p1 = u1 / steps, p2 = u2 / steps / steps, p3 = u3 / steps / steps / steps, q1 = v1 / steps, q2 = v2 / steps / steps, q3 = v3 / steps / steps / steps;
      const lastA = Math.ceil((highU - u0 + long) / tileU), lastB = Math.ceil((highV - v0 + long) / tileV);
      for (let a = Math.floor((lowU - u0 - long) / tileU); a <= lastA; a++) for (let b = Math.floor((lowV - v0 - long) / tileV); b <= lastB; b++) {
        const du = u0 + a * tileU, dv = v0 + b * tileV;
        const mu = du + u1 / 2 + u2 / 4 + u3 / 8, mv = dv + v1 / 2 + v2 / 4 + v3 / 8, mx = mu * c - mv * s, my = mu * s + mv * c;
        if (mx < left - reach || my < top - reach || mx > right + reach || my > bottom + reach) continue;
        let dark = false;
        for (let k = 0; k <= 4 && !dark; k++) {
          const t = k / 4, u = du + t * (u1 + t * (u2 + t * u3)), v = dv + t * (v1 + t * (v2 + t * v3));
          dark = most[clamp(Math.floor((u * s + v * c - oy) / PATCH), 0, patchY) * (patchX + 1) + clamp(Math.floor((u * c - v * s - ox) / PATCH), 0, patchX)] > limit;
        }
        if (!dark) continue;
        let aside = 0, above = 0, total = 0;
        for (let i = 0; i <= steps; i++) {
          const u = du + i * (p1 + i * (p2 + i * p3));
          let v = dv + i * (q1 + i * (q2 + i * q3)) + aside;
          if (line >= 0) {
            const w = v;
            v += WAVER[0] * SINE[(WAVER[1] * u + WAVER[2] * w) * STEPS & TURN - 1] + WAVER[3] * SINE[(WAVER[4] * u + WAVER[5] * w) * STEPS & TURN - 1];
            if (wave) v += wave * (WAVE[0] * Math.sin(turn * (u + w / WAVE[1])) + WAVE[2] * Math.sin(turn * (WAVE[3] * u - w / WAVE[4])));
          }
          const x = u * c - v * s, y = u * s + v * c;
          let p = (x * perX | 0) - x0, q = (y * perY | 0) - y0;
          p = p < 0 ? 0 : p >= wide ? wide - 1 : p;
          q = q < 0 ? 0 : q >= tall ? tall - 1 : q;
          const got = tone[q * wide + p], d = got - limit;
          px[i] = x; py[i] = y; depth[i] = d; total += d;
          if (d > 0) above++;
          if (line >= 0) {
            const aim = WAY[row + level[got]];
            if (!i) { aside = aim; px[0] -= aside * s; py[0] += aside * c; } else if (d > 0) aside += GIVE * (aim - aside);
          }
        }
        if (whole) { if (total > 0) this.run(0, steps, 0, steps, step, screen, strokes[o + 10], ink, paint); continue; }
        if (!above) continue;
        if (above > steps) { this.run(0, steps, 0, steps, step, screen, strokes[o + 10], ink, paint); continue; }
        let begins = -1, ends = -1, peak = 0;
        for (let i = 0; i <= steps + 1; i++) {
          if (i <= steps && depth[i] > 0) {
            if (begins < 0) { begins = i; peak = 0; }
            ends = i;
            if (depth[i] > peak) peak = depth[i];
          } else if (begins >= 0 && (i > steps || i - ends > GAP || depth[i] < -DEEP)) {
            this.run(begins, ends, peak, steps, step, screen, strokes[o + 10], ink, paint);
            begins = -1;
          }
        }
      }
    }
    if (!paint) blocks.cover(ink.map(area => area * unit * unit));
  }

  run(begins, ends, peak, steps, step, screen, weight, ink, paint) {
    if (ends - begins < SHORT && peak <= DEEP && ends - begins !== steps) return;
    const ta = begins > 0 ? this.end(begins, -1, steps, step) : 0, tb = ends < steps ? this.end(ends, 1, steps, step) : steps;
    if (tb <= ta) return;
    if (!paint) {
      const {width, height, unit, gain, blocks: {side, left, top, across, down}} = this, per = unit / side;
      const each = weight * (screen.whole ? (steps * step + 0.785 * this.layer.pen) / (steps + 1) : step * (tb - ta) / (ends - begins + 1));
      for (let j = begins; j <= ends; j++) {
        const x = px[j], y = py[j], a = Math.floor(x * per) - left, b = Math.floor(y * per) - top, i = Math.min(j, steps - 1);
        if (x < 0 || y < 0 || x >= width || y >= height || a < 0 || b < 0 || a >= across || b >= down) continue;
        // a wave stretches the way, and a printer widens what slants
        const dx = px[i + 1] - px[i], dy = py[i + 1] - py[i];
        ink[b * across + a] += screen.wave ? each * ((1 - gain * screen.widens) * far(dx, dy) + gain * (Math.abs(dx) + Math.abs(dy))) / step : each;
      }
      return;
    }
    const every = screen.level ? 3 : 1;
    let count = point(0, ta, steps);
    for (let i = every * (Math.floor(ta / every) + 1); i < tb; i += every)
      if (i - ta > 0.5 && tb - i > 0.5) { alongX[count] = px[i]; alongY[count++] = py[i]; }
    paint(point(count, tb, steps));
  }

  // Where a run ends whose last sample is `at`, when `at + way` has too little tone.
  end(at, way, steps, step) {
    const off = at + way, fall = depth[at] - depth[off], {pen} = this.layer;
    if (fall > STEEP) {
      const i = clamp(at - way, 0, steps), j = clamp(off + way, 0, steps), t = this.crossing(px[i], py[i], px[j], py[j]);
      if (t >= 0) return i + (j - i) * t - way * pen / 2 / step;
    }
    return at + way * (depth[at] / fall - EARLY * pen / step);
  }
  crossing(x, y, u, v) {
    const {picture} = this.layer, E = picture.edges, gx = picture.w / this.width, gy = picture.h / this.height;
    x = x * gx - 0.5; y = y * gy - 0.5; u = u * gx - 0.5; v = v * gy - 0.5;
    let best = 9, answer = -1;
    for (let j = Math.max(-1, Math.floor(Math.min(y, v))); j <= Math.min(picture.h - 1, Math.floor(Math.max(y, v))); j++)
      for (let i = Math.max(-1, Math.floor(Math.min(x, u))); i <= Math.min(picture.w - 1, Math.floor(Math.max(x, u))); i++)
        for (const e of picture.edgesIn[picture.at(i, j)] || []) if (picture.between(e, x, y, u, v)) {
          const k = 7 * e, p = E[k + 4] * y - E[k + 5] * x + E[k + 6], q = E[k + 4] * v - E[k + 5] * u + E[k + 6], t = p / (p - q);
          if (Math.abs(t - 0.5) < best) { best = Math.abs(t - 0.5); answer = t; }
        }
    return answer;
  }

  // What each block would lack, in 255ths, smoothed; with the ink of this layer still to come, which is as much as its tone.
  lacking(toCome = false) {
    const {sum, tone, wide, tall, blocks: {bare, across, down, left, top}} = this, lack = new Float64Array(across * down), cells = new Float64Array(across * down), own = this.own = new Float64Array(across * down);
    const {perX, perY} = this.blocksPerCell(), inX = Int32Array.from({length: wide}, (_, p) => clamp(Math.floor((this.x0 + p + 0.5) * perX) - left, 0, across - 1));
    for (let q = 0; q < tall; q++) {
      const row = clamp(Math.floor((this.y0 + q + 0.5) * perY) - top, 0, down - 1) * across;
      for (let p = 0; p < wide; p++) { const k = row + inX[p]; lack[k] += sum[q * wide + p]; own[k] += tone[q * wide + p]; cells[k]++; }
    }
    for (let k = 0; k < lack.length; k++) {
      own[k] = toCome ? own[k] / Math.max(1, cells[k]) / 255 : 0;
      lack[k] = lack[k] / Math.max(1, cells[k]) - 255 * (1 - bare[k] * (1 - own[k]));
    }
    const soften = (start, stride, length) => {
      let here = lack[start];
      for (let k = 0; k < length; k++) {
        const before = here;
        here = lack[start + k * stride];
        lack[start + k * stride] = (before + 2 * here + lack[start + Math.min(k + 1, length - 1) * stride]) / 4;
      }
    };
    for (let j = 0; j < down; j++) soften(j * across, 1, across);
    for (let i = 0; i < across; i++) soften(i, across, down);
    return lack;
  }
  blocksPerCell() { return {perX: this.unit / this.perX / this.blocks.side, perY: this.unit / this.perY / this.blocks.side}; }

  // The feedback: what the first pass would lack is added to the tone.
  correct(lack = this.lacking()) {
    const {tone, wide, tall, blocks: {bare, across, down, left, top}} = this, {perX, perY} = this.blocksPerCell();
    const taken = this.layer.screens[0].level ? 1 : TAKEN_UP;  // of textures that are not lines half of the lack is chance
    lack.forEach((more, k) => { lack[k] = more *= taken; bare[k] = clamp(bare[k] - more / 255, 0, 1); });
    const place = (k, per, first, count) => {
      const at = (k + 0.5) * per - 0.5 - first, low = clamp(Math.floor(at), 0, count - 1);
      return [low, Math.min(low + 1, count - 1), clamp(at - low, 0, 1)];
    };
    const low = new Int32Array(wide), high = new Int32Array(wide), part = new Float64Array(wide), more = new Float64Array(across);
    for (let p = 0; p < wide; p++) [low[p], high[p], part[p]] = place(this.x0 + p, perX, left, across);
    for (let q = 0; q < tall; q++) {
      const [a, b, f] = place(this.y0 + q, perY, top, down);
      for (let i = 0; i < across; i++) more[i] = lack[a * across + i] * (1 - f) + lack[b * across + i] * f;
      for (let p = 0; p < wide; p++) {
        const k = q * wide + p, from = more[low[p]];
        if (tone[k]) tone[k] = byte(tone[k] + from + (more[high[p]] - from) * part[p]);
      }
    }
  }
}

// The samples of the stroke at hand, and a run's points.
const [px, py, depth, alongX, alongY] = Array.from({length: 5}, () => new Float64Array(4100));
function point(count, t, steps) {
  const i = clamp(Math.floor(t), 0, steps - 1), f = t - i;
  alongX[count] = px[i] + f * (px[i + 1] - px[i]);
  alongY[count] = py[i] + f * (py[i + 1] - py[i]);
  return count + 1;
}

// Gives a layer the pens that suit a picture of that width: on a small one they are finer, but not finer than PRINT_DOTS dots.
function suit(layer, width, dot) {
  const {given, pen} = layer, part = clamp(Math.sqrt(width / PRINT_FULL), PRINT_LEAST, 1), finer = wide => Math.min(Math.max(part * wide, PRINT_DOTS * dot), wide);
  layer.magnification = layer.engraving ? given.magnification : (finer(given.magnification * pen - WIDENED) + WIDENED) / pen;
  layer.outlinePen = finer(given.outlinePen) / layer.magnification;
  layer.linePen = finer(given.linePen);
  layer.fine = part;
  if (layer.given.fill.length) grow(layer, Math.max(width / size[0], given.least / Math.min(...layer.tile.tile)));
}
// Gives a layer its tile `scale` times as large, and lines for the tones that the tile does not reach.
function grow(layer, scale) {
  const {tile, given, magnification} = layer, by = scale / magnification, parts = SPAN_PARTS * 1.001 * scale;
  if (layer.grown && layer.grown.scale === scale && layer.grown.by === by) return;
  const there = tile.spans.map(([from, upto]) => from <= parts && (upto > parts || upto === EVER));
  const strokes = tile.strokes.filter((_, k) => there[Math.floor(k / STROKE)]).map((x, k) => k % STROKE < 9 ? x * by : k % STROKE === 9 ? x / by : x);
  const reached = strokes.length ? Math.min(1, strokes[strokes.length - STROKE + 9] / 255) : 0, over = tone => reached + (1 - reached) * tone;
  layer.screens = [{...tile, strokes, tile: tile.tile.map(side => side * by)}, ...given.fill.map(([angle, low, high], k) => lines(k + 1, angle, over(low), over(high), 0, 0, far(Math.cos(angle * Math.PI / 180), 0) + Math.abs(Math.sin(angle * Math.PI / 180))))];
  layer.grown = {scale, by};
}

// Draws the layers of a picture of width by height points in a window (x0 y0 x1 y1) of it. gain: points that the device adds to an
// upright stroke. every: cells of tone a node of the field, 2 in a hurry. dot: the least that the device paints, points. Calls
// stroke(layer, screen, count, pressure) with strokes of hatching and outline(layer, xs, ys, pen) with outlines, both in units of
// the layer, each `magnification` points, and fill(layer, xs, ys) with shapes, in points.
function draw(layers, width, height, window, gain, every, stroke, outline, fill, dot = gain) {
  for (const layer of layers) suit(layer, width, dot);
  const blocks = new Blocks(width, height, window, BLOCK * Math.max(...layers.map(layer => layer.magnification)));
  if (!blocks.bare.length) return;
  const sheets = layers.map(layer => new Sheet(layer, blocks, gain)), outlines = layers.map(layer => outlinesOf(layer, blocks));
  const told = layers.map(layer => tellingOn(layer, blocks, gain));
  addUp(sheets);
  for (const sheet of sheets) {
    if (sheet.layer.engraving) {
      const {unit} = sheet;
      engrave(sheet, every, (layer, xs, ys) => fill(layer, xs.map(x => x * unit), ys.map(y => y * unit)));
      continue;
    }
    if (sheet.layer.field) { follow(sheet, every, stroke); continue; }
    if (sheet.layer.black < 1) sheet.solid(fill);
    let most = sheet.patches();
    for (const screen of sheet.layer.screens) sheet.hatch(screen, most);
    sheet.correct();
    most = sheet.patches();
    for (const screen of sheet.layer.screens) sheet.hatch(screen, most, count => stroke(sheet.layer, screen, count, 1));
  }
  layers.forEach((layer, k) => outlines[k].forEach(([xs, ys, pen]) => outline(layer, xs, ys, pen)));
  layers.forEach((layer, k) => told[k].forEach(line => outlined(line).forEach(([xs, ys]) => fill(layer, xs, ys))));
}

// Tones of layers add up. Where a layer lies over one of the same texture, its strokes stand for both; over others it is hatched the
// more densely, the more of its ink will fall on theirs.
function addUp(sheets) {
  sheets.forEach((sheet, i) => sheets.slice(0, i).forEach(below => {
    if (below.layer.family !== sheet.layer.family) return;
    const under = sheet.looked(below, below.tone), over = below.looked(sheet, sheet.tone);
    sheet.tone.forEach((t, k) => { if (t) sheet.tone[k] = Math.min(255, t + under[k]); });
    over.forEach((t, k) => { if (t) below.tone[k] = 0; });
  }));
  sheets.forEach((sheet, i) => {
    if (sheets.length > 1) sheet.sum = sheet.tone.slice();
    if (!i) return;
    const under = sheet.looked(sheets[i - 1], sheets[i - 1].sum);
    under.forEach((u, k) => {
      const t = sheet.tone[k];
      sheet.sum[k] = Math.min(255, t + u);
      if (t) sheet.tone[k] = t + u >= 255 ? 255 : byte(255 * t / (255 - u));
    });
  });
}
