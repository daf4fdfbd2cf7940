// follow.js - hatching along a field of directions. The same steps as penink_cli/blasting/form.py and shares.py, which lay all lines
// anew to make tone true; here the pen's pressure does at the end.

// How much of the paper each layer, [turn, low, high], is to cover for a tone 0 .. 1.
function sharesOf(tone, layers) {
  const out = [];
  let bare = 1, before = 0, here = tone > layers[0][1];
  layers.forEach(([, , high], i) => {
    let reached = tone, after = false;
    if (i + 1 < layers.length) {
      const onset = layers[i + 1][1];
      after = here && tone > onset;
      if (after) reached = high - GIVES_WAY * (high - before) * (1 - smooth((tone - onset) / BACK_AFTER));
    }
    const cover = here ? clamp(1 - (1 - reached) / bare, 0, 1) : 0;
    bare *= 1 - cover;
    out.push(cover);
    before = high;
    here = after;
  });
  return out;
}

// Means over squares of 2 reach + 1 cells, of a grid `wide` across.
function boxMean(values, wide, reach) {
  const tall = values.length / wide, across = new Float32Array(values.length), out = new Float32Array(values.length);
  for (const [from, into, count, many, step, next] of [[values, across, wide, tall, 1, wide], [across, out, tall, wide, wide, 1]])
    for (let line = 0; line < many; line++) {
      const at = k => from[line * next + clamp(k, 0, count - 1) * step];
      let sum = 0;
      for (let k = -reach; k <= reach; k++) sum += at(k);
      for (let k = 0; k < count; k++) { into[line * next + k * step] = sum / (2 * reach + 1); sum += at(k + reach + 1) - at(k - reach); }
    }
  return out;
}

// Nodes at every so many cells of a sheet, the same ones wherever the window is.
function nodesOf({x0, y0, wide, tall, perX, perY}, every) {
  const i0 = Math.ceil(x0 / every) * every, j0 = Math.ceil(y0 / every) * every;
  return {
    i0, j0, every, columns: Math.max(1, Math.ceil((x0 + wide - i0) / every)), rows: Math.max(1, Math.ceil((y0 + tall - j0) / every)),
    left: (i0 + 0.5) / perX, top: (j0 + 0.5) / perY, dx: every / perX, dy: every / perY,
  };
}
// A grid's values from those of the sheet's cells.
function pick(sheet, {i0, j0, every, columns, rows}, values) {
  const out = new Float32Array(columns * rows);
  for (let j = 0, k = 0; j < rows; j++) for (let i = 0, from = (j0 + j * every - sheet.y0) * sheet.wide + i0 - sheet.x0; i < columns; i++, k++) out[k] = values[from + i * every];
  return out;
}

