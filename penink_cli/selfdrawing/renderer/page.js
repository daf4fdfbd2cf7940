// page.js - the page: the view of the picture, moving, printing and saving it.

const UNIT = 2;                                               // CSS pixels a unit of the screen's texture: a pen of about one pixel
const PRINTER = 72 / 600;                                     // what a printer of 600 dpi adds to an upright pen, points
const MOST = 64;                                              // greatest magnification
const canvas = document.querySelector("canvas"), status = document.querySelector("output");
const view = {zoom: 1, x: 0, y: 0};                           // x, y: of the picture's corner, CSS pixels
let layers = [], size = [1, 1], image = null, shown = null, due = 0, later = 0, painted = {ms: 0, strokes: 0, count: 0, every: 1};

// How large the picture is at zoom 1: it fits the window.
const fitted = () => Math.min(canvas.clientWidth / size[0], canvas.clientHeight / size[1]) * 0.96;
const scale = () => fitted() * view.zoom;

function settle() {
  view.zoom = clamp(view.zoom, 0.25, MOST);
  for (const [axis, extent, room] of [["x", size[0] * scale(), canvas.clientWidth], ["y", size[1] * scale(), canvas.clientHeight]])
    view[axis] = extent <= room ? (room - extent) / 2 : clamp(view[axis], room - extent, 0);
}
function fit() { view.zoom = 1; settle(); moved(); }
function zoomAt(factor, x, y) {
  const before = view.zoom;
  view.zoom = clamp(before * factor, 0.25, MOST);
  const by = view.zoom / before;
  view.x = x - (x - view.x) * by;
  view.y = y - (y - view.y) * by;
  settle();
  moved();
}

// Until fresh strokes are there the old ones are shown in their new place.
function moved() {
  if (shown) {
    const by = scale() / shown.scale;
    canvas.style.transform = `translate(${view.x - shown.x * by}px,${view.y - shown.y * by}px) scale(${by})`;
  }
  clearTimeout(due);
  clearTimeout(later);
  due = setTimeout(hurry, painted.ms < 60 ? 0 : 120);
}
// Along a field coarsely at first, and finely when nothing moves.
function hurry() {
  if (!layers.some(layer => layer.field)) { repaint(); return; }
  repaint(2);
  later = setTimeout(() => repaint(), 250);
}

function repaint(every = 1) {
  const began = performance.now(), ratio = window.devicePixelRatio || 1, wide = Math.round(canvas.clientWidth * ratio), tall = Math.round(canvas.clientHeight * ratio);
  settle();
  const per = UNIT * ratio, x = view.x * ratio, y = view.y * ratio, right = x + size[0] * scale() * ratio, bottom = y + size[1] * scale() * ratio;
  let strokes = 0;
  const sheets = inks().map(ink => {
    const raster = new Raster(wide, tall, ...[x, y, right, bottom].map(Math.round));
    draw(layers.filter(layer => layer.ink === ink), size[0] * scale() / UNIT, size[1] * scale() / UNIT, [-x / per, -y / per, (wide - x) / per, (tall - y) / per], 0, every, (layer, screen, count, pressure) => {
      raster.stroke(alongX, alongY, count, per * layer.magnification, x, y, pressure * layer.pen * layer.magnification * per / 2, false);
      strokes++;
    }, (layer, xs, ys, pen) => raster.stroke(xs, ys, xs.length, per * layer.magnification, x, y, pen * layer.magnification * per / 2, true),
    (layer, xs, ys) => { raster.fill(xs, ys, per, x, y); strokes++; }, 1 / per);
    return {raster, ink};
  });
  if (!image || image.width !== wide || image.height !== tall) image = new ImageData(canvas.width = wide, canvas.height = tall);
  show(image, sheets);
  canvas.style.transform = "";
  canvas.getContext("2d").putImageData(image, 0, 0);
  shown = {x: view.x, y: view.y, scale: scale()};
  painted = {ms: performance.now() - began, strokes, count: painted.count + 1, every};
  status.value = `${view.zoom.toFixed(view.zoom < 10 ? 1 : 0)}×`;
}

// The inks, the first at the bottom. They are transparent, and layers of one know nothing of those of another.
const inks = () => [...new Set(layers.map(layer => layer.ink))];

