// Numbers as the Markdown report prints them.

// results.json has null for what is undefined and "inf" for infinity.
export function decode(value) {
  if (value === null || value === undefined) return NaN;
  if (value === "inf") return Infinity;
  if (value === "-inf") return -Infinity;
  return value;
}

// With that many significant digits: 0.0123, 12.3, 12345, and 1.23e-05 below 1e-4 or from a million on.
export function significant(value, digits = 3) {
  if (Number.isNaN(value)) return "–";
  if (value === 0 || !Number.isFinite(value)) return String(value).replace("Infinity", "inf");
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  if (exponent < -4 || exponent >= 6) return value.toExponential(digits - 1).replace(/e([+-])(\d)$/, "e$10$2");
  return value.toFixed(Math.max(0, digits - 1 - exponent));
}

export const percent = (value, digits = 1) => (Number.isFinite(value) ? `${(100 * value).toFixed(digits)} %` : "–");

export function signed(value) {
  return value > 0 ? `+${significant(value)}` : significant(value).replace("-", "−");
}

export const mean = (values) => {
  const known = values.filter((value) => !Number.isNaN(value));
  return known.length ? known.reduce((sum, value) => sum + value, 0) / known.length : NaN;
};

// "resolution" 64 before 128, names as they come.
export function sortedValues(values) {
  return values.every((value) => value !== "" && Number.isFinite(Number(value)))
    ? [...values].sort((a, b) => Number(a) - Number(b))
    : values;
}
