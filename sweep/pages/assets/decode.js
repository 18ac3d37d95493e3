// Numbers as `sweep/pages/packing.py` packs them.

const NOTHING = -(2 ** 31);

async function unpacked(block) {
  const planes = await inflated(block.base64);
  const size = planes.length / 4;
  const numbers = new Int32Array(size);
  for (let k = 0; k < size; k++) {
    const zigzag = planes[k] | (planes[size + k] << 8) | (planes[2 * size + k] << 16) | (planes[3 * size + k] << 24);
    numbers[k] = (zigzag >>> 1) ^ -(zigzag & 1);
  }
  if (block.differences) {
    const row = block.shape[block.shape.length - 1];
    for (let k = 0; k < size; k++) if (k % row) numbers[k] += numbers[k - 1]; // modulo 2^32, as Int32Array does
  }
  return numbers;
}

async function inflated(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
