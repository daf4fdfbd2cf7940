// data.js - the illustration's data, as penink_cli/selfdrawing/data.py writes them.

class Reader {
  constructor(bytes) { this.bytes = bytes; this.at = 0; }
  byte() { return this.bytes[this.at++]; }
  word() { return this.byte() * 256 + this.byte(); }

  // Ink levels, each coded modulo levels as its difference from the median of left, upper and left + upper - corner.
  samples(w, h, levels) { return this.levels(w, h, levels).map(v => Math.floor(v * 255 / (levels - 1) + 0.5)); }
  levels(w, h, levels) {
    const level = new Uint8Array(w * h);
    for (let j = 0; j < h; j++) for (let i = 0; i < w; i++) {
      const k = j * w + i, left = i ? level[k - 1] : j ? level[k - w] : 0, up = j ? level[k - w] : left;
      const corner = i && j ? level[k - w - 1] : j ? up : left;
      const median = Math.max(Math.min(left, up), Math.min(Math.max(left, up), left + up - corner));
      level[k] = (median + this.byte()) % levels;
    }
    return level;
  }

  // Chains of edges: number of edges, first vertex, steps, in 16ths of a sample.
  edges(chains, outlined) {
    const numbers = new Map(), xs = [], ys = [], ends = [], outlines = [];
    const vertex = (x, y) => {
      const key = x * 8192 + y;
      if (!numbers.has(key)) {
        numbers.set(key, xs.length);
        xs.push((x - 0.5) / 16 - 0.5);
        ys.push((y - 0.5) / 16 - 0.5);
      }
      return numbers.get(key);
    };
    for (let c = 0; c < chains; c++) {
      const count = this.word();
      const pressure = c < outlined ? this.byte() : 0;
      let x = this.word(), y = this.word();
      const chain = [vertex(x, y)];
      for (let e = 0; e < count; e++) {
        const dx = this.byte() - 128, dy = this.byte() - 128;
        if (dx || dy) { x += dx; y += dy; } else { x = this.word(); y = this.word(); }
        chain.push(vertex(x, y));
        ends.push(chain.slice(-2));
      }
      if (c < outlined) outlines.push({pressure, xs: chain.map(v => xs[v]), ys: chain.map(v => ys[v])});
    }
    return {xs, ys, ends, outlines};
  }

  // Directions, coded as samples are: pictures of the cosine and the sine of twice the angle, each as 127.5 (1 + value).
  field(w, h, {picture, xs, ys, ends}) {
    if (!w) return null;
    const angle = this.levels(w, h, ANGLES), part = of => new Picture(w, h, angle.map(k => byte(127.5 + 127.5 * of(2 * Math.PI * k / ANGLES))),
      xs.map(x => (x + 0.5) * w / picture.w - 0.5), ys.map(y => (y + 0.5) * h / picture.h - 0.5), ends);
    const field = {cos: part(Math.cos), sin: part(Math.sin)};
    for (const half of [field.cos, field.sin]) half.nodesIn = [];           // no paths around the ends of edges: a field needs none
    return field;
  }

  // Telling lines: step of the ladder, breadth, number of points, the first point, differences of steps, weights.
  told(dark, white) {
    return Array.from({length: dark + white}, (_, k) => {
      const enters = this.byte(), breadth = this.word(), count = this.word();
      let x = this.word(), y = this.word(), dx = 0, dy = 0;
      const xs = [x], ys = [y];
      for (let i = 1; i < count; i++) { xs.push(x += dx += this.byte() - 128); ys.push(y += dy += this.byte() - 128); }
      return {enters, breadth, xs, ys, weights: xs.map(() => this.byte() / 15), white: k >= dark};
    });
  }

  // The strokes of a tile: threshold, first point, three steps from there, in quarters of a point. Those of a tile that grows begin
  // with their span, and have a longer threshold.
  tile({tile, fresh, covers, whole, widens, strokes: count, grows}) {
    const strokes = [], spans = grows ? [] : null;
    for (let k = 0; k < count; k++) {
      if (grows) spans.push([this.byte(), this.byte()]);
      const limit = grows ? (this.word() + 0.5) / SPAN_PARTS : this.byte(), u0 = this.word() / 4, v0 = this.word() / 4;
      const [x1, y1, x2, y2, x3, y3] = Array.from({length: 6}, () => (this.byte() - 128) / 4);
      const axis = (first, a, b, c) => [first, 3 * a, 3 * (b - 2 * a), c - 3 * a - 3 * (b - 2 * a)];
      strokes.push(Math.hypot(x3, y3), ...axis(u0, x1, x2, x3), ...axis(v0, y1, y2, y3), limit, freshInk(limit / 255, covers, fresh), -1);
    }
    return {angle: 0, strokes: Float64Array.from(strokes), tile, whole, wave: 0, turn: 0, widens, spans};
  }
}

// Layers from the description in the page and its bytes.
function readLayers(description, bytes) {
  const reader = new Reader(bytes);
  return description.map(d => {
    const ink = reader.samples(d.w, d.h, d.levels), {xs, ys, ends, outlines} = reader.edges(d.chains, d.outlined);
    const screens = [], picture = new Picture(d.w, d.h, ink, xs, ys, ends);
    d.screens.forEach((s, i) =>
      screens.push(Array.isArray(s) ? lines(i, ...s) : "again" in s ? again(screens[0], s.again) : reader.tile(s)));
    const curve = d.gamma === 1 ? null :
      Uint8Array.from({length: 256}, (_, t) => Math.floor(255 * (1 - (1 - t / 255) ** d.gamma) + 0.5));
    const field = reader.field(...d.field, {picture, xs, ys, ends}), told = reader.told(...d.told);
    return {picture, screens, outlines, curve, field, told, form: d.form, black: d.black, ink: d.ink, engraving: d.engraving, lineGrid: d.lineGrid, linePen: d.linePen, lineEven: d.lineEven,
      family: d.family, pen: d.pen, magnification: d.magnification, outlinePen: d.outlinePen, tile: screens[0], given: d};
  });
}
