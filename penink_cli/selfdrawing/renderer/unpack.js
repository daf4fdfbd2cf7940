"use strict";
// unpack.js - bytes that were deflated and written in base 64.

async function unpack(text) {
  const stream = new Blob([Uint8Array.from(atob(text), c => c.charCodeAt(0))]).stream();
  return new Uint8Array(await new Response(stream.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
}
