// Numbers for people to read, as the program prints them.

const grouped = new Intl.NumberFormat("en");

/** A count with its thousands apart: `69,451`. */
export function count(value: number): string {
  return grouped.format(Math.round(value));
}

/** A number to so many significant digits: `0.001234`, `12.35`, `1.235e-9`. */
export function significant(value: number, digits = 4): string {
  const magnitude = Math.abs(value);
  if (magnitude === 0 || !Number.isFinite(magnitude)) return String(value);
  if (magnitude >= 1e9 || magnitude < 1e-5) return value.toExponential(digits - 1);
  if (magnitude >= 10 ** (digits - 1)) return value.toFixed(0);
  return value.toFixed(digits - 1 - Math.floor(Math.log10(magnitude)));
}

/** A number in as few signs as axes have room for: `20 k`. */
export function brief(value: number): string {
  if (value >= 1e6) return `${trimmed(value / 1e6)} M`;
  if (value >= 1e3) return `${trimmed(value / 1e3)} k`;
  return trimmed(value);
}

function trimmed(value: number): string {
  return String(Number(value.toPrecision(3)));
}

/** Bytes in the unit that leaves one to three digits: `1.2 MB`. */
export function bytes(value: number): string {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let unit = 0;
  while (value >= 999.5 && unit + 1 < units.length) {
    value /= 1000;
    unit++;
  }
  return `${unit === 0 ? value : value.toFixed(1)} ${units[unit]}`;
}

/** A time in the unit that suits it, from nanoseconds up. */
export function time(milliseconds: number): string {
  if (milliseconds < 1e-3) return `${(milliseconds * 1e6).toFixed(0)} ns`;
  if (milliseconds < 1) return `${significant(milliseconds * 1e3, 3)} µs`;
  return `${significant(milliseconds, 3)} ms`;
}