// A window (points) of the picture, drawn `width` points wide, as an SVG document. gain: points that the device adds to a stroke.
// dot: a dot of the device for which the pens of a small picture are chosen, points.
// The document is as penink_cli/outputs/svg.py writes it: in millimetres, a group a layer, a path a stroke, shapes for strokes that
// swell. All of it lies within the frame, for a plotter knows no clip path.
function svg(width, window, gain, dot = gain) {
  const height = width * size[1] / size[0], [x0, y0] = window, x1 = Math.min(window[2], width), y1 = Math.min(window[3], height), mm = x => +(x * 25.4 / 72).toFixed(3);
  const groups = layers.map(() => ({strokes: [], shapes: [], pens: new Map()}));
  const at = (x, y) => `${mm(x - x0)} ${mm(y - y0)}`;
  const add = (layer, pen, xs, ys, count) => {
    const {strokes, pens} = groups[layers.indexOf(layer)], wide = +(Math.max(0.1, pen) * 25.4 / 72).toFixed(4), by = layer.magnification;
    for (const points of cropped(xs, ys, count, by, pen / 2, [x0, y0, x1, y1])) {
      const d = points.map(([x, y]) => at(x, y));
      // a dot is a line of a micrometre: some programs do not draw a line without length, and vpype drops it
      strokes.push([wide, d.every(p => p === d[0]) ? d[0] + "h.001" : d.filter((p, i) => p !== d[i - 1]).join(" ")]);
      pens.set(wide, (pens.get(wide) || 0) + 1);
    }
  };
  for (const ink of inks()) draw(layers.filter(layer => layer.ink === ink), width, height, window, gain, 1,
    (layer, screen, count, pressure) => add(layer, pressure * layer.pen * layer.magnification - gain * screen.widens, alongX, alongY, count),
    (layer, xs, ys, pen) => add(layer, pen * layer.magnification - MEAN * gain, xs, ys, xs.length),
    (layer, xs, ys) => {
      const shape = clipped(xs, ys, [x0, y0, x1, y1]);
      if (shape.length > 2) groups[layers.indexOf(layer)].shapes.push(shape.map(([x, y]) => at(x, y)).join(" "));
    }, dot);
  const wide = mm(x1 - x0), tall = mm(y1 - y0);
  return `<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" version="1.1" width="${wide}mm" height="${tall}mm" viewBox="0 0 ${wide} ${tall}">\n` +
    groups.map(({strokes, shapes, pens}, i) => {
      const ink = layers[i].ink, usual = [...pens].reduce((a, b) => b[1] > a[1] ? b : a, [0.3, 0])[0];
      return `<g id="layer${i + 1}" inkscape:groupmode="layer" inkscape:label="${i + 1}" fill="none" stroke="${ink}" stroke-width="${usual}" stroke-linecap="round" stroke-linejoin="round">\n` +
        strokes.map(([pen, d]) => `<path d="M${d}"${pen === usual ? "" : ` stroke-width="${pen}"`}/>\n`).join("") +
        (shapes.length ? `<g fill="${ink}" stroke="none">\n${shapes.map(d => `<path d="M${d}z"/>\n`).join("")}</g>\n` : "") + "</g>\n";
    }).join("") + "</svg>\n";
}

// The parts of a polyline, `by` points a unit, that lie in a frame and no nearer than rim to its border.
function cropped(xs, ys, count, by, rim, [left, top, right, bottom]) {
  const rx = Math.min(rim, (right - left) / 2), ry = Math.min(rim, (bottom - top) / 2), out = [];
  let run = null;
  for (let i = 1; i < count; i++) {
    const ax = xs[i - 1] * by, ay = ys[i - 1] * by, bx = xs[i] * by, by1 = ys[i] * by;
    let from = 0, upto = 1;
    for (const [a, step, least, most] of [[ax, bx - ax, left + rx, right - rx], [ay, by1 - ay, top + ry, bottom - ry]]) {
      if (!step) { if (a < least || a > most) upto = -1; continue; }
      const enters = (least - a) / step, leaves = (most - a) / step;
      from = Math.max(from, Math.min(enters, leaves));
      upto = Math.min(upto, Math.max(enters, leaves));
    }
    if (from > upto) { run = null; continue; }
    const point = t => [ax + t * (bx - ax), ay + t * (by1 - ay)];
    if (!run || from > 0) out.push(run = [point(from)]);
    run.push(point(upto));
    if (upto < 1) run = null;
  }
  return out;
}
// The part of a shape that lies in a frame, side by side (Sutherland and Hodgman 1974).
function clipped(xs, ys, [left, top, right, bottom]) {
  let shape = Array.from(xs, (x, i) => [x, ys[i]]);
  for (const [axis, limit, way] of [[0, left, 1], [0, right, -1], [1, top, 1], [1, bottom, -1]]) {
    const inside = p => way * (p[axis] - limit) >= 0;
    if (shape.every(inside)) continue;
    shape = shape.flatMap((p, i) => {
      const q = shape[i ? i - 1 : shape.length - 1], t = (limit - q[axis]) / (p[axis] - q[axis]);
      const cross = inside(p) === inside(q) ? [] : [[q[0] + t * (p[0] - q[0]), q[1] + t * (p[1] - q[1])]];
      return inside(p) ? [...cross, p] : cross;
    });
  }
  return shape;
}

