// Where, when and how the given model fails, and how the error falls as effects are added.
function noiseLine(data) { return constant(data.length, 1); }

function residualCharts() {
  const host = (name) => document.querySelector('[data-chart="residual-' + name + '"]');
  if (!host("time")) return;
  const r = page.diagnosis.residual;
  const simple = (name, title, note, x, y, label, series, extra) => {
    if (!y.length) return host(name).remove();
    addChart(host(name), () => Object.assign({
      title, note, height: name === "time" ? 240 : 200,
      data: [x, y, noiseLine(y)],
      scales: { x: { time: false, ...(series === "bar" ? { range: (u, a, b) => barRange(x) } : {}) }, y: { range: fromZero } },
      axes: [axis(label), axis(null, { size: 50 })],
      series: [{ label, value: (u, v) => shortNumber(v, 3) },
        series === "bar" ? bar("error, rms [sigma]", "error") : line("error, rms [sigma]", "error", { fill: colour("error-soft") }),
        line("noise", "noise", { dash: [6, 5] })],
    }, extra ? extra() : {}));
  };
  simple("time", "By time: error of each frame, rms [sigma]", "", r.time, r.frame_rms,
    "time since the first stamp [s]", "line", () => ({ clock: true }));
  const order = r.nodes.map((n, i) => i).sort((a, b) => r.node_rms[b] - r.node_rms[a]);
  simple("node", "By place: observed nodes, worst first [sigma]",
    order.length ? "Worst: node " + r.nodes[order[0]] + "." : "",
    order.map((o, i) => i + 1), order.map((o) => r.node_rms[o]), "nodes", "line");
  simple("amplitude", "By size of the motion [sigma]", "Each bar is a fifth of the frames.", r.amplitude.map((v) => 1e3 * v),
    r.amplitude_rms, "motion up to [mm]", "bar", () => categorical(r.amplitude.map((v) => shortNumber(1e3 * v, 2)), r.amplitude_rms, "motion up to [mm]"));
  simple("frequency", "By frequency: share of the error [%]", "", r.frequency, r.power.map((v) => 100 * v), "frequency [Hz]",
    "line", () => ({
      data: [r.frequency, r.power.map((v) => 100 * v)],
      series: [{ label: "frequency [Hz]", value: (u, v) => shortNumber(v, 3) },
        line("share [%]", "error", { fill: colour("error-soft") })],
    }));
  simple("phase", "By phase of the main oscillation [sigma]", "0 is where the recording starts.", r.phase, r.phase_rms, "phase [degree]",
    "bar", () => categorical(r.phase.map((v) => String(Math.round((v * 180) / Math.PI))), r.phase_rms, "phase [degree]"));
}

function barRange(x) { return [0.4, x.length + 0.6]; }

function categorical(names, values, label) {
  const x = values.map((v, i) => i + 1);
  return {
    data: [x, values, noiseLine(values)],
    scales: { x: { time: false, range: () => barRange(x) }, y: { range: fromZero } },
    axes: [axis(label, { splits: () => x, values: () => names, grid: { show: false } }), axis(null, { size: 50 })],
    series: [{ label, value: (u, v) => (finite(v) ? names[v - 1] : "–") }, bar("error, rms [sigma]", "error"),
      line("noise", "noise", { dash: [6, 5] })],
  };
}

// A name in lines that fit below a column.
function inLines(name, width) {
  const lines = [""];
  for (const word of name.split(" ")) {
    const last = lines[lines.length - 1];
    if (last && 7 * (last.length + word.length + 1) > width) lines.push(word); else lines[lines.length - 1] = last ? last + " " + word : word;
  }
  return lines.join("\n");
}

// Writes each column's number above it.
function columnLabels(u, labels) {
  u.ctx.save();
  u.ctx.fillStyle = colour("text");
  u.ctx.font = "600 " + 13 * devicePixelRatio + "px system-ui, sans-serif";
  u.ctx.textAlign = "center";
  labels.forEach((label, i) => u.ctx.fillText(label, u.valToPos(u.data[0][i], "x", true), u.valToPos(u.data[1][i], "y", true) - 6 * devicePixelRatio));
  u.ctx.restore();
}

// The error of each model, step by step. Words and numbers are those of the table below it.
function staircase() {
  const host = document.querySelector("[data-chart=steps]");
  if (!host) return;
  const { steps } = page.diagnosis, rows = Array.from(document.querySelectorAll("#staircase .scroll tbody tr"), (row) => Array.from(row.cells, (c) => c.textContent));
  const x = steps.map((s, i) => i + 1), held = steps.map((s) => 1e3 * s.held_out_rms), noise = steps.map((s) => 1e3 * s.noise_floor);
  addChart(host, () => {
    const names = rows.map((cells) => inLines(cells[0], (host.clientWidth - 60) / steps.length));
    const lines = Math.max(...names.map((n) => n.split("\n").length));
    return {
      title: "Held-out error of each model [mm]", height: 220 + 16 * lines,
      data: [x, held, noise],
      scales: { x: { time: false, range: () => barRange(x) }, y: { range: (u, low, high) => [0, 1.12 * Math.max(...held, ...noise)] } },
      axes: [axis(null, { splits: () => x, values: () => names, grid: { show: false }, size: 16 + 16 * lines }), axis(null, { size: 50 })],
      series: [{ label: "model", value: (u, v) => (finite(v) ? rows[v - 1][0] : "–") }, bar("held-out error", "error"), line("noise", "noise", { dash: [6, 5], paths: () => null })],
      table: [{ name: "model", values: rows.map((cells) => cells[0]) }, { name: "held-out error [mm]", values: held },
        { name: "error of fitted frames [mm]", values: steps.map((s) => 1e3 * s.train_rms) }, { name: "noise [mm]", values: noise }],
      hooks: { draw: [(u) => level(u, noise[noise.length - 1], colour("noise")), (u) => columnLabels(u, rows.map((cells) => cells[1]))] },
    };
  });
}
