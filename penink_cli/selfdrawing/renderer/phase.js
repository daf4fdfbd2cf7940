// phase.js - a phase whose level lines run along a field of directions, as dense as is asked.
// The same steps as penink_cli/blasting/phase.py and level_lines.py, which say why.
//
// A grid is {columns, rows, left, top, dx, dy, i0, j0, every}: node (i, j) lies at (left + i dx, top + j dy), and is cell
// (i0 + i every, j0 + j every) of the picture's tone. Its arrays have a number a node.

// The links from each node to the right and downwards: weight times cosine and sine of the change predicted, and the sign.
function linksOf({columns, rows, dx, dy}, nx, ny, density, weak) {
  const out = new Float32Array(6 * columns * rows);
  for (let j = 0, p = 0; j < rows; j++) for (let i = 0; i < columns; i++, p++) for (let k = 0; k < 2; k++) {
    const o = 6 * p + 3 * k, q = k ? p + columns : p + 1;
    out[o + 2] = 1;
    if (k ? j + 1 >= rows : i + 1 >= columns) continue;
    const dot = nx[p] * nx[q] + ny[p] * ny[q], sign = dot < 0 ? -1 : 1, a = k ? ny[p] : nx[p], b = sign * (k ? ny[q] : nx[q]);
    const weight = (LINK_LEAST + (1 - LINK_LEAST) * Math.abs(dot)) * (1 + LINK_ALONG * (1 - (a + b) * (a + b) / 4)) * (weak[p] >> k & 1 ? LINK_LEAK : 1);
    const at = Math.round((k ? dy : dx) / 2 * (density[p] * a + density[q] * b) * TURN);
    out[o] = weight * SINE[at + TURN / 4 & TURN - 1];
    out[o + 1] = weight * SINE[at & TURN - 1];
    out[o + 2] = sign;
  }
  return {columns, rows, links: out};
}

// Links between every second node: two in a row, of whose weights the lesser counts.
function halved({columns, rows, links}) {
  const across = columns + 1 >> 1, down = rows + 1 >> 1, out = new Float32Array(6 * across * down);
  for (let j = 0, o = 0; j < down; j++) for (let i = 0; i < across; i++) for (let k = 0; k < 2; k++, o += 3) {
    out[o + 2] = 1;
    if (k ? 2 * j + 1 >= rows : 2 * i + 1 >= columns) continue;
    const a = 6 * (2 * j * columns + 2 * i) + 3 * k, b = a + 6 * (k ? columns : 1);
    const c1 = links[a], s1 = links[a + 1], c2 = links[b], s2 = links[a + 2] * links[b + 1], most = Math.max(c1 * c1 + s1 * s1, c2 * c2 + s2 * s2);
    if (!most) continue;
    const w = 1 / Math.sqrt(most);
    out[o] = w * (c1 * c2 - s1 * s2);
    out[o + 1] = w * (c1 * s2 + s1 * c2);
    out[o + 2] = links[a + 2] * links[b + 2];
  }
  return {columns: across, rows: down, links: out};
}

// As `agree` below, in a fifth of the time: every second node of a row from p on, before `end`, none of them at the border.
function sweepRow(links, psi, set, columns, p, end) {
  for (; p < end; p += 2) {
    if (set[p] === 2) continue;
    const l = 6 * p, z = 2 * p, d = z + 2 * columns, u = l - 6 * columns, e = z - 2 * columns;
    const l0 = links[l], l1 = links[l + 1], l3 = links[l + 3], l4 = links[l + 4], k6 = links[l - 6], k5 = links[l - 5], u3 = links[u + 3], u4 = links[u + 4];
    const rx = psi[z + 2], ry = links[l + 2] * psi[z + 3], dx = psi[d], dy = links[l + 5] * psi[d + 1], lx = psi[z - 2], ly = psi[z - 1], ux = psi[e], uy = psi[e + 1];
    const x = l0 * rx + l1 * ry + l3 * dx + l4 * dy + k6 * lx - k5 * ly + u3 * ux - u4 * uy;
    const y = l0 * ry - l1 * rx + l3 * dy - l4 * dx + links[l - 4] * (k6 * ly + k5 * lx) + links[u + 5] * (u3 * uy + u4 * ux);
    const n = x * x + y * y;
    if (n <= 1e-12) continue;
    const by = 1 / Math.sqrt(n);
    psi[z] = x * by;
    psi[z + 1] = y * by;
  }
}

