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

// A chart: `make` gives {title, file (its name, else the title), note, data, series, ...uPlot options} each time that it is drawn.
function addChart(host, make) {
  const chart = { host, make, plot: null };
  host.dataset.plot = "chart";
  chart.draw = () => {
    if (chart.plot) chart.plot.destroy();
    host.replaceChildren();
    const { title, file, note, controls, data, clock, height, table, ...options } = chart.make();
    if (title) host.append(element("h3", {}, title, saveButtons(file || title, () => chart.table, () => savePicture(file || title, chart.plot.ctx.canvas, title))));
    if (note) host.append(element("p", { className: "soft note" }, note));
    if (controls) host.append(controls);
    const size = { width: Math.max(200, host.clientWidth), height: height || (host.clientWidth < 480 ? 210 : 260) };
    const hooks = Object.assign({}, options.hooks);
    hooks.draw = [...(hooks.draw || []), (u) => { if (u.moveClock) u.moveClock(player.time); }];
    chart.table = table || tableOf(options, data);
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

// The chart's numbers as columns with a heading.
function tableOf(options, data) {
  const label = (options.axes && options.axes[0].label) || "x";
  return data.map((values, i) => ({ name: i === 0 ? label : options.series[i].label, values }));
}

function csvOf(table) {
  const cell = (x) => (x === null || x === undefined || Number.isNaN(x) ? "" : typeof x === "string" ? '"' + x.replaceAll('"', '""') + '"' : String(x));
  const rows = [table.map((c) => cell(c.name))];
  for (let k = 0; k < Math.max(...table.map((c) => c.values.length)); ++k) rows.push(table.map((c) => cell(c.values[k])));
  return rows.map((row) => row.join(",")).join("\r\n") + "\r\n";
}

function save(name, blob) {
  const link = element("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);  // a busy browser reads the file late
}

const fileName = (title) => title.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_|_$/g, "").toLowerCase() || "chart";

// A canvas on the page's ground, below its title.
function savePicture(name, canvas, title) {
  const scale = devicePixelRatio, head = title ? 28 * scale : 0;
  const sheet = element("canvas", { width: canvas.width, height: canvas.height + head }), context = sheet.getContext("2d");
  context.fillStyle = colour("card");
  context.fillRect(0, 0, sheet.width, sheet.height);
  context.fillStyle = colour("text");
  context.font = "600 " + 14 * scale + "px system-ui, sans-serif";
  if (title) context.fillText(title, 8 * scale, 19 * scale);
  context.drawImage(canvas, 0, head);
  sheet.toBlob((blob) => save(fileName(name) + ".png", blob));
}

// Buttons that save a plot: `table` gives its numbers as columns, `picture` saves what it shows.
function saveButtons(title, table, picture) {
  const button = (kind, act) => element("button", { type: "button", name: "save-" + kind, className: "save", title: "Save this plot as " + kind.toUpperCase(), onclick: act }, kind.toUpperCase());
  return element("span", { className: "saves" },
    button("csv", () => save(fileName(title) + ".csv", new Blob([csvOf(table())], { type: "text/csv" }))),
    button("png", picture));
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
