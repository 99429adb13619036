// The surface in three dimensions, coloured by misfit.
const stops = [[0, "#3b6fb6"], [0.25, "#6fb7c9"], [0.5, "#f4e8a4"], [0.75, "#f0904a"], [1, "#b5172f"]];

function shade(share, out) {
  const s = Math.min(1, Math.max(0, share));
  let k = 0;
  while (k < stops.length - 2 && s > stops[k + 1][0]) ++k;
  return out.set(stops[k][1]).lerp(shade.other.set(stops[k + 1][1]), (s - stops[k][0]) / (stops[k + 1][0] - stops[k][0]));
}
shade.other = new THREE.Color();

// Root mean square over the frames at each vertex.
function overFrames(values, vertices) {
  const sum = new Float64Array(vertices), count = new Float64Array(vertices);
  for (let i = 0; i < values.length; ++i) {
    if (Number.isNaN(values[i])) continue;
    sum[i % vertices] += values[i] ** 2;
    count[i % vertices] += 1;
  }
  return sum.map((s, v) => (count[v] > 0 ? Math.sqrt(s / count[v]) : NaN));
}

// For vertices that were never measured: those that were, at most three edges away along the surface.
function neighbours(rest, triangles, everMeasured) {
  const edges = everMeasured.map(() => new Set());
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[i + k], b = triangles[i + ((k + 1) % 3)];
      edges[a].add(b);
      edges[b].add(a);
    }
  }
  const far = (a, b) => Math.hypot(...[0, 1, 2].map((k) => rest[3 * a + k] - rest[3 * b + k]));
  return everMeasured.map((yes, v) => {
    if (yes) return [];
    const known = new Set([v]), found = [];
    let ring = [v];
    for (let step = 0; step < 3; ++step) {
      const next = [];
      for (const r of ring) for (const e of edges[r]) if (!known.has(e)) { known.add(e); next.push(e); }
      for (const e of next) if (everMeasured[e]) found.push({ v: e, far: far(v, e) });
      ring = next;
    }
    return found;
  });
}

