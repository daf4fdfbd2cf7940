// raster.js - strokes painted on a grid of pixels. A canvas, without a graphics card, takes five times as long.

class Raster {
  // Of wide x tall pixels those within left .. right, top .. bottom are paper; the others are left transparent.
  constructor(wide, tall, left, top, right, bottom) {
    Object.assign(this, {wide, tall, left: clamp(left, 0, wide), top: clamp(top, 0, tall), right: clamp(right, 0, wide), bottom: clamp(bottom, 0, tall)});
    this.light = new Float32Array(wide * tall).fill(255);
  }

  // The polyline of the first `count` of xs, ys, `by` pixels a unit from (x, y), with round ends; half its pen is `half` pixels wide.
  // Strokes that cover parts of a pixel add up; `solid` ones, parts of which overlap, do not.
  stroke(xs, ys, count, by, x, y, half, solid) {
    for (let k = 1; k < count; k++)
      this.segment(xs[k - 1] * by + x - 0.5, ys[k - 1] * by + y - 0.5, xs[k] * by + x - 0.5, ys[k] * by + y - 0.5, half, solid || k === 1, solid || k === count - 1, solid);
  }
  // From (ax,ay) to (bx,by), pixels having their middles at whole numbers. first, last: whether that end is round, else it is cut square.
  segment(ax, ay, bx, by, half, first, last, solid) {
    const {light, wide} = this, dx = bx - ax, dy = by - ay, long = Math.sqrt(dx * dx + dy * dy);
    // along its main axis and across
    const flat = Math.abs(dx) >= Math.abs(dy), a = flat ? ax : ay, b = flat ? ay : ax;
    const c = long ? (flat ? dx : dy) / long : 1, d = long ? (flat ? dy : dx) / long : 0, over = flat ? 1 : wide, down = flat ? wide : 1;
    const low = flat ? this.left : this.top, high = flat ? this.right : this.bottom, lowest = flat ? this.top : this.left, highest = flat ? this.bottom : this.right;
    const reach = half + 0.5, most = Math.min(1, 2 * half), slope = d / c, up = reach / Math.abs(c), side = reach * Math.abs(d), end = a + c * long, far = b + d * long;
    const before = first ? reach : side, after = last ? reach : side;
    const from = Math.max(low, Math.ceil(c > 0 ? a - before : end - after));
    const upto = Math.min(high - 1, Math.floor(c > 0 ? end + after : a + before));
    for (let i = from; i <= upto; i++) {
      const middle = b + (i - a) * slope, x = i - a, stop = Math.min(highest - 1, Math.floor(middle + up));
      for (let j = Math.max(lowest, Math.ceil(middle - up)); j <= stop; j++) {
        const k = i * over + j * down, was = light[k];
        if (was < 0.5) continue;                              // black already, as most of a dark place soon is
        const y = j - b, t = x * c + y * d;
        let cover;
        if (t < 0) { if (!first) continue; cover = reach - Math.sqrt(x * x + y * y); }
        else if (t >= long) { if (!last) continue; cover = reach - Math.sqrt((i - end) * (i - end) + (j - far) * (j - far)); }
        else cover = reach - Math.abs(x * d - y * c);
        if (cover <= 0) continue;
        if (cover > most) cover = most;
        light[k] = solid ? Math.min(was, 255 * (1 - cover)) : was * (1 - cover);
      }
    }
  }

  // A shape with corners at xs, ys, `by` pixels a unit from (x, y). How much of each pixel it covers is summed up, so shapes
  // side by side add up. A side changes the sums where it passes; running sums along the rows cover the pixels right of it at the end.
  fill(xs, ys, by, x, y) {
    this.sums ||= new Float32Array((this.wide + 2) * this.tall);
    let area = 0;
    for (let i = 0, j = xs.length - 1; i < xs.length; j = i++) area += xs[j] * ys[i] - xs[i] * ys[j];
    const way = area < 0 ? -1 : 1;
    for (let i = 0, j = xs.length - 1; i < xs.length; j = i++) this.side(xs[j] * by + x, ys[j] * by + y, xs[i] * by + x, ys[i] * by + y, way);
  }
  side(ax, ay, bx, by, way) {
    if (ay === by) return;
    if (ay > by) { [ax, ay, bx, by] = [bx, by, ax, ay]; way = -way; }
    const {sums, wide, tall} = this, slope = (bx - ax) / (by - ay);
    for (let j = Math.max(0, Math.floor(ay)), last = Math.min(tall, by); j < last; j++) {
      const top = Math.max(j, ay), bottom = Math.min(j + 1, by), high = way * (bottom - top);
      if (bottom <= top) continue;
      let x0 = clamp(ax + (top - ay) * slope, 0, wide), x1 = clamp(ax + (bottom - ay) * slope, 0, wide);
      if (x0 > x1) [x0, x1] = [x1, x0];
      // what is right of the side between column 0 and x, of a strip as high as it is here
      const right = x => x <= x0 ? 0 : x >= x1 ? x - (x0 + x1) / 2 : (x - x0) * (x - x0) / (2 * (x1 - x0));
      for (let i = Math.floor(x0), k = j * (wide + 2) + i, upto = Math.floor(x1) + 1, before = 0, last = 0; i <= upto; i++, k++) {
        const now = right(i + 1);
        sums[k] -= high * (now - last - before);
        before = now - last;
        last = now;
      }
    }
  }

  // The light that is left of each pixel, all shapes counted.
  done() {
    if (this.sums) for (let j = this.top; j < this.bottom; j++)
      for (let i = 0, sum = 0, from = j * (this.wide + 2); i < this.right; i++) {
        sum += this.sums[from + i];
        this.light[j * this.wide + i] *= 1 - clamp(sum, 0, 1);
      }
    return this.light;
  }
}

// Onto the pixels of an image: rasters of the same frame, each with its ink.
function show(image, sheets) {
  const out = new Int32Array(image.data.buffer), {wide, left, right, top, bottom} = sheets[0].raster;
  const lights = sheets.map(({raster}) => raster.done()), parts = sheets.map(({ink}) => [1, 3, 5].map(k => 1 - parseInt(ink.slice(k, k + 2), 16) / 255));
  out.fill(0);
  for (let j = top; j < bottom; j++) for (let k = j * wide + left, end = j * wide + right; k < end; k++) {
    let red = 255, green = 255, blue = 255;
    for (let s = 0; s < lights.length; s++) {
      const dark = 1 - lights[s][k] / 255, [r, g, b] = parts[s];
      red *= 1 - dark * r; green *= 1 - dark * g; blue *= 1 - dark * b;
    }
    out[k] = (red + 0.5 | 0) | (green + 0.5 | 0) << 8 | (blue + 0.5 | 0) << 16 | 0xff000000;
  }
}
