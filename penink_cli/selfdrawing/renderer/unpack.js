"use strict";
// unpack.js - bytes that were deflated and written five letters to four bytes (packer.letters).

async function unpack(text, length) {
  const bytes = new Uint8Array(text.length / 5 * 4), words = new DataView(bytes.buffer);
  for (let k = 0; k < text.length; k += 5) {
    let word = 0;
    for (const letter of text.slice(k, k + 5)) word = word * 85 + (letter === "}" ? 20 : letter === "~" ? 52 : letter.charCodeAt(0) - 40);
    words.setUint32(k / 5 * 4, word);
  }
  const stream = new Blob([bytes.subarray(0, length)]).stream();
  return new Uint8Array(await new Response(stream.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
}
