// Pictures as numbers, and the colours that they are shown in.

const decoded = new Map();

/** Half floats, low bytes first and high bytes after them, deflated, in base64: width x height of them, rows from the top. */
export async function halfFloats(text, count) {
  if (decoded.has(text)) return decoded.get(text);
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const plain = new Uint8Array(await new Response(stream).arrayBuffer());
  if (plain.length !== 2 * count) throw new Error(`a picture holds ${plain.length} bytes instead of ${2 * count}`);
  const values = new Float32Array(count);
  for (let i = 0; i < count; ++i) values[i] = halfFloat(plain[i] | (plain[count + i] << 8));
  decoded.set(text, values);
  return values;
}

export function halfFloat(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const mantissa = bits & 1023;
  if (exponent === 0) return sign * mantissa * 2 ** -24;
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (1 + mantissa / 1024) * 2 ** (exponent - 15);
}

function mix(a, b, t) {
  return a.map((v, i) => v + (b[i] - v) * t);
}

function onScale(scale, t) {
  const at = Math.max(0, Math.min(1, t)) * (scale.length - 1);
  const below = Math.min(Math.floor(at), scale.length - 2);
  return mix(scale[below], scale[below + 1], at - below);
}

// Blue, light grey, red: told apart by those who cannot tell red from green, and as lightness from the middle.
const errorScale = [[8, 48, 140], [90, 150, 215], [240, 240, 236], [226, 128, 92], [140, 14, 20]];
const workScale = [[0, 0, 0], [62, 38, 128], [172, 50, 112], [243, 152, 42], [255, 255, 255]];
const outside = [70, 70, 74];
const notFinite = [255, 0, 255];

/** What can be shown of a job. `colour(value, exposure)` is an sRGB triple; `text` says a value. */
export const kinds = [
  {key: "visibility", title: "visibility", legend: ["0, umbra", "1, lit"],
   at: (t) => grey(t),
   colour: (value, exposure) => grey(value * 2 ** exposure)},
  {key: "error", title: "signed error", legend: ["−0.5 too dark", "+0.5 too bright"],
   at: (t) => onScale(errorScale, t),
   colour: (value, exposure) => onScale(errorScale, 0.5 + value * 2 ** exposure)},
  {key: "work", title: "texels read", legend: ["0", "1000 and more"],
   at: (t) => onScale(workScale, t),
   colour: (value, exposure) => onScale(workScale, Math.log1p(value * 2 ** exposure) / Math.log1p(1000))},
];

function grey(value) {
  const linear = Math.max(0, Math.min(1, value));
  const encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
  return [255 * encoded, 255 * encoded, 255 * encoded];
}

/** A canvas of the picture's own size. */
export function painted(values, width, height, kind, exposure) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  for (let i = 0; i < values.length; ++i) {
    const value = values[i];
    const colour = Number.isNaN(value) ? outside : Number.isFinite(value) ? kind.colour(value, exposure) : notFinite;
    image.data.set([colour[0], colour[1], colour[2], 255], 4 * i);
  }
  context.putImageData(image, 0, 0);
  return canvas;
}
