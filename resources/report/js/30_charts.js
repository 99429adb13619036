// Charts with uPlot, in the page's colours. They are made anew when those change.
const charts = [];

const font = '12px system-ui, "Segoe UI", "DejaVu Sans", sans-serif';

function axis(label, extra) {
  return Object.assign({
    stroke: colour("soft"), font, label, labelFont: font, labelSize: 16, labelGap: 0, size: 32,
    grid: { stroke: colour("edge"), width: 1 }, ticks: { stroke: colour("edge"), width: 1, size: 4 },
  }, extra);
}

function nearest(times, time) {
  const at = place(times, time);
  return at.index + (at.share > 0.5 ? 1 : 0);
}

// A vertical line that follows the player's clock; a click on the chart moves the clock.
function clockLine(u) {
  if (!replays.length) return;
  const line = element("div", { className: "clock-line" });
  u.over.append(line);
  const move = (time) => {
    const x = u.valToPos(time, "x");
    line.style.display = x >= 0 && x <= u.over.clientWidth ? "" : "none";
    line.style.transform = "translateX(" + x + "px)";
    if (u.cursor.left < 0) u.setLegend({ idx: nearest(u.data[0], time) });
  };
  u.moveClock = move;
  u.over.addEventListener("click", () => {
    if (u.cursor.left >= 0) { setPlaying(false); player.show(u.posToVal(u.cursor.left, "x")); }
  });
  u.over.addEventListener("mouseleave", () => move(player.time));
  move(player.time);
}

// A chart: `make` gives {title, note, data, series, ...uPlot options} each time that it is drawn.
function addChart(host, make) {
  const chart = { host, make, plot: null };
  chart.draw = () => {
    if (chart.plot) chart.plot.destroy();
    host.replaceChildren();
    const { title, note, controls, data, clock, height, ...options } = chart.make();
    if (title) host.append(element("h3", {}, title));
    if (note) host.append(element("p", { className: "soft note" }, note));
    if (controls) host.append(controls);
    const size = { width: Math.max(200, host.clientWidth), height: height || (host.clientWidth < 480 ? 210 : 260) };
    const hooks = Object.assign({}, options.hooks);
    hooks.draw = [...(hooks.draw || []), (u) => { if (u.moveClock) u.moveClock(player.time); }];
    chart.plot = new uPlot(Object.assign(size, {
      cursor: { y: false, points: { size: 7 }, drag: { x: true, y: false } },
    }, options, { hooks }), data, host);
    host.classList.toggle("still", !clock || !replays.length);
    host.setAttribute("role", "img");
    host.setAttribute("aria-label", title || options.label || "chart");
    if (clock) clockLine(chart.plot);
    requestAnimationFrame(() => { if (chart.plot.moveClock) chart.plot.moveClock(player.time); });
  };
  chart.draw();
  charts.push(chart);
  new ResizeObserver(() => {
    const width = Math.max(200, host.clientWidth);
    if (chart.plot && Math.abs(chart.plot.width - width) > 1) {
      chart.plot.setSize({ width, height: chart.plot.height });
    }
  }).observe(host);
  return chart;
}

function line(label, name, extra) {
  return Object.assign({
    label, stroke: colour(name), width: 2, points: { show: false }, value: (u, v) => shortNumber(v, 4), spanGaps: false,
  }, extra);
}

const timeSeries = { label: "time [s]", value: (u, v) => (finite(v) ? v.toFixed(clockDigits()) : "–") };
const constant = (count, value) => Array(count).fill(value);

// Room above the data, zero below.
const fromZero = (u, low, high) => [0, (finite(high) && high > 0 ? high : 1) * 1.08];

const bars = uPlot.paths.bars({ size: [0.75, 60], radius: 0.12 });
function bar(label, name) {
  return { label, paths: bars, stroke: colour(name), fill: colour(name) + "88", width: 1, points: { show: false },
    value: (u, v) => shortNumber(v, 3) };
}