// The lines' unit normals at the nodes, either way, `turn` degrees from the field, which is looked up in places a few cells apart.
function normalsOf(sheet, grid, turn) {
  const {layer: {field}, n, m, x0, y0, wide, tall} = sheet, count = grid.columns * grid.rows, nx = new Float32Array(count), ny = new Float32Array(count);
  const across = Math.max(field.cos.w, Math.ceil(n / FIELD_CELLS)), down = Math.max(field.cos.h, Math.ceil(m / FIELD_CELLS));
  const left = Math.floor(x0 * across / n), top = Math.floor(y0 * down / m), right = Math.min(across, Math.ceil((x0 + wide) * across / n)), bottom = Math.min(down, Math.ceil((y0 + tall) * down / m));
  const [C, S] = [field.cos, field.sin].map(part => part.tone(across, down, left, top, right, bottom)), cos = new Float32Array(count), sin = new Float32Array(count);
  const place = (k, i0, cells, places, from, upto) => {       // between the two places nearest to a node
    const at = (i0 + k * grid.every + 0.5) * places / cells - 0.5 - from, low = clamp(Math.floor(at), 0, upto - from - 1);
    return [low, Math.min(low + 1, upto - from - 1), clamp(at - low, 0, 1)];
  };
  const columns = Array.from({length: grid.columns}, (_, i) => place(i, grid.i0, n, across, left, right));
  for (let j = 0, p = 0; j < grid.rows; j++) {
    const [a, b, f] = place(j, grid.j0, m, down, top, bottom), above = a * (right - left), below = b * (right - left);
    for (let i = 0; i < grid.columns; i++, p++) {
      const [c, d, g] = columns[i];
      cos[p] = (C[above + c] * (1 - g) + C[above + d] * g) * (1 - f) + (C[below + c] * (1 - g) + C[below + d] * g) * f;
      sin[p] = (S[above + c] * (1 - g) + S[above + d] * g) * (1 - f) + (S[below + c] * (1 - g) + S[below + d] * g) * f;
    }
  }
  const a = Math.cos(turn * Math.PI / 90), b = Math.sin(turn * Math.PI / 90);
  for (let p = 0; p < count; p++) {
    let c = cos[p] / 127.5 - 1, s = sin[p] / 127.5 - 1;
    const long = Math.max(1e-3, far(c, s)), u = (c * a - s * b) / long, v = (s * a + c * b) / long;
    const half = Math.sqrt(Math.max(0, (1 + Math.abs(u)) / 2)), other = v / 2 / half;
    nx[p] = u >= 0 ? -other : v < 0 ? half : -half;
    ny[p] = u >= 0 ? half : Math.abs(other);
  }
  return [nx, ny];
}

// The edges over which the tone steps so strongly that lines end there.
function wallsOf(sheet) {
  const {layer: {picture}, tone, n, m, x0, y0, wide, tall} = sheet, E = picture.edges, out = new Uint8Array(picture.count), px = n / picture.w, py = m / picture.h;
  const at = (x, y) => tone[clamp(Math.floor(y) - y0, 0, tall - 1) * wide + clamp(Math.floor(x) - x0, 0, wide - 1)];
  for (let e = 0; e < picture.count; e++) {
    const ax = (E[7 * e] + 0.5) * px, ay = (E[7 * e + 1] + 0.5) * py, bx = (E[7 * e + 2] + 0.5) * px, by = (E[7 * e + 3] + 0.5) * py;
    if (Math.max(ax, bx) < x0 || Math.min(ax, bx) > x0 + wide || Math.max(ay, by) < y0 || Math.min(ay, by) > y0 + tall) continue;
    const long = Math.max(1e-6, far(bx - ax, by - ay)), u = 1.5 * (by - ay) / long, v = 1.5 * (ax - bx) / long;
    let step = 0;
    for (const t of [0.2, 0.5, 0.8]) {
      const x = ax + t * (bx - ax), y = ay + t * (by - ay);
      step = Math.max(step, Math.abs(at(x + u, y + v) - at(x - u, y - v)));
    }
    out[e] = step > WALL ? 1 : 0;
  }
  return out;
}

// The links that walls cross: bit 0 to the right of a node, bit 1 below it.
function weakOf(sheet, {i0, j0, every, columns, rows}, walls) {
  const {layer: {picture}, n, m} = sheet, E = picture.edges, weak = new Uint8Array(columns * rows);
  const pass = (a0, b0, a1, b1, count, other, mark) => {
    if (a0 > a1) [a0, b0, a1, b1] = [a1, b1, a0, b0];
    for (let k = Math.max(0, Math.floor(a0) + 1); k <= Math.min(count - 1, a1); k++) {
      const t = b0 + (b1 - b0) * (k - a0) / (a1 - a0);
      if (t >= 0 && t < other) mark(k, Math.floor(t));
    }
  };
  for (let e = 0; e < picture.count; e++) if (walls[e]) {
    const [ax, bx] = [0, 2].map(k => ((E[7 * e + k] + 0.5) * n / picture.w - 0.5 - i0) / every), [ay, by] = [1, 3].map(k => ((E[7 * e + k] + 0.5) * m / picture.h - 0.5 - j0) / every);
    pass(ay, ax, by, bx, rows, columns, (j, i) => { weak[j * columns + i] |= 1; });
    pass(ax, ay, bx, by, columns, rows, (i, j) => { weak[j * columns + i] |= 2; });
  }
  return weak;
}

