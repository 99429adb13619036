// Theme, and everything into its place.
const themes = ["auto", "light", "dark"];

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  $("theme").textContent = { auto: "◐", light: "☀", dark: "☾" }[theme];
  $("theme").title = "Colours: " + theme;
  for (const chart of charts) chart.draw();
  if (replays.length) player.tell();
}

$("theme").addEventListener("click", () => {
  setTheme(themes[(themes.indexOf(document.documentElement.dataset.theme) + 1) % themes.length]);
});
document.documentElement.dataset.theme = "auto";
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => setTheme(document.documentElement.dataset.theme));

// Paper is white.
let themeOnScreen = "auto";
addEventListener("beforeprint", () => { themeOnScreen = document.documentElement.dataset.theme; setTheme("light"); });
addEventListener("afterprint", () => setTheme(themeOnScreen));

if (page.course) {
  for (const p of page.course.parameters) {
    const host = document.querySelector('[data-chart="parameter:' + CSS.escape(p.name) + '"]');
    if (host) parameterChart(host, p);
  }
  const misfit = document.querySelector("[data-chart=misfit]");
  if (misfit) misfitChart(misfit);
}
if (page.compare) startComparison();
if (page.diagnosis) { residualCharts(); staircase(); }
if (replays.length) {
  startSurface();
  startMotion();
  startPicture();
  player.listen((time) => { for (const c of charts) if (c.plot.moveClock) c.plot.moveClock(time); });
  startPlayer();
}
// On a phone each row of such a table is a card, and every cell says what it is.
for (const table of document.querySelectorAll("table.stacked")) {
  const heads = Array.from(table.rows[0].cells, (th) => th.textContent);
  for (const row of Array.from(table.rows).slice(1)) Array.from(row.cells).forEach((cell, i) => { cell.dataset.label = heads[i]; });
  table.classList.add("labelled");
}
document.documentElement.dataset.ready = "yes";