class SurfaceView {
  constructor(host, renderer) {
    this.host = host;
    this.renderer = renderer;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    host.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 1e-4, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.render());
    // The page still scrolls over the surface: by wheel without Ctrl, by a finger that goes up or down.
    const canvas = this.renderer.domElement;
    canvas.style.touchAction = "pan-y";
    canvas.addEventListener("pointerdown", () => { this.controls.enableZoom = true; }, { capture: true });
    canvas.addEventListener("wheel", (event) => { this.controls.enableZoom = event.ctrlKey || event.metaKey; }, { capture: true, passive: true });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "Surface of the model, coloured by misfit; drag to turn, Ctrl and wheel to zoom, click to choose a point");
    canvas.title = "Drag to turn, Ctrl and wheel to zoom, click to choose the point that is plotted";
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x99a2b0, 2.2));
    this.sun = new THREE.DirectionalLight(0xffffff, 1.6);
    this.scene.add(this.sun);
    this.build();
    this.resetView();
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  build() {
    const { rest, triangles, time } = replays[0].surface, n = rest.length / 3;
    this.count = n;
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    this.geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(rest), 3));
    this.geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(4 * n), 4));
    // What was measured is solid, and hides what lies behind it; the rest may be glass. Pushed back a little, so that
    // points on the surface are seen whole.
    const material = { vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 60 };
    this.scene.add(new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial({ ...material, alphaTest: 0.6 })),
      new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial({ ...material, transparent: true, depthWrite: false })));
    this.addBox(rest);
    for (const r of replays) {
      r.surface.errorAll = overFrames(r.surface.error, n);
      r.surface.sigmasAll = overFrames(r.surface.sigmas, n);
    }
    // One scale for all models, so that the better one looks it.
    const given = replays[0].surface;
    this.most = { error: quantile(given.error, 0.98) || 1, sigmas: Math.max(3, quantile(given.sigmas, 0.98) || 3) };
    // Outlines pass over the body: one frame alone tells of few places.
    if (given.error.filter(Number.isFinite).length < 0.3 * given.time.length * given.errorAll.filter(Number.isFinite).length) {
      document.querySelector("input[name=span][value=all]").checked = true;
    }
    this.near = neighbours(rest, triangles, Array.from(given.errorAll, (x) => Number.isFinite(x)));
    const told = this.near.filter((near, v) => near.length || Number.isFinite(given.errorAll[v])).length;
    $("glass").checked = told < 0.5 * n;
    this.points = new THREE.BufferGeometry();
    this.tracked = replays[0].tracks.map((t, i) => i).filter((i) => replays[0].tracks[i].components.length === 3);
    this.points.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * this.tracked.length), 3));
    this.dots = new THREE.Points(this.points, new THREE.PointsMaterial({ size: 5 * Math.min(2, devicePixelRatio) / 2 + 2, sizeAttenuation: false }));
    this.dots.frustumCulled = false;
    this.scene.add(this.dots);
    const [low, high] = this.restBox;
    if (page.arrows) this.arrows = new MissingForce(this.scene, rest, Math.hypot(...low.map((l, a) => high[a] - l)));
    this.surroundings = new Surroundings(this, rest, low, high);
    this.mark = new THREE.BufferGeometry();
    this.mark.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3), 3));
    this.marked = new THREE.Points(this.mark, new THREE.PointsMaterial({ size: 13 * Math.min(2, devicePixelRatio) / 2 + 3, sizeAttenuation: false, depthTest: false }));
    this.marked.frustumCulled = false;
    this.scene.add(this.marked);
    this.chosen = -1;
    this.listenForClicks();
  }

  addBox(rest) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const { displacement } = replays[0].surface;
    const stretch = (values, base) => values.forEach((v, i) => {
      const x = base ? base[i % base.length] + v : v;
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    });
    stretch(rest);
    this.restBox = [low.slice(), high.slice()];
    stretch(displacement, rest);
    this.low = low;
    this.high = high;
    const corner = (k) => [0, 1, 2].map((a) => ((k >> a) & 1 ? high[a] : low[a]));
    const edges = [];
    for (let k = 0; k < 8; ++k) for (let a = 0; a < 3; ++a) if (!((k >> a) & 1)) edges.push(...corner(k), ...corner(k | (1 << a)));
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(edges), 3));
    this.box = new THREE.LineSegments(lines, new THREE.LineBasicMaterial());
    this.scene.add(this.box);
    const [a, b] = this.restBox;
    this.host.append(element("span", { className: "soft size" },
      "at rest " + [0, 1, 2].map((i) => shortNumber(1e3 * (b[i] - a[i]), 3)).join(" × ") + " mm (x, y, z)"));
  }

  // Where a place is on the canvas [pixel], and how far away.
  project(at) {
    const p = new THREE.Vector3(...at).project(this.camera);
    return { x: 0.5 * (1 + p.x) * this.host.clientWidth, y: 0.5 * (1 - p.y) * this.host.clientHeight, depth: p.z };
  }

  placeLabel(label, at, shown) {
    label.hidden = !shown;
    if (!shown) return;
    const { x, y } = this.project(at);
    const clamp = (v, most) => Math.min(Math.max(v, 2), Math.max(2, most - 2));
    label.style.left = clamp(x, this.host.clientWidth - label.offsetWidth) + "px";
    label.style.top = clamp(y - label.offsetHeight, this.host.clientHeight - label.offsetHeight) + "px";
  }

  // Each tracked point belongs to the surface's vertex that is next to it at first.
  followTracks() {
    const { rest, displacement } = replays[0].surface;
    const first = Float64Array.from(rest, (x, i) => x + displacement[i]);
    this.trackVertex = this.tracked.map((t) => {
      const c = replays[0].tracks[t].components, k = c[0].predicted.findIndex(Number.isFinite);
      return nearestVertex(first, c.map((axis) => axis.predicted[Math.max(0, k)]));
    });
  }

  // A click without a drag chooses the tracked point that is nearest to it on the screen, and of near ones the foremost.
  listenForClicks() {
    this.followTracks();
    const canvas = this.renderer.domElement;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => { down = { x: event.clientX, y: event.clientY }; });
    canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down.x, event.clientY - down.y) > 4) return;
      const box = canvas.getBoundingClientRect();
      this.pick(event.clientX - box.left, event.clientY - box.top);
    });
  }

  pick(x, y) {
    const position = this.geometry.attributes.position.array;
    const seen = this.trackVertex.map((v, i) => {
      const p = this.project(position.subarray(3 * v, 3 * v + 3));
      return { i, far: Math.hypot(p.x - x, p.y - y), depth: p.depth };
    });
    const least = Math.min(...seen.map((p) => p.far));
    if (!(least < 40)) return;
    const best = seen.filter((p) => p.far < least + 12).sort((a, b) => a.depth - b.depth)[0];
    if (best && this.onPick) this.onPick(this.tracked[best.i]);
  }

  choose(track) {
    this.chosen = this.tracked.indexOf(track);
    this.placeMark();
    this.render();
  }

  placeMark() {
    this.marked.visible = this.chosen >= 0;
    if (!this.marked.visible) return;
    const v = this.trackVertex[this.chosen];
    this.mark.attributes.position.array.set(this.geometry.attributes.position.array.subarray(3 * v, 3 * v + 3));
    this.mark.attributes.position.needsUpdate = true;
  }

  resetView() {
    const centre = new THREE.Vector3(...this.low.map((l, i) => 0.5 * (l + this.high[i])));
    const radius = 0.5 * Math.hypot(...this.low.map((l, i) => this.high[i] - l));
    const narrow = Math.min(1, this.host.clientWidth / Math.max(1, this.host.clientHeight));
    const distance = (0.9 * radius) / Math.sin((Math.PI / 180) * 16) / narrow;
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(new THREE.Vector3(0.72, -1, 0.55).normalize().multiplyScalar(distance));
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.render();
  }

  resize() {
    const width = Math.max(50, this.host.clientWidth), height = Math.max(50, this.host.clientHeight);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  render() {
    this.sun.position.copy(this.camera.position);
    this.box.material.color.set(colour("edge"));
    this.dots.material.color.set(colour("text"));
    if (this.arrows) this.arrows.mesh.material.color.set(colour("force"));
    this.marked.material.color.set(colour("accent"));
    this.surroundings.render();
    this.renderer.render(this.scene, this.camera);
  }

  // Displacement between two kept frames, misfit of the nearer one.
  show(time) {
    const s = player.replay.surface, at = place(s.time, time), n = 3 * this.count;
    const from = at.index * n, next = Math.min(at.index + 1, s.time.length - 1) * n;
    const magnify = Number($("magnify-value").textContent);
    const position = this.geometry.attributes.position.array;
    for (let i = 0; i < n; ++i) {
      position[i] = s.rest[i] + magnify * ((1 - at.share) * s.displacement[from + i] + at.share * s.displacement[next + i]);
    }
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.geometry.computeBoundingSphere();
    this.paint(s, at.share > 0.5 ? next / 3 : from / 3);
    this.placeDots(time, magnify);
    if (this.arrows) this.arrows.show(time, position);
    this.surroundings.show(time, position);
    this.placeMark();
    this.render();
  }

  paint(s, from) {
    const kind = document.querySelector("input[name=colour]:checked").value;
    const all = document.querySelector("input[name=span]:checked").value === "all";
    const values = all ? s[kind + "All"] : s[kind], start = all ? 0 : from;
    const most = this.most[kind], colours = this.geometry.attributes.color.array, c = new THREE.Color();
    const nothing = new THREE.Color("#8d96a3"), glass = $("glass").checked ? 0.16 : 1;
    for (let v = 0; v < this.count; ++v) {
      let value = values[start + v];
      if (Number.isNaN(value)) {
        let sum = 0, weight = 0;
        for (const near of this.near[v]) {
          const x = values[start + near.v];
          if (!Number.isNaN(x)) { sum += x / near.far; weight += 1 / near.far; }
        }
        value = weight > 0 ? sum / weight : NaN;
      }
      const shown = Number.isNaN(value) ? nothing : shade(value / most, c);
      colours.set([shown.r, shown.g, shown.b, shown === nothing ? glass : 1], 4 * v);
    }
    this.geometry.attributes.color.needsUpdate = true;
    this.drawScale(kind, most);
  }

  drawScale(kind, most) {
    const unit = kind === "error" ? " mm" : " sigma";
    $("colour-bar").replaceChildren(element("span", {}, "0"), element("i", {}),
      element("span", {}, shortNumber(most, 2) + unit), element("em", {}, "nothing measured"));
  }

  // What is shown, one row a vertex.
  table() {
    const s = player.replay.surface, k = nearest(s.time, player.time), all = document.querySelector("input[name=span]:checked").value === "all";
    const part = (values, a) => Array.from({ length: this.count }, (x, v) => 1e3 * values[3 * v + a]);
    const moved = s.displacement.subarray(3 * this.count * k, 3 * this.count * (k + 1));
    const misfit = (kind) => Array.from(all ? s[kind + "All"] : s[kind].subarray(this.count * k, this.count * (k + 1)));
    const axes = ["x", "y", "z"];
    return [...axes.map((name, a) => ({ name: name + " at rest [mm]", values: part(s.rest, a) })),
      ...axes.map((name, a) => ({ name: "displacement " + name + " at " + s.time[k] + " s [mm]", values: part(moved, a) })),
      { name: "misfit [mm]", values: misfit("error") }, { name: "misfit [sigma]", values: misfit("sigmas") }];
  }

  // Measured positions, which mean nothing beside a magnified body.
  placeDots(time, magnify) {
    this.dots.visible = Boolean($("measured") && $("measured").checked) && magnify === 1;
    if (!this.dots.visible) return;
    const k = nearest(player.replay.time, time), array = this.points.attributes.position.array;
    this.tracked.forEach((t, i) => player.replay.tracks[t].components.forEach((c, a) => { array[3 * i + a] = c.measured[k]; }));
    this.points.attributes.position.needsUpdate = true;
  }

  turn(on) {
    this.controls.autoRotate = on;
    const step = () => {
      if (!this.controls.autoRotate) return;
      this.controls.update();
      requestAnimationFrame(step);
    };
    if (on) requestAnimationFrame(step);
  }
}

