// Pictures of a run: unpacked from what bench/report/packed_picture.h says, and shown at an exposure.
import {blob, inflate} from "./blobs.js";

// The value of each of the 65536 half floats.
const HALF_VALUES = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31,
      mantissa = bits & 1023;
    const amount = exponent === 0 ? mantissa * 2 ** -24 : (1 + mantissa / 1024) * 2 ** (exponent - 15);
    values[bits] = bits & 0x8000 ? -amount : amount;
  }
  return values;
})();

function unpack(bytes, entry, base) {
  const count = 3 * entry.width * entry.height;
  const planes = new Uint16Array(count);
  for (let i = 0; i < count; ++i) {
    const residual = bytes[i] | (bytes[count + i] << 8);
    const predicted = base ? base[i] : i % entry.width === 0 ? 0 : planes[i - 1];
    planes[i] = residual + predicted;
  }
  return planes;
}

export class Pictures {
  // files: path -> {blob, packed, width, height, base}
  constructor(files) {
    this.files = files;
    this.loaded = new Map();
  }

  has(path) {
    return Boolean(path) && path in this.files;
  }

  // {width, height, planes}: half floats, channel after channel.
  hdr(path) {
    return this.once(path, async () => {
      const entry = this.files[path];
      const base = entry.base ? (await this.hdr(entry.base)).planes : undefined;
      return {
        width: entry.width,
        height: entry.height,
        planes: unpack(await inflate(await blob(entry.blob)), entry, base),
      };
    });
  }

  // An ImageBitmap of a PNG.
  png(path) {
    return this.once(path, async () =>
      createImageBitmap(new Blob([await blob(this.files[path].blob)], {type: "image/png"})),
    );
  }

  once(path, load) {
    if (!this.loaded.has(path)) this.loaded.set(path, load());
    return this.loaded.get(path);
  }
}

export function valueAt(picture, x, y) {
  const size = picture.width * picture.height,
    i = y * picture.width + x;
  return [0, 1, 2].map((channel) => HALF_VALUES[picture.planes[channel * size + i]]);
}

const encodeSrgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const byteOf = (linear) => Math.round(255 * encodeSrgb(Math.min(Math.max(linear, 0), 1)));

// Scaled by 2^stops, clamped to [0, 1], in sRGB.
export function developed(picture, stops) {
  const codes = Uint8Array.from(HALF_VALUES, (value) => byteOf(value * 2 ** stops));
  return painted(picture, (i) => codes[picture.planes[i]]);
}

// |a - b| at the same exposure, so that it reads as light.
export function difference(a, b, stops) {
  const scale = 2 ** stops;
  return painted(a, (i) => byteOf(scale * Math.abs(HALF_VALUES[a.planes[i]] - HALF_VALUES[b.planes[i]])));
}

// byteAt: of an index into planes.
function painted({width, height}, byteAt) {
  const size = width * height;
  const image = new ImageData(width, height);
  for (let i = 0; i < size; ++i) {
    for (let channel = 0; channel < 3; ++channel) image.data[4 * i + channel] = byteAt(channel * size + i);
    image.data[4 * i + 3] = 255;
  }
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}
