// The page's numbers, and small helpers.
const page = JSON.parse(document.getElementById("data").textContent);
const showing = page.showing;
const $ = (id) => document.getElementById(id);
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
const finite = (x) => x !== null && Number.isFinite(x);

function element(tag, attributes, ...children) {
  const e = document.createElement(tag);
  Object.assign(e, attributes);
  e.append(...children);
  return e;
}

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// {offset, scale, data} -> numbers; -32768 stands for what is not there.
function shorts(coded) {
  const bytes = bytesOf(coded.data), view = new DataView(bytes.buffer), out = new Float64Array(bytes.length / 2);
  for (let i = 0; i < out.length; ++i) {
    const n = view.getInt16(2 * i, true);
    out[i] = n === -32768 ? NaN : coded.offset + coded.scale * n;
  }
  return out;
}

// {most, data} -> numbers; 255 stands for what is not there.
function shades(coded) {
  return Float32Array.from(bytesOf(coded.data), (n) => (n === 255 ? NaN : coded.most * (n / 254) ** 2));
}

function corners(base64) {
  const bytes = bytesOf(base64), view = new DataView(bytes.buffer), out = new Uint16Array(bytes.length / 2);
  for (let i = 0; i < out.length; ++i) out[i] = view.getUint16(2 * i, true);
  return out;
}

function quantile(values, p) {
  const sorted = Float64Array.from(values.filter(Number.isFinite)).sort();
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(p * sorted.length))] : NaN;
}

function shortNumber(x, digits = 3) {
  if (!finite(x)) return "–";
  return String(Number(x.toPrecision(digits)));
}

// Lengths are in mm on the whole page; forces and pressures get the prefix that suits the largest of them.
function shownUnit(most, unit) {
  if (unit === "m") return { scale: 1e3, name: "mm" };
  if (unit !== "N" && unit !== "Pa" && unit !== "N/kg") return { scale: 1, name: unit };
  const [prefix, size] = [["k", 1e3], ["", 1], ["m", 1e-3]].find(([, s]) => most >= s) || ["µ", 1e-6];
  return { scale: 1 / size, name: prefix + unit };
}

function withUnit(value, unit, digits) {
  const { scale, name } = shownUnit(Math.abs(value), unit);
  return shortNumber(scale * value, digits) + " " + name;
}

// Index of the last entry at or before t in an ascending list, and how far t is on the way to the next.
function place(times, t) {
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  if (high <= low) return { index: low, share: 0 };
  const share = (t - times[low]) / (times[high] - times[low]);
  return { index: low, share: Math.min(1, Math.max(0, share)) };
}

const replays = showing.replays.map((coded) => ({
  name: coded.name,
  time: coded.time,
  rms: coded.rms,
  outlines: coded.outlines,
  held: shorts(coded.held),
  loads: coded.loads.map((load) => ({ ...load, value: shorts(load.value) })),
  tracks: coded.tracks.map((t) => ({
    name: t.name,
    unit: t.unit,
    components: t.components.map((c) => ({ name: c.name, measured: shorts(c.measured), predicted: shorts(c.predicted) })),
  })),
  surface: {
    rest: shorts(coded.surface.rest),
    triangles: corners(coded.surface.triangles),
    time: coded.surface.frames.map((k) => coded.time[k]),
    displacement: shorts(coded.surface.displacement),
    error: shades(coded.surface.error).map((x) => 1e3 * x),
    sigmas: shades(coded.surface.sigmas),
  },
}));