// Lines of that density (a unit) along the field, for each level of the phase: [xs, ys] each, in steps of about a unit. The phase found
// before is kept as long as the picture is as large.
function linesAlong(sheet, number, turn, density, wanted, every, walls, spacing, levels = [0]) {
  const grid = nodesOf(sheet, every), [nx, ny] = normalsOf(sheet, grid, turn), dense = pick(sheet, grid, density), {layer, n, m} = sheet;
  if (!layer.phases || layer.phases.n !== n || layer.phases.m !== m) layer.phases = {n, m, known: []};
  const psi = phaseOf(grid, nx, ny, dense, weakOf(sheet, grid, walls), layer.phases.known[number]);
  // near the window's border the phase is not settled
  const rim = Math.ceil(12 / every), {columns, rows, i0, j0} = grid;
  layer.phases.known[number] = {
    psi, i0, j0, every, columns, left: i0 > every ? rim : 0, top: j0 > every ? rim : 0,
    right: i0 + columns * every < n ? columns - rim : columns, bottom: j0 + rows * every < m ? rows - rim : rows,
  };
  const there = wanted ? pick(sheet, grid, wanted) : new Uint8Array(psi.length).fill(1), rounds = clamp(Math.round(LINE_SMOOTHING * spacing * spacing), 2, 40);
  return levels.map(level => evened(levelLines(grid, psi, nx, ny, dense, there, level), rounds, 2).map(line => prolonged(line, sheet)));
}

// Lines that end at the outermost nodes, half a cell within the frame, go on beyond it.
function prolonged(line, {width, height}) {
  const [xs, ys] = line, n = xs.length, near = k => xs[k] < 1.5 || ys[k] < 1.5 || xs[k] > width - 1.5 || ys[k] > height - 1.5, begins = near(0), ends = near(n - 1);
  if (xs[0] === xs[n - 1] && ys[0] === ys[n - 1] || !begins && !ends) return line;
  return line.map(at => Float64Array.from([...begins ? [2.5 * at[0] - 1.5 * at[1]] : [], ...at, ...ends ? [2.5 * at[n - 1] - 1.5 * at[n - 2]] : []]));
}

// A number 0 .. 1 that depends on a place alone.
function chance(x, y) {
  let h = Math.imul(Math.round(x * 1.3) | 0, 0x9e3779b1) ^ Math.imul(Math.round(y * 1.3) | 0, 0x85ebca6b);
  h = Math.imul(h ^ h >>> 15, 0x2c1b3c6d);
  return ((h ^ h >>> 13) >>> 8) / 16777216;
}

// Where the walls of a picture cross the way from (x, y) to (u, v), units: nearest to its start; -1 for nowhere.
function wallBetween({layer: {picture}, width, height}, walls, x, y, u, v) {
  const E = picture.edges, gx = picture.w / width, gy = picture.h / height;
  x = x * gx - 0.5; y = y * gy - 0.5; u = u * gx - 0.5; v = v * gy - 0.5;
  let best = 2;
  for (let j = Math.max(-1, Math.floor(Math.min(y, v))); j <= Math.min(picture.h - 1, Math.floor(Math.max(y, v))); j++)
    for (let i = Math.max(-1, Math.floor(Math.min(x, u))); i <= Math.min(picture.w - 1, Math.floor(Math.max(x, u))); i++) {
      const list = picture.edgesIn[picture.at(i, j)];
      if (list) for (const e of list) if (walls[e] && picture.between(e, x, y, u, v)) {
        const k = 7 * e, p = E[k + 4] * y - E[k + 5] * x + E[k + 6], q = E[k + 4] * v - E[k + 5] * u + E[k + 6];
        best = Math.min(best, p / (p - q));
      }
    }
  return best > 1 ? -1 : best;
}