// The nodes' unit numbers, from those of the coarser grid, each brought to agree with its neighbours. Nodes that are known stay.
function relaxed({columns, rows, links}, coarse, sweeps, known) {
  const count = columns * rows, psi = new Float32Array(2 * count), set = known(columns, rows, psi);
  const agree = (p, i, j) => {
    if (set[p] === 2) return;
    const l = 6 * p, z = 2 * p;
    let x = 0, y = 0;
    if (i + 1 < columns) {
      const m = links[l + 2] * psi[z + 3];
      x = links[l] * psi[z + 2] + links[l + 1] * m;
      y = links[l] * m - links[l + 1] * psi[z + 2];
    }
    if (j + 1 < rows) {
      const d = z + 2 * columns, m = links[l + 5] * psi[d + 1];
      x += links[l + 3] * psi[d] + links[l + 4] * m;
      y += links[l + 3] * m - links[l + 4] * psi[d];
    }
    if (i > 0) {
      x += links[l - 6] * psi[z - 2] - links[l - 5] * psi[z - 1];
      y += links[l - 4] * (links[l - 6] * psi[z - 1] + links[l - 5] * psi[z - 2]);
    }
    if (j > 0) {
      const u = l - 6 * columns, d = z - 2 * columns;
      x += links[u + 3] * psi[d] - links[u + 4] * psi[d + 1];
      y += links[u + 5] * (links[u + 3] * psi[d + 1] + links[u + 4] * psi[d]);
    }
    const n = x * x + y * y;
    if (n <= 1e-12) return;
    const by = 1 / Math.sqrt(n);
    psi[z] = x * by;
    psi[z + 1] = y * by;
  };
  if (coarse) {
    const across = columns + 1 >> 1;
    for (let j = 0; j < rows; j += 2) for (let i = 0; i < columns; i += 2) {
      const p = j * columns + i, q = 2 * ((j >> 1) * across + (i >> 1));
      if (!set[p]) { psi[2 * p] = coarse[q]; psi[2 * p + 1] = coarse[q + 1]; }
    }
    for (let turn = 1; turn < 3; turn++)
      for (let j = 0; j < rows; j++) for (let i = 0; i < columns; i++) if ((j & 1) + (i & 1) === turn) agree(j * columns + i, i, j);
  }
  for (let p = 0; p < count; p++) if (psi[2 * p] * psi[2 * p] + psi[2 * p + 1] * psi[2 * p + 1] < 0.25) {
    const at = Math.imul(p + 1, 0x9e3779b1) >>> 8;            // chance
    psi[2 * p] = SINE[at + TURN / 4 & TURN - 1];
    psi[2 * p + 1] = SINE[at & TURN - 1];
  }
  for (let sweep = 0; sweep < sweeps; sweep++) for (let colour = 0; colour < 2; colour++)
    for (let j = 0; j < rows; j++) {
      const first = j + colour & 1, row = j * columns;
      if (!j || j === rows - 1 || columns < 4) { for (let i = first; i < columns; i += 2) agree(row + i, i, j); continue; }
      if (!first) agree(row, 0, j);
      sweepRow(links, psi, set, columns, row + (first || 2), row + columns - 1);
      if ((columns - 1 & 1) === first) agree(row + columns - 1, columns - 1, j);
    }
  return psi;
}

