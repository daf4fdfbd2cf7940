// reload.js - a page that follows its file. Now and then it opens its file in a hidden frame, which tells the mark of the file's drawing;
// where that is another mark, the page loads itself again. A page may neither fetch nor read a local file, but open one in a frame.

const LOOK = 300;                                             // milliseconds from one answer to the next look

// Whether this page is such a frame, which has no more to do. mark: of its drawing.
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
