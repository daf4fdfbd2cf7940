// drawing.js - strokes from tone: each stroke is drawn wherever the tone exceeds its threshold.
// The same steps as texture.ps and drawing.ps, which say why.

const PARTS = [0, 0.5, 0.63, 0.75, 1], COVERS = [0, 0.6912, 0.845, 0.943, 0.995];
const AROUND = 288, ACROSS = 100, LINES = 256, BLOCK = 9, PATCH = 18, GAP = 3, SHORT = 3, DEEP = 24;
// Units around the window that are reconstructed and corrected with it: what lies farther moves no stroke in it visibly.
const MARGIN = 36;

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
  there.forEach((k, i) => { WAY[64 * k + r] = (clamp(Math.floor(128.5 + 24 * (at[i] - home[i])), 0, 255) - 128) / 24; });
}

// A screen of lines: strokes as the coefficients of cubics in u and v, limit, line, weight (the ink of a unit of length).
function lines(number, angle, low, high, wave, turn, widens) {
  let state = 4711 + 97 * number;
  const random = () => (state = (state * 25173 + 13849) % 65536) >> 8, spread = () => random() / 128 - 1;
  const strokes = [], span = (high - low) / (1 - low);
  const slopes = PARTS.slice(1).map((part, k) => (COVERS[k + 1] - COVERS[k]) / (part - PARTS[k]) * ACROSS / LINES);
  for (let line = 0; line < LINES; line++) {
    const home = (line + 0.5) * ACROSS / LINES, cover = interpolate((RANK[line] + 0.5) / LINES, PARTS, COVERS);
    const limit = 255 * (low + (1 - low) * cover), weight = freshInk(cover, COVERS.slice(1), slopes);
    let u0 = random() * AROUND / 256;
    for (let left = AROUND; left > 0;) {
      let long = 42 + random() / 8;
      if (left < long + 30) long = left;
      const a = home + 0.1 * spread(), b = home + 0.1 * spread(), push = 0.45 * spread();
      if (cover < span) strokes.push({long, u: [u0, long, 0, 0], v: [a, b - a + push, -push, 0], limit, line, weight});
      u0 += long;
      left -= long;
    }
  }
  const level = Uint8Array.from({length: 256}, (_, t) =>
    Math.min(63, Math.floor(64 * interpolate(clamp((t / 255 - low) / (1 - low), 0, 1), COVERS, PARTS))));
  return {angle, strokes, level, tile: [AROUND, ACROSS], whole: false, wave, turn, widens};
}

// The same strokes half a tile away: from tone low on they cover what the screen leaves bare.
function again(screen, low) {
  const [du, dv] = screen.tile.map(side => side / 2);
  return {...screen, strokes: screen.strokes.map(s => ({...s, limit: 255 * low + (1 - low) * s.limit,
    u: [s.u[0] + du, ...s.u.slice(1)], v: [s.v[0] + dv, ...s.v.slice(1)]}))};
}

