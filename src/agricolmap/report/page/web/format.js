// Numbers as people read them.

const MINUS = "\u2212";
const GAP = "\u00a0";  // between a number and its unit no line ends

export const known = (value) => typeof value === "number" && Number.isFinite(value);

export function fixed(value, digits) {
  if (!known(value)) return "unknown";
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

/** A length in centimetres below a metre, else in metres. */
export function length(metres) {
  if (!known(metres)) return "unknown";
  if (Math.abs(metres) < 0.995) return `${fixed(100 * metres, 1)}${GAP}cm`;
  return `${fixed(metres, 2)}${GAP}m`;
}

export const degrees = (value) => `${fixed(value, 2)}°`;

/** As the command line says it: nothing is certain. */
export function percent(share) {
  if (!known(share)) return "unknown";
  if (share > 0.9995) return `>${GAP}99.9${GAP}%`;
  if (share < 0.0005) return `<${GAP}0.1${GAP}%`;
  return `${(100 * share).toFixed(1)}${GAP}%`;
}

/** 1234567 as 1 234 567, with blanks that do not break. */
export function count(value) {
  return String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

export function seconds(value) {
  return value < 0.1 ? `${fixed(1000 * value, 0)} ms` : `${fixed(value, 2)} s`;
}

export function bytes(value) {
  return value >= 1e9 ? `${fixed(value / 1e9, 1)} GB` : `${fixed(value / 1e6, 0)} MB`;
}

/** All digits of a double, for copying. */
export const exact = (value) => (Object.is(value, -0) ? "0" : String(value));

/** Enough of two paths to tell them apart: their last parts, as many as it takes. */
export function shortNames(one, other) {
  const [a, b] = [one, other].map((path) => path.split("/"));
  let parts = 1;
  const tail = (path) => path.slice(-parts).join("/");
  while (tail(a) === tail(b) && parts < Math.max(a.length, b.length)) ++parts;
  return [tail(a), tail(b)];
}
