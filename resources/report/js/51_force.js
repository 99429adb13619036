// Force against displacement, measured and predicted: a loop where the tissue loses energy.
function strongest(loads, unit) {
  let best = null, most = 0;
  for (const load of loads.filter((l) => l.unit === unit)) {
    for (let i = 0; i < load.value.length; i += 3) {
      const value = load.value.subarray(i, i + 3), size = Math.hypot(...value);
      if (size > most) { most = size; best = { load, most, along: Array.from(value, (x) => x / size) }; }
    }
  }
  return best;
}

const dot = (vectors, along, k) => along.reduce((sum, x, a) => sum + x * vectors[a][k], 0);
const columns = (flat) => [0, 1, 2].map((a) => Float64Array.from({ length: flat.length / 3 }, (x, k) => flat[3 * k + a]));

// What is plotted: {title, x label, y label, curves of {name, x, y}}; null where nothing was measured of it.
function forceCurves(track, component) {
  const push = strongest(player.replay.loads, "N"), drive = strongest(player.replay.loads, "m");
  const reaction = player.replay.tracks.find((t) => t.unit === "N" && t.components.length === 3);
  const words = (along) => "(" + along.map((x) => x.toFixed(2)).join(", ") + ")";
  const list = (make) => Array.from(player.replay.time, (t, k) => make(k));
  if (drive && reaction) {
    const motion = columns(drive.load.value), x = list((k) => 1e3 * dot(motion, drive.along, k));
    const most = Math.max(...reaction.components.flatMap((c) => [...c.measured]).filter(Number.isFinite).map(Math.abs)), unit = shownUnit(most, "N");
    const force = (kind) => list((k) => unit.scale * dot(reaction.components.map((c) => c[kind]), drive.along, k));
    return { title: "Force against displacement: " + drive.load.name + ", along " + words(drive.along), x: "displacement [mm]", y: "force [" + unit.name + "]",
      curves: ["measured", "predicted"].map((kind) => ({ name: kind, x, y: force(kind) })) };
  }
  if (!push || track.unit !== "m" || !track.components[component]) return null;
  const unit = shownUnit(push.most, "N");
  const load = columns(push.load.value), y = list((k) => unit.scale * dot(load, push.along, k)), whole = track.components.length === 3;
  const moved = (kind) => {
    const parts = whole ? track.components.map((c) => c[kind]) : [track.components[component][kind]];
    const along = whole ? push.along : [1], first = Math.max(0, list((k) => dot(parts, along, k)).findIndex(Number.isFinite));
    return list((k) => 1e3 * (dot(parts, along, k) - dot(parts, along, first)));
  };
  return { title: "Force against displacement: " + push.load.name + ", " + track.name + (whole ? ", along " + words(push.along) : ""),
    x: "displacement [mm]", y: "force [" + unit.name + "]", curves: ["measured", "predicted"].map((kind) => ({ name: kind, x: moved(kind), y })) };
}

// A curve that may turn back, which uPlot's own lines may not.
function loop(u, i) {
  const [xs, ys] = u.data[i], context = u.ctx;
  context.save();
  context.beginPath();
  context.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  context.clip();
  context.strokeStyle = u.series[i].stroke();
  context.lineWidth = 1.6 * devicePixelRatio;
  context.beginPath();
  let drawn = false;
  xs.forEach((x, k) => {
    if (!finite(x) || !finite(ys[k])) { drawn = false; return; }
    const at = [u.valToPos(x, "x", true), u.valToPos(ys[k], "y", true)];
    if (drawn) context.lineTo(...at); else context.moveTo(...at);
    drawn = true;
  });
  context.stroke();
  context.restore();
  return null;
}

function startForce(track, component) {
  const host = document.querySelector("[data-chart=force]");
  if (!forceCurves(track(), component())) { host.remove(); return null; }
  let last = null;
  const showNow = (u, found) => {
    const k = nearest(player.replay.time, player.time);
    u.over.querySelectorAll(".now").forEach((e, i) => {
      const x = found.curves[i].x[k], y = found.curves[i].y[k];
      e.hidden = !finite(x) || !finite(y);
      if (e.hidden) return;
      e.style.left = u.valToPos(x, "x") + "px";
      e.style.top = u.valToPos(y, "y") + "px";
      e.style.background = colour(found.curves[i].name);
    });
  };
  const chart = addChart(host, () => {
    const found = forceCurves(track(), component()) || last;
    last = found;
    const span = (key) => {
      const all = found.curves.flatMap((c) => c[key]).filter(Number.isFinite), low = Math.min(...all), high = Math.max(...all);
      const edge = 0.06 * (high - low || 1);
      return () => [low - edge, high + edge];
    };
    const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
    return {
      title: found.title, mode: 2, legend: { show: false }, cursor: { show: false },
      note: element("span", { className: "key" }, element("i", { className: "line-measured" }), "measured ", element("i", { className: "line-predicted" }), "predicted, " + player.replay.name),
      data: [null, ...found.curves.map((c) => [c.x, c.y])],
      scales: { x: { time: false, auto: false, range: span("x") }, y: { auto: false, range: span("y") } },
      axes: [axis(found.x), axis(found.y, { size: 62 })],
      series: [null, ...found.curves.map((c) => ({ label: c.name, stroke: colour(c.name), facets, paths: loop, points: { show: false } }))],
      table: [{ name: "time since the first stamp [s]", values: Array.from(player.replay.time) },
        ...found.curves.flatMap((c) => [{ name: c.name + " " + found.x, values: c.x }, { name: found.y, values: c.y }])],
      hooks: { ready: [(u) => { u.over.append(...found.curves.map((c) => element("i", { className: "now" }))); showNow(u, found); }], setSize: [(u) => showNow(u, found)] },
    };
  });
  player.listen(() => showNow(chart.plot, last));
  return chart;
}
