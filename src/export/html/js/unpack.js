// The scene and its meshes out of this file: base64 of bytes that zlib compressed.

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
}

async function unpack(id) {
  const packed = new Blob([bytesOf(document.getElementById(id).textContent.trim())]);
  const stream = packed.stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

