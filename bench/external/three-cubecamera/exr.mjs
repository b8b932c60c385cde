// Writes OpenEXR files (https://openexr.com/en/latest/OpenEXRFileLayout.html): one part, scan lines, no compression.

const kFloat = 2;

function attribute(name, type, value) {
  const size = Buffer.alloc(4);
  size.writeUInt32LE(value.length);
  return Buffer.concat([Buffer.from(`${name}\0${type}\0`, 'latin1'), size, value]);
}

function ints(...values) {
  const bytes = Buffer.alloc(4 * values.length);
  values.forEach((value, i) => bytes.writeInt32LE(value, 4 * i));
  return bytes;
}

const floats = (...values) => Buffer.from(new Float32Array(values).buffer);

// Name, pixel type, perceptual linearity with three reserved bytes, sampling in x and y.
const channel = (name) => Buffer.concat([Buffer.from(`${name}\0`, 'latin1'), ints(kFloat, 0, 1, 1)]);

// `rgb`: Float32Array of width * height * 3 values, top row first.
export function encodeExr(width, height, rgb) {
  const window = ints(0, 0, width - 1, height - 1);
  const header = Buffer.concat([
    ints(20000630, 2), // magic number, version without flags
    attribute('channels', 'chlist', Buffer.concat([channel('B'), channel('G'), channel('R'), Buffer.alloc(1)])),
    attribute('compression', 'compression', Buffer.alloc(1)),
    attribute('dataWindow', 'box2i', window),
    attribute('displayWindow', 'box2i', window),
    attribute('lineOrder', 'lineOrder', Buffer.alloc(1)),
    attribute('pixelAspectRatio', 'float', floats(1)),
    attribute('screenWindowCenter', 'v2f', floats(0, 0)),
    attribute('screenWindowWidth', 'float', floats(1)),
    Buffer.alloc(1),
  ]);
  const rowBytes = 12 * width;
  const blockBytes = 8 + rowBytes;
  const offsets = Buffer.alloc(8 * height);
  const rows = Buffer.alloc(blockBytes * height);
  for (let y = 0; y < height; y++) {
    offsets.writeBigUInt64LE(BigInt(header.length + offsets.length + y * blockBytes), 8 * y);
    rows.writeInt32LE(y, y * blockBytes);
    rows.writeInt32LE(rowBytes, y * blockBytes + 4);
    const row = new Float32Array(3 * width); // all of B, then G, then R
    for (let x = 0; x < width; x++)
      for (let c = 0; c < 3; c++) row[c * width + x] = rgb[3 * (y * width + x) + 2 - c];
    Buffer.from(row.buffer).copy(rows, y * blockBytes + 8);
  }
  return Buffer.concat([header, offsets, rows]);
}
