// One tracked thing, measured and predicted.
function range(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  return high - low;
}

function liveliest(tracks) {
  let best = { track: 0, component: 0, range: -1 };
  tracks.forEach((track, t) => track.components.forEach((c, k) => {
    const r = range(c.measured);
    if (r > best.range) best = { track: t, component: k, range: r };
  }));
  return best;
}

function startMotion() {
  const host = document.querySelector("[data-chart=motion]"), tracks = $("track"), components = $("component");
  if (!player.replay.tracks.length) return;
  const best = liveliest(player.replay.tracks);
  player.replay.tracks.forEach((t, i) => tracks.append(element("option", { value: i }, t.name)));
  const listComponents = () => {
    const before = components.value;
    const list = player.replay.tracks[Number(tracks.value)].components;
    components.replaceChildren(...list.map((c, i) => element("option", { value: i }, c.name)));
    components.value = before !== "" && Number(before) < list.length ? before : "0";
  };
  tracks.value = best.track;
  listComponents();
  components.value = best.component;
  const chart = addChart(host, () => {
    const track = player.replay.tracks[Number(tracks.value)], c = track.components[Number(components.value)];
    const most = Math.max(...[...c.measured, ...c.predicted].filter(Number.isFinite).map(Math.abs));
    const { scale, name: unit } = shownUnit(most, track.unit);
    const values = (list) => Array.from(list, (v) => (Number.isFinite(v) ? scale * v : null));
    return {
      title: track.name + ", " + c.name + " [" + unit + "]",
      clock: true,
      data: [player.replay.time, values(c.measured), values(c.predicted)],
      scales: { x: { time: false } },
      axes: [axis("time since the first stamp [s]"), axis(null, { size: 62 })],
      series: [timeSeries, line("measured", "measured", { width: 1, points: { show: true, size: 4, fill: colour("measured"), space: 0 } }),
        line("predicted, " + player.replay.name, "predicted")],
    };
  });
  const force = startForce(() => player.replay.tracks[Number(tracks.value)], () => Number(components.value));
  const draw = () => { chart.draw(); if (force) force.draw(); tellPoint(Number(tracks.value)); };
  tracks.addEventListener("change", () => { listComponents(); draw(); });
  components.addEventListener("change", draw);
  if (surfaceView) {
    surfaceView.onPick = (track) => { tracks.value = track; listComponents(); draw(); };
    tellPoint(Number(tracks.value));
  }
  let drawn = player.model;
  player.listen(() => { if (drawn !== player.model) { drawn = player.model; draw(); } });
}

// What is plotted is marked on the surface.
function tellPoint(track) {
  if (!surfaceView) return;
  surfaceView.choose(track);
  if (surfaceView.tracked.length) $("picked").textContent = "Plotted: " + player.replay.tracks[track].name + ". Click the surface for another point.";
}