let surfaceView = null;

function startSurface() {
  const host = $("surface");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  } catch (error) {
    host.replaceChildren(element("p", { className: "soft" }, "This browser cannot show the surface (no WebGL)."));
    host.dataset.webgl = "no";
    return;
  }
  const view = new SurfaceView(host, renderer);
  surfaceView = view;
  const gradient = stops.map(([at, c]) => c + " " + 100 * at + "%").join(",");
  document.documentElement.style.setProperty("--misfit-scale", "linear-gradient(90deg," + gradient + ")");
  if (!view.tracked.length) $("measured").closest("label").remove();
  player.listen((time) => view.show(time));
  const again = () => view.show(player.time);
  for (const input of document.querySelectorAll("input[name=colour],input[name=span]")) input.addEventListener("change", again);
  if ($("measured")) $("measured").addEventListener("change", again);
  $("magnify").addEventListener("input", () => {
    $("magnify-value").textContent = [1, 2, 5, 10, 20, 50][Number($("magnify").value)];
    again();
  });
  $("glass").addEventListener("change", again);
  $("surroundings").addEventListener("change", again);
  $("surface-saves").append(saveButtons("surface", () => view.table(), () => savePicture("surface", renderer.domElement, "")));
  if ($("arrows")) $("arrows").addEventListener("change", again);
  $("turn").addEventListener("change", () => view.turn($("turn").checked));
  $("view").addEventListener("click", () => view.resetView());
}
