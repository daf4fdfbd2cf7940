// telling.js - telling lines: those that there is room for at the picture's size, swelling and tapered.
// The same steps as telling.ps; penink_cli/lines/strokes.py and selfdrawing/telling.py say why.

// Telling lines of a layer on a picture of width by height points: {xs, ys, widths} each, in points; widths has the pen's width at
// each point. A spot may have but one point.
function tellingOf(layer, width, height, white) {
  if (!layer.told.length) return [];
  if (!layer.toldAt || layer.toldAt.width !== width || layer.toldAt.height !== height || layer.toldAt.pen !== layer.linePen) {
    const sx = width / layer.lineGrid[0], sy = height / layer.lineGrid[1];
    const strokes = kind => {
      // finer pens have room for the lines of a picture that is as much larger
      const room = width * 1.001 / (layer.lineEven && !kind ? 1 : layer.fine), step = LADDER.filter(wide => wide <= room).length - 1;
      const drawn = layer.told.filter(line => line.white === kind && line.enters <= step);
      const pen = layer.linePen + (layer.lineEven ? WIDENED : 0);    // what a printer adds to a technical pen counts
      return drawn.map(line => kind ? pressed(line, sx, sy, WHITE_PEN, false) : pressed(line, sx, sy, pen, layer.lineEven));
    };
    layer.toldAt = {width, height, pen: layer.linePen, dark: strokes(false), white: strokes(true)};
  }
  return white ? layer.toldAt.white : layer.toldAt.dark;
}

function pressed({xs, ys, weights, breadth}, sx, sy, pen, even) {
  const broad = breadth && (even ? pen : Math.max(breadth / 2 * Math.sqrt(sx * sy), LINE_FINEST * pen));
  const px = xs.map(x => x * sx), py = ys.map(y => y * sy), n = px.length;
  if (n === 1) return {xs: px, ys: py, widths: [broad || pen]};
  const legs = px.slice(1).map((x, i) => far(x - px[i], py[i + 1] - py[i]));
  const ring = !breadth && n > 5 && far(px[0] - px[n - 1], py[0] - py[n - 1]) < Math.max(...legs) / 3;
  if (ring) {
    px[n - 1] = px[0];
    py[n - 1] = py[0];
    legs[n - 2] = Math.max(1e-9, far(px[0] - px[n - 2], py[0] - py[n - 2]));
  }
  // directions: of the parabola through each point and its neighbours
  const slope = (at, i) => (at[i + 1] - at[i]) / legs[i];
  const lean = at => {
    const inner = (i, k) => (slope(at, i) * legs[k] + slope(at, k) * legs[i]) / (legs[i] + legs[k]);
    const out = at.map((_, i) => i && i < n - 1 ? inner(i - 1, i) : 0);
    if (n === 2) return [slope(at, 0), slope(at, 0)];
    out[0] = ring ? inner(n - 2, 0) : 2 * slope(at, 0) - out[1];
    out[n - 1] = ring ? out[0] : 2 * slope(at, n - 2) - out[n - 2];
    return out;
  };
  const lx = lean(px), ly = lean(py), qx = [px[0]], qy = [py[0]], press = [weights[0]], run = [0];
  let way = 0;
  for (let i = 0; i < n - 1; i++) {
    const parts = Math.max(1, Math.ceil(legs[i] / LINE_STEP)), third = legs[i] / 3;
    for (let k = 1; k <= parts; k++) {
      const t = k / parts, r = 1 - t, a = r * r * r, b = 3 * r * r * t, c = 3 * r * t * t, d = t * t * t, last = i === n - 2 && k === parts;
      const at = way + t * legs[i];
      if (!last && at - run[run.length - 1] < LINE_STEP / 2) continue;     // closer ones are the photograph's noise
      qx.push(a * px[i] + b * (px[i] + lx[i] * third) + c * (px[i + 1] - lx[i + 1] * third) + d * px[i + 1]);
      qy.push(a * py[i] + b * (py[i] + ly[i] * third) + c * (py[i + 1] - ly[i + 1] * third) + d * py[i + 1]);
      press.push(r * weights[i] + t * weights[i + 1]);
      run.push(at);
    }
    way += legs[i];
  }
  const shorter = 0.8 + 0.2 * Math.min(1, way / 40), tapers = Math.min(LINE_TAPER, Math.max(way / 2, 1e-9));
  const widths = run.map((at, i) => {
    if (breadth || even) return broad || pen;
    const t = ring ? 1 : clamp(Math.min(at, way - at) / tapers, 0, 1), tip = LINE_TIP + (1 - LINE_TIP) * t * (2 - t);
    return pen * Math.max((LINE_FINEST + (1 - LINE_FINEST) * press[i]) * tip * shorter, 0.7 * LINE_FINEST);
  });
  return {xs: qx, ys: qy, widths};
}

