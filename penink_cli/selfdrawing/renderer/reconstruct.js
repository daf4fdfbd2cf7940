// reconstruct.js - grey samples and discontinuity edges to tone on a grid of any size (section 2 of the paper).
// The same steps as reconstruct.ps, which says why; only a window of the grid is filled.

const TILE = 96, MOST_TILES = 400;                            // cells; tiles that are kept
const NUDGE = 1 / 1024, REACH = 2 * Math.SQRT2 + 1;
const smooth = t => t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
const clamp = (x, low, high) => x < low ? low : x > high ? high : x;
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
    for (let i = 0; i < list.length; i++) if (this.between(list[i], x, y, u, v)) return true;
    return false;
  }

  nodesSeen(x, y) {
    const i = Math.floor(x), j = Math.floor(y), walls = this.near(this.edgesIn, i, j, 4), out = [];
    for (const t of this.near(this.nodesIn, i, j, 4)) {
      const [u, v] = this.nodes[t], far = Math.hypot(u - x, v - y);
      if (far < REACH && !this.blocked(walls, x, y, u, v)) out.push([t, far]);
    }
    return out;
  }
  // Where a path from sample (i, j) may bend: [x, y, length, node]
  paths(i, j) {
    const key = j * this.w + i;
    if (!this.pathsOf[key]) {
      const reached = new Map(this.nodesSeen(i, j));
      for (const [t] of reached) {                            // what is added meanwhile is visited too
        for (const [s, far] of this.arcsOf[t] ||= this.nodesSeen(...this.nodes[t])) {
          const d = reached.get(t) + far;
          if (d < REACH && d < (reached.get(s) ?? 9)) { reached.delete(s); reached.set(s, d); }
        }
      }
      this.pathsOf[key] = Array.from(reached, ([t, d]) => [...this.nodes[t], d, t]);
    }
    return this.pathsOf[key];
  }

  // The same as reconstruct, from tiles that are kept as long as the grid stays the same: who moves the picture needs new
  // ones at its border only.
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
    const {w, h, ink} = this, wide = x1 - x0, tone = new Uint8Array(wide * (y1 - y0));
    const axis = (from, upto, cells, samples) => Array.from({length: upto - from}, (_, k) => {
      const x = (from + k + 0.5) * samples / cells - 0.5, i = Math.floor(x);
      return {i, f: x - i, k: cubic(x - i)};
    });
    const X = axis(x0, x1, n, w), Y = axis(y0, y1, m, h), rows = new Map();
    const along = j => {
      j = clamp(j, 0, h - 1);
      if (!rows.has(j)) {
        const row = new Float64Array(wide), s = i => ink[j * w + clamp(i, 0, w - 1)];
        X.forEach(({i, k}, p) => { row[p] = s(i - 1) * k[0] + s(i) * k[1] + s(i + 1) * k[2] + s(i + 2) * k[3]; });
        rows.set(j, row);
      }
      return rows.get(j);
    };
    Y.forEach(({i, k}, q) => {
      const [a, b, c, d] = [-1, 0, 1, 2].map(o => along(i + o)), [ka, kb, kc, kd] = k;
      for (let p = 0; p < wide; p++) tone[q * wide + p] = byte(a[p] * ka + b[p] * kb + c[p] * kc + d[p] * kd);
    });
    if (!this.count) return tone;
    for (let q = 0; q < Y.length;) {
      let last = q;
      while (last < Y.length && Y[last].i === Y[q].i) last++;
      for (let p = 0; p < wide;) {
        let end = p;
        while (end < wide && X[end].i === X[p].i) end++;
        if (this.dirty[this.at(X[p].i, Y[q].i)]) this.square(X, Y, p, end, q, last, tone, wide);
        p = end;
      }
      q = last;
    }
    return tone;
  }

  // The cells p0 .. p1, q0 .. q1 of one square.
  square(X, Y, p0, p1, q0, q1, tone, wide) {
    const {w, h, ink, edges: E} = this, I = X[p0].i, J = Y[q0].i, cx = I + 0.5, cy = J + 0.5;
    const tx = [], ty = [], shadows = new Array(16).fill(null);
    for (let k = 0; k < 16; k++) { tx.push(clamp(I - 1 + (k & 3), 0, w - 1)); ty.push(clamp(J - 1 + (k >> 2), 0, h - 1)); }
    let hidden = false;
    for (const e of this.near(this.edgesIn, I, J, 1)) {
      const o = 7 * e, ax = E[o], ay = E[o + 1], bx = E[o + 2], by = E[o + 3], dx = E[o + 4], dy = E[o + 5], c = E[o + 6];
      const above = z => z > 0 || (z === 0 && dy < 0), z = dx * cy - dy * cx + c;
      const astride = Math.abs(z) <= (Math.abs(dx) + Math.abs(dy)) / 2;
      for (let k = 0; k < 16; k++) {
        const sx = tx[k], sy = ty[k], side = above(dx * sy - dy * sx + c);
        if (!astride && side === above(z)) continue;
        const sign = side ? 1 : -1;
        const A = sign * ((ax - sx) * (cy - sy) - (ay - sy) * (cx - sx)), a = (Math.abs(ax - sx) + Math.abs(ay - sy)) / 2;
        if (A <= -a) continue;
        const B = -sign * ((bx - sx) * (cy - sy) - (by - sy) * (cx - sx)), b = (Math.abs(bx - sx) + Math.abs(by - sy)) / 2;
        if (B <= -b) continue;
        hidden = true;
        if (!astride && A >= a && B >= b) shadows[k] = true;
        else if (shadows[k] !== true) (shadows[k] ||= []).push(e);
      }
    }
    if (!hidden) return;
    const value = tx.map((x, k) => ink[ty[k] * w + x]), bends = new Array(16).fill(null);
    let around = [];
    if (this.near(this.nodesIn, I, J, 2).length) {
      for (let k = 0; k < 16; k++) if (shadows[k]) {
        const most = Math.hypot(tx[k] - cx, ty[k] - cy) + 2.4143;
        const useful = this.paths(tx[k], ty[k]).filter(([x, y, d]) => d + Math.hypot(x - cx, y - cy) < most);
        if (useful.length) bends[k] = useful;
      }
      around = this.near(this.edgesIn, I, J, 2);
    }
    const light = new Float64Array(16), seen = new Map();
    const sums = (kx, ky, all) => {
      let num = 0, den = 0;
      for (let k = 0; k < 16; k++) {
        const weight = kx[k & 3] * ky[k >> 2] * (all ? 1 : light[k]);
        num += weight * value[k];
        den += weight;
      }
      return [num, den];
    };
    for (let q = q0; q < q1; q++) for (let p = p0; p < p1; p++) {
      const x = I + X[p].f, y = J + Y[q].f;
      let all = true;
      seen.clear();
      for (let k = 0; k < 16; k++) {
        light[k] = 1;
        const shadow = shadows[k];
        if (!shadow || (shadow !== true && !this.blocked(shadow, x, y, tx[k], ty[k]))) continue;
        let least = 1;
        if (bends[k]) {
          const straight = Math.hypot(tx[k] - x, ty[k] - y);
          for (const bend of bends[k]) {
            const u = bend[0], v = bend[1], t = bend[3], detour = bend[2] + Math.sqrt((u - x) * (u - x) + (v - y) * (v - y)) - straight;
            if (detour >= least) continue;
            if (!seen.has(t)) seen.set(t, !this.blocked(around, x, y, u, v));
            if (seen.get(t)) least = detour;
          }
        }
        light[k] = 1 - smooth(least);
        all = false;
      }
      if (all) continue;
      let [num, den] = sums(X[p].k, Y[q].k), faith = 1;
      if (den < 0.5) {
        const share = smooth(den / 0.5), [numS, denS] = sums(spline(X[p].f), spline(Y[q].f));
        num = share * num + (1 - share) * numS;
        den = share * den + (1 - share) * denS;
        faith = smooth(denS * 10000);
      }
      if (faith > 0) {
        let result = num / den;
        if (faith < 1) { const [N, D] = sums(X[p].k, Y[q].k, true); result = faith * result + (1 - faith) * N / D; }
        tone[q * wide + p] = byte(result);
      }
    }
  }
}