// How much each screen covers in each cell of the sheet: where the picture is black the first closes up, and the others end.
function coversOf(sheet) {
  const {tone, wide, layer: {form, black}} = sheet;
  const hatched = black < 1 ? form.slice(0, -1) : form, table = hatched.map(() => new Float32Array(256));
  for (let t = 0; t < 256; t++) sharesOf(Math.min(t / 255, 0.995), hatched).forEach((cover, i) => { table[i][t] = cover; });
  // a layer is not begun for a spot
  const around = boxMean(tone, wide, 6), out = hatched.map(() => new Float32Array(tone.length));
  for (let k = 0; k < tone.length; k++) {
    const t = tone[k];
    let onset = 0;
    for (let i = 1; i < hatched.length; i++) if (t > 255 * hatched[i][1] && around[k] <= 255 * hatched[i][1] && t <= 255 * (hatched[i][1] + 0.15)) { onset = i; break; }
    if (onset) {
      const few = sharesOf(t / 255, hatched.slice(0, onset));
      for (let i = 0; i < onset; i++) out[i][k] = few[i];
    } else for (let i = 0; i < hatched.length; i++) out[i][k] = table[i][t];
  }
  if (black < 1) {
    const part = boxMean(tone.map((t, k) => t > 255 * black && (around[k] > 255 * black || t > 255 * (black + 0.03)) ? 1 : 0), wide, 3);
    for (let k = 0; k < tone.length; k++) if (part[k] > 0) {
      out[0][k] += (CLOSE - out[0][k]) * part[k];
      if (part[k] > 0.999) for (let i = 1; i < out.length; i++) out[i][k] = 0;
    }
  }
  return out;
}

// Where next to nothing is covered, the density around, over 4 x 4 cells, is carried on: lines would turn aside where it fell to nothing.
function carriedOn(density, cover, wide, reach) {
  const tall = cover.length / wide, across = wide + 3 >> 2, down = tall + 3 >> 2;
  let known = new Float32Array(across * down), thick = new Float32Array(across * down);
  for (let j = 0, k = 0; j < tall; j++) for (let i = 0; i < wide; i++, k++) {
    const c = (j >> 2) * across + (i >> 2), there = density[k] * Math.min(1, cover[k] / FAINT);
    known[c] += there;
    thick[c] += there * density[k];
  }
  for (let round = 0; round < 3; round++) { known = boxMean(known, across, reach); thick = boxMean(thick, across, reach); }
  for (let j = 0, k = 0; j < tall; j++) for (let i = 0; i < wide; i++, k++) {
    const c = (j >> 2) * across + (i >> 2), around = Math.max(SPARSEST, thick[c] / Math.max(1e-6, known[c])), d = density[k];
    if (d > around) continue;
    const t = smooth((cover[k] - FAINT / 4) * 4 / (3 * FAINT));
    density[k] = d * t + around * (1 - t);
  }
  return density;
}

