// Axes, loads and supports around the surface, with words.
class Surroundings {
  constructor(view, rest, low, high) {
    this.view = view;
    this.low = low;
    this.size = Math.hypot(...low.map((l, a) => high[a] - l));
    this.loads = replays[0].loads;
    this.vertex = this.loads.map((load) => nearestVertex(rest, load.place));
    this.most = this.loads.map((load) => {
      let most = 0;
      for (let i = 0; i < load.value.length; i += 3) most = Math.max(most, Math.hypot(load.value[i], load.value[i + 1], load.value[i + 2]));
      return most || 1;
    });
    this.axes = ["x", "y", "z"].map((name, a) => {
      const arrow = new ArrowMesh(view.scene, 1), along = [0, 1, 2].map((b) => (a === b ? 1 : 0));
      arrow.set(0, low, along, 0.2 * this.size, 0.012 * this.size);
      arrow.finish();
      return { arrow, label: this.label(name), tip: low.map((l, b) => l + 0.22 * this.size * along[b]) };
    });
    this.arrows = new ArrowMesh(view.scene, this.loads.length);
    this.labels = this.loads.map(() => this.label(""));
    this.held = new THREE.BufferGeometry();
    this.held.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(replays[0].held), 3));
    this.supports = new THREE.Points(this.held, new THREE.PointsMaterial({ size: 3 * Math.min(2, devicePixelRatio), sizeAttenuation: false }));
    view.scene.add(this.supports);
  }

  label(text) {
    const e = element("span", { className: "in-view" }, text);
    this.view.host.append(e);
    return e;
  }

  get on() { return $("surroundings").checked; }

  // Forces point at where they act; a prescribed motion points to where it goes.
  show(time, surface) {
    this.tips = this.loads.map((load, i) => {
      const k = nearest(player.replay.time, time), value = load.value.subarray(3 * k, 3 * k + 3), strength = Math.hypot(...value);
      const at = surface.subarray(3 * this.vertex[i], 3 * this.vertex[i] + 3);
      const along = Array.from(value, (x) => x / (strength || 1)), length = 0.3 * this.size * (strength / this.most[i]);
      const from = load.unit === "N" ? Array.from(at, (x, a) => x - length * along[a]) : Array.from(at);
      this.arrows.set(i, from, along, length, 0.022 * this.size * Math.min(1, strength / (0.1 * this.most[i])));
      this.labels[i].textContent = load.name + ": " + withUnit(strength, load.unit, 3);
      return from;
    });
    this.arrows.finish();
  }

  render() {
    const colours = ["--axis-x", "--axis-y", "--axis-z"];
    this.axes.forEach(({ arrow, label, tip }, a) => {
      arrow.mesh.visible = this.on;
      arrow.mesh.material.color.set(colour(colours[a].slice(2)));
      this.view.placeLabel(label, tip, this.on);
    });
    this.arrows.mesh.visible = this.supports.visible = this.on;
    this.arrows.mesh.material.color.set(colour("load"));
    this.supports.material.color.set(colour("text"));
    this.labels.forEach((label, i) => this.view.placeLabel(label, this.tips ? this.tips[i] : this.low, this.on && Boolean(this.tips)));
  }
}