// Draws one layer. layer: picture, screens, pen, outlines ...; width, height: of the picture in units; window: x0 y0 x1 y1 of it.
// Calls paint(xs, ys) with each stroke as a polyline in units, and outline(xs, ys, closed) with each outline.
function draw(layer, width, height, view, paint, outline) {
  const {picture, pen} = layer, n = Math.max(picture.w, Math.round(width)), m = Math.max(picture.h, Math.round(height));
  const perX = n / width, perY = m / height, gx = picture.w / width, gy = picture.h / height;
  // the part of the grid that matters: the window, strokes that reach into it, whole blocks
  const from = (x, per) => Math.max(0, Math.floor((x - MARGIN) / BLOCK) * BLOCK * per), upto = (x, per, most) =>
    Math.min(most, Math.ceil((x + MARGIN) / BLOCK) * BLOCK * per);
  const x0 = Math.floor(from(view[0], perX)), y0 = Math.floor(from(view[1], perY));
  const x1 = Math.ceil(upto(view[2], perX, n)), y1 = Math.ceil(upto(view[3], perY, m)), wide = x1 - x0, tall = y1 - y0;
  if (wide <= 0 || tall <= 0) return;
  const tone = picture.tone(n, m, x0, y0, x1, y1);
  if (layer.curve) for (let k = 0; k < tone.length; k++) tone[k] = layer.curve[tone[k]];

  const bx0 = Math.floor(x0 / perX / BLOCK), by0 = Math.floor(y0 / perY / BLOCK);
  const across = Math.ceil(Math.min(width, x1 / perX) / BLOCK - 1e-9) - bx0, down = Math.ceil(Math.min(height, y1 / perY) / BLOCK - 1e-9) - by0;
  const bare = new Float64Array(across * down).fill(1);
  const blockOf = (x, y) => {
    const i = Math.floor(x / BLOCK) - bx0, j = Math.floor(y / BLOCK) - by0;
    return x >= 0 && y >= 0 && x < width && y < height && i >= 0 && j >= 0 && i < across && j < down ? j * across + i : -1;
  };
  const traced = layer.outlines.map(chain => trace(chain, width / picture.w, height / picture.h));
  for (const {xs, ys} of traced) for (let j = 1; j < xs.length; j++) {
    const long = Math.hypot(xs[j] - xs[j - 1], ys[j] - ys[j - 1]), parts = Math.max(1, Math.ceil(long / 2));
    for (let k = 0.5; k < parts; k++) {
      const b = blockOf(xs[j - 1] + (xs[j] - xs[j - 1]) * k / parts, ys[j - 1] + (ys[j] - ys[j - 1]) * k / parts);
      if (b >= 0) bare[b] *= Math.max(0, 1 - long / parts * layer.outlinePen / (BLOCK * BLOCK));
    }
  }

  const px = new Float64Array(4096), py = new Float64Array(4096), depth = new Float64Array(4096);
  let ink, most, patchX, patchY;

  const patches = () => {
    patchX = Math.floor(wide / perX / PATCH); patchY = Math.floor(tall / perY / PATCH);
    const here = new Uint8Array((patchX + 1) * (patchY + 1));
    for (let q = 0; q < tall; q++) {
      const row = Math.min(patchY, Math.floor((q + 0.5) / perY / PATCH)) * (patchX + 1);
      for (let p = 0; p < wide; p++) {
        const k = row + Math.min(patchX, Math.floor((p + 0.5) / perX / PATCH));
        if (tone[q * wide + p] > here[k]) here[k] = tone[q * wide + p];
      }
    }
    most = here.map((_, k) => {
      const i = k % (patchX + 1), j = Math.floor(k / (patchX + 1));
      let top = 0;
      for (let b = Math.max(0, j - 1); b <= Math.min(patchY, j + 1); b++)
        for (let a = Math.max(0, i - 1); a <= Math.min(patchX, i + 1); a++) top = Math.max(top, here[b * (patchX + 1) + a]);
      return top;
    });
  };
  const ox = x0 / perX, oy = y0 / perY;
  const patchAt = (x, y) => most[clamp(Math.floor((y - oy) / PATCH), 0, patchY) * (patchX + 1) + clamp(Math.floor((x - ox) / PATCH), 0, patchX)];

  const crossing = (x, y, u, v) => {
    let best = 9, answer = -1;
    const E = picture.edges;
    for (let j = Math.max(-1, Math.floor(Math.min(y, v))); j <= Math.min(picture.h - 1, Math.floor(Math.max(y, v))); j++)
      for (let i = Math.max(-1, Math.floor(Math.min(x, u))); i <= Math.min(picture.w - 1, Math.floor(Math.max(x, u))); i++)
        for (const e of picture.edgesIn[picture.at(i, j)] || []) if (picture.between(e, x, y, u, v)) {
          const k = 7 * e, p = E[k + 4] * y - E[k + 5] * x + E[k + 6], q = E[k + 4] * v - E[k + 5] * u + E[k + 6], t = p / (p - q);
          if (Math.abs(t - 0.5) < best) { best = Math.abs(t - 0.5); answer = t; }
        }
    return answer;
  };

  const pass = painting => {
    patches();
    for (const screen of layer.screens) {
      const c = Math.cos(screen.angle * Math.PI / 180), s = Math.sin(screen.angle * Math.PI / 180), [tileU, tileV] = screen.tile;
      ink = new Float64Array(across * down);
      // the strokes that can reach what has been reconstructed
      const left = Math.max(-4, x0 / perX), top = Math.max(-4, y0 / perY), right = Math.min(width + 4, x1 / perX), bottom = Math.min(height + 4, y1 / perY);
      const us = [], vs = [];
      for (const [x, y] of [[left, top], [right, top], [left, bottom], [right, bottom]]) { us.push(x * c + y * s); vs.push(y * c - x * s); }
      const lowU = Math.min(...us), highU = Math.max(...us), lowV = Math.min(...vs), highV = Math.max(...vs);
      const away = screen.wave + 4, near = {left: left - away, top: top - away, right: right + away, bottom: bottom + away};
      for (const stroke of screen.strokes) {
        const {long, u: [u0, u1, u2, u3], v: [v0, v1, v2, v3], limit, line} = stroke;
        const steps = clamp(Math.ceil(long / 1.5), 1, 4094), half = long / 2;
        for (let a = Math.floor((lowU - u0 - long) / tileU); a <= Math.ceil((highU - u0 + long) / tileU); a++)
          for (let b = Math.floor((lowV - v0 - long) / tileV); b <= Math.ceil((highV - v0 + long) / tileV); b++) {
            const du = u0 + a * tileU, dv = v0 + b * tileV;
            const mu = du + u1 / 2 + u2 / 4 + u3 / 8, mv = dv + v1 / 2 + v2 / 4 + v3 / 8, mx = mu * c - mv * s, my = mu * s + mv * c;
            if (mx < near.left - half || my < near.top - half || mx > near.right + half || my > near.bottom + half) continue;
            for (let k = 0; k <= 4; k++) {
              const t = k / 4, u = du + t * (u1 + t * (u2 + t * u3)), v = dv + t * (v1 + t * (v2 + t * v3));
              if (patchAt(u * c - v * s, u * s + v * c) > limit) {
                const reach = half + away, within = line >= 0 && mx - reach >= ox && my - reach >= oy &&
                  mx + reach < x1 / perX && my + reach < y1 / perY;
                copy(screen, stroke, steps, du, dv, c, s, within, painting);
                break;
              }
            }
          }
      }
      if (!painting) for (let k = 0; k < bare.length; k++) {
        const i = k % across, j = Math.floor(k / across);
        const area = Math.min(BLOCK, width - (bx0 + i) * BLOCK) * Math.min(BLOCK, height - (by0 + j) * BLOCK);
        bare[k] *= 1 - Math.min(1, ink[k] / area);
      }
    }
  };

  // One stroke in one place; within: all of it is where the tone is known.
  const copy = (screen, stroke, steps, du, dv, c, s, within, painting) => {
    const {long, u: [, u1, u2, u3], v: [, v1, v2, v3], limit, line, weight} = stroke, {wave, turn, level} = screen, step = long / steps;
    let aside = 0, above = 0, total = 0;
    for (let i = 0; i <= steps; i++) {
      const t = i / steps, u = du + t * (u1 + t * (u2 + t * u3));
      let v = dv + t * (v1 + t * (v2 + t * v3)) + aside;
      if (line >= 0) {
        const w = v;
        v += 0.3 * Math.sin(0.09 * u + 0.03 * w) + 0.2 * Math.sin(0.21 * u - 0.05 * w);
        if (wave) v += wave * (0.4 * Math.sin(turn * (u + w / 3)) + 0.15 * Math.sin(turn * (1.7 * u - w / 5)));
      }
      const x = u * c - v * s, y = u * s + v * c;
      let p = Math.floor(x * perX) - x0, q = Math.floor(y * perY) - y0;
      if (!within) { p = p < 0 ? 0 : p >= wide ? wide - 1 : p; q = q < 0 ? 0 : q >= tall ? tall - 1 : q; }
      const got = tone[q * wide + p], d = got - limit;
      px[i] = x; py[i] = y; depth[i] = d; total += d;
      if (d > 0) above++;
      if (line >= 0) {
        const aim = WAY[64 * line + level[got]];
        if (!i) { aside = aim; px[0] -= aside * s; py[0] += aside * c; } else if (d > 0) aside += 0.2 * (aim - aside);
      }
    }
    if (screen.whole) { if (total > 0) close(0, steps, 0, steps, step, screen, weight, painting); return; }
    if (!above) return;
    let begins = -1, ends = -1, peak = 0;
    for (let i = 0; i <= steps + 1; i++) {
      if (i <= steps && depth[i] > 0) {
        if (begins < 0) { begins = i; peak = 0; }
        ends = i;
        peak = Math.max(peak, depth[i]);
      } else if (begins >= 0 && (i > steps || i - ends > GAP || depth[i] < -DEEP)) {
        close(begins, ends, peak, steps, step, screen, weight, painting);
        begins = -1;
      }
    }
  };
  const end = (at, way, steps, step) => {
    const off = at + way, fall = depth[at] - depth[off];
    if (fall > 10) {
      const i = clamp(at - way, 0, steps), j = clamp(off + way, 0, steps);
      const t = crossing(px[i] * gx - 0.5, py[i] * gy - 0.5, px[j] * gx - 0.5, py[j] * gy - 0.5);
      if (t >= 0) return i + (j - i) * t - way * pen / 2 / step;
    }
    return at + way * (depth[at] / fall - 0.4 * pen / step);
  };
  const close = (begins, ends, peak, steps, step, screen, weight, painting) => {
    if (ends - begins < SHORT && peak <= DEEP && ends - begins !== steps) return;
    const ta = begins > 0 ? end(begins, -1, steps, step) : 0, tb = ends < steps ? end(ends, 1, steps, step) : steps;
    if (tb <= ta) return;
    if (!painting) {
      const each = weight * (screen.whole ? (steps * step + 0.785 * pen) / (steps + 1) : step * (tb - ta) / (ends - begins + 1));
      for (let j = begins; j <= ends; j++) {
        const b = blockOf(px[j], py[j]), i = Math.min(j, steps - 1);
        // a wave stretches the way
        if (b >= 0) ink[b] += screen.wave ? each * Math.hypot(px[i + 1] - px[i], py[i + 1] - py[i]) / step : each;
      }
      return;
    }
    const xs = [], ys = [], every = screen.level ? 3 : 1, point = t => {
      const i = clamp(Math.floor(t), 0, steps - 1), f = t - i;
      xs.push(px[i] + f * (px[i + 1] - px[i])); ys.push(py[i] + f * (py[i + 1] - py[i]));
    };
    point(ta);
    for (let i = every * (Math.floor(ta / every) + 1); i < tb; i += every)
      if (i - ta > 0.5 && tb - i > 0.5) { xs.push(px[i]); ys.push(py[i]); }
    point(tb);
    paint(xs, ys, screen);
  };

  // the feedback: what the first pass would lack, smoothed, is added to the tone
  const correct = () => {
    const lack = new Float64Array(across * down), cells = new Float64Array(across * down);
    const inX = Array.from({length: wide}, (_, p) => clamp(Math.floor((x0 + p + 0.5) / perX / BLOCK) - bx0, 0, across - 1));
    for (let q = 0; q < tall; q++) {
      const row = clamp(Math.floor((y0 + q + 0.5) / perY / BLOCK) - by0, 0, down - 1) * across;
      for (let p = 0; p < wide; p++) { lack[row + inX[p]] += tone[q * wide + p]; cells[row + inX[p]]++; }
    }
    for (let k = 0; k < lack.length; k++) lack[k] = lack[k] / Math.max(1, cells[k]) - 255 * (1 - bare[k]);
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
    const place = (k, per, first, blocks) => {
      const at = (k + 0.5) / per / BLOCK - 0.5 - first, low = clamp(Math.floor(at), 0, blocks - 1);
      return [low, Math.min(low + 1, blocks - 1), clamp(at - low, 0, 1)];
    };
    const low = new Int32Array(wide), high = new Int32Array(wide), part = new Float64Array(wide), more = new Float64Array(across);
    for (let p = 0; p < wide; p++) [low[p], high[p], part[p]] = place(x0 + p, perX, bx0, across);
    for (let q = 0; q < tall; q++) {
      const [a, b, f] = place(y0 + q, perY, by0, down);
      for (let i = 0; i < across; i++) more[i] = lack[a * across + i] * (1 - f) + lack[b * across + i] * f;
      for (let p = 0; p < wide; p++) {
        const k = q * wide + p;
        const from = more[low[p]];
        if (tone[k]) tone[k] = byte(tone[k] + from + (more[high[p]] - from) * part[p]);
      }
    }
  };
  pass(false);
  correct();
  pass(true);
  for (const {xs, ys, closed} of traced) outline(xs, ys, closed);
}

function trace(chain, sx, sy) {
  const xs = chain.map(([x]) => (x + 0.5) * sx), ys = chain.map(([, y]) => (y + 0.5) * sy), last = xs.length - 1;
  return {xs, ys, closed: last > 2 && xs[0] === xs[last] && ys[0] === ys[last]};
}

// The control points between which an outline's curve runs: none for a corner or an end.
function leans(xs, ys, closed) {
  const last = xs.length - 1;
  return xs.map((x, i) => {
    const a = i ? i - 1 : closed ? last - 1 : 0, b = i < last ? i + 1 : closed ? 1 : last;
    const ax = x - xs[a], ay = ys[i] - ys[a], bx = xs[b] - x, by = ys[b] - ys[i], dot = ax * bx + ay * by;
    return dot > 0 && 4 * dot * dot >= (ax * ax + ay * ay) * (bx * bx + by * by) ? [(ax + bx) / 6, (ay + by) / 6] : [0, 0];
  });
}