// Strokes of a layer along its field: stroke(layer, screen, count, pressure), the points in alongX and alongY.
function follow(sheet, every, stroke) {
  const {layer, wide, tall, x0, y0, perX, perY, blocks, unit, gain} = sheet, {pen} = layer, walls = wallsOf(sheet), found = [], inks = [];
  const per = unit / blocks.side, blockAt = (x, y) => {
    const a = Math.floor(x * per) - blocks.left, b = Math.floor(y * per) - blocks.top;
    return x < 0 || y < 0 || x >= sheet.width || y >= sheet.height || a < 0 || b < 0 || a >= blocks.across || b >= blocks.down ? -1 : b * blocks.across + a;
  };
  coversOf(sheet).forEach((cover, number) => {
    const ink = new Float64Array(blocks.bare.length), some = cover.some(c => c > RAGGED[0]);
    inks.push(ink);
    if (!some) return;
    const solid = 0.9 * CLOSE;
    const density = carriedOn(cover.map(c => c / pen), cover, wide, 2);
    const near = boxMean(cover.map(c => c > RAGGED[0] ? 1 : 0), wide, 3);
    const cell = (x, y) => clamp(Math.floor(y * perY) - y0, 0, tall - 1) * wide + clamp(Math.floor(x * perX) - x0, 0, wide - 1), at = (x, y) => cover[cell(x, y)];
    for (const [xs, ys] of linesAlong(sheet, number, layer.form[number][0], density, near, every, walls, 3)[0]) {
      const n = xs.length, due = chance(xs[n >> 1], ys[n >> 1]), enough = RAGGED[0] + (RAGGED[1] - RAGGED[0]) * due;
      let points = [], black = false, walled = false;
      const end = () => {
        if (points.length > 2 * STROKE_LEAST || walled && points.length > 2) {          // between walls even a short one tells
          found.push([number, points, black]);
          for (let k = 0; k + 3 < points.length; k += 2) {
            const b = blockAt(points[k], points[k + 1]);
            if (b >= 0) ink[b] += far(points[k + 2] - points[k], points[k + 3] - points[k + 1]) * pen;
          }
        }
        points = [];
        walled = false;
      };
      for (let k = 0; k < n; k++) {
        const x = xs[k], y = ys[k], w = WAVER[0] * SINE[(WAVER[1] * x + WAVER[2] * y) * STEPS & TURN - 1] * 0.7;
        const c = cell(x, y), there = cover[c] > enough && cover[c] > due * density[c] * pen;   // of lines too many some are left out
        if (black !== cover[c] > solid) {                     // into black, or out of it, a line goes on as another stroke
          const last = points.slice(-2);
          walled = true;
          end();
          black = !black;
          walled = true;
          points = last;
        }
        if (there) points.push(x + w, y + w);
        const cut = points.length > 2 * STROKE_PT[0] && chance(x, y) < 1 / 24 || points.length > 2 * STROKE_PT[1];
        if (!there || cut) { end(); continue; }
        if (k + 1 < n) {
          const t = wallBetween(sheet, walls, x, y, xs[k + 1], ys[k + 1]);
          if (t >= 0) {
            const back = t - pen / 2;
            if (back > 0) points.push(x + w + back * (xs[k + 1] - x), y + w + back * (ys[k + 1] - y));
            else if (points.length > 2) { points[points.length - 2] += back * (x - xs[k - 1] || 0); points[points.length - 1] += back * (y - ys[k - 1] || 0); }
            walled = true;
            end();
            walled = true;
          }
        }
      }
      end();
    }
  });
  // the pen's pressure makes up for ink that is lacking, or too much
  let slope = blocks.bare.map(() => 0);
  const clear = blocks.bare.slice();
  for (const ink of inks) {
    const covered = ink.map((area, k) => Math.min(0.97, area * unit * unit / blocks.area(k)));
    slope = slope.map((s, k) => s + covered[k] / (1 - covered[k]));
    blocks.cover(ink.map(area => area * unit * unit));
  }
  slope = slope.map((s, k) => s * Math.min(clear[k], blocks.bare[k]));
  const lack = sheet.lacking(), press = lack.map((more, k) => slope[k] > 0.004 ? clamp(1 + more / 255 / slope[k], PRESSED[0], PRESSED[1]) : 1);
  lack.forEach((_, k) => { blocks.bare[k] = clamp(blocks.bare[k] - (press[k] - 1) * slope[k], 0, 1); });
  for (const [number, points, black] of found) {
    let sum = 0, some = 0;
    for (let k = 0; k < points.length; k += 8) {
      const b = blockAt(points[k], points[k + 1]);
      if (b >= 0) { sum += press[b]; some++; }
    }
    let count = 0;
    const skip = points.length > 24 ? 4 : 2, put = k => { alongX[count] = points[k]; alongY[count++] = points[k + 1]; };
    for (let k = 0; k < points.length - 2; k += skip) put(k);
    put(points.length - 2);
    stroke(layer, layer.screens[number], count, black ? PRESSED[2] : some ? Math.round(20 * sum / some) / 20 : 1);
  }
}