// What is seen, in points: a unit of the screen's texture is a point.
function visible() {
  const clip = (x, most) => clamp(x / UNIT, 0, most * scale() / UNIT);
  return [clip(-view.x, size[0]), clip(-view.y, size[1]), clip(canvas.clientWidth - view.x, size[0]), clip(canvas.clientHeight - view.y, size[1])];
}
function save() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([svg(size[0] * scale() / UNIT, visible(), 0, 1 / UNIT / (window.devicePixelRatio || 1))], {type: "image/svg+xml"}));
  link.download = document.title + ".svg";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
// On paper the whole picture, at its natural size or as large as the sheet has room for, as lines: the printer draws them at
// its own resolution.
function beforePrint() { document.querySelector("#paper").innerHTML = svg(size[0], [0, 0, ...size], PRINTER); }
function afterPrint() { document.querySelector("#paper").replaceChildren(); }

function listen() {
  const fingers = new Map(), middle = () => [canvas.clientWidth / 2, canvas.clientHeight / 2], spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  const frame = canvas.parentElement;
  frame.addEventListener("wheel", event => {
    event.preventDefault();
    const box = frame.getBoundingClientRect();                // not offsetX: the canvas may be stretched until it is drawn anew
    zoomAt(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015) * (event.ctrlKey ? 4 : 1)), event.clientX - box.left, event.clientY - box.top);
  }, {passive: false});
  frame.addEventListener("pointerdown", event => { fingers.set(event.pointerId, [event.clientX, event.clientY]); frame.setPointerCapture(event.pointerId); });
  for (const over of ["pointerup", "pointercancel"]) frame.addEventListener(over, event => fingers.delete(event.pointerId));
  frame.addEventListener("pointermove", event => {
    const was = fingers.get(event.pointerId), is = [event.clientX, event.clientY];
    if (!was) return;
    const apart = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, is);
    if (fingers.size === 2) {
      const [a, b] = [...fingers.values()], box = frame.getBoundingClientRect();
      zoomAt(spread() / apart, (a[0] + b[0]) / 2 - box.left, (a[1] + b[1]) / 2 - box.top);
    } else {
      view.x += is[0] - was[0];
      view.y += is[1] - was[1];
      settle();
      moved();
    }
  });
  const by = (x, y) => () => { view.x += x; view.y += y; settle(); moved(); };
  const actions = {
    "+": () => zoomAt(1.5, ...middle()), "-": () => zoomAt(1 / 1.5, ...middle()), "0": fit, s: save, p: () => window.print(),
    ArrowLeft: by(80, 0), ArrowRight: by(-80, 0), ArrowUp: by(0, 80), ArrowDown: by(0, -80),
  };
  actions["="] = actions["+"];
  document.addEventListener("keydown", event => {
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
  for (const button of document.querySelectorAll("button")) button.addEventListener("click", () => actions[button.value]());
  window.addEventListener("resize", () => { settle(); moved(); });
  window.addEventListener("beforeprint", beforePrint);
  window.addEventListener("afterprint", afterPrint);
}

// width, height: of the picture in points; description: of its layers; bytes: their data.
function start(width, height, description, bytes) {
  size = [width, height];
  layers = readLayers(description, bytes);
  listen();
  settle();
  repaint();
  document.body.dataset.ready = "yes";
}