// The unit numbers of a grid. A part of them may be known from before, so that lines stay while the picture is moved.
function phaseOf(grid, nx, ny, density, weak, before) {
  const levels = [linksOf(grid, nx, ny, density, weak)];
  for (let last; last = levels[levels.length - 1], Math.min(last.columns, last.rows) > 4;) levels.push(halved(last));
  let psi = null;
  for (let k = levels.length - 1; k >= 0; k--) psi = relaxed(levels[k], psi, k ? COARSE_SWEEPS : SWEEPS, (columns, rows, into) => {
    const set = new Uint8Array(columns * rows), step = grid.every << k;
    if (before) for (let j = 0; j < rows; j++) for (let i = 0; i < columns; i++) {
      const x = (grid.i0 + i * step - before.i0) / before.every, y = (grid.j0 + j * step - before.j0) / before.every;
      if (x < before.left || y < before.top || x >= before.right || y >= before.bottom || x !== Math.floor(x) || y !== Math.floor(y)) continue;
      const p = j * columns + i, q = y * before.columns + x;
      into[2 * p] = before.psi[2 * q];
      into[2 * p + 1] = before.psi[2 * q + 1];
      set[p] = 2;
    }
    return set;
  });
  return psi;
}

// Level lines as polylines {xs, ys, first, ring}: where the phase is `level`, 0 or 1/2. A quad is two triangles; each node has the links to
// its right, downwards and across. Lines end at triangles around which the changes do not add up, and where nothing is wanted.
function levelLines({columns, rows, left, top, dx, dy}, psi, nx, ny, density, wanted, level) {
  const nodes = columns * rows, phase = new Float32Array(nodes), change = new Float32Array(3 * nodes), sign = new Int8Array(3 * nodes), begin = new Int32Array(3 * nodes + 1);
  for (let p = 0; p < nodes; p++) phase[p] = Math.atan2(psi[2 * p + 1], psi[2 * p]) / (2 * Math.PI) - level;
  let total = 0;
  const rx = new Float32Array(nodes), ry = new Float32Array(nodes);
  for (let p = 0; p < nodes; p++) { rx[p] = density[p] * nx[p] * dx / 2; ry[p] = density[p] * ny[p] * dy / 2; }
  for (let j = 0, p = 0; j < rows; j++) for (let i = 0; i < columns; i++, p++) for (let k = 0; k < 3; k++) {
    const l = 3 * p + k, q = k === 0 ? p + 1 : k === 1 ? p + columns : p + columns + 1;
    begin[l] = total;
    if (k !== 1 && i + 1 >= columns || k && j + 1 >= rows || !wanted[p] && !wanted[q]) continue;
    const s = nx[p] * nx[q] + ny[p] * ny[q] < 0 ? -1 : 1, predicted = (k !== 1 ? rx[p] + s * rx[q] : 0) + (k ? ry[p] + s * ry[q] : 0);
    const off = s * (phase[q] + level) - phase[p] - level - predicted;
    sign[l] = s;
    change[l] = predicted + off - Math.floor(off + 0.5);
    total += Math.abs(Math.floor(phase[p] + change[l]) - Math.floor(phase[p]));
  }
  begin[3 * nodes] = total;
  const x = new Float32Array(total), y = new Float32Array(total), across = new Uint8Array(total), one = new Int32Array(total).fill(-1), two = new Int32Array(total).fill(-1);
  const firstOf = (a, b) => Math.floor(b > 0 ? a : a + b) + 1;
  for (let j = 0, p = 0; j < rows; j++) for (let i = 0; i < columns; i++, p++) for (let k = 0; k < 3; k++) {
    const l = 3 * p + k, b = change[l];
    for (let c = begin[l], whole = firstOf(phase[p], b); c < begin[l + 1]; c++, whole++) {
      const t = (whole - phase[p]) / b;
      x[c] = left + dx * (i + (k !== 1 ? t : 0));
      y[c] = top + dy * (j + (k ? t : 0));
      across[c] = k >> 1;
    }
  }
  const join = (a, b) => { if (one[a] < 0) one[a] = b; else if (two[a] < 0) two[a] = b; };
  for (let j = 0; j + 1 < rows; j++) for (let i = 0; i + 1 < columns; i++) for (let h = 0; h < 2; h++) {
    const p = j * columns + i, r = h ? p + columns : p + 1, e0 = 3 * p + h, e1 = 3 * r + 1 - h, e2 = 3 * p + 2, s1 = sign[e0], count = k => begin[k + 1] - begin[k];
    if (count(e0) + count(e1) + count(e2) < 2 || sign[e0] * sign[e1] * sign[e2] <= 0) continue;
    if (Math.abs(change[e0] + s1 * change[e1] - change[e2]) > 0.3) continue;
    // the phase along the three links, as the corner sees it
    const a = phase[p], a1 = a + change[e0], low = Math.min(a, a1, a1 + s1 * change[e1]), high = Math.max(a, a1, a1 + s1 * change[e1]);
    for (let v = Math.floor(low) + 1; v <= high; v++) {
      let c = -1;
      for (let k = 0; k < 3; k++) {
        const e = k === 0 ? e0 : k === 1 ? e1 : e2, own = k === 1 ? phase[r] : a, at = Math.floor(own + (k === 1 ? s1 * (v - a1) : v - a) + 0.5) - firstOf(own, change[e]);
        if (at < 0 || at >= begin[e + 1] - begin[e]) continue;
        if (c < 0) c = begin[e] + at; else { join(c, begin[e] + at); join(begin[e] + at, c); break; }
      }
    }
  }
  // along the crossings; crossings of links across only lead on to the next
  const xs = new Float32Array(total + (total >> 2) + 1), ys = new Float32Array(total + (total >> 2) + 1), first = [0], ring = [];
  let n = 0;
  for (let turn = 0; turn < 2; turn++) for (let start = 0; start < total; start++) {
    if (one[start] < 0 || !turn && two[start] >= 0) continue;
    for (let at = start, before = -1; ;) {
      const after = one[at] !== before ? one[at] : two[at];
      if (!across[at] || !turn && (after < 0 || before < 0)) { xs[n] = x[at]; ys[n++] = y[at]; }
      one[at] = two[at] = -1;
      if (after < 0 || after === start) break;
      before = at;
      at = after;
    }
    const from = first[first.length - 1];
    if (turn && n - from >= 4) { xs[n] = xs[from]; ys[n++] = ys[from]; }
    if (n - from < 2 || turn && n - from < 5) { n = from; continue; }
    first.push(n);
    ring.push(!!turn);
  }
  return {xs, ys, first, ring};
}

