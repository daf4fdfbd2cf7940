// page.js - the page: what is seen of the picture, how one moves, prints and saves.

const UNIT = 2;                                               // CSS pixels a unit of the screen's texture: a pen of about one pixel
const PRINTER = 72 / 600;                                     // what a printer of 600 dpi adds to an upright pen, points
const MOST = 64;                                              // greatest magnification
const canvas = document.querySelector("canvas"), status = document.querySelector("output");
const view = {zoom: 1, x: 0, y: 0};                           // x, y: of the picture's corner, CSS pixels
let layers = [], size = [1, 1], image = null, shown = null, due = 0, painted = {ms: 0, strokes: 0, count: 0};

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
  due = setTimeout(repaint, painted.ms < 60 ? 0 : 120);
}

function repaint() {
  const began = performance.now(), ratio = window.devicePixelRatio || 1, wide = Math.round(canvas.clientWidth * ratio), tall = Math.round(canvas.clientHeight * ratio);
  settle();
  const per = UNIT * ratio, x = view.x * ratio, y = view.y * ratio, right = x + size[0] * scale() * ratio, bottom = y + size[1] * scale() * ratio;
  const raster = new Raster(wide, tall, ...[x, y, right, bottom].map(Math.round));
  let strokes = 0;
  draw(layers, size[0] * scale() / UNIT, size[1] * scale() / UNIT, [-x / per, -y / per, (wide - x) / per, (tall - y) / per], 0, (layer, screen, count) => {
    raster.stroke(alongX, alongY, count, per * layer.magnification, x, y, layer.pen * layer.magnification * per / 2, false);
    strokes++;
  }, (layer, xs, ys, pen) => raster.stroke(xs, ys, xs.length, per * layer.magnification, x, y, pen * layer.magnification * per / 2, true));
  if (!image || image.width !== wide || image.height !== tall) image = new ImageData(canvas.width = wide, canvas.height = tall);
  raster.show(image);
  canvas.style.transform = "";
  canvas.getContext("2d").putImageData(image, 0, 0);
  shown = {x: view.x, y: view.y, scale: scale()};
  painted = {ms: performance.now() - began, strokes, count: painted.count + 1};
  status.value = `${view.zoom.toFixed(view.zoom < 10 ? 1 : 0)}×`;
}

// A window (points) of the picture, drawn at so many points wide, as an SVG document for a device whose pixels are `gain` points.
function svg(width, window, gain) {
  const height = width * size[1] / size[0], [x0, y0, x1, y1] = window, fixed = x => x.toFixed(2), paths = new Map();
  const add = (layer, pen, xs, ys, count) => {
    const wide = fixed(Math.max(0.1, pen));
    let d = "M";
    for (let i = 0; i < count; i++) d += (i ? " " : "") + fixed(xs[i] * layer.magnification) + " " + fixed(ys[i] * layer.magnification);
    if (!paths.has(wide)) paths.set(wide, []);
    paths.get(wide).push(d);
  };
  draw(layers, width, height, window, gain,
    (layer, screen, count) => add(layer, layer.pen * layer.magnification - gain * screen.widens, alongX, alongY, count),
    (layer, xs, ys, pen) => add(layer, pen * layer.magnification - MEAN * gain, xs, ys, xs.length));
  return [`<svg xmlns="http://www.w3.org/2000/svg" width="${fixed(x1 - x0)}pt" height="${fixed(y1 - y0)}pt" viewBox="${fixed(x0)} ${fixed(y0)} ${fixed(x1 - x0)} ${fixed(y1 - y0)}">`,
    `<clipPath id="frame"><rect width="${fixed(width)}" height="${fixed(height)}"/></clipPath><g clip-path="url(#frame)" fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">`,
    ...Array.from(paths, ([wide, list]) => `<path stroke-width="${wide}" d="${list.join("")}"/>`)].join("\n") + "</g></svg>\n";
}

// What is seen, in points: a unit of the screen's texture is a point.
function visible() {
  const clip = (x, most) => clamp(x / UNIT, 0, most * scale() / UNIT);
  return [clip(-view.x, size[0]), clip(-view.y, size[1]), clip(canvas.clientWidth - view.x, size[0]), clip(canvas.clientHeight - view.y, size[1])];
}
function save() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([svg(size[0] * scale() / UNIT, visible(), 0)], {type: "image/svg+xml"}));
  link.download = document.title + ".svg";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
// On paper the whole picture, at its natural size, as lines: the printer draws them at its own resolution.
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
