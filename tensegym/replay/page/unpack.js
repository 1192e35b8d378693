// The recording out of its script element: a header and its arrays, as tensegym/replay/replay_file.py packs them.
async function unpack(text) {
  const packed = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(stream).arrayBuffer();
  const size = new DataView(bytes).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, size)));
  const arrays = {};
  let at = 4 + size;
  for (const name of header.order) {
    const shape = header.arrays[name];
    const count = shape.reduce((a, b) => a * b, 1);
    arrays[name] = new Float32Array(bytes, at, count);
    arrays[name].width = shape.slice(1).reduce((a, b) => a * b, 1); // numbers a row
    at += 4 * count;
  }
  return { ...header, arrays };
}
