// Runs beside each other: each parameter and the error over time, a line a run.
const runColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195", "#8c8c00"];
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

function compareChart(host, title, pick, range) {
  addChart(host, () => ({
    title, data: joinRuns(pick),
    scales: { x: { time: false }, y: { range } },
    axes: [axis("time since the first frame [s]"), axis(null, { size: 62 })],
    series: [timeSeries, ...page.compare.runs.map((run, i) => line(run.name, "predicted", {
      stroke: runColours[i % runColours.length], dash: runDashes[Math.floor(i / runColours.length) % 4], spanGaps: true }))],
  }));
}

// The first frames' guesses may be far off; the scale holds what comes after the first quarter of each run.
function settledRange(pick) {
  return () => {
    const all = page.compare.runs.flatMap((run) => (pick(run) || []).slice(Math.floor(run.time.length / 4))).filter(finite);
    const low = Math.min(...all), high = Math.max(...all), edge = 0.3 * (high - low || Math.abs(high) || 1);
    return [low - edge, high + edge];
  };
}

function startComparison() {
  for (const [name, title] of Object.entries(page.compare.titles)) {
    const pick = (run) => run.parameters[name] && run.parameters[name].mean;
    compareChart(document.querySelector('[data-chart="compare:' + CSS.escape(name) + '"]'), title, pick, settledRange(pick));
  }
  compareChart(document.querySelector("[data-chart=compare-misfit]"), "Error of each frame, rms [mm]", (run) => run.misfit, fromZero);
}
