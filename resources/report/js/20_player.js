// The one clock of the page: whoever shows an instant listens to it.
const player = {
  time: 0, model: 0, playing: false, listeners: [],
  get replay() { return replays[this.model]; },
  get first() { return this.replay.time[0]; },
  get last() { return this.replay.time[this.replay.time.length - 1]; },
  listen(act) { this.listeners.push(act); },
  tell() { for (const act of this.listeners) act(this.time); },
  show(time) {
    this.time = Math.min(this.last, Math.max(this.first, time));
    $("scrub").value = this.time;
    $("clock").textContent = this.time.toFixed(clockDigits()) + " s";
    this.tell();
  },
};

// A hundredth of the recording can be told.
function clockDigits() {
  const times = replays.length ? player.replay.time : page.course ? page.course.time : page.compare.runs[0].time, span = times[times.length - 1] - times[0];
  return span > 0 ? Math.min(6, Math.max(1, Math.ceil(2 - Math.log10(span)))) : 2;
}

// Speeds that show the recording in about so many seconds; the first one that takes ten or less is taken.
function listSpeeds() {
  const span = player.last - player.first, list = $("speed");
  for (const speed of [8, 4, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001]) {
    const seconds = span / speed;
    if (seconds >= 2 && seconds <= 120) list.append(element("option", { value: speed }, speed + "×"));
  }
  if (!list.options.length) list.append(element("option", { value: 1 }, "1×"));
  const speeds = Array.from(list.options, (o) => Number(o.value));
  list.value = speeds.includes(1) && span <= 30 ? 1 : speeds.filter((s) => span / s <= 10).pop() || speeds[0];
}

function setPlaying(on) {
  player.playing = on;
  $("play").textContent = on ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", on ? "Pause" : "Play");
  if (!on) return;
  if (player.time >= player.last) player.show(player.first);
  let before = performance.now();
  const step = (now) => {
    if (!player.playing) return;
    const seconds = ((now - before) / 1000) * Number($("speed").value);
    before = now;
    player.show(player.time + seconds);
    if (player.time >= player.last) return setPlaying(false);
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

function startPlayer() {
  const scrub = $("scrub");
  scrub.min = player.first;
  scrub.max = player.last;
  listSpeeds();
  scrub.addEventListener("input", () => { setPlaying(false); player.show(Number(scrub.value)); });
  $("play").addEventListener("click", () => setPlaying(!player.playing));
  for (const radio of document.querySelectorAll("input[name=model]")) {
    radio.addEventListener("change", () => { player.model = Number(radio.value); player.show(player.time); });
  }
  document.addEventListener("keydown", (event) => {
    if (/^(INPUT|SELECT|BUTTON|TEXTAREA|SUMMARY)$/.test(event.target.tagName)) return;
    const frame = (player.last - player.first) / Math.max(1, player.replay.time.length - 1);
    if (event.key === " ") { event.preventDefault(); setPlaying(!player.playing); }
    if (event.key === "ArrowRight") player.show(player.time + frame);
    if (event.key === "ArrowLeft") player.show(player.time - frame);
  });
  // The liveliest instant says more than the first, at which nothing has happened yet.
  const rms = player.replay.rms.map((r) => (finite(r) ? r : 0));
  player.show(player.replay.time[rms.indexOf(Math.max(...rms))]);
}
