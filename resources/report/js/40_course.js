// The estimate and its error over time.
function parameterChart(host, parameter) {
  const course = page.course, quarter = Math.floor(course.time.length / 4);
  const height = (from) => Math.max(...parameter.upper.slice(from).filter(finite)) -
    Math.min(...parameter.lower.slice(from).filter(finite));
  const wide = quarter > 0 && height(0) > 6 * height(quarter);
  let close = false;
  addChart(host, () => {
    const from = close ? quarter : 0;
    const cut = (list) => list.slice(from);
    const lower = cut(parameter.lower), upper = cut(parameter.upper);
    const low = Math.min(...lower.filter(finite)), high = Math.max(...upper.filter(finite));
    const logarithmic = low > 0 && high > 8 * low;
    let controls = null;
    if (wide) {
      const box = element("input", { type: "checkbox", checked: close, id: "close-" + parameter.name });
      box.addEventListener("change", () => { close = box.checked; charts.find((c) => c.host === host).draw(); });
      controls = element("label", { className: "tick" }, box, " close-up of the later frames");
    }
    const last = parameter.mean.filter(finite).pop();
    return {
      title: parameter.title + (parameter.unit ? " [" + parameter.unit + "]" : ""),
      controls, clock: true,
      data: [cut(course.time), cut(parameter.mean), lower, upper],
      scales: { x: { time: false }, y: logarithmic ? { distr: 3, range: () => [low / 1.15, high * 1.15] } : { range: (u, a, b) => uPlot.rangeNum(a, b, 0.08, true) } },
      axes: [axis("time since the first stamp [s]"), axis(null, {
        size: 62, ...(logarithmic ? { splits: () => roundSteps(low / 1.15, high * 1.15), filter: (u, ticks) => ticks } : {}),
        values: (u, ticks) => ticks.map((v) => (v === null ? "" : shortNumber(v, 4))) })],
      series: [timeSeries, line("estimate", "predicted"),
        line("95 % from", "predicted", { width: 0.5 }), line("to", "predicted", { width: 0.5 })],
      bands: [{ series: [3, 2], fill: colour("band") }],
      hooks: { draw: [(u) => level(u, last, colour("predicted"))] },
    };
  });
}

// 1, 2 and 5 times powers of ten in between; over many decades powers of ten alone.
function roundSteps(low, high) {
  const all = [], decades = Math.log10(high / low);
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    for (const digit of decades > 3 ? [1] : [1, 2, 5]) all.push(digit * 10 ** power);
  }
  return all.filter((x) => x >= low && x <= high);
}

// A dashed level across the chart.
function level(u, value, stroke) {
  if (!finite(value)) return;
  const y = Math.round(u.valToPos(value, "y", true)), { left, top, width, height } = u.bbox;
  if (y < top || y > top + height) return;
  u.ctx.save();
  u.ctx.strokeStyle = stroke;
  u.ctx.setLineDash([6, 5]);
  u.ctx.lineWidth = devicePixelRatio;
  u.ctx.beginPath();
  u.ctx.moveTo(left, y);
  u.ctx.lineTo(left + width, y);
  u.ctx.stroke();
  u.ctx.restore();
}

function skippedMarks(u) {
  const { top, height } = u.bbox;
  u.ctx.save();
  u.ctx.fillStyle = colour("bad");
  for (const time of page.course.skipped) {
    u.ctx.fillRect(Math.round(u.valToPos(time, "x", true)) - 1, top + 0.94 * height, 2, 0.06 * height);
  }
  u.ctx.restore();
}

function misfitChart(host) {
  const course = page.course, n = course.time.length;
  addChart(host, () => ({
    title: "Error of each frame, rms [mm]",
    note: course.skipped.length ? "Red marks: frames that could not be used." : "",
    clock: true,
    data: [course.time, course.misfit, constant(n, course.noise), course.sigmas],
    scales: { x: { time: false }, y: { range: fromZero } },
    axes: [axis("time since the first stamp [s]"), axis(null, { size: 62 })],
    series: [timeSeries, line("measurement − model", "error", { fill: colour("error-soft") }),
      line("noise of the sensors", "noise", { dash: [6, 5] }), { label: "in sigmas", scale: "none", stroke: "transparent", points: { show: false },
        value: (u, v) => shortNumber(v, 3) }],
    hooks: { draw: [skippedMarks] },
  }));
}
