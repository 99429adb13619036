// Runs beside each other: each parameter and the error over time, a line a run, in one of eight colours.
const runDashes = [[], [8, 4], [2, 3], [10, 3, 2, 3]];

// One list of times for all runs, and each run's values there; null where it has no frame.
function joinRuns(pick) {
  const { runs } = page.compare, times = [...new Set(runs.flatMap((r) => r.time))].sort((a, b) => a - b);
  const at = new Map(times.map((t, i) => [t, i]));
  return [times, ...runs.map((run) => {
    const values = Array(times.length).fill(null), from = pick(run);
    if (from) run.time.forEach((t, k) => { values[at.get(t)] = from[k]; });
    return values;
  })];
}

function runColour(i) {
  const all = colour("runs").split(" ");
  return all[i % all.length];
}

// Lines over time; with `bounds`, a parameter's 95 % interval is a band around each.
function compareChart(host, title, pick, range, bounds) {
  const step = bounds ? 3 : 1;
  const value = (u, v, i, k) => shortNumber(v, 4) + (bounds && finite(v) ? " (" + shortNumber(u.data[i + 1][k], 4) + " to " + shortNumber(u.data[i + 2][k], 4) + ")" : "");
  const lines = (run, i) => {
    const own = { stroke: runColour(i), dash: runDashes[Math.floor(i / 8) % 4], spanGaps: true };
    const bound = (label) => line(run.name + ", 95 % " + label, "predicted", { ...own, width: 0.5, class: "bound" });
    return [line(run.name, "predicted", { ...own, value }), ...(bounds ? [bound("from"), bound("to")] : [])];
  };
  addChart(host, () => {
    const joined = [pick, ...(bounds || [])].map(joinRuns), data = [joined[0][0]];
    page.compare.runs.forEach((run, i) => data.push(...joined.map((all) => all[i + 1])));
    return {
      title, data,
      scales: { x: { time: false }, y: { range } },
      axes: [axis("time since the first frame [s]"), axis(null, { size: 62 })],
      series: [timeSeries, ...page.compare.runs.flatMap(lines)],
      bands: bounds ? page.compare.runs.map((run, i) => ({ series: [step * i + 3, step * i + 2], fill: runColour(i) + "2e" })) : [],
    };
  });
}

// A long name keeps its beginning and its end, which tells it apart.
function shortened(name, most) {
  const half = Math.floor((most - 1) / 2);
  return name.length <= most ? name : name.slice(0, half) + "…" + name.slice(-half);
}

// Each run's last estimate: its mean as a dot on its interval.
function whiskers(u, i) {
  const { ctx, data } = u, [means, rows, finals] = data[i], pixel = devicePixelRatio;
  ctx.save();
  finals.forEach(([mean, lower, upper], k) => {
    if (![mean, lower, upper].every(finite)) return;
    const at = (x) => u.valToPos(x, "x", true), y = u.valToPos(rows[k], "y", true);
    ctx.fillStyle = runColour(k);
    ctx.globalAlpha = 0.4;
    ctx.fillRect(at(lower), y - 4 * pixel, Math.max(2 * pixel, at(upper) - at(lower)), 8 * pixel);
    ctx.globalAlpha = 1;
    ctx.beginPath();
    ctx.arc(at(mean), y, 5.5 * pixel, 0, 2 * Math.PI);
    ctx.fill();
  });
  ctx.restore();
  return null;
}

function intervalChart(host, title, name) {
  const { runs } = page.compare, n = runs.length;
  const finals = runs.map((run) => (run.parameters[name] ? run.parameters[name].final : [null, null, null]));
  const all = finals.flat().filter(finite), low = Math.min(...all), high = Math.max(...all), edge = 0.06 * (high - low || Math.abs(high) || 1);
  if (!all.length) return host.remove();
  addChart(host, () => {
    const room = Math.min(170, Math.round(0.36 * host.clientWidth)), rows = runs.map((run, i) => n - i);
    const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
    return {
      title: title.replace(/^[^[]*/, "Last estimate and 95 % "), file: title + ", last estimate", mode: 2, legend: { show: false }, cursor: { show: false }, height: 60 + 34 * n,
      data: [null, [finals.map((f) => f[0]), rows, finals]],
      scales: { x: { time: false, auto: false, range: () => [low - edge, high + edge] }, y: { auto: false, range: () => [0.4, n + 0.6] } },
      axes: [axis(null), axis(null, { size: room, splits: () => rows.slice().reverse(), grid: { show: false },
        values: (u, ticks) => ticks.map((y) => shortened(runs[n - y].name, Math.floor(room / 7.5))) })],
      series: [null, { label: title, facets, paths: whiskers, points: { show: false } }],
      table: [{ name: "run", values: runs.map((run) => run.name) },
        ...["estimate", "95 % from", "95 % to"].map((word, k) => ({ name: title + " " + word, values: finals.map((f) => f[k]) }))],
    };
  });
}

// The first frames' guesses may be far off; the scale holds what comes after the first quarter of each run, and of intervals
// what comes after the half.
function settledRange(pick, bounds) {
  return () => {
    const later = (of, share) => page.compare.runs.flatMap((run) => (of(run) || []).slice(Math.floor(share * run.time.length)));
    const all = [...later(pick, 0.25), ...bounds.flatMap((of) => later(of, 0.5))].filter(finite);
    const low = Math.min(...all), high = Math.max(...all), edge = 0.15 * (high - low || Math.abs(high) || 1);
    return [low - edge, high + edge];
  };
}

function startComparison() {
  const host = (kind) => document.querySelector('[data-chart="' + kind + '"]');
  for (const [name, title] of Object.entries(page.compare.titles)) {
    const of = (part) => (run) => run.parameters[name] && run.parameters[name][part], bounds = [of("lower"), of("upper")];
    intervalChart(host("intervals:" + CSS.escape(name)), title, name);
    compareChart(host("compare:" + CSS.escape(name)), title, of("mean"), settledRange(of("mean"), bounds), bounds);
  }
  compareChart(host("compare-misfit"), "Error of each frame, rms [mm]", (run) => run.misfit, fromZero, null);
}
