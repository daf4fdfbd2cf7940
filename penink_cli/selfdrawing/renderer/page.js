// page.js - the page: what is seen of the picture, how one moves, prints and saves.

const UNIT = 2;                                               // CSS pixels a unit of the screen's texture: a pen of about one pixel
const PRINTER = 72 / 600;                                     // what a printer of 600 dpi adds to an upright pen, points
const MOST = 64;                                              // greatest magnification
const canvas = document.querySelector("canvas"), status = document.querySelector("output");
const view = {zoom: 1, x: 0, y: 0};                           // x, y: of the picture's corner, CSS pixels
let layers = [], size = [1, 1], shown = null, due = 0, painted = {ms: 0, strokes: 0};

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
  const began = performance.now(), ratio = window.devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  canvas.style.transform = "";
  settle();
  const context = canvas.getContext("2d"), wide = size[0] * scale(), tall = size[1] * scale();
  let strokes = 0;
  context.fillStyle = "#fff";
  context.setTransform(ratio, 0, 0, ratio, view.x * ratio, view.y * ratio);
  context.fillRect(0, 0, wide, tall);
  context.beginPath();
  context.rect(0, 0, wide, tall);
  context.clip();
  context.lineCap = context.lineJoin = "round";
  for (const layer of layers) {
    const unit = UNIT * layer.magnification, unclipped = [-view.x, -view.y, canvas.clientWidth - view.x, canvas.clientHeight - view.y];
    context.setTransform(ratio * unit, 0, 0, ratio * unit, view.x * ratio, view.y * ratio);
    context.lineWidth = layer.pen;
    // each stroke by itself: in batches the browser takes longer, for it tells overlaps within a path
    draw(layer, wide / unit, tall / unit, unclipped.map(x => x / unit), (xs, ys) => {
      context.beginPath();
      context.moveTo(xs[0], ys[0]);
      for (let i = 1; i < xs.length; i++) context.lineTo(xs[i], ys[i]);
      context.stroke();
      strokes++;
    }, (xs, ys, closed) => {
      context.beginPath();
      context.lineWidth = layer.outlinePen;
      const lean = leans(xs, ys, closed);
      context.moveTo(xs[0], ys[0]);
      for (let i = 1; i < xs.length; i++)
        context.bezierCurveTo(xs[i - 1] + lean[i - 1][0], ys[i - 1] + lean[i - 1][1], xs[i] - lean[i][0], ys[i] - lean[i][1], xs[i], ys[i]);
      context.stroke();
    });
  }
  shown = {x: view.x, y: view.y, scale: scale()};
  painted = {ms: performance.now() - began, strokes};
  status.value = `${view.zoom.toFixed(view.zoom < 10 ? 1 : 0)}×`;
}

// A window (points) of the picture, drawn at so many points wide, as an SVG document for a device whose pixels are `gain` points.
function svg(width, window, gain) {
  const height = width * size[1] / size[0], [x0, y0, x1, y1] = window, fixed = x => x.toFixed(2);
  const parts = [`<svg xmlns="http://www.w3.org/2000/svg" width="${fixed(x1 - x0)}pt" height="${fixed(y1 - y0)}pt" viewBox="${window.map(fixed).slice(0, 2).join(" ")} ${fixed(x1 - x0)} ${fixed(y1 - y0)}">`,
    `<clipPath id="frame"><rect width="${fixed(width)}" height="${fixed(height)}"/></clipPath><g clip-path="url(#frame)" fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">`];
  for (const layer of layers) {
    const unit = layer.magnification, hatching = new Map(), outlines = [];
    draw(layer, width / unit, height / unit, window.map(x => x / unit), (xs, ys, screen) => {
      if (!hatching.has(screen)) hatching.set(screen, []);
      hatching.get(screen).push("M" + xs.map((x, i) => fixed(x * unit) + " " + fixed(ys[i] * unit)).join(" "));
    }, (xs, ys, closed) => {
      const lean = leans(xs, ys, closed), p = (x, y) => fixed(x * unit) + " " + fixed(y * unit);
      outlines.push("M" + p(xs[0], ys[0]) + xs.slice(1).map((x, i) => "C" + [
        p(xs[i] + lean[i][0], ys[i] + lean[i][1]), p(x - lean[i + 1][0], ys[i + 1] - lean[i + 1][1]), p(x, ys[i + 1])].join(" ")).join(""));
    });
    const add = (paths, pen) => parts.push(`<path stroke-width="${fixed(Math.max(0.1, pen))}" d="${paths.join("")}"/>`);
    for (const [screen, paths] of hatching) add(paths, layer.pen * unit - gain * screen.widens);
    if (outlines.length) add(outlines, layer.outlinePen * unit - 1.27 * gain);
  }
  return parts.join("\n") + "</g></svg>\n";
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
    zoomAt(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015) * (event.ctrlKey ? 4 : 1)), event.offsetX, event.offsetY);
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