// The outlines of a line that swells, each [xs, ys], cut in pieces where it bends so sharply that a side would turn back.
function outlined({xs, ys, widths}) {
  const n = xs.length, out = [], turn = Array.from({length: n}, () => 0), dx = [], dy = [];
  if (n === 1) return [round(xs[0], ys[0], widths[0] / 2, 0, 2 * Math.PI)];
  for (let i = 0; i < n - 1; i++) {
    const long = Math.max(1e-9, far(xs[i + 1] - xs[i], ys[i + 1] - ys[i]));
    dx.push((xs[i + 1] - xs[i]) / long);
    dy.push((ys[i + 1] - ys[i]) / long);
  }
  for (let i = 1; i < n - 1; i++) {
    const bend = Math.abs(Math.atan2(dx[i - 1] * dy[i] - dy[i - 1] * dx[i], dx[i - 1] * dx[i] + dy[i - 1] * dy[i]));
    turn[i] = widths[i] / 2 * Math.tan(Math.min(1.5, bend / 2)) > 0.6 * Math.min(far(xs[i + 1] - xs[i], ys[i + 1] - ys[i]), far(xs[i] - xs[i - 1], ys[i] - ys[i - 1])) || bend > 1 ? 1 : 0;
  }
  for (let from = 0, to; from < n - 1; from = to) {
    for (to = from + 1; to < n - 1 && !turn[to];) to++;
    const left = [[], []], right = [[], []];
    for (let i = from; i <= to; i++) {
      const a = Math.max(from, i - 1), b = Math.min(to - 1, i);
      let x = dx[a] + dx[b], y = dy[a] + dy[b];
      const long = far(x, y), half = widths[i] / 2;
      x /= long; y /= long;
      left[0].push(xs[i] + y * half); left[1].push(ys[i] - x * half);
      right[0].unshift(xs[i] - y * half); right[1].unshift(ys[i] + x * half);
    }
    const begins = Math.atan2(dy[from], dx[from]), ends = Math.atan2(dy[to - 1], dx[to - 1]);
    const head = round(xs[to], ys[to], widths[to] / 2, ends - Math.PI / 2, ends + Math.PI / 2), tail = round(xs[from], ys[from], widths[from] / 2, begins + Math.PI / 2, begins + 3 * Math.PI / 2);
    out.push([0, 1].map(k => left[k].concat(head[k], right[k], tail[k])));
  }
  return out;
}
function round(x, y, radius, from, upto) {
  const steps = Math.max(3, Math.ceil((upto - from) * Math.sqrt(radius) * 3)), at = Array.from({length: steps - 1}, (_, k) => from + (upto - from) * (k + 1) / steps);
  return [at.map(a => x + radius * Math.cos(a)), at.map(a => y + radius * Math.sin(a))];
}

// The dark lines that are seen in the window, in the widths to ask of the device. Their ink is added to the blocks.
function tellingOn(layer, blocks, gain) {
  const ink = new Float64Array(blocks.bare.length), out = [], more = -MEAN * gain;
  for (const {xs, ys, widths} of tellingOf(layer, blocks.width, blocks.height, false)) {
    if (!xs.some((x, i) => x > blocks.x0 - 3 && x < blocks.x1 + 3 && ys[i] > blocks.y0 - 3 && ys[i] < blocks.y1 + 3)) continue;
    out.push({xs, ys, widths: widths.map(w => Math.max(0.05, w + more))});
    for (let i = 0; i < xs.length; i++) {
      const x = xs[i], y = ys[i], j = Math.min(i + 1, xs.length - 1), wide = widths[i], area = i < j ? wide * far(xs[j] - x, ys[j] - y) : xs.length === 1 ? Math.PI / 4 * wide * wide : 0;
      const a = Math.floor(x / blocks.side) - blocks.left, b = Math.floor(y / blocks.side) - blocks.top;
      if (x >= 0 && y >= 0 && x < blocks.width && y < blocks.height && a >= 0 && b >= 0 && a < blocks.across && b < blocks.down) ink[b * blocks.across + a] += area;
    }
  }
  blocks.cover(ink);
  return out;
}

// Light lines: the tone along them is taken away where it is dark.
function lighten(sheet, lines) {
  if (!lines.length) return;
  const {tone, unit, perX, perY, x0, y0, wide, tall} = sheet, lifted = tone.slice();
  for (const {xs, ys, widths} of lines) for (let i = 0; i + 1 < xs.length; i++) {
    const long = far(xs[i + 1] - xs[i], ys[i + 1] - ys[i]), steps = Math.max(1, Math.ceil(long / unit)), half = widths[i] / 2 / unit;
    for (let k = 0; k < steps; k++) {
      const x = (xs[i] + (xs[i + 1] - xs[i]) * k / steps) / unit * perX - x0, y = (ys[i] + (ys[i + 1] - ys[i]) * k / steps) / unit * perY - y0;
      for (let q = Math.max(0, Math.floor(y - half)); q <= Math.min(tall - 1, Math.floor(y + half)); q++)
        for (let p = Math.max(0, Math.floor(x - half)); p <= Math.min(wide - 1, Math.floor(x + half)); p++) {
          const at = q * wide + p, share = clamp(half + 0.5 - far(p + 0.5 - x, q + 0.5 - y), 0, 1);
          const left = tone[at] * (1 - share * clamp((tone[at] / 255 - WHITE_FROM) / (WHITE_FULL - WHITE_FROM), 0, 1));
          lifted[at] = Math.min(lifted[at], left);
        }
    }
  }
  sheet.tone = lifted;
}