// Numbers along a line, in place, as means of weights 1 2 1, so many times.
function softened(at, rounds, ring) {
  const last = at.length - 1;
  for (let round = 0; round < rounds; round++) {
    let before = ring ? at[last - 1] : at[0];
    for (let i = ring ? 0 : 1; i < last; i++) {
      const here = at[i];
      at[i] = (before + 2 * here + at[i + 1]) / 4;
      before = here;
    }
    if (ring) at[last] = at[0];
  }
  return at;
}

// The same lines in steps of about a unit, the corners that the grid gave them taken off: [xs, ys] each.
function evened({xs, ys, first, ring}, rounds, shortest) {
  const out = [];
  for (let line = 0; line + 1 < first.length; line++) {
    const from = first[line], upto = first[line + 1] - 1;
    let long = 0;
    for (let k = from; k < upto; k++) long += far(xs[k + 1] - xs[k], ys[k + 1] - ys[k]);
    if (long < shortest) continue;
    const steps = Math.max(1, Math.round(long)), step = long / steps, px = new Float64Array(steps + 1), py = new Float64Array(steps + 1);
    let k = from, way = 0, leg = far(xs[k + 1] - xs[k], ys[k + 1] - ys[k]);
    for (let i = 0; i <= steps; i++) {
      while (way + leg < i * step && k + 1 < upto) { way += leg; k++; leg = far(xs[k + 1] - xs[k], ys[k + 1] - ys[k]); }
      const t = leg ? Math.min(1, (i * step - way) / leg) : 0;
      px[i] = xs[k] + t * (xs[k + 1] - xs[k]);
      py[i] = ys[k] + t * (ys[k + 1] - ys[k]);
    }
    for (const at of [px, py]) softened(at, rounds, ring[line]);
    out.push([px, py]);
  }
  return out;
}
