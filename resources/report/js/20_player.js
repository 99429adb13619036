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
    $("clock").textContent = this.time.toFixed(2) + " s";
    this.tell();
  },
};

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
  const rms = player.replay.rms;
  let worst = 0;
  for (let i = 0; i < rms.length; ++i) if (finite(rms[i]) && rms[i] > rms[worst]) worst = i;
  player.show(player.replay.time[worst]);
}
