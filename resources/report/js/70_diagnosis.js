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
  simple("time", "By time: error of each frame, rms [sigma]", "1 is noise.", r.time, r.frame_rms,
    "time since the first stamp [s]", "line", () => ({ clock: true }));
  const order = r.nodes.map((n, i) => i).sort((a, b) => r.node_rms[b] - r.node_rms[a]);
  simple("node", "By place: observed nodes, worst first [sigma]",
    order.length ? "Worst: node " + r.nodes[order[0]] + ". The surface above shows where (all frames, sigma)." : "",
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

// Words and numbers are those of the table below it.
function staircase() {
  const host = $("steps");
  if (!host) return;
  const steps = page.diagnosis.steps, most = Math.max(...steps.map((s) => Math.max(s.held_out_rms, s.noise_floor)));
  const rows = document.querySelectorAll("#staircase tbody tr");
  steps.forEach((step, i) => {
    const cells = rows[i].cells, block = element("i", {});
    block.style.height = (100 * step.held_out_rms) / most + "%";
    host.append(element("div", { className: "step" }, element("b", {}, cells[1].textContent),
      element("div", { className: "rise" }, block), element("span", {}, cells[0].textContent)));
  });
  const noise = element("div", { className: "floor" },
    element("span", {}, "noise " + rows[steps.length - 1].cells[3].textContent));
  noise.style.setProperty("--at", steps[steps.length - 1].noise_floor / most);
  host.append(noise);
}
