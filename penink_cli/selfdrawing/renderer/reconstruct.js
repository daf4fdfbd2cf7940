// reconstruct.js - grey samples and discontinuity edges to tone on a grid of any size (section 2 of the paper).
// The same steps as reconstruct.ps, which says why; only a window of the grid is filled.

const TILE = 64, MOST_TILES = 900, MOST_SQUARES = 6000;                            // cells; tiles that are kept
const NUDGE = 1 / 1024, REACH = 2 * Math.SQRT2 + 1;
const smooth = t => t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
const clamp = (x, low, high) => x < low ? low : x > high ? high : x;
const far = (x, y) => Math.sqrt(x * x + y * y);             // Math.hypot takes ten times as long
const byte = x => clamp(Math.floor(x + 0.5), 0, 255);

function cubic(f) {
  return [((1 - f / 2) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1, ((2 - 1.5 * f) * f + 0.5) * f, (f - 1) * f * f / 2];
}
function spline(f) {
  const g = 1 - f;
  return [g * g * g / 6, (f / 2 - 1) * f * f + 2 / 3, (g / 2 - 1) * g * g + 2 / 3, f * f * f / 6];
}

// One layer's samples and edges. ink: w * h bytes; xs, ys: of vertices, in sample units; ends: pairs of vertices.
class Picture {
  constructor(w, h, ink, xs, ys, ends) {
    Object.assign(this, {w, h, ink, count: ends.length});
    this.edges = new Float64Array(7 * ends.length);           // ax ay bx by dx dy c
    this.columns = w + 1;
    this.edgesIn = new Array((w + 1) * (h + 1));
    this.nodesIn = new Array((w + 1) * (h + 1));
    this.dirty = new Uint8Array((w + 1) * (h + 1));
    const angles = Array.from(xs, () => []);
    ends.forEach(([a, b], e) => {
      const dx = xs[b] - xs[a], dy = ys[b] - ys[a];
      this.edges.set([xs[a], ys[a], xs[b], ys[b], dx, dy, dy * xs[a] - dx * ys[a]], 7 * e);
      angles[a].push(Math.atan2(dy, dx));
      angles[b].push(Math.atan2(-dy, -dx));
      for (let j = Math.floor(Math.min(ys[a], ys[b])); j <= Math.max(ys[a], ys[b]); j++) {
        const at = y => dy ? xs[a] + clamp((y - ys[a]) / dy, 0, 1) * dx : y === j ? xs[a] : xs[b];
        const x0 = Math.min(at(j), at(j + 1)), x1 = Math.max(at(j), at(j + 1));
        for (let i = Math.max(-1, Math.floor(x0 - 0.001)); i <= Math.min(w - 1, x1 + 0.001); i++) {
          if (j < -1 || j >= h) continue;
          (this.edgesIn[this.at(i, j)] ||= []).push(e);
          for (let q = Math.max(-1, j - 1); q <= Math.min(h - 1, j + 1); q++)
            for (let p = Math.max(-1, i - 1); p <= Math.min(w - 1, i + 1); p++) this.dirty[this.at(p, q)] = 1;
        }
      }
    });
    this.nodes = [];
    angles.forEach((list, v) => {
      if (!list.length || xs[v] <= -0.5 || xs[v] >= w - 0.5 || ys[v] <= -0.5 || ys[v] >= h - 0.5) return;
      for (const a of list) {
        let gap = 2 * Math.PI;
        for (const b of list) {
          const turn = b < a ? b - a + 2 * Math.PI : b - a;
          if (turn > 1e-6 && turn < gap) gap = turn;
        }
        if (gap < 3.1398) continue;
        let out = a + gap / 2;
        if (list.length === 1) out += a >= 0 && a < 3.14159 ? -0.122 : 0.122;
        const x = xs[v] + NUDGE * Math.cos(out), y = ys[v] + NUDGE * Math.sin(out);
        (this.nodesIn[this.at(Math.floor(x), Math.floor(y))] ||= []).push(this.nodes.length);
        this.nodes.push([x, y]);
      }
    });
    this.arcsOf = [];
    this.pathsOf = [];
    this.seen = new Int32Array(Math.max(this.count, this.nodes.length));
    this.stamp = 0;
    this.tiles = new Map();
    this.squares = new Map();
    this.queries = 0;
  }

  at(i, j) { return (j + 1) * this.columns + i + 1; }

  near(table, i, j, span) {
    const found = [], stamp = ++this.stamp;
    for (let q = Math.max(-1, j - span); q <= Math.min(this.h - 1, j + span); q++)
      for (let p = Math.max(-1, i - span); p <= Math.min(this.w - 1, i + span); p++)
        for (const k of table[this.at(p, q)] || [])
          if (this.seen[k] !== stamp) { this.seen[k] = stamp; found.push(k); }
    return found;
  }

  // Does edge e separate (x,y) from (u,v)?
  between(e, x, y, u, v) {
    const E = this.edges, k = 7 * e, dx = E[k + 4], dy = E[k + 5], c = E[k + 6];
    const p = dx * y - dy * x + c, q = dx * v - dy * u + c;
    if (dy < 0 ? (p >= 0) === (q >= 0) : (p > 0) === (q > 0)) return false;
    const K = u - x, L = v - y, M = L * x - K * y;
    return (K * E[k + 1] - L * E[k] + M > 0) !== (K * E[k + 3] - L * E[k + 2] + M > 0);
  }
  blocked(list, x, y, u, v) {
    for (const e of list) if (this.between(e, x, y, u, v)) return true;
    return false;
  }

  // The shadows of edges, seen from (u,v), in the square around (cx,cy): null for none, true if one covers all of it, or ten numbers an
  // edge: three linear functions, each a constant and factors of x and y, and a limit. (x,y) is hidden where the first exceeds the
  // limit, the second is at least 0 and the third exceeds 0.
  shadow(list, u, v, cx, cy) {
    const E = this.edges, out = [];
    for (const e of list) {
      const o = 7 * e, ax = E[o], ay = E[o + 1], bx = E[o + 2], by = E[o + 3], dx = E[o + 4], dy = E[o + 5], c = E[o + 6];
      const q = dx * v - dy * u + c, sign = q > 0 || (q === 0 && dy < 0) ? 1 : -1;
      const z = -sign * (dx * cy - dy * cx + c), half = (Math.abs(dx) + Math.abs(dy)) / 2;
      if (z < -half) continue;
      const A = sign * ((ax - u) * (cy - v) - (ay - v) * (cx - u)), a = (Math.abs(ax - u) + Math.abs(ay - v)) / 2;
      if (A <= -a) continue;
      const B = -sign * ((bx - u) * (cy - v) - (by - v) * (cx - u)), b = (Math.abs(bx - u) + Math.abs(by - v)) / 2;
      if (B <= -b) continue;
      if (z > half && A >= a && B >= b) return true;
      // on the edge's line a query counts as above it where dy < 0; in line with a vertex, as left of the vertex
      const sideA = [sign * ((ay - v) * u - (ax - u) * v), sign * (v - ay), sign * (ax - u)];
      const sideB = [sign * ((bx - u) * v - (by - v) * u), sign * (by - v), sign * (u - bx)];
      out.push(-sign * c, sign * dy, -sign * dx, ...(sign > 0 ? sideB.concat(sideA) : sideA.concat(sideB)), (sign > 0) === dy < 0 ? 0 : -1e-300);
    }
    return out.length ? Float64Array.from(out) : null;
  }

  nodesSeen(x, y) {
    const i = Math.floor(x), j = Math.floor(y), walls = this.near(this.edgesIn, i, j, 4), out = [];
    for (const t of this.near(this.nodesIn, i, j, 4)) {
      const [u, v] = this.nodes[t], d = far(u - x, v - y);
      if (d < REACH && !this.blocked(walls, x, y, u, v)) out.push([t, d]);
    }
    return out;
  }
  // Where a path from sample (i, j) may bend: [x, y, length, node]
  paths(i, j) {
    const key = j * this.w + i;
    if (!this.pathsOf[key]) {
      const reached = new Map(this.nodesSeen(i, j));
      for (const [t] of reached) {                            // what is added meanwhile is visited too
        for (const [s, more] of this.arcsOf[t] ||= this.nodesSeen(...this.nodes[t])) {
          const d = reached.get(t) + more;
          if (d < REACH && d < (reached.get(s) ?? 9)) { reached.delete(s); reached.set(s, d); }
        }
      }
      this.pathsOf[key] = Array.from(reached, ([t, d]) => [...this.nodes[t], d, t]);
    }
    return this.pathsOf[key];
  }

  // As reconstruct, from tiles that are kept as long as the grid stays the same: a picture that is moved needs new tiles at its border
  // only.
  tone(n, m, x0, y0, x1, y1) {
    const wide = x1 - x0, out = new Uint8Array(wide * (y1 - y0));
    if (n !== this.n || m !== this.m || this.tiles.size > MOST_TILES) Object.assign(this, {n, m, tiles: new Map()});
    for (let j = Math.floor(y0 / TILE); j * TILE < y1; j++) for (let i = Math.floor(x0 / TILE); i * TILE < x1; i++) {
      const left = i * TILE, top = j * TILE, right = Math.min(n, left + TILE), bottom = Math.min(m, top + TILE), key = j * 65536 + i;
      if (!this.tiles.has(key)) this.tiles.set(key, this.reconstruct(n, m, left, top, right, bottom));
      const tile = this.tiles.get(key), from = Math.max(left, x0), upto = Math.min(right, x1);
      for (let q = Math.max(top, y0); q < Math.min(bottom, y1); q++) {
        const row = (q - top) * (right - left) - left;
        out.set(tile.subarray(row + from, row + upto), (q - y0) * wide + from - x0);
      }
    }
    return out;
  }

  // Tone of the cells x0 .. x1, y0 .. y1 of a grid of n x m that fills the frame.
  reconstruct(n, m, x0, y0, x1, y1) {
    const {w, h, ink} = this, wide = x1 - x0, tall = y1 - y0, tone = new Uint8Array(wide * tall), plain = new Float64Array(wide * tall);
    const axis = (from, many, cells, samples) => {            // the square each cell is in, where there, cubic weights
      const at = {i: new Int32Array(many), f: new Float64Array(many), k: new Float64Array(4 * many)};
      for (let k = 0; k < many; k++) {
        const x = (from + k + 0.5) * samples / cells - 0.5;
        at.i[k] = Math.floor(x);
        at.f[k] = x - at.i[k];
        at.k.set(cubic(at.f[k]), 4 * k);
      }
      return at;
    };
    const X = axis(x0, wide, n, w), Y = axis(y0, tall, m, h), rows = [];
    const along = j => {
      j = clamp(j, 0, h - 1);
      if (!rows[j]) {
        const row = rows[j] = new Float64Array(wide), s = i => ink[j * w + clamp(i, 0, w - 1)];
        for (let p = 0; p < wide; p++) {
          const i = X.i[p], k = 4 * p;
          row[p] = s(i - 1) * X.k[k] + s(i) * X.k[k + 1] + s(i + 1) * X.k[k + 2] + s(i + 2) * X.k[k + 3];
        }
      }
      return rows[j];
    };
    for (let q = 0; q < tall; q++) {
      const [a, b, c, d] = [-1, 0, 1, 2].map(o => along(Y.i[q] + o)), [ka, kb, kc, kd] = Y.k.subarray(4 * q, 4 * q + 4);
      for (let p = 0; p < wide; p++) tone[q * wide + p] = byte(plain[q * wide + p] = a[p] * ka + b[p] * kb + c[p] * kc + d[p] * kd);
    }
    if (!this.count) return tone;
    for (let q = 0, last; q < tall; q = last) {
      for (last = q; last < tall && Y.i[last] === Y.i[q];) last++;
      for (let p = 0, end; p < wide; p = end) {
        for (end = p; end < wide && X.i[end] === X.i[p];) end++;
        if (this.dirty[this.at(X.i[p], Y.i[q])]) this.square(X, Y, p, end, q, last, tone, wide, plain);
      }
    }
    return tone;
  }

  // The values of the samples around square (I, J), and of each sample that edges may hide there its shadows and where paths to it may
  // bend; null where nothing is hidden. It is kept, for it takes as long as a screenful of cells.
  hidden(I, J) {
    const {w, h, ink} = this, cx = I + 0.5, cy = J + 0.5, taps = [], key = this.at(I, J);
    if (this.squares.has(key)) return this.squares.get(key);
    const walls = this.near(this.edgesIn, I, J, 1), value = new Float64Array(16), nodes = new Map();
    let around = null;
    for (let k = 0; k < 16; k++) {
      const u = clamp(I - 1 + (k & 3), 0, w - 1), v = clamp(J - 1 + (k >> 2), 0, h - 1);
      value[k] = ink[v * w + u];
      const shadow = this.shadow(walls, u, v, cx, cy);
      if (!shadow) continue;
      const most = far(u - cx, v - cy) + 2.4143, bends = [];
      around ||= this.near(this.nodesIn, I, J, 2).length ? this.near(this.edgesIn, I, J, 2) : [];
      if (around.length) for (const [x, y, way, t] of this.paths(u, v)) if (way + far(x - cx, y - cy) < most) {
        if (!nodes.has(t)) nodes.set(t, {x, y, hidden: this.shadow(around, x, y, cx, cy), at: -1, way: 0, seen: 0});
        const node = nodes.get(t);
        if (node.hidden !== true) bends.push({node, way});
      }
      bends.sort((a, b) => a.way - b.way);
      taps.push({k, u, v, shadow, bends});
    }
    if (this.squares.size >= MOST_SQUARES) this.squares.clear();
    this.squares.set(key, taps.length ? {taps, value} : null);
    return this.squares.get(key);
  }

  // The cells p0 .. p1, q0 .. q1 of one square.
  square(X, Y, p0, p1, q0, q1, tone, wide, plain) {
    const I = X.i[p0], J = Y.i[q0], found = this.hidden(I, J);
    if (!found) return;
    const {taps, value} = found, many = p1 - p0, hidden = new Uint16Array(many * (q1 - q0)), fx = X.f, x0 = I + fx[p0], perX = many > 1 ? (many - 1) / (fx[p1 - 1] - fx[p0]) : 1;
    // which taps are hidden from which cells: from one stretch of each row by each edge
    for (const {k, shadow} of taps) {
      if (shadow === true) for (let c = 0; c < hidden.length; c++) hidden[c] |= 1 << k;
      else for (let o = 0; o < shadow.length; o += 10) for (let q = q0; q < q1; q++) {
        const y = J + Y.f[q], row = (q - q0) * many;
        let from = 0, upto = many - 1;
        for (let l = o; l < o + 9; l += 3) {
          const slope = shadow[l + 1], rest = shadow[l] + shadow[l + 2] * y;
          if (slope > 0) from = Math.max(from, Math.ceil((-rest / slope - x0) * perX) - 1);
          else if (slope < 0) upto = Math.min(upto, Math.floor((-rest / slope - x0) * perX) + 1);
          else if (rest < 0) upto = -1;
        }
        while (from <= upto && !within(shadow, o, I + fx[p0 + from], y)) from++;
        while (from <= upto && !within(shadow, o, I + fx[p0 + upto], y)) upto--;
        for (; from <= upto; from++) hidden[row + from] |= 1 << k;
      }
    }
    const light = new Float64Array(16), losses = new Float64Array(16);
    let num = 0, den = 0;
    const sums = (kx, ky, x, y, all) => {
      num = den = 0;
      for (let k = 0; k < 16; k++) {
        const weight = kx[x + (k & 3)] * ky[y + (k >> 2)] * (all ? 1 : light[k]);
        num += weight * value[k];
        den += weight;
      }
    };
    for (let q = q0; q < q1; q++) for (let p = p0; p < p1; p++) {
      const away = hidden[(q - q0) * many + p - p0];
      if (!away) continue;
      const x = I + fx[p], y = J + Y.f[q], cell = q * wide + p, query = ++this.queries;
      // most cells keep most of their taps: what the others weigh is taken off the sum of all
      let lost = 0, lostInk = 0;
      for (const {k, u, v, bends} of taps) {
        if (!(away >> k & 1)) continue;
        let least = 1;
        if (bends.length) {
          const straight = far(u - x, v - y);
          for (const {node, way} of bends) {                  // the nearest to the sample first
            if (way - straight >= least) break;
            if (node.at !== query) { node.at = query; node.way = far(node.x - x, node.y - y); node.seen = 0; }
            if (way + node.way - straight >= least) continue;
            if (!node.seen) node.seen = node.hidden && anywhere(node.hidden, x, y) ? -1 : 1;
            if (node.seen > 0) least = way + node.way - straight;
          }
        }
        const loss = smooth(least), weight = X.k[4 * p + (k & 3)] * Y.k[4 * q + (k >> 2)] * loss;
        losses[k] = loss;
        lost += weight;
        lostInk += weight * value[k];
      }
      let faith = 1;
      num = plain[cell] - lostInk;
      den = 1 - lost;
      if (den < T1) {
        for (let k = 0; k < 16; k++) light[k] = away >> k & 1 ? 1 - losses[k] : 1;
        sums(X.k, Y.k, 4 * p, 4 * q);
        const share = smooth(den / T1), numC = num, denC = den;
        sums(spline(X.f[p]), spline(Y.f[q]), 0, 0);
        faith = smooth(den * 10000);
        num = share * numC + (1 - share) * num;
        den = share * denC + (1 - share) * den;
      }
      if (faith > 0) {
        let result = num / den;
        if (faith < 1) { sums(X.k, Y.k, 4 * p, 4 * q, true); result = faith * result + (1 - faith) * num / den; }
        tone[cell] = byte(result);
      }
    }
  }
}

// Is (x,y) in one edge's shadow, whose numbers begin at k; is it in any?
function within(shadow, k, x, y) {
  return shadow[k] + shadow[k + 1] * x + shadow[k + 2] * y > shadow[k + 9] &&
    shadow[k + 3] + shadow[k + 4] * x + shadow[k + 5] * y >= 0 && shadow[k + 6] + shadow[k + 7] * x + shadow[k + 8] * y > 0;
}
function anywhere(shadow, x, y) {
  for (let k = 0; k < shadow.length; k += 10) if (within(shadow, k, x, y)) return true;
  return false;
}
