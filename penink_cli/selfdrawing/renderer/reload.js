// reload.js - a page that follows its file: now and then a frame of the same file tells the mark of what it is by now,
// and where that is another the page loads itself anew. A local file may be neither fetched nor read; this it may.

const LOOK = 300;                                             // milliseconds from one answer to the next look

// mark: of the page's drawing. Whether this is such a frame, which has no more to do.
function reloading(mark) {
  if (location.search === "?mark") {
    parent.postMessage({mark}, "*");
    return true;
  }
  const frame = document.createElement("iframe");
  frame.hidden = true;
  const look = () => { frame.src = location.href.split(/[?#]/)[0] + "?mark"; };
  window.addEventListener("message", event => {
    if (event.source !== frame.contentWindow || !event.data || !event.data.mark) return;
    if (event.data.mark === mark) setTimeout(look, LOOK);
    else location.reload();
  });
  look();
  document.body.append(frame);
  return false;
}
